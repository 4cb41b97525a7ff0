#include "gpu/program.h"

#include "gpu/gl_table.inc"

#include <array>
#include <stdexcept>

namespace surfelao {
namespace {

/// One compiled shader of a stage.
GlHandle compile(const GlTable& gl, GLenum stage, std::string_view file,
                 std::span<const ShaderFile> files, std::span<const std::string> definitions)
{
    const ShaderSource source = assemble_shader(files, file, definitions);
    GlHandle shader(gl, gl.CreateShader(stage),
                    [](const GlTable& table, unsigned name) { table.DeleteShader(name); });
    const char* text = source.text.c_str();
    gl.ShaderSource(shader.id(), 1, &text, nullptr);
    gl.CompileShader(shader.id());
    GLint compiled = GL_FALSE;
    gl.GetShaderiv(shader.id(), GL_COMPILE_STATUS, &compiled);
    if (compiled != GL_TRUE) {
        std::array<char, 4096> log{};
        gl.GetShaderInfoLog(shader.id(), static_cast<GLsizei>(log.size()), nullptr, log.data());
        throw std::runtime_error("the shader " + std::string(file) + " does not compile:\n" +
                                 name_files_in_log(log.data(), source.files));
    }
    return shader;
}

}  // namespace

Program::Program(const GlContext& context, std::string_view vertex_file,
                 std::string_view fragment_file, std::span<const std::string> definitions,
                 std::span<const ShaderFile> files)
    : name_(std::string(vertex_file) + " + " + std::string(fragment_file))
{
    const GlTable& gl = context.gl();
    const GlHandle vertex = compile(gl, GL_VERTEX_SHADER, vertex_file, files, definitions);
    const GlHandle fragment = compile(gl, GL_FRAGMENT_SHADER, fragment_file, files, definitions);
    handle_ = GlHandle(gl, gl.CreateProgram(),
                       [](const GlTable& table, unsigned name) { table.DeleteProgram(name); });
    gl.AttachShader(handle_.id(), vertex.id());
    gl.AttachShader(handle_.id(), fragment.id());
    gl.LinkProgram(handle_.id());
    GLint linked = GL_FALSE;
    gl.GetProgramiv(handle_.id(), GL_LINK_STATUS, &linked);
    if (linked != GL_TRUE) {
        std::array<char, 4096> log{};
        gl.GetProgramInfoLog(handle_.id(), static_cast<GLsizei>(log.size()), nullptr, log.data());
        throw std::runtime_error("the shaders " + name_ + " do not link:\n" + log.data());
    }

    GLint count = 0;
    gl.GetProgramiv(handle_.id(), GL_ACTIVE_UNIFORMS, &count);
    for (GLint i = 0; i < count; ++i) {
        std::array<char, 256> name{};
        GLint size = 0;
        GLenum type = 0;
        gl.GetActiveUniform(handle_.id(), static_cast<GLuint>(i), static_cast<GLsizei>(name.size()),
                            nullptr, &size, &type, name.data());
        locations_[name.data()] = gl.GetUniformLocation(handle_.id(), name.data());
    }
    check_gl(gl, "making a program");
}

std::vector<std::string> Program::uniforms() const
{
    std::vector<std::string> names;
    for (const auto& [name, unused] : locations_)
        names.push_back(name);
    return names;
}

int Program::location(std::string_view uniform) const
{
    const auto found = locations_.find(uniform);
    if (found == locations_.end())
        throw std::runtime_error("the shaders " + name_ + " use no uniform '" +
                                 std::string(uniform) + "'");
    handle_.gl().UseProgram(handle_.id());
    return found->second;
}

void Program::set(std::string_view uniform, float value) const
{
    handle_.gl().Uniform1f(location(uniform), value);
}

void Program::set(std::string_view uniform, int value) const
{
    handle_.gl().Uniform1i(location(uniform), value);
}

void Program::set(std::string_view uniform, unsigned value) const
{
    handle_.gl().Uniform1ui(location(uniform), value);
}

void Program::set(std::string_view uniform, glm::ivec2 value) const
{
    handle_.gl().Uniform2i(location(uniform), value.x, value.y);
}

void Program::set(std::string_view uniform, glm::vec2 value) const
{
    handle_.gl().Uniform2f(location(uniform), value.x, value.y);
}

void Program::set(std::string_view uniform, glm::vec3 value) const
{
    handle_.gl().Uniform3f(location(uniform), value.x, value.y, value.z);
}

void Program::set(std::string_view uniform, glm::vec4 value) const
{
    handle_.gl().Uniform4f(location(uniform), value.x, value.y, value.z, value.w);
}

void Program::set(std::string_view uniform, const glm::mat3& value) const
{
    handle_.gl().UniformMatrix3fv(location(uniform), 1, GL_FALSE, &value[0].x);
}

void Program::set(std::string_view uniform, const glm::mat4& value) const
{
    handle_.gl().UniformMatrix4fv(location(uniform), 1, GL_FALSE, &value[0].x);
}

void Program::set(std::string_view sampler, const TextureBuffer& texture)
{
    bind(sampler, texture.binding());
}

void Program::set(std::string_view sampler, const Texture2D& texture)
{
    bind(sampler, texture.binding());
}

void Program::set(std::string_view sampler, const Texture3D& texture)
{
    bind(sampler, texture.binding());
}

void Program::bind(std::string_view sampler, TextureBinding texture)
{
    location(sampler);  // refuses an unknown name
    textures_.insert_or_assign(std::string(sampler), texture);
}

void Program::use() const
{
    const GlTable& gl = handle_.gl();
    gl.UseProgram(handle_.id());
    GLint unit = 0;
    for (const auto& [sampler, texture] : textures_) {
        gl.ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
        gl.BindTexture(texture.target, texture.id);
        gl.Uniform1i(locations_.find(sampler)->second, unit);
        ++unit;
    }
    gl.ActiveTexture(GL_TEXTURE0);
}

}  // namespace surfelao

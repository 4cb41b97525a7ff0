/// program.h: shaders made ready to run, and what they are given.
#pragma once

#include "gpu/objects.h"
#include "gpu/shader_source.h"

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace surfelao {

/// A vertex and a fragment shader, compiled and linked. Uniforms keep their values between draws.
class Program {
public:
    /// By file name in shaders/; definitions: see assemble_shader. Throws std::runtime_error with
    /// the driver's log, our file and line when the driver does not take them. Costs 30 to 70 ms on
    /// llvmpipe (at the first draw): make once, use often.
    Program(const GlContext& context, std::string_view vertex_file, std::string_view fragment_file,
            std::span<const std::string> definitions = {},
            std::span<const ShaderFile> files = shader_files());

    /// Names of the uniforms that the linked program uses.
    std::vector<std::string> uniforms() const;

    /// Throws std::runtime_error when the program uses no uniform of that name.
    void set(std::string_view uniform, float value) const;
    void set(std::string_view uniform, int value) const;
    void set(std::string_view uniform, unsigned value) const;
    void set(std::string_view uniform, glm::ivec2 value) const;
    void set(std::string_view uniform, glm::vec2 value) const;
    void set(std::string_view uniform, glm::vec3 value) const;
    void set(std::string_view uniform, glm::vec4 value) const;
    void set(std::string_view uniform, const glm::mat3& value) const;
    void set(std::string_view uniform, const glm::mat4& value) const;

    /// Binds a texture to a sampler for the draws that follow; the texture must live until then.
    void set(std::string_view sampler, const TextureBuffer& texture);
    void set(std::string_view sampler, const Texture2D& texture);
    void set(std::string_view sampler, const Texture3D& texture);

    /// Makes it the program of the next draw, with its textures. Called by draw().
    void use() const;

private:
    int location(std::string_view uniform) const;
    void bind(std::string_view sampler, TextureBinding texture);
    GlHandle handle_;
    std::string name_;
    std::map<std::string, int, std::less<>> locations_;
    std::map<std::string, TextureBinding, std::less<>> textures_;
};

}  // namespace surfelao

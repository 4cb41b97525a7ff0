#include "gpu/objects.h"

#include "gpu/gl_table.inc"
#include "surfels/errors.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace surfelao {
namespace {

struct FormatNames {
    GLint internal;
    GLenum layout;
    GLenum type;
    std::size_t bytes;
};

FormatNames names_of(TexelFormat format)
{
    switch (format) {
        case TexelFormat::rgba8:
            return {GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, 4};
        case TexelFormat::srgb8_alpha8:
            return {GL_SRGB8_ALPHA8, GL_RGBA, GL_UNSIGNED_BYTE, 4};
        case TexelFormat::r32f:
            return {GL_R32F, GL_RED, GL_FLOAT, 4};
        case TexelFormat::rg32f:
            return {GL_RG32F, GL_RG, GL_FLOAT, 8};
        case TexelFormat::rgba32f:
            return {GL_RGBA32F, GL_RGBA, GL_FLOAT, 16};
        case TexelFormat::r32ui:
            return {GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, 4};
        case TexelFormat::rgba32ui:
            return {GL_RGBA32UI, GL_RGBA_INTEGER, GL_UNSIGNED_INT, 16};
        case TexelFormat::depth32f:
            return {GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT, 4};
    }
    SURFELAO_CHECK(false);
}

GlHandle make_buffer(const GlTable& gl)
{
    GLuint id = 0;
    gl.GenBuffers(1, &id);
    return GlHandle(gl, id,
                    [](const GlTable& table, unsigned name) { table.DeleteBuffers(1, &name); });
}

GlHandle make_texture(const GlTable& gl)
{
    GLuint id = 0;
    gl.GenTextures(1, &id);
    return GlHandle(gl, id,
                    [](const GlTable& table, unsigned name) { table.DeleteTextures(1, &name); });
}

GlHandle make_framebuffer(const GlTable& gl)
{
    GLuint id = 0;
    gl.GenFramebuffers(1, &id);
    return GlHandle(
        gl, id, [](const GlTable& table, unsigned name) { table.DeleteFramebuffers(1, &name); });
}

GlHandle make_vertex_array(const GlTable& gl)
{
    GLuint id = 0;
    gl.GenVertexArrays(1, &id);
    return GlHandle(
        gl, id, [](const GlTable& table, unsigned name) { table.DeleteVertexArrays(1, &name); });
}

void check_size(const GlInfo& info, const char* what, int width, int height)
{
    if (width < 1 || height < 1 || width > info.max_texture_size || height > info.max_texture_size)
        throw std::runtime_error(std::string("OpenGL: a ") + what + " of " + std::to_string(width) +
                                 " x " + std::to_string(height) + " pixels cannot be made; 1 to " +
                                 std::to_string(info.max_texture_size) + " a side can");
}

std::size_t texels_of(TexelFormat format, std::span<const std::byte> bytes)
{
    SURFELAO_CHECK(bytes.size() % names_of(format).bytes == 0);
    return bytes.size() / names_of(format).bytes;
}

/// Bytes to allocate for a texture buffer: an empty one gets a texel, drivers differ on no bytes.
std::size_t checked_buffer_size(const GlInfo& info, TexelFormat format, std::size_t texels)
{
    const std::size_t limit = static_cast<std::size_t>(info.max_buffer_texels);
    if (texels > limit)
        throw std::runtime_error("OpenGL: a texture buffer of " + std::to_string(texels) +
                                 " texels cannot be made; this device takes " +
                                 std::to_string(limit));
    return std::max<std::size_t>(texels, 1) * names_of(format).bytes;
}

}  // namespace

// --- Buffer
// ---------------------------------------------------------------------------------------

Buffer::Buffer(const GlContext& context, std::size_t bytes)
    : handle_(make_buffer(context.gl())), size_(bytes)
{
    // bound as a vertex buffer whatever it is for: that binding belongs to no vertex array
    gl().BindBuffer(GL_ARRAY_BUFFER, id());
    gl().BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(bytes), nullptr, GL_STATIC_DRAW);
    check_gl(gl(), "making a buffer");
}

Buffer::Buffer(const GlContext& context, std::span<const std::byte> bytes)
    : Buffer(context, bytes.size())
{
    update_bytes(0, bytes);
}

void Buffer::update_bytes(std::size_t offset, std::span<const std::byte> bytes)
{
    SURFELAO_CHECK(offset + bytes.size() <= size_);
    gl().BindBuffer(GL_ARRAY_BUFFER, id());
    gl().BufferSubData(GL_ARRAY_BUFFER, static_cast<GLintptr>(offset),
                       static_cast<GLsizeiptr>(bytes.size()), bytes.data());
    check_gl(gl(), "filling a buffer");
}

void Buffer::read_bytes(std::span<std::byte> bytes) const
{
    SURFELAO_CHECK(bytes.size() <= size_);
    gl().BindBuffer(GL_ARRAY_BUFFER, id());
    gl().GetBufferSubData(GL_ARRAY_BUFFER, 0, static_cast<GLsizeiptr>(bytes.size()), bytes.data());
    check_gl(gl(), "reading a buffer");
}

// --- textures
// -------------------------------------------------------------------------------------

TextureBuffer::TextureBuffer(const GlContext& context, TexelFormat format,
                             std::span<const std::byte> bytes)
    : TextureBuffer(context, format, texels_of(format, bytes))
{
    buffer_.update(0, bytes);
}

TextureBuffer::TextureBuffer(const GlContext& context, TexelFormat format, std::size_t texels)
    : buffer_(context, checked_buffer_size(context.info(), format, texels)),
      texture_(make_texture(context.gl()))
{
    const GlTable& gl = context.gl();
    gl.BindTexture(GL_TEXTURE_BUFFER, texture_.id());
    gl.TexBuffer(GL_TEXTURE_BUFFER, static_cast<GLenum>(names_of(format).internal), buffer_.id());
    check_gl(gl, "making a texture buffer");
}

TextureBinding TextureBuffer::binding() const
{
    return {GL_TEXTURE_BUFFER, texture_.id()};
}

Texture2D::Texture2D(const GlContext& context, int width, int height, TexelFormat format,
                     std::span<const std::byte> texels, const TextureOptions& options)
    : handle_(make_texture(context.gl())), width_(width), height_(height)
{
    check_size(context.info(), "texture", width, height);
    const FormatNames names = names_of(format);
    SURFELAO_CHECK(texels.empty() || texels.size() == names.bytes *
                                                          static_cast<std::size_t>(width) *
                                                          static_cast<std::size_t>(height));
    const GlTable& gl = context.gl();
    gl.BindTexture(GL_TEXTURE_2D, handle_.id());
    gl.TexImage2D(GL_TEXTURE_2D, 0, names.internal, width, height, 0, names.layout, names.type,
                  texels.empty() ? nullptr : texels.data());
    const bool linear = options.filter != TextureFilter::nearest;
    const bool mipmaps = options.filter == TextureFilter::mipmaps;
    if (mipmaps)
        gl.GenerateMipmap(GL_TEXTURE_2D);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER,
                     mipmaps ? GL_LINEAR_MIPMAP_LINEAR : (linear ? GL_LINEAR : GL_NEAREST));
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, linear ? GL_LINEAR : GL_NEAREST);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S,
                     options.wrap == TextureWrap::clamp ? GL_CLAMP_TO_EDGE : GL_REPEAT);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T,
                     options.wrap == TextureWrap::repeat ? GL_REPEAT : GL_CLAMP_TO_EDGE);
    check_gl(gl, "making a texture");
}

TextureBinding Texture2D::binding() const
{
    return {GL_TEXTURE_2D, handle_.id()};
}

Texture3D::Texture3D(const GlContext& context, glm::ivec3 size, std::span<const glm::vec4> texels)
    : handle_(make_texture(context.gl()))
{
    SURFELAO_CHECK(size.x > 0 && size.y > 0 && size.z > 0 &&
                   texels.size() == static_cast<std::size_t>(size.x) *
                                        static_cast<std::size_t>(size.y) *
                                        static_cast<std::size_t>(size.z));
    const GlTable& gl = context.gl();
    gl.BindTexture(GL_TEXTURE_3D, handle_.id());
    gl.TexImage3D(GL_TEXTURE_3D, 0, GL_RGBA16F, size.x, size.y, size.z, 0, GL_RGBA, GL_FLOAT,
                  texels.data());
    gl.TexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    gl.TexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    for (const GLenum axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
        gl.TexParameteri(GL_TEXTURE_3D, axis, GL_CLAMP_TO_EDGE);
    check_gl(gl, "making a block of texels");
}

TextureBinding Texture3D::binding() const
{
    return {GL_TEXTURE_3D, handle_.id()};
}

// --- Framebuffer
// ----------------------------------------------------------------------------------

Framebuffer::Framebuffer(const GlContext& context, const FramebufferOptions& options)
    : gl_(&context.gl()), width_(options.width), height_(options.height)
{
    check_size(context.info(), "framebuffer", width_, height_);
    handle_ = make_framebuffer(*gl_);
    gl_->BindFramebuffer(GL_FRAMEBUFFER, handle_.id());

    const auto attach = [&](GLenum where, TexelFormat format) {
        Texture2D texture(context, width_, height_, format);
        gl_->FramebufferTexture2D(GL_FRAMEBUFFER, where, GL_TEXTURE_2D, texture.binding().id, 0);
        if (where == GL_DEPTH_ATTACHMENT)
            depth_.emplace(std::move(texture));
        else
            colors_.push_back(std::move(texture));
    };
    std::vector<GLenum> outputs;
    for (const TexelFormat format : options.colors) {
        outputs.push_back(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(outputs.size()));
        attach(outputs.back(), format);
    }
    if (options.depth)
        attach(GL_DEPTH_ATTACHMENT, TexelFormat::depth32f);
    gl_->DrawBuffers(static_cast<GLsizei>(outputs.size()), outputs.data());
    check_gl(*gl_, "making a framebuffer");
    const GLenum status = gl_->CheckFramebufferStatus(GL_FRAMEBUFFER);
    if (status != GL_FRAMEBUFFER_COMPLETE)
        throw std::runtime_error(
            "OpenGL: this device cannot draw into a framebuffer of these "
            "formats (status " +
            std::to_string(status) + ")");
}

Framebuffer Framebuffer::window(const GlContext& context, int width, int height)
{
    check_size(context.info(), "window", width, height);
    Framebuffer result;
    result.gl_ = &context.gl();
    result.width_ = width;
    result.height_ = height;
    return result;
}

void Framebuffer::clear_color(glm::vec4 value, std::size_t index) const
{
    gl_->BindFramebuffer(GL_FRAMEBUFFER, id());
    gl_->Disable(GL_SCISSOR_TEST);
    gl_->ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    gl_->ClearBufferfv(GL_COLOR, static_cast<GLint>(index), &value.x);
    check_gl(*gl_, "clearing a framebuffer");
}

void Framebuffer::clear_color(glm::uvec4 value, std::size_t index) const
{
    gl_->BindFramebuffer(GL_FRAMEBUFFER, id());
    gl_->Disable(GL_SCISSOR_TEST);
    gl_->ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    gl_->ClearBufferuiv(GL_COLOR, static_cast<GLint>(index), &value.x);
    check_gl(*gl_, "clearing a framebuffer");
}

void Framebuffer::clear_depth(float value) const
{
    gl_->BindFramebuffer(GL_FRAMEBUFFER, id());
    gl_->Disable(GL_SCISSOR_TEST);
    gl_->DepthMask(GL_TRUE);
    gl_->ClearBufferfv(GL_DEPTH, 0, &value);
    check_gl(*gl_, "clearing a depth buffer");
}

void Framebuffer::copy_to(const Framebuffer& target, std::size_t index) const
{
    const auto attachment = [&](const Framebuffer& of) {
        return of.id() == 0 ? static_cast<GLenum>(GL_BACK)
                            : GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(index);
    };
    gl_->BindFramebuffer(GL_READ_FRAMEBUFFER, id());
    gl_->ReadBuffer(attachment(*this));
    gl_->BindFramebuffer(GL_DRAW_FRAMEBUFFER, target.id());
    gl_->Disable(GL_SCISSOR_TEST);
    gl_->ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    const bool same = width_ == target.width_ && height_ == target.height_;
    // all colours of the target are listed for drawing; the blit writes to each of them, so name
    // one
    const GLenum only = attachment(target);
    if (target.id() != 0)
        gl_->DrawBuffers(1, &only);
    gl_->BlitFramebuffer(0, 0, width_, height_, 0, 0, target.width_, target.height_,
                         GL_COLOR_BUFFER_BIT, same ? GL_NEAREST : GL_LINEAR);
    if (target.id() != 0) {
        std::vector<GLenum> outputs;
        for (std::size_t i = 0; i < target.colors_.size(); ++i)
            outputs.push_back(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(i));
        gl_->DrawBuffers(static_cast<GLsizei>(outputs.size()), outputs.data());
    }
    check_gl(*gl_, "copying a framebuffer");
}

void Framebuffer::read(const Rect& part, unsigned layout, unsigned type, void* out) const
{
    SURFELAO_CHECK(part.x >= 0 && part.y >= 0 && part.x + part.width <= width_ &&
                   part.y + part.height <= height_);
    gl_->ReadPixels(part.x, part.y, part.width, part.height, layout, type, out);
    check_gl(*gl_, "reading pixels");
}

void Framebuffer::bind_for_reading(std::size_t index) const
{
    gl_->BindFramebuffer(GL_FRAMEBUFFER, id());
    gl_->ReadBuffer(id() == 0 ? static_cast<GLenum>(GL_BACK)
                              : GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(index));
}

void Framebuffer::copy_color(const Rect& part, const Buffer& out, std::size_t offset,
                             std::size_t index) const
{
    SURFELAO_CHECK(offset + static_cast<std::size_t>(part.width) *
                                static_cast<std::size_t>(part.height) * sizeof(glm::vec4) <=
                   out.size());
    bind_for_reading(index);
    gl_->BindBuffer(GL_PIXEL_PACK_BUFFER, out.id());
    gl_->ReadPixels(part.x, part.y, part.width, part.height, GL_RGBA, GL_FLOAT,
                    reinterpret_cast<void*>(offset));
    gl_->BindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    check_gl(*gl_, "copying pixels");
}

std::vector<glm::vec4> Framebuffer::read_color(const Rect& part, std::size_t index) const
{
    std::vector<glm::vec4> result(static_cast<std::size_t>(part.width) *
                                  static_cast<std::size_t>(part.height));
    bind_for_reading(index);
    read(part, GL_RGBA, GL_FLOAT, result.data());
    return result;
}

std::vector<float> Framebuffer::read_red(const Rect& part, std::size_t index) const
{
    std::vector<float> result(static_cast<std::size_t>(part.width) *
                              static_cast<std::size_t>(part.height));
    bind_for_reading(index);
    read(part, GL_RED, GL_FLOAT, result.data());
    return result;
}

std::vector<std::uint32_t> Framebuffer::read_numbers(const Rect& part, std::size_t index) const
{
    std::vector<std::uint32_t> result(static_cast<std::size_t>(part.width) *
                                      static_cast<std::size_t>(part.height));
    bind_for_reading(index);
    read(part, GL_RED_INTEGER, GL_UNSIGNED_INT, result.data());
    return result;
}

// --- VertexArray
// ----------------------------------------------------------------------------------

VertexArray::VertexArray(const GlContext& context) : handle_(make_vertex_array(context.gl()))
{
    check_gl(context.gl(), "making a vertex array");
}

void VertexArray::indices(const Buffer& buffer)
{
    const GlTable& gl = handle_.gl();
    gl.BindVertexArray(id());
    gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffer.id());
    check_gl(gl, "describing indices");
}

}  // namespace surfelao

/// objects.h: what lives in the device's memory. All RAII and move-only; each belongs to the
/// context it was made with (context.h), which must be current where it is used or destroyed, and
/// must outlive it. Constructors throw std::runtime_error when the device refuses (out of memory,
/// beyond a limit) and for sizes of zero, naming the object.
#pragma once

#include "gpu/context.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace surfelao {

/// The name of one GL object; deletes it.
class GlHandle {
public:
    using Delete = void (*)(const GlTable& gl, unsigned id);
    GlHandle() = default;
    GlHandle(const GlTable& gl, unsigned id, Delete destroy) : gl_(&gl), id_(id), destroy_(destroy)
    {
    }
    ~GlHandle()
    {
        if (id_ != 0)
            destroy_(*gl_, id_);
    }
    GlHandle(GlHandle&& other) noexcept
        : gl_(other.gl_), id_(std::exchange(other.id_, 0)), destroy_(other.destroy_)
    {
    }
    GlHandle& operator=(GlHandle&& other) noexcept
    {
        std::swap(gl_, other.gl_);
        std::swap(id_, other.id_);
        std::swap(destroy_, other.destroy_);
        return *this;
    }
    unsigned id() const { return id_; }
    const GlTable& gl() const { return *gl_; }

private:
    const GlTable* gl_ = nullptr;
    unsigned id_ = 0;
    Delete destroy_ = nullptr;
};

/// Bytes: vertex attributes, indices, or the memory of a texture buffer.
class Buffer {
public:
    /// Of that many bytes, not filled.
    Buffer(const GlContext& context, std::size_t bytes);

    /// A copy of `values`, which are plain data.
    template <typename T>
    Buffer(const GlContext& context, std::span<const T> values)
        : Buffer(context, std::as_bytes(values))
    {
    }
    Buffer(const GlContext& context, std::span<const std::byte> bytes);

    /// Overwrites bytes [offset, offset + size of values).
    template <typename T>
    void update(std::size_t offset, std::span<const T> values)
    {
        update_bytes(offset, std::as_bytes(values));
    }

    /// The first bytes, as many as `values` has; waits for what is written there.
    template <typename T>
    void read(std::span<T> values) const
    {
        read_bytes(std::as_writable_bytes(values));
    }

    std::size_t size() const { return size_; }
    unsigned id() const { return handle_.id(); }
    const GlTable& gl() const { return handle_.gl(); }

private:
    void update_bytes(std::size_t offset, std::span<const std::byte> bytes);
    void read_bytes(std::span<std::byte> bytes) const;
    GlHandle handle_;
    std::size_t size_ = 0;
};

/// How a texel is stored. Float formats come back from the device with all their bits; *ui formats
/// are fetched as integers by usampler*, so that no bit of a mixed record is touched. srgb8_alpha8
/// is fetched and filtered as linear light.
enum class TexelFormat { rgba8, srgb8_alpha8, r32f, rg32f, rgba32f, r32ui, rgba32ui, depth32f };

/// Can be bound to a sampler of a program.
struct TextureBinding {
    unsigned target = 0;
    unsigned id = 0;
};

/// A long array that shaders read by texelFetch from a samplerBuffer or usamplerBuffer.
class TextureBuffer {
public:
    /// values: plain data whose bytes are a whole number of texels. Throws std::runtime_error when
    /// there are more texels than GlInfo::max_buffer_texels.
    template <typename T>
    TextureBuffer(const GlContext& context, TexelFormat format, std::span<const T> values)
        : TextureBuffer(context, format, std::as_bytes(values))
    {
    }
    TextureBuffer(const GlContext& context, TexelFormat format, std::span<const std::byte> bytes);
    /// Of that many texels, not filled.
    TextureBuffer(const GlContext& context, TexelFormat format, std::size_t texels);

    template <typename T>
    void update(std::size_t offset, std::span<const T> values)
    {
        buffer_.update(offset, values);
    }
    TextureBinding binding() const;
    const Buffer& buffer() const { return buffer_; }

private:
    Buffer buffer_;
    GlHandle texture_;
};

enum class TextureFilter {
    nearest,
    linear,
    mipmaps,  ///< linear between mipmap levels made from the first
};

enum class TextureWrap {
    clamp,
    repeat_x,  ///< a panorama that closes on itself
    repeat,    ///< both ways
};

struct TextureOptions {
    TextureFilter filter = TextureFilter::nearest;
    TextureWrap wrap = TextureWrap::clamp;
};

/// width x height texels; row 0 is the bottom row, as everywhere in OpenGL.
class Texture2D {
public:
    /// `texels` are width * height records in the format's layout; empty: not filled.
    template <typename T>
    Texture2D(const GlContext& context, int width, int height, TexelFormat format,
              std::span<const T> texels, const TextureOptions& options = {})
        : Texture2D(context, width, height, format, std::as_bytes(texels), options)
    {
    }
    Texture2D(const GlContext& context, int width, int height, TexelFormat format,
              std::span<const std::byte> texels = {}, const TextureOptions& options = {});

    int width() const { return width_; }
    int height() const { return height_; }
    TextureBinding binding() const;

private:
    GlHandle handle_;
    int width_ = 0, height_ = 0;
};

/// A block of texels, x fastest, then y, then z; between them what is fetched is linear, beyond the
/// outer ones as they are. Four numbers each, given as floats and kept as halves: a share of 2^-11
/// of a value is lost.
class Texture3D {
public:
    Texture3D(const GlContext& context, glm::ivec3 size, std::span<const glm::vec4> texels);

    TextureBinding binding() const;

private:
    GlHandle handle_;
};

/// An axis-aligned part of a target, in pixels from the lower left corner.
struct Rect {
    int x = 0, y = 0, width = 0, height = 0;
};

struct FramebufferOptions {
    int width = 0, height = 0;  ///< > 0
    std::vector<TexelFormat> colors = {TexelFormat::rgba8};
    bool depth = false;  ///< a float depth buffer
};

/// A target to draw into. Its colours and its depth are textures.
class Framebuffer {
public:
    Framebuffer(const GlContext& context, const FramebufferOptions& options);

    /// The default framebuffer of a window's context, whose size its owner knows. Zero-size windows
    /// (minimised) are an error here too: do not draw then.
    [[nodiscard]] static Framebuffer window(const GlContext& context, int width, int height);

    int width() const { return width_; }
    int height() const { return height_; }
    Rect rect() const { return {0, 0, width_, height_}; }

    /// Of a framebuffer that is not a window.
    const Texture2D& color(std::size_t index = 0) const { return colors_[index]; }
    const Texture2D& depth() const { return *depth_; }

    /// Fills the part with one colour per attachment (float formats) or the depth, without drawing.
    void clear_color(glm::vec4 value, std::size_t index = 0) const;
    void clear_color(glm::uvec4 value, std::size_t index = 0) const;  ///< *ui formats
    void clear_depth(float value = 1.0f) const;

    /// Copies colour `index` to the same of `target`; stretched, with linear filtering, where sizes
    /// differ.
    void copy_to(const Framebuffer& target, std::size_t index = 0) const;

    /// Copies the texels of colour `index` in `part`, rgba32f, to `out` from byte `offset` on, row
    /// by row from the bottom. They do not leave the device, and nobody waits.
    void copy_color(const Rect& part, const Buffer& out, std::size_t offset,
                    std::size_t index = 0) const;

    /// The texels of colour `index` in `part`, row by row from the bottom, waiting for the drawing.
    /// Not for *ui formats.
    std::vector<glm::vec4> read_color(const Rect& part, std::size_t index = 0) const;
    /// The same, for r32f: one float a texel.
    std::vector<float> read_red(const Rect& part, std::size_t index = 0) const;
    /// The same, for r32ui.
    std::vector<std::uint32_t> read_numbers(const Rect& part, std::size_t index = 0) const;

    unsigned id() const { return handle_.id(); }
    const GlTable& gl() const { return *gl_; }

private:
    Framebuffer() = default;
    void bind_for_reading(std::size_t index) const;
    void read(const Rect& part, unsigned layout, unsigned type, void* out) const;
    const GlTable* gl_ = nullptr;
    GlHandle handle_;  // empty for a window: GL's framebuffer 0
    std::vector<Texture2D> colors_;
    std::optional<Texture2D> depth_;
    int width_ = 0, height_ = 0;
};

/// Which vertices a drawing has: none of its own, since shaders make them from gl_VertexID, and
/// maybe indices. The buffer must outlive it.
class VertexArray {
public:
    explicit VertexArray(const GlContext& context);

    /// 32-bit indices for draws with `indexed`.
    void indices(const Buffer& buffer);

    unsigned id() const { return handle_.id(); }

private:
    GlHandle handle_;
};

}  // namespace surfelao

/// sample_sum.h: a picture of several drawings, each moved by a part of a pixel.
#pragma once

#include "gpu/context.h"
#include "gpu/objects.h"
#include "image/image.h"

#include <glm/vec2.hpp>

#include <memory>

namespace surfelao {

/// The sum of several drawings of one size, and their mean.
class SampleSum {
public:
    SampleSum(const GlContext& context, int width, int height);
    ~SampleSum();
    SampleSum(SampleSum&&) noexcept;
    SampleSum& operator=(SampleSum&&) noexcept;

    void clear();
    /// texel: how many pixels wide the drawing's texels are; it covers the sum.
    void add(const Framebuffer& drawing, int texel = 1);
    /// A picture of the same size, as one drawing.
    void add(const Image& picture);
    int count() const;

    /// The mean as linear light; row 0 is the top. At least one drawing must have been added.
    [[nodiscard]] Image mean() const;

    /// Shows the mean, sRGB-encoded, on an 8-bit target, a window's for example; `corner` is where
    /// its lower left corner goes.
    void show(const Framebuffer& target, glm::ivec2 corner) const;
    /// The same within a part of the target.
    void show(const Framebuffer& target, glm::ivec2 corner, const Rect& part) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace surfelao

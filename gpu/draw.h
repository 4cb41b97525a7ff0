/// draw.h: one drawing, with everything that has a say in it. No state is left over from one
/// drawing to the next, and none is expected from whoever used the context before.
#pragma once

#include "gpu/objects.h"
#include "gpu/program.h"

#include <optional>

namespace surfelao {

enum class DepthTest {
    off,        ///< neither tested nor written
    less,       ///< nearer wins, and is written
    read_only,  ///< nearer wins, nothing is written
};

enum class Blend {
    off,
    over,      ///< out = alpha * new + (1 - alpha) * old
    add,       ///< out = old + new, alpha too
    multiply,  ///< out = old * new, alpha too
};

enum class Cull { none, back, front };  ///< counter-clockwise triangles show their front

struct DrawState {
    DepthTest depth = DepthTest::off;
    Blend blend = Blend::off;
    Cull cull = Cull::none;
    bool write_color = true;
    std::optional<Rect> viewport = {};  ///< where clip space lands; the whole target if absent
    std::optional<Rect> scissor = {};   ///< nothing is drawn outside; the whole target if absent
};

struct DrawCall {
    std::size_t count = 0;  ///< of vertices or indices: three a triangle
    bool indexed = false;   ///< through VertexArray::indices
};

/// Draws triangles. Throws std::runtime_error on any error of the device.
void draw(const Framebuffer& target, const Program& program, const VertexArray& vertices,
          const DrawCall& call, const DrawState& state = {});

/// One triangle over the whole viewport, for shaders/fullscreen.vert: one fragment a pixel.
void draw_fullscreen(const Framebuffer& target, const Program& program, const VertexArray& empty,
                     const DrawState& state = {});

/// Draws the same, writing no colour, and tells whether any fragment was not discarded. Waits.
[[nodiscard]] bool any_fragment(const Framebuffer& target, const Program& program,
                                const VertexArray& empty, const DrawState& state = {});

}  // namespace surfelao

#include "gpu/draw.h"

#include "gpu/gl_table.inc"

namespace surfelao {
namespace {

void enable(const GlTable& gl, GLenum what, bool on)
{
    on ? gl.Enable(what) : gl.Disable(what);
}

void apply(const GlTable& gl, const Framebuffer& target, const DrawState& state)
{
    gl.BindFramebuffer(GL_FRAMEBUFFER, target.id());
    const Rect viewport = state.viewport.value_or(target.rect());
    gl.Viewport(viewport.x, viewport.y, viewport.width, viewport.height);
    enable(gl, GL_SCISSOR_TEST, state.scissor.has_value());
    if (state.scissor.has_value())
        gl.Scissor(state.scissor->x, state.scissor->y, state.scissor->width, state.scissor->height);

    enable(gl, GL_DEPTH_TEST, state.depth != DepthTest::off);
    gl.DepthFunc(GL_LESS);
    gl.DepthMask(state.depth == DepthTest::less ? GL_TRUE : GL_FALSE);

    enable(gl, GL_BLEND, state.blend != Blend::off);
    gl.BlendEquation(GL_FUNC_ADD);
    if (state.blend == Blend::over)
        gl.BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    else if (state.blend == Blend::multiply)
        gl.BlendFuncSeparate(GL_DST_COLOR, GL_ZERO, GL_DST_ALPHA, GL_ZERO);
    else
        gl.BlendFuncSeparate(GL_ONE, GL_ONE, GL_ONE, GL_ONE);

    enable(gl, GL_CULL_FACE, state.cull != Cull::none);
    gl.CullFace(state.cull == Cull::front ? GL_FRONT : GL_BACK);
    const GLboolean write_color = state.write_color ? GL_TRUE : GL_FALSE;
    gl.ColorMask(write_color, write_color, write_color, write_color);
}

}  // namespace

void draw(const Framebuffer& target, const Program& program, const VertexArray& vertices,
          const DrawCall& call, const DrawState& state)
{
    if (call.count == 0)
        return;
    const GlTable& gl = target.gl();
    apply(gl, target, state);
    program.use();
    gl.BindVertexArray(vertices.id());
    const GLsizei count = static_cast<GLsizei>(call.count);
    if (call.indexed)
        gl.DrawElements(GL_TRIANGLES, count, GL_UNSIGNED_INT, nullptr);
    else
        gl.DrawArrays(GL_TRIANGLES, 0, count);
    check_gl(gl, "drawing");
}

void draw_fullscreen(const Framebuffer& target, const Program& program, const VertexArray& empty,
                     const DrawState& state)
{
    draw(target, program, empty, {.count = 3}, state);
}

bool any_fragment(const Framebuffer& target, const Program& program, const VertexArray& empty,
                  const DrawState& state)
{
    const GlTable& gl = target.gl();
    GLuint id = 0;
    gl.GenQueries(1, &id);
    const GlHandle query(
        gl, id, [](const GlTable& table, unsigned name) { table.DeleteQueries(1, &name); });
    DrawState uncoloured = state;
    uncoloured.write_color = false;
    gl.BeginQuery(GL_ANY_SAMPLES_PASSED, query.id());
    draw_fullscreen(target, program, empty, uncoloured);
    gl.EndQuery(GL_ANY_SAMPLES_PASSED);
    GLuint passed = GL_FALSE;
    gl.GetQueryObjectuiv(query.id(), GL_QUERY_RESULT, &passed);
    check_gl(gl, "asking for fragments");
    return passed != GL_FALSE;
}

}  // namespace surfelao

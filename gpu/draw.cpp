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
    gl.DepthFunc(state.depth == DepthTest::equal_or_less ? GL_LEQUAL : GL_LESS);
    const bool write_depth =
        state.depth == DepthTest::less || state.depth == DepthTest::equal_or_less;
    gl.DepthMask(write_depth ? GL_TRUE : GL_FALSE);

    enable(gl, GL_BLEND, state.blend != Blend::off);
    gl.BlendEquation(GL_FUNC_ADD);
    if (state.blend == Blend::over)
        gl.BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    else
        gl.BlendFuncSeparate(GL_ONE, GL_ONE, GL_ONE, GL_ONE);

    enable(gl, GL_CULL_FACE, state.cull != Cull::none);
    gl.CullFace(state.cull == Cull::front ? GL_FRONT : GL_BACK);
    const GLboolean write_color = state.write_color ? GL_TRUE : GL_FALSE;
    gl.ColorMask(write_color, write_color, write_color, write_color);
    gl.Enable(GL_PROGRAM_POINT_SIZE);
    gl.Enable(GL_MULTISAMPLE);
}

GLenum name_of(Primitive primitive)
{
    switch (primitive) {
        case Primitive::triangles:
            return GL_TRIANGLES;
        case Primitive::triangle_strip:
            return GL_TRIANGLE_STRIP;
        case Primitive::lines:
            return GL_LINES;
        case Primitive::points:
            break;
    }
    return GL_POINTS;
}

}  // namespace

void draw(const Framebuffer& target, const Program& program, const VertexArray& vertices,
          const DrawCall& call, const DrawState& state)
{
    if (call.count == 0 || call.instances == 0)
        return;
    const GlTable& gl = target.gl();
    apply(gl, target, state);
    program.use();
    gl.BindVertexArray(vertices.id());
    const GLenum primitive = name_of(call.primitive);
    const GLsizei count = static_cast<GLsizei>(call.count);
    const GLsizei instances = static_cast<GLsizei>(call.instances);
    if (call.indexed)
        gl.DrawElementsInstanced(primitive, count, GL_UNSIGNED_INT,
                                 reinterpret_cast<const void*>(call.first * 4), instances);
    else
        gl.DrawArraysInstanced(primitive, static_cast<GLint>(call.first), count, instances);
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

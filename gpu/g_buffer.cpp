#include "gpu/g_buffer.h"

#include "gpu/draw.h"
#include "gpu/program.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include <algorithm>

namespace surfelao {
namespace {

/// What is nearer than that share of the farthest is not seen.
constexpr float kNearest = 1e-6f;

std::vector<glm::vec4> as_texels(std::span<const glm::vec3> values)
{
    std::vector<glm::vec4> texels;
    texels.reserve(values.size());
    for (const glm::vec3& value : values)
        texels.emplace_back(value, 0.0f);
    return texels;
}

template <class T>
std::span<const T> view_of(const std::vector<T>& values)
{
    return values;
}

/// Of a ball about the origin that holds them.
float ball_radius_of(std::span<const glm::vec3> points)
{
    float radius = 0.0f;
    for (const glm::vec3& p : points)
        radius = std::max(radius, glm::length(p));
    return radius;
}

void set_view(Program& program, const View& view)
{
    program.set("u_eye", view.eye);
    program.set("u_right", view.right);
    program.set("u_up", view.up);
    program.set("u_forward", view.forward);
    program.set("u_lens_low", view.lens.low);
    program.set("u_lens_high", view.lens.high);
    program.set("u_is_orthographic", view.lens.orthographic ? 1 : 0);
}

}  // namespace

Lens part_of(const Lens& lens, int width, int height, const Rect& part)
{
    const glm::vec2 pixel = (lens.high - lens.low) / glm::vec2(width, height);
    const glm::vec2 low = lens.low + pixel * glm::vec2(part.x, part.y);
    return {low, low + pixel * glm::vec2(part.width, part.height), lens.orthographic};
}

Lens shifted(const Lens& lens, int width, int height, glm::vec2 shift)
{
    const glm::vec2 by = shift * (lens.high - lens.low) / glm::vec2(width, height);
    return {lens.low + by, lens.high + by, lens.orthographic};
}

PixelRay pixel_ray(const Lens& lens, int width, int height, glm::vec2 pixel)
{
    const glm::vec2 q = glm::mix(lens.low, lens.high, pixel / glm::vec2(width, height));
    if (lens.orthographic)
        return {glm::vec3(q, 0.0f), glm::vec3(0.0f, 0.0f, 1.0f)};
    return {glm::vec3(0.0f), glm::vec3(q, 1.0f)};
}

glm::vec3 to_view(const View& view, glm::vec3 point)
{
    const glm::vec3 d = point - view.eye;
    return {glm::dot(d, view.right), glm::dot(d, view.up), glm::dot(d, view.forward)};
}

glm::vec3 to_world(const View& view, glm::vec3 point)
{
    return view.eye + point.x * view.right + point.y * view.up + point.z * view.forward;
}

DrawnMesh::DrawnMesh(const GlContext& context, const Geometry& geometry, const Surface& surface)
    : positions_(context, TexelFormat::rgba32f, view_of(as_texels(geometry.positions))),
      triangles_(context, TexelFormat::r32ui, view_of(geometry.triangles)),
      corners_(context, TexelFormat::r32ui, view_of(surface.corners(geometry))),
      normals_(context, TexelFormat::rgba32f, view_of(as_texels(surface.normals))),
      vertices_(context),
      index_count_(3 * geometry.triangles.size())
{
    vertices_.indices(triangles_.buffer());
    radius_ = ball_radius_of(geometry.positions);
}

void DrawnMesh::move(std::span<const glm::vec3> positions, std::span<const glm::vec3> normals)
{
    positions_.update(0, view_of(as_texels(positions)));
    normals_.update(0, view_of(as_texels(normals)));
    radius_ = ball_radius_of(positions);
}

GBuffer::GBuffer(const GlContext& context, int width, int height)
    : context_(context),
      triangles_(context,
                 {.width = width, .height = height, .colors = {TexelFormat::r32ui}, .depth = true}),
      surface_(
          context,
          {.width = width, .height = height, .colors = {TexelFormat::rgba32f, TexelFormat::r32f}}),
      nothing_(context)
{
}

void GBuffer::draw(const DrawnMesh& mesh, const View& view, Cull cull)
{
    view_ = view;
    draw_triangles(mesh, cull);
    find_surface(mesh);
}

void GBuffer::draw_triangles(const DrawnMesh& mesh, Cull cull)
{
    Program& program = context_.program("g_triangles.vert", "g_triangles.frag");
    set_view(program, view_);
    const float distance = glm::length(view_.eye);
    const float far = 1.01f * (distance + mesh.radius_);
    // along the view, not to the ball's nearest point: it may lie aside
    const float forward = -glm::dot(view_.eye, view_.forward);
    program.set("u_near", std::max(0.99f * (forward - mesh.radius_), kNearest * far));
    program.set("u_far", far);
    program.set("u_positions", mesh.positions_);
    triangles_.clear_color(glm::uvec4(0));
    triangles_.clear_depth();
    surfelao::draw(triangles_, program, mesh.vertices_,
                   {.count = mesh.index_count_, .indexed = true},
                   {.depth = DepthTest::less, .cull = cull});
}

Program& GBuffer::program_at_points(const DrawnMesh& mesh, const char* fragment_file) const
{
    Program& program = context_.program("fullscreen.vert", fragment_file);
    set_view(program, view_);
    program.set("u_size", glm::ivec2(width(), height()));
    program.set("u_seen", triangles_.color());
    program.set("u_positions", mesh.positions_);
    program.set("u_triangles", mesh.triangles_);
    return program;
}

void GBuffer::draw_values(const DrawnMesh& mesh, const TextureBuffer& values, glm::vec2 background,
                          const Framebuffer& target) const
{
    Program& program = program_at_points(mesh, "g_values.frag");
    program.set("u_values", values);
    program.set("u_background", background);
    draw_fullscreen(target, program, nothing_);
}

void GBuffer::find_surface(const DrawnMesh& mesh)
{
    Program& program = program_at_points(mesh, "g_surface.frag");
    program.set("u_corners", mesh.corners_);
    program.set("u_normals", mesh.normals_);
    draw_fullscreen(surface_, program, nothing_);
}

std::vector<std::uint32_t> GBuffer::read_triangles() const
{
    return triangles_.read_numbers(triangles_.rect());
}

std::vector<glm::vec4> GBuffer::read_surface() const
{
    return surface_.read_color(surface_.rect());
}

}  // namespace surfelao

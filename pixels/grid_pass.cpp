#include "pixels/grid_pass.h"

#include "gpu/draw.h"
#include "gpu/program.h"
#include "grid/cone.h"
#include "surfels/errors.h"

#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <string>
#include <string_view>

namespace surfelao {
namespace {

constexpr std::size_t kBoxVertices = 36;

std::vector<Texture3D> cells_of(const GlContext& context, const AoGrid& grid)
{
    const std::size_t channels = channels_of(grid.store);
    std::vector<Texture3D> cells;
    for (std::size_t first = 0; first < channels; first += 4) {
        std::vector<glm::vec4> texels(grid.cell_count(), glm::vec4(0.0f));
        for (std::size_t i = 0; i < texels.size(); ++i) {
            for (std::size_t c = first; c < std::min(channels, first + 4); ++c)
                texels[i][static_cast<int>(c - first)] = grid.values[i * channels + c];
        }
        cells.emplace_back(context, grid.cells, std::span<const glm::vec4>(texels));
    }
    return cells;
}

/// Its columns are the view's axes.
glm::dmat3 axes_of(const View& view)
{
    return {glm::dvec3(view.right), glm::dvec3(view.up), glm::dvec3(view.forward)};
}

/// From half boxes of the grid to view space.
glm::dmat4 box_to_view(const PlacedGrid& object, const View& view)
{
    const AoGrid& grid = *object.grid;
    const Placement& at = object.placement;
    const glm::dvec3 middle = 0.5 * (grid.low + grid.high), half = 0.5 * (grid.high - grid.low);
    const glm::dmat3 turn = glm::transpose(axes_of(view)) * at.rotation;
    glm::dmat4 result(1.0);
    for (int axis = 0; axis < 3; ++axis)
        result[axis] = glm::dvec4(at.scale * half[axis] * turn[axis], 0.0);
    const glm::dvec3 place = placed_point(middle, at);
    result[3] = glm::dvec4((place - glm::dvec3(view.eye)) * axes_of(view), 1.0);
    return result;
}

/// What is left out so that they remain; a mirrored box has its faces turned.
Cull back_faces(const PlacedGrid& object)
{
    return glm::determinant(object.placement.rotation) < 0.0 ? Cull::back : Cull::front;
}

/// From pixels' middles and distances to half boxes.
void set_rays(Program& program, const glm::dmat4& to_box, const Lens& lens, int width, int height)
{
    const glm::dvec2 low(lens.low);
    const glm::dvec2 step = glm::dvec2(lens.high - lens.low) / glm::dvec2(width, height);
    const glm::dvec3 across(to_box[0]), upwards(to_box[1]);
    const glm::dvec3 forward(to_box[2]), eye(to_box[3]);
    const glm::dmat3 pixels(step.x * across, step.y * upwards,
                            low.x * across + low.y * upwards + (lens.orthographic ? eye : forward));
    program.set("u_across", glm::mat3(pixels));
    program.set("u_rest", glm::vec3(lens.orthographic ? forward : eye));
}

void set_warp(Program& program, const AoGrid& grid)
{
    const glm::vec3 cells(grid.cells), scale = 0.5f * (cells - 1.0f) / cells;
    const glm::vec3 far = (1.0f - grid.inner_share) / (1.0f - grid.inner);
    program.set("u_inner", grid.inner);
    program.set("u_far", scale * far);
    program.set("u_bend", scale * (grid.inner_share / grid.inner - far));
}

}  // namespace

GridPass::GridPass(const GlContext& context) : context_(context), nothing_(context)
{
}

Framebuffer GridPass::make_target(int width, int height) const
{
    return {context_, {.width = width, .height = height, .colors = {TexelFormat::r32f}}};
}

const GridPass::Stored& GridPass::stored(const std::shared_ptr<const AoGrid>& grid)
{
    const auto found = stored_.find(grid.get());
    if (found != stored_.end())
        return found->second;
    return stored_.emplace(grid.get(), Stored{grid, cells_of(context_, *grid)}).first->second;
}

Program& GridPass::program_for(const GBuffer& seen, const PlacedGrid& object, const Texture2D* own,
                               const char* fragment_file)
{
    const AoGrid& grid = *object.grid;
    const View& view = seen.view();
    const bool is_sh = grid.store == GridStore::sh;
    const bool is_joined = std::string_view(fragment_file) == "grid_merge.frag";
    const bool is_rescaled = grid.border == GridBorder::rescale;
    std::vector<std::string> definitions;
    if (is_sh && is_joined)
        definitions.emplace_back("SH");
    if (is_rescaled)
        definitions.emplace_back("RESCALE");
    if (view.lens.orthographic)
        definitions.emplace_back("ORTHOGRAPHIC");
    const bool is_lifted = object.lift != glm::dvec3(0.0);
    if (is_lifted)
        definitions.emplace_back("LIFT");
    const bool is_left_out = own != nullptr && object.surface != 0;
    if (is_left_out)
        definitions.emplace_back("OWN");
    Program& program = context_.program("grid_box.vert", fragment_file, definitions);
    const glm::dmat4 from_box = box_to_view(object, view);
    program.set("u_from_box", glm::mat4(from_box));
    set_rays(program, glm::inverse(from_box), view.lens, seen.width(), seen.height());
    program.set("u_to_grid", glm::mat3(glm::transpose(object.placement.rotation) * axes_of(view)));
    if (is_lifted)
        program.set("u_lift", glm::vec3(2.0 * object.lift / (grid.high - grid.low)));
    if (is_left_out) {
        program.set("u_own", *own);
        program.set("u_number", static_cast<float>(object.surface));
    }
    program.set("u_lens_low", view.lens.low);
    program.set("u_lens_high", view.lens.high);
    program.set("u_is_orthographic", view.lens.orthographic ? 1 : 0);
    program.set("u_surface", seen.surface());
    set_warp(program, grid);
    if (is_rescaled)
        program.set("u_border", glm::vec2(grid.border_value, 1.0f / (1.0f - grid.border_value)));
    const std::vector<Texture3D>& textures = stored(object.grid).cells;
    program.set("u_cells", textures[0]);
    if (is_sh && !is_joined) {
        program.set("u_cells_2", textures[1]);
        program.set("u_cells_3", textures[2]);
    }
    return program;
}

void GridPass::draw(const GBuffer& seen, std::span<const PlacedGrid> objects, GridMerge merge,
                    const Framebuffer& target, const Texture2D* own)
{
    SURFELAO_CHECK(target.width() == seen.width() && target.height() == seen.height());
    if (merge == GridMerge::caps) {
        join(seen, objects, target, own);
        return;
    }
    target.clear_color(glm::vec4(1.0f));
    if (own != nullptr) {
        Program& program = context_.program("fullscreen.vert", "grid_own.frag");
        program.set("u_own", *own);
        draw_fullscreen(target, program, nothing_);
    }
    for (const PlacedGrid& object : objects) {
        const Program& program = program_for(
            seen, object, own,
            object.grid->store == GridStore::sh ? "grid_shade_sh.frag" : "grid_shade.frag");
        surfelao::draw(target, program, nothing_, {.count = kBoxVertices},
                       {.blend = Blend::multiply, .cull = back_faces(object)});
    }
}

void GridPass::join(const GBuffer& seen, std::span<const PlacedGrid> objects,
                    const Framebuffer& target, const Texture2D* own)
{
    if (!joined_ || joined_->first.width() != seen.width() ||
        joined_->first.height() != seen.height()) {
        const FramebufferOptions options{
            .width = seen.width(), .height = seen.height(), .colors = {TexelFormat::rgba32f}};
        joined_.emplace(Framebuffer(context_, options), Framebuffer(context_, options));
    }
    const auto& [before, after] = *joined_;
    before.clear_color(glm::vec4(0.0f));
    after.clear_color(glm::vec4(0.0f));
    for (const PlacedGrid& object : objects) {
        Program& program = program_for(seen, object, own, "grid_merge.frag");
        program.set("u_before", before.color());
        surfelao::draw(after, program, nothing_, {.count = kBoxVertices},
                       {.cull = back_faces(object)});
        after.copy_to(before);
    }
    std::vector<std::string> definitions;
    if (own != nullptr)
        definitions.emplace_back("OWN");
    Program& program = context_.program("fullscreen.vert", "grid_union.frag", definitions);
    if (own != nullptr)
        program.set("u_own", *own);
    program.set("u_surface", seen.surface());
    program.set("u_before", before.color());
    draw_fullscreen(target, program, nothing_);
}

}  // namespace surfelao

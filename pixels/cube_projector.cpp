#include "pixels/cube_projector.h"

#include "gpu/draw.h"
#include "gpu/program.h"
#include "surfels/errors.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <functional>
#include <numeric>

namespace surfelao {
namespace {

/// A map within this share of the distance of the first that is left out fades.
constexpr float kFadingShare = 0.5f;

std::vector<std::uint32_t> values_of(const CubeMap& map)
{
    std::vector<std::uint32_t> values;
    values.reserve(map.occlusion.size());
    for (std::size_t i = 0; i < map.occlusion.size(); ++i)
        values.push_back(std::uint32_t{map.occlusion[i]} | std::uint32_t{map.normals[i].x} << 8 |
                         std::uint32_t{map.normals[i].y} << 16);
    return values;
}

void set_eye(Program& program, const View& view, int width, int height)
{
    program.set("u_eye", view.eye);
    program.set("u_right", view.right);
    program.set("u_up", view.up);
    program.set("u_forward", view.forward);
    program.set("u_lens_low", view.lens.low);
    program.set("u_lens_high", view.lens.high);
    program.set("u_is_orthographic", view.lens.orthographic ? 1 : 0);
    program.set("u_size", glm::ivec2(width, height));
}

}  // namespace

std::vector<ProjectedMap> nearest_maps(std::span<const glm::vec3> centres,
                                       std::span<const float> weights, glm::vec3 eye, int most)
{
    std::vector<ProjectedMap> chosen;
    for (std::uint32_t i = 0; i < centres.size(); ++i) {
        if (weights[i] > 0.0f)
            chosen.push_back({i, weights[i]});
    }
    const auto distance = [&](const ProjectedMap& map) {
        return glm::distance(centres[map.index], eye);
    };
    std::ranges::stable_sort(chosen, {}, distance);
    const auto count = static_cast<std::size_t>(most);
    if (chosen.size() > count) {
        const float left_out = distance(chosen[count]);
        chosen.resize(count);
        for (ProjectedMap& map : chosen)
            map.weight *=
                glm::clamp((left_out - distance(map)) / (kFadingShare * left_out), 0.0f, 1.0f);
        std::erase_if(chosen, [](const ProjectedMap& map) { return !(map.weight > 0.0f); });
    }
    std::ranges::stable_sort(chosen, std::greater{}, &ProjectedMap::weight);
    return chosen;
}

CubeProjector::CubeProjector(const GlContext& context) : context_(context), nothing_(context)
{
}

void CubeProjector::add(CubeMap map, float weight)
{
    SURFELAO_CHECK(maps_.empty() || map.size == maps_.front().size);
    maps_.push_back(std::move(map));
    weights_.push_back(weight);
    const std::size_t texels = maps_.back().distances.size();
    if (maps_.size() <= capacity_) {
        upload(maps_.size() - 1);
        return;
    }
    capacity_ = std::max(maps_.size(), 2 * capacity_);
    distances_.emplace(context_, TexelFormat::r32f, capacity_ * texels);
    values_.emplace(context_, TexelFormat::r32ui, capacity_ * texels);
    upload(0);
}

void CubeProjector::upload(std::size_t first)
{
    for (std::size_t i = first; i < maps_.size(); ++i) {
        const CubeMap& map = maps_[i];
        const std::size_t offset = i * map.distances.size() * sizeof(float);
        const std::vector<std::uint32_t> values = values_of(map);
        distances_->update(offset, std::span<const float>(map.distances));
        values_->update(offset, std::span<const std::uint32_t>(values));
    }
}

void CubeProjector::set_weight(std::size_t map, float weight)
{
    weights_[map] = weight;
}

void CubeProjector::clear()
{
    maps_.clear();
    weights_.clear();
    distances_.reset();
    values_.reset();
    capacity_ = 0;
}

std::size_t CubeProjector::bytes() const
{
    return std::accumulate(maps_.begin(), maps_.end(), std::size_t{0},
                           [](std::size_t sum, const CubeMap& map) { return sum + map.bytes(); });
}

Framebuffer CubeProjector::make_target(int width, int height) const
{
    return {context_, {.width = width, .height = height, .colors = {TexelFormat::rg32f}}};
}

void CubeProjector::project(const GBuffer& seen, const Framebuffer& target, int most)
{
    target.clear_color(glm::vec4(0.0f));
    std::vector<glm::vec3> centres;
    for (const CubeMap& map : maps_)
        centres.push_back(map.centre);
    std::vector<glm::vec4> records;
    const std::vector<ProjectedMap> used = nearest_maps(centres, weights_, seen.view().eye, most);
    for (std::size_t k = 0; k < used.size(); ++k) {
        const float next = k + 1 < used.size() ? used[k + 1].weight : 0.0f;
        records.emplace_back(centres[used[k].index], static_cast<float>(used[k].index));
        records.emplace_back(used[k].weight - next, used[k].weight, 0.0f, 0.0f);
    }
    if (records.empty())
        return;
    const TextureBuffer table(context_, TexelFormat::rgba32f, std::span<const glm::vec4>(records));
    Program& program = context_.program("fullscreen.vert", "cube_project.frag");
    set_eye(program, seen.view(), seen.width(), seen.height());
    program.set("u_surface", seen.surface());
    program.set("u_distances", *distances_);
    program.set("u_values", *values_);
    program.set("u_maps", table);
    program.set("u_map_count", static_cast<int>(records.size() / 2));
    program.set("u_face_size", maps_.front().size);
    draw_fullscreen(target, program, nothing_);
}

}  // namespace surfelao

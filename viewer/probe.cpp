#include "viewer/probe.h"

#include "atlas/layout.h"
#include "viewer/part_list.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cstdio>
#include <span>

namespace surfelao {
namespace {

std::string part_at(const Scene& scene, std::size_t triangle)
{
    for (const Label* label : parting_labels(scene)) {
        const bool has_it = std::ranges::any_of(label->ranges, [&](const Label::Range& range) {
            return triangle >= range.first && triangle - range.first < range.count;
        });
        if (has_it)
            return label->name;
    }
    return {};
}

std::optional<Occlusion> told_by(const ModelMap* map, const PagePlaces& places)
{
    if (!map || places.count == 0)
        return std::nullopt;
    glm::vec3 bent;
    for (std::uint32_t k = 0; k < 3; ++k)
        bent[static_cast<int>(k)] = 2.0f * fetch_at(map->bent, places, k) - 1.0f;
    return Occlusion{1.0f - fetch_at(map->visibility, places), bent};
}

std::optional<Occlusion> told_by(const PixelAnswers& answers, glm::ivec2 pixel)
{
    if (answers.picture.empty() || pixel.x >= answers.width || pixel.y >= answers.height)
        return std::nullopt;
    const glm::vec4& texel =
        answers
            .picture[static_cast<std::size_t>(pixel.y) * static_cast<std::size_t>(answers.width) +
                     static_cast<std::size_t>(pixel.x)];
    return Occlusion{texel.w, glm::vec3(texel)};
}

std::optional<Occlusion> told_by(std::span<const Occlusion> values, std::uint32_t vertex)
{
    return vertex < values.size() ? std::optional(values[vertex]) : std::nullopt;
}

/// In the file's units: the file's own numbers where nothing is moved.
glm::dvec3 position_of(const CellView& view, const glm::uvec3& corners, const glm::vec3& shares,
                       bool at_vertex, const Reading& reading)
{
    const Mesh& mesh = *view.model()->mesh;
    const Frame& frame = mesh.geometry.frame;
    if (view.is_moved())
        return frame.centre + frame.diagonal * glm::dvec3(reading.place);
    const std::vector<glm::dvec3>& positions = mesh.scene.positions;
    if (at_vertex)
        return positions[reading.vertex];
    return static_cast<double>(shares.x) * positions[corners.x] +
           static_cast<double>(shares.y) * positions[corners.y] +
           static_cast<double>(shares.z) * positions[corners.z];
}

void read_values(const CellView& view, const Cell& cell, glm::ivec2 pixel, Reading& reading)
{
    const SessionState& state = view.session().state();
    if (cell.at_pixels && view.has_pixels()) {
        if (const std::optional<float> told = view.told_by_picture(pixel))
            reading.own = Occlusion{*told, glm::vec3(0.0f)};
        else
            reading.own = told_by(view.pixels(), pixel);
        reading.reference = told_by(view.ray_pixels(), pixel);
    } else if (state.layout && !view.is_moved()) {
        const PagePlaces places =
            places_of(*state.model->mesh, state.layout->layout, reading.point);
        reading.own = told_by(state.map.get(), places);
        reading.reference = told_by(state.map_reference.get(), places);
    } else {
        reading.own = told_by(view.vertex_values(), reading.vertex);
        if (!view.is_moved())
            reading.reference = told_by(state.reference, reading.vertex);
    }
}

}  // namespace

Reading read_at(const CellView& view, const Cell& cell, const SurfacePoint& point, glm::ivec2 pixel)
{
    const Model& model = *view.model();
    const Geometry& geometry = model.geometry();
    const std::span<const glm::vec3> positions = view.positions();
    const std::span<const glm::vec3> normals = view.wedge_normals();
    const glm::uvec3& corners = geometry.triangles[point.triangle];
    const glm::uvec3& wedges = model.mesh->surface.corners(model.geometry())[point.triangle];
    const glm::vec3 shares(1.0f - point.at.x - point.at.y, point.at);
    const int nearest = shares.x >= shares.y && shares.x >= shares.z ? 0
                        : shares.y >= shares.z                       ? 1
                                                                     : 2;
    Reading reading;
    reading.point = point;
    reading.vertex = corners[nearest];
    reading.triangle = geometry.scene_triangle(point.triangle);
    reading.part = part_at(model.mesh->scene, reading.triangle);
    const bool at_vertex = where_of(cell) == Where::vertices;
    if (at_vertex) {
        reading.place = positions[reading.vertex];
        reading.normal = normals[wedges[nearest]];
    } else {
        glm::vec3 normal(0.0f);
        for (int k = 0; k < 3; ++k) {
            reading.place += shares[k] * positions[corners[k]];
            normal += shares[k] * normals[wedges[k]];
        }
        const float length = glm::length(normal);
        reading.normal = length > 0.0f ? normal / length : normal;
    }
    reading.position = position_of(view, corners, shares, at_vertex, reading);
    read_values(view, cell, pixel, reading);
    return reading;
}

std::string text_of(const Reading& reading)
{
    std::string text;
    char line[160];
    const auto add = [&](const char* format, auto... values) {
        std::snprintf(line, sizeof line, format, values...);
        text += text.empty() ? "" : "\n";
        text += line;
    };
    const auto add_vector = [&](const char* name, const glm::vec3& v) {
        add("%-10s %+.3f %+.3f %+.3f", name, static_cast<double>(v.x), static_cast<double>(v.y),
            static_cast<double>(v.z));
    };
    const auto number = [](float value) { return static_cast<double>(value); };
    if (reading.own)
        add("occlusion  %.4f", number(reading.own->occlusion));
    if (reading.reference)
        add("rays       %.4f", number(reading.reference->occlusion));
    if (reading.own && reading.reference)
        add("error      %+.4f", number(reading.own->occlusion - reading.reference->occlusion));
    add("position   %.6g %.6g %.6g", reading.position.x, reading.position.y, reading.position.z);
    add_vector("normal", reading.normal);
    if (reading.own && reading.own->bent_normal != glm::vec3(0.0f))
        add_vector("bent", reading.own->bent_normal);
    add("vertex     %u", reading.vertex);
    add("triangle   %zu", reading.triangle);
    if (!reading.part.empty())
        text += "\npart       " + reading.part;
    return text;
}

}  // namespace surfelao

#include "bake/info.h"

#include "bake/sample.h"
#include "bake/table.h"
#include "files/scene_io.h"
#include "reference/well_defined.h"
#include "surfels/geometry.h"
#include "surfels/number_text.h"
#include "surfels/receiver.h"

#include <glm/common.hpp>

#include <algorithm>

namespace surfelao {
namespace {

constexpr std::size_t kPartsShown = 20;

/// "3 triangles", "1 triangle"; an irregular noun gives both forms: "vertex|vertices".
std::string count_text(std::uint64_t count, const std::string& noun)
{
    const std::size_t bar = noun.find('|');
    std::string text = std::to_string(count) + ' ';
    if (bar == std::string::npos)
        return text + noun + (count == 1 ? "" : "s");
    return text + (count == 1 ? noun.substr(0, bar) : noun.substr(bar + 1));
}

std::string point_text(glm::dvec3 p)
{
    return '(' + exact(p.x) + ", " + exact(p.y) + ", " + exact(p.z) + ')';
}

/// What a user may want to know before trusting a bake, a sentence each.
std::vector<std::string> oddities(const Info& info)
{
    const Topology& topology = info.topology;
    std::vector<std::string> odd;
    const auto add = [&](std::uint64_t count, const std::string& noun, const std::string& what) {
        if (count > 0)
            odd.push_back(count_text(count, noun) + ' ' + what);
    };
    add(info.dropped_triangles, "triangle", "without area: dropped, they occlude nothing");
    add(topology.duplicate_triangle_count, "triangle",
        "repeated at the same place: they count once");
    add(info.unused_vertices, "vertex|vertices", "in no triangle");
    add(info.vertices_without_normal, "vertex|vertices", "without a normal: they get occlusion 0");
    add(topology.nonmanifold_edge_count, "edge", "between more than two triangles");
    add(topology.misoriented_edge_count, "edge", "between triangles that face opposite ways");
    add(info.half_edges.complex_triangle_count, "triangle",
        "where the surface is no manifold: fans that meet in a point, or more than two at an edge");
    add(topology.boundary_edge_count, "edge",
        "at a border, around " + count_text(info.half_edges.hole_count, "hole") + " of up to " +
            count_text(info.half_edges.largest_hole_edges, "edge"));
    add(info.ill_defined, "vertex|vertices",
        "of " + std::to_string(info.examined) +
            " examined without an answer of their own: in another surface's plane, or between "
            "surfaces nearer than the receivers' offset");
    return odd;
}

}  // namespace

Info inspect(const std::filesystem::path& input, const Progress& progress)
{
    const Scene scene = read_scene(input);
    const Geometry geometry = make_geometry(scene);
    Info info;
    info.input = input;
    info.parts = scene.parts;
    info.vertices = scene.positions.size();
    info.triangles = scene.triangles.size();
    info.dropped_triangles = geometry.dropped_triangles;
    info.diagonal = geometry.frame.diagonal;
    info.topology = analyse_topology(geometry);
    info.half_edges = examine_half_edges(geometry);

    std::vector<bool> used(scene.positions.size(), false);
    info.low = info.high = scene.positions[scene.triangles.front().x];
    for (const glm::uvec3 triangle : scene.triangles) {
        for (int corner = 0; corner < 3; ++corner) {
            used[triangle[corner]] = true;
            info.low = glm::min(info.low, scene.positions[triangle[corner]]);
            info.high = glm::max(info.high, scene.positions[triangle[corner]]);
        }
    }
    for (std::size_t v = 0; v < used.size(); ++v) {
        info.unused_vertices += !used[v];
        info.positions += geometry.welded[v] == v;
        info.vertices_without_normal += geometry.normals[v] == glm::vec3(0.0f);
        info.area += geometry.areas[v];
    }
    info.area *= info.diagonal * info.diagonal;

    const Definition definition;
    const std::vector<Receiver> receivers =
        receivers_at_wedges(geometry, make_surface(scene, geometry));
    std::vector<Receiver> examined;
    for (const std::uint32_t v : sample_of(receivers.size(), kExaminedVertices)) {
        if (receivers[v].normal != glm::vec3(0.0f))
            examined.push_back(receivers[v]);
    }
    info.examined = examined.size();
    for (const float change : placement_change(RayScene(geometry, RayScene::Build::robust),
                                               examined, definition, progress))
        info.ill_defined += change > kIllDefined;
    return info;
}

std::string text_of(const Info& info)
{
    const Topology& topology = info.topology;
    std::string text =
        info.input.string() + "\n  " + count_text(info.vertices, "vertex|vertices") + " at " +
        count_text(info.positions, "place") + ", " + count_text(info.triangles, "triangle") + ", " +
        count_text(info.parts.size(), "part") + "\n  box " + point_text(info.low) + " to " +
        point_text(info.high) + ", diagonal " + exact(info.diagonal) + ", area " +
        exact(info.area) + "\n  " + count_text(topology.component_count, "connected piece") + ", " +
        std::to_string(topology.closed_component_count) + " of them closed, " +
        count_text(info.half_edges.handle_count, "handle") + "\n";
    if (info.parts.size() > 1) {
        Table table({"  part", "name", "vertices", "triangles"});
        for (std::size_t i = 0; i < std::min(kPartsShown, info.parts.size()); ++i) {
            const Part& part = info.parts[i];
            table.add({"  " + std::to_string(i), part.name, std::to_string(part.vertex_count),
                       std::to_string(part.triangle_count)});
        }
        text += table.text();
        if (info.parts.size() > kPartsShown)
            text += "  and " + std::to_string(info.parts.size() - kPartsShown) + " more\n";
    }
    const std::vector<std::string> odd = oddities(info);
    text += odd.empty() ? "nothing odd\n" : "odd, but legal:\n";
    for (const std::string& sentence : odd)
        text += "  " + sentence + '\n';
    return text;
}

}  // namespace surfelao

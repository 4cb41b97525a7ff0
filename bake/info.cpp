#include "bake/info.h"

#include "bake/notes.h"
#include "bake/sample.h"
#include "bake/table.h"
#include "bake/world.h"
#include "engines/engine.h"
#include "reference/well_defined.h"
#include "surfels/geometry.h"
#include "surfels/labels.h"
#include "surfels/number_text.h"
#include "surfels/receiver.h"
#include "surfels/surface.h"
#include "surfels/texels.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <numbers>
#include <span>

namespace surfelao {
namespace {

constexpr std::size_t kPartsShown = 20;
constexpr std::size_t kNamesShown = 40;

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
    if (info.ill_defined > 0)
        odd.push_back(std::to_string(info.ill_defined) + " of " +
                      count_text(info.examined, "place") +
                      " where occlusion is asked have no answer of their own: in another "
                      "surface's plane, or between surfaces nearer than the receivers' offset");
    odd.insert(odd.end(), info.notes.begin(), info.notes.end());
    return odd;
}

/// The share of texels that show several sheets.
double overlap_of(const MapRaster& raster)
{
    constexpr std::uint32_t kRows = 64;  // what memory holds at a time
    std::uint64_t covered = 0, overlapping = 0;
    for (std::uint32_t first = 0; first < raster.size().height; first += kRows) {
        const std::vector<Texel> texels = raster.texels(first, kRows);
        const auto is_next = [&](std::size_t i) {  // sheet of the texel before it
            return i > 0 && i < texels.size() && texels[i].x == texels[i - 1].x &&
                   texels[i].y == texels[i - 1].y;
        };
        for (std::size_t i = 0; i < texels.size(); ++i) {
            covered += is_next(i) ? 0 : 1;
            overlapping += !is_next(i) && is_next(i + 1) ? 1 : 0;
        }
    }
    return covered == 0 ? 0.0 : static_cast<double>(overlapping) / static_cast<double>(covered);
}

UvReport report_of(const Geometry& geometry, const UvSet& uvs)
{
    UvReport report;
    for (std::size_t t = 0; t < geometry.triangles.size(); ++t) {
        const glm::uvec3 corners =
            uvs.corners.empty() ? geometry.triangles[t] : uvs.corners[geometry.scene_triangle(t)];
        if (std::max({corners.x, corners.y, corners.z}) != UvSet::kNone)
            ++report.triangles;
    }
    const MapRaster raster(geometry, uvs, kUvMap);
    report.flat = raster.flat_triangles() - (geometry.triangles.size() - report.triangles);
    report.outside = raster.outside_triangles();
    report.sheets = raster.sheets();
    if (report.sheets <= kMostSheets)
        report.overlap = overlap_of(raster);
    return report;
}

std::vector<UvReport> uv_reports(const Mesh& mesh)
{
    std::vector<UvReport> reports;
    for (std::uint32_t set = 0; set < mesh.scene.uvs.size(); ++set) {
        if (mesh.scene.uvs[set].empty())
            continue;
        reports.push_back(report_of(mesh.geometry, mesh.scene.uvs[set]));
        reports.back().set = set;
    }
    return reports;
}

/// What the file holds, without an engine.
void look_at(const Mesh& mesh, Info& info)
{
    const Scene& scene = mesh.scene;
    const Geometry& geometry = mesh.geometry;
    info.parts = scene.parts;
    info.labels = scene.labels;
    info.vertices = scene.positions.size();
    info.triangles = scene.triangles.size();
    info.dropped_triangles = geometry.dropped_triangles;
    info.diagonal = geometry.frame.diagonal;
    info.normals_in_file = !scene.normals.empty();
    info.corners_from_file = mesh.surface.corners_from_file;
    info.replaced_corners = mesh.surface.replaced_corners;
    info.uvs = uv_reports(mesh);
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
        info.vertices_without_normal += mesh.surface.normals[v] == glm::vec3(0.0f);
        info.area += geometry.areas[v];
    }
    info.area *= info.diagonal * info.diagonal;
}

/// What a bake with default settings would have to say.
void bake_for_notes(const std::shared_ptr<const Mesh>& mesh, const VertexTarget& target,
                    const Progress& progress, Info& info)
{
    const Definition definition;
    const Solution solution =
        solve(prepare(mesh->occluding()), target.receivers(), {.definition = definition}, progress);
    const std::vector<Occlusion> values = target.values(solution.occlusion);
    info.mean_occlusion = mean_occlusion_of(mesh->surface, values);
    info.misfit = target.misfit(solution.occlusion, values);
    info.notes = notes_of({*mesh, info.topology, definition, values, info.misfit});
}

/// A cloud, with what a bake with default settings would have to say.
void look_at_points(const Scene& scene, const Progress& progress, Info& info)
{
    const PointTarget target = make_point_target(scene, {});
    const Solution solution =
        solve_points(prepare(target.cloud, target.squares), target, {}, progress);
    info.parts = scene.parts;
    info.vertices = scene.positions.size();
    info.positions = info.vertices - target.cloud.counts.duplicates;
    info.normals_in_file = !scene.normals.empty();
    info.points = report_of(target);
    info.receivers = info.vertices;
    info.vertices_without_normal = target.cloud.counts.without_normal;
    Box box;
    for (const glm::dvec3& p : scene.positions)
        box.include(p);
    info.low = box.low;
    info.high = box.high;
    info.diagonal = target.cloud.frame.diagonal;
    double area = 0.0, sum = 0.0;
    for (const std::uint32_t i : target.cloud.occluders)
        area += std::numbers::pi * double{target.cloud.radii[i]} * double{target.cloud.radii[i]};
    info.area = area * info.diagonal * info.diagonal;
    for (const Occlusion& answer : solution.occlusion)
        sum += answer.occlusion;
    info.mean_occlusion = sum / static_cast<double>(std::max<std::uint64_t>(
                                    1, info.vertices - info.vertices_without_normal));
    info.notes = scene.notes;
    std::ranges::copy(point_notes(target), std::back_inserter(info.notes));
}

std::string points_text(const Info& info)
{
    const PointReport& points = *info.points;
    std::string text = info.input.string() + "\n  " + count_text(info.vertices, "point") +
                       ", no faces\n  box " + point_text(info.low) + " to " +
                       point_text(info.high) + ", diagonal " + exact(info.diagonal) + "\n  about " +
                       significant(points.spacing) + " apart, noise " + fixed(points.noise, 2) +
                       " of a point's radius, area about " + significant(info.area) + "\n  ";
    text += info.normals_in_file
                ? "normals in the file at " + std::to_string(points.counts.from_file) + " points"
                : "no normals in the file: fitted, their sides by " + name_of(points.orientation);
    text += ", mean occlusion " + fixed(info.mean_occlusion, 4) + '\n';
    text += info.notes.empty() ? "nothing odd\n" : "odd, but legal:\n";
    for (const std::string& note : info.notes)
        text += "  " + note + '\n';
    return text;
}

std::string normals_text(const Info& info)
{
    if (!info.normals_in_file)
        return "no normals in the file: smooth within " + exact(NormalSettings{}.crease) +
               " degrees";
    return "normals in the file, used at " + std::to_string(info.corners_from_file) + " of " +
           count_text(3 * (info.triangles - info.dropped_triangles), "corner");
}

/// A share of something; what is above zero is said to be.
std::string percent_text(double share)
{
    return share > 0.0 && share < 0.0005 ? "less than 0.1 %" : fixed(100.0 * share, 1) + " %";
}

std::string uvs_text(const UvReport& uvs)
{
    const std::string size = std::to_string(kUvMap.width) + " x " + std::to_string(kUvMap.height);
    return "texture coordinates: set " + std::to_string(uvs.set) + ", " +
           count_text(uvs.triangles, "triangle") + ", " + std::to_string(uvs.flat) +
           " without area there, " + std::to_string(uvs.outside) + " outside of [0, 1], " +
           (uvs.overlap ? percent_text(*uvs.overlap) + " of texels covered twice (at " + size + ")"
                        : "the map covered " + fixed(uvs.sheets, 0) + " times over");
}

/// Names with what they are of and how much they cover; those of one name and the same triangles in
/// one line. Empty where the file has none.
std::string labels_text(const Info& info)
{
    struct Row {
        std::string kinds;
        const Label* label;
    };
    std::vector<Row> rows;
    for (const Label& label : info.labels) {
        const auto same = std::ranges::find_if(rows, [&](const Row& row) {
            return row.label->name == label.name && row.label->ranges == label.ranges;
        });
        const std::string kind(name_of(label.kind));
        if (same != rows.end())
            same->kinds += ", " + kind;
        else if (rows.size() <= kNamesShown)
            rows.push_back({kind, &label});
    }
    if (rows.empty())
        return {};
    Table table({"  name", "of", "triangles"});
    for (std::size_t i = 0; i < std::min(kNamesShown, rows.size()); ++i)
        table.add({"  " + rows[i].label->name, rows[i].kinds,
                   std::to_string(triangle_count(*rows[i].label))});
    return table.text() + (rows.size() > kNamesShown ? "  and more names (--json has all)\n" : "");
}

}  // namespace

Info inspect(const std::filesystem::path& input, const Progress& progress,
             const ReadOptions& reading)
{
    Info info;
    info.input = input;
    Scene scene = read_scene(input, reading);
    if (scene.triangles.empty()) {
        look_at_points(scene, progress, info);
        return info;
    }
    const auto mesh = std::make_shared<const Mesh>(mesh_of(std::move(scene), {}, {}, {}));
    const VertexTarget target(mesh, {});
    look_at(*mesh, info);
    // the bake is the first half of the work, the rays are the second
    const auto half = [&](double begin) {
        return Progress(
            [&progress, begin](double done) { return !progress || progress(begin + 0.5 * done); });
    };
    bake_for_notes(mesh, target, half(0.0), info);

    const std::span<const Receiver> receivers = target.receivers();
    info.receivers = receivers.size();
    std::vector<Receiver> examined;
    for (const std::uint32_t i : sample_of(receivers.size(), kExaminedReceivers))
        examined.push_back(receivers[i]);
    info.examined = examined.size();
    for (const float change : placement_change(RayScene(mesh->occluding(), RayScene::Build::robust),
                                               examined, Definition{}, half(0.5)))
        info.ill_defined += change > kIllDefined;
    return info;
}

std::string text_of(const Info& info)
{
    if (info.points)
        return points_text(info);
    const Topology& topology = info.topology;
    std::string text =
        info.input.string() + "\n  " + count_text(info.vertices, "vertex|vertices") + " at " +
        count_text(info.positions, "place") + ", " + count_text(info.triangles, "triangle") + ", " +
        count_text(info.parts.size(), "part") + "\n  box " + point_text(info.low) + " to " +
        point_text(info.high) + ", diagonal " + exact(info.diagonal) + ", area " +
        exact(info.area) + "\n  " + count_text(topology.component_count, "connected piece") + ", " +
        std::to_string(topology.closed_component_count) + " of them closed, " +
        count_text(info.half_edges.handle_count, "handle") + "\n";
    text += "  " + normals_text(info) + "\n";
    for (const UvReport& uvs : info.uvs)
        text += "  " + uvs_text(uvs) + "\n";
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
    text += labels_text(info);
    const std::vector<std::string> odd = oddities(info);
    text += odd.empty() ? "nothing odd\n" : "odd, but legal:\n";
    for (const std::string& sentence : odd)
        text += "  " + sentence + '\n';
    return text;
}

}  // namespace surfelao

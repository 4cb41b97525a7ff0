#include "bake/notes.h"

#include "bake/part_hints.h"
#include "surfels/number_text.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace surfelao {
namespace {

std::string of_all(std::uint64_t count, std::uint64_t all, const std::string& noun)
{
    return std::to_string(count) + " of " + count_text(all, noun);
}

std::string percent(double share)
{
    const long rounded = std::lround(100.0 * share);
    return rounded > 0 ? std::to_string(rounded) + " %" : "less than 1 %";
}

/// Empty where all face outward.
std::string facing_note(const Geometry& geometry, const Topology& topology)
{
    const std::uint64_t inward = topology.inward_count, all = topology.solid_count;
    if (inward == 0)
        return {};
    double area = 0.0, whole = 0.0;
    for (std::size_t v = 0; v < geometry.areas.size(); ++v) {
        whole += geometry.areas[v];
        area += topology.sides[v] == OccluderSide::front ? geometry.areas[v] : 0.0;
    }
    return of_all(inward, all, "closed piece") + (inward == 1 ? " faces" : " face") + " inward, " +
           percent(area / whole) + " of the surface: what is baked there is the inside";
}

/// Empty where few vertices are inside; pieces that face inward have a note of their own.
std::string closed_note(std::span<const Occlusion> values, const Topology& topology)
{
    std::uint64_t closed = 0;
    for (std::size_t v = 0; v < values.size(); ++v)
        closed += values[v].occlusion > kClosed && topology.sides[v] != OccluderSide::front;
    if (closed == 0 || static_cast<double>(closed) < kNotableClosed * double(values.size()))
        return {};
    return of_all(closed, values.size(), "vertex|vertices") + (closed == 1 ? " is" : " are") +
           " closed on all sides, as inside of other parts or against them";
}

/// The mean occlusion of the vertices with a normal that belong to nothing of this name.
double mean_beside(const Baked& baked, const std::string& name)
{
    const Scene& scene = baked.mesh.scene;
    Surface beside;
    beside.normals.assign(
        baked.mesh.surface.normals.begin(),
        baked.mesh.surface.normals.begin() + std::ptrdiff_t(scene.positions.size()));
    for (const Label& label : scene.labels) {
        for (const Label::Range& range : label.ranges) {
            for (std::uint32_t t = range.first; t < range.first + range.count && label.name == name;
                 ++t) {
                for (int corner = 0; corner < 3; ++corner)
                    beside.normals[scene.triangles[t][corner]] = glm::vec3(0.0f);
            }
        }
    }
    return mean_occlusion_of(beside, baked.values);
}

/// Why so little light comes in; empty where enough does.
std::string dark_note(const Baked& baked)
{
    const bool is_far = baked.definition.max_distance > kInteriorDistance;
    const bool is_interior = mean_occlusion_of(baked.mesh.surface, baked.values) > kInteriorMean;
    std::string closed;  // a ground closes undersides too, rightly
    if (!is_interior && !baked.definition.ground)
        closed = closed_note(baked.values, baked.topology);
    const std::string around = name_of_enclosing(baked.mesh);
    if (!around.empty() && mean_beside(baked, around) > kInteriorMean)
        return "part " + around + " encloses all others, so hardly any light comes in: --exclude " +
               shell_word(around) + " leaves it out" +
               (is_far ? ", --preset interior is for interiors" : "");
    const std::string sky = name_of_sky(baked.mesh);
    if (!sky.empty() && (is_interior || !closed.empty()))
        return "part " + sky + " is called like a sky, and much of the rest is closed: --exclude " +
               shell_word(sky) + " leaves it out";
    if (is_interior)
        return is_far ? "an interior: try --preset interior" : "";
    return closed;
}

}  // namespace

double mean_occlusion_of(const Surface& surface, std::span<const Occlusion> values)
{
    double sum = 0.0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (surface.normals[i] != glm::vec3(0.0f)) {
            sum += values[i].occlusion;
            ++count;
        }
    }
    return count > 0 ? sum / static_cast<double>(count) : 0.0;
}

std::uint64_t vertices_without_normal(const Mesh& mesh)
{
    const std::vector<glm::vec3>& normals = mesh.surface.normals;
    std::vector<bool> counts(normals.size(), true);
    for (const bool is_baked : {false, true}) {
        for (std::size_t t = 0; t < mesh.unbaked.size(); ++t) {
            for (int corner = 0; corner < 3 && mesh.unbaked[t] != is_baked; ++corner)
                counts[mesh.scene.triangles[t][corner]] = is_baked;
        }
    }
    std::uint64_t count = 0;
    for (std::size_t v = 0; v < mesh.surface.vertex_count(); ++v)
        count += counts[v] && normals[v] == glm::vec3(0.0f);
    return count;
}

std::vector<std::string> notes_of(const Baked& baked)
{
    std::vector<std::string> notes = baked.mesh.scene.notes;
    const auto add = [&](std::string note) {
        if (!note.empty())
            notes.push_back(std::move(note));
    };
    const Surface& surface = baked.mesh.surface;
    if (baked.mesh.geometry.triangles.empty()) {
        add("no triangle has an area: there is no surface, and nothing occludes");
        return notes;
    }
    if (surface.replaced_corners > 0)
        add(of_all(surface.replaced_corners, surface.replaced_corners + surface.corners_from_file,
                   "normal") +
            " of the file without direction or on the wrong side of the face: replaced by smooth "
            "ones");
    add(facing_note(baked.mesh.geometry, baked.topology));
    if (baked.misfit && baked.misfit->rms > kNotableMisfit && baked.misfit->share >= kNotableShare)
        add("what is seen errs by about " + fixed(baked.misfit->rms, 2) + ": " +
            percent(baked.misfit->share) +
            " of the surface lies in triangles too large for values at vertices; --subdivide "
            "helps");
    for (std::string& hint : hints_by_name(baked.mesh))
        add(std::move(hint));
    add(dark_note(baked));
    return notes;
}

}  // namespace surfelao

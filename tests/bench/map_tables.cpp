// map_tables: maps of whatever maker, judged alike.
//
//     map_tables write MESH OUT.obj [SIZE]
//                                       the triangles that have an area, with our corner normals
//                                       and the coordinates of the map, new ones for a map of that
//                                       size: what all makers are given
//     map_tables judge MESH MAP...      JSON: for each map, a linear picture of the visibility,
//                                       what it displays against robust rays at points all over
//                                       the surface, of which points are told too
//
// The file's texture coordinates of number 0 count. Points, rays and what is left out are those of
// `surfelao compare --at texels` (bake/surface_error.h).

#include "atlas/layout.h"
#include "bake/surface_error.h"
#include "bake/texel_layout.h"
#include "files/scene_io.h"
#include "image/image_file.h"
#include "surfels/atomic_file.h"
#include "surfels/errors.h"
#include "surfels/number_text.h"

#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

namespace {

using namespace surfelao;

struct World {
    /// size: of new coordinates; 0: the file's.
    World(const std::filesystem::path& path, std::uint32_t size) : mesh(make_mesh(read_scene(path)))
    {
        TexelSettings settings;
        settings.uvs = size > 0 ? UvChoice::made : UvChoice::file;
        settings.size = size > 0 ? size : settings.size;
        layout = layout_for(mesh, settings).layout;
    }
    Mesh mesh;
    MapLayout layout;
};

void append_line(std::string& text, const char* key, std::initializer_list<double> numbers)
{
    text += key;
    for (const double number : numbers) {
        text += ' ';
        append_shortest(text, number);
    }
    text += '\n';
}

std::string obj_of(const World& world)
{
    const Mesh& mesh = world.mesh;
    const UvSet& uvs = world.layout.pages.front();
    std::string text;
    for (const glm::dvec3 p : mesh.scene.positions)
        append_line(text, "v", {p.x, p.y, p.z});
    for (const glm::dvec2 uv : uvs.values)
        append_line(text, "vt", {uv.x, 1.0 - uv.y});
    for (const glm::vec3 n : mesh.surface.normals)
        append_line(text, "vn", {n.x, n.y, n.z});
    for (std::uint32_t t = 0; t < mesh.geometry.triangles.size(); ++t) {
        const glm::uvec3 vertices = mesh.geometry.triangles[t],
                         normals = mesh.surface.corners(mesh.geometry)[t];
        const glm::uvec3 places =
            uvs.corners.empty() ? vertices : uvs.corners[mesh.geometry.scene_triangle(t)];
        text += 'f';
        for (int k = 0; k < 3; ++k) {
            text += ' ' + std::to_string(vertices[k] + 1) + '/';
            if (places[k] != UvSet::kNone)
                text += std::to_string(places[k] + 1);
            text += '/' + std::to_string(normals[k] + 1);
        }
        text += '\n';
    }
    return text;
}

Map map_of(const std::filesystem::path& path)
{
    const Image image = read_image(path);
    Map map(static_cast<std::uint32_t>(image.width), static_cast<std::uint32_t>(image.height), 1);
    for (std::size_t i = 0; i < map.values.size(); ++i)
        map.values[i] = image.pixels[i].x;
    return map;
}

std::string judgement_of(const World& world, const SurfaceTruth& truth,
                         const std::filesystem::path& path)
{
    const std::vector<Map> pages = {map_of(path)};
    std::vector<Occlusion> shown;
    for (const SurfacePoint& point : truth.points)
        shown.push_back({1.0f - fetch_at(pages, places_of(world.mesh, world.layout, point)), {}});
    const ErrorStatistics error = error_against(truth, shown);
    return "{\"rmse\": " + exact(error.rmse) + ", \"bias\": " + exact(error.bias) +
           ", \"p95\": " + exact(error.p95) + ", \"max\": " + exact(error.max) + "}";
}

std::string judged(const World& world, int count, char** maps)
{
    TruthSettings settings;
    settings.leave_out_hidden = true;
    settings.measure = triangle_areas(world.mesh.geometry);
    for (std::uint32_t t = 0; t < settings.measure.size(); ++t) {
        if (places_of(world.mesh, world.layout, {t, {0.25f, 0.25f}}).count == 0)
            settings.measure[t] = 0.0;
    }
    const SurfaceTruth truth = trace_truth(world.mesh, settings);
    std::string text = "{\"points\": " + std::to_string(truth.points.size()) +
                       ", \"ill_defined\": " + std::to_string(truth.ill_defined) +
                       ", \"hidden\": " + std::to_string(truth.hidden) + ", \"maps\": [";
    for (int i = 0; i < count; ++i)
        text += (i > 0 ? ", " : "") + judgement_of(world, truth, maps[i]);
    return text + "]}\n";
}

}  // namespace

int main(int argument_count, char** arguments)
try {
    const std::string task = argument_count > 3 ? arguments[1] : "";
    if (task == "write") {
        const auto size =
            static_cast<std::uint32_t>(argument_count > 4 ? std::atoi(arguments[4]) : 0);
        write_atomically(arguments[3], obj_of(World(arguments[2], size)));
    } else if (task == "judge") {
        std::fputs(judged(World(arguments[2], 0), argument_count - 3, arguments + 3).c_str(),
                   stdout);
    } else {
        std::fputs("usage: map_tables write MESH OUT.obj [SIZE] | judge MESH MAP...\n", stderr);
        return 2;
    }
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "map_tables: %s\n", error.what());
    return 1;
}

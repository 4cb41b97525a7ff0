// atlas_tables: charts of meshes, and what another maker of charts needs to make its own of them.
//
//     atlas_tables SIZE OUT MESH...
//
// Writes OUT/STEM.places (three floats each), OUT/STEM.corners (three places a triangle, 32 bits
// each), OUT/STEM.uvs (two floats each, from 0 to 1) and OUT/STEM.uv_corners, and prints JSON: per
// mesh what Atlas reports, and seconds. Places are welded; triangles without area are left out.

#include "atlas/atlas.h"
#include "files/scene_io.h"
#include "surfels/atomic_file.h"
#include "surfels/stopwatch.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace {

using namespace surfelao;

template <class Item>
void write_items(const std::filesystem::path& path, const std::vector<Item>& items)
{
    write_atomically(path, std::string_view(reinterpret_cast<const char*>(items.data()),
                                            items.size() * sizeof(Item)));
}

void write_arrays(const std::filesystem::path& stem, const Mesh& mesh, const UvSet& uvs)
{
    const Geometry& geometry = mesh.geometry;
    std::vector<float> places, values;
    std::vector<std::uint32_t> corners, uv_corners;
    std::vector<std::uint32_t> place_of(geometry.positions.size(), UvSet::kNone);
    for (std::size_t t = 0; t < geometry.triangles.size(); ++t) {
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t vertex = geometry.welded[geometry.triangles[t][k]];
            if (place_of[vertex] == UvSet::kNone) {
                place_of[vertex] = static_cast<std::uint32_t>(places.size() / 3);
                const glm::vec3 p = geometry.positions[vertex];
                places.insert(places.end(), {p.x, p.y, p.z});
            }
            corners.push_back(place_of[vertex]);
            uv_corners.push_back(uvs.corners[geometry.scene_triangle(t)][k]);
        }
    }
    for (const glm::dvec2 uv : uvs.values)
        values.insert(values.end(), {static_cast<float>(uv.x), static_cast<float>(uv.y)});
    write_items(stem.string() + ".places", places);
    write_items(stem.string() + ".corners", corners);
    write_items(stem.string() + ".uvs", values);
    write_items(stem.string() + ".uv_corners", uv_corners);
}

}  // namespace

int main(int argc, char** argv)
{
    if (argc < 4) {
        std::fputs("atlas_tables SIZE OUT MESH...\n", stderr);
        return 2;
    }
    AtlasSettings settings;
    settings.size = static_cast<std::uint32_t>(std::atoi(argv[1]));
    const std::filesystem::path out = argv[2];
    std::filesystem::create_directories(out);
    std::puts("[");
    for (int i = 3; i < argc; ++i) {
        const std::filesystem::path path = argv[i];
        const Mesh mesh = make_mesh(read_scene(path));
        double seconds = std::numeric_limits<double>::max();
        Atlas atlas;
        for (int round = 0; round < 3; ++round) {
            Stopwatch watch;
            atlas = make_atlas(mesh, settings);
            seconds = std::min(seconds, watch.lap());
        }
        const std::string name =
            path.stem() == "scene" ? path.parent_path().filename() : path.stem();
        write_arrays(out / name, mesh, atlas.layout.pages.front());
        std::printf(
            "{\"name\": \"%s\", \"triangles\": %zu, \"charts\": %u, \"use\": %.5f, "
            "\"seconds\": %.4f}%s\n",
            name.c_str(), mesh.geometry.triangles.size(), atlas.chart_count, atlas.use, seconds,
            i + 1 < argc ? "," : "");
    }
    std::puts("]");
    return 0;
}

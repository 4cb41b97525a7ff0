// Pictures of maps by OSMesa, on models and flat.

#include "viewer/atlas_picture.h"

#include "golden.h"
#include "image/color_map.h"
#include "random.h"
#include "scenes.h"
#include "viewer/render.h"
#include "viewer/solve_map.h"
#include "viewer/solve_model.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace surfelao {
namespace {

constexpr int kPixels = 96;

RenderOptions of_map(Colors colors, const SurfaceData& data)
{
    RenderOptions options;
    options.width = options.height = kPixels;
    options.samples = 1;
    options.view.colors = colors;
    options.view.ground = false;
    options.backend = GlBackend::osmesa;
    options.data = data;
    return options;
}

/// A square of two triangles, its normals turning from the sky to +x along x.
Mesh turning_square()
{
    Mesh mesh = make_mesh(scenes::sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1));
    for (std::size_t v = 0; v < mesh.surface.normals.size(); ++v)
        mesh.surface.normals[v] =
            mesh.scene.positions[v].x > 0.5 ? glm::vec3(1, 0, 0) : glm::vec3(0, 0, 1);
    return mesh;
}

enum class Pages { one, tiles, blended };

/// All kinds of layouts of the square, over more than one repetition of the map.
MapLayout layout_of(const Mesh& mesh, Pages kind)
{
    UvSet page;
    for (const glm::dvec3 p : mesh.scene.positions)
        page.values.emplace_back(1.7 * p.x - 0.3, 0.9 * p.y + 0.2 * p.x);
    MapLayout layout{.size = {5, 4}, .pages = {page}, .is_blended = kind == Pages::blended};
    if (kind == Pages::blended)
        layout.pages = {page, page, page};
    if (kind == Pages::tiles) {
        layout.pages = {page, page};
        layout.pages[0].corners = {mesh.scene.triangles[0], glm::uvec3(UvSet::kNone)};
        layout.pages[1].corners = {glm::uvec3(UvSet::kNone), mesh.scene.triangles[1]};
    }
    return layout;
}

/// Whole bytes.
ModelMap random_map(const MapLayout& layout)
{
    ModelMap map = open_map(layout);
    Random random(7);
    for (Map& page : map.visibility)
        for (float& value : page.values)
            value = static_cast<float>(random.bits() % 256) / 255.0f;
    return map;
}

/// Where the square is seen in a pixel's middle, from straight above; nothing near its edges.
std::optional<SurfacePoint> seen_at(const Mesh& mesh, const Camera& camera, glm::ivec2 pixel)
{
    const glm::mat4 to_world =
        glm::inverse(projection_matrix(camera, 1.0f, 0.1f, 10.0f) * view_matrix(camera));
    const glm::vec2 clip = (glm::vec2(pixel) + 0.5f) / static_cast<float>(kPixels) * 2.0f - 1.0f;
    const glm::vec4 far = to_world * glm::vec4(clip.x, -clip.y, 1.0f, 1.0f);
    const glm::vec3 direction = glm::vec3(far) / far.w - camera.eye;
    const Geometry& geometry = mesh.geometry;
    const glm::vec3 at =
        camera.eye + (geometry.positions[0].z - camera.eye.z) / direction.z * direction;
    for (std::uint32_t t = 0; t < 2; ++t) {
        const glm::uvec3 corners = geometry.triangles[t];
        const glm::vec3 a = geometry.positions[corners.x];
        const glm::mat2 sides(glm::vec2(geometry.positions[corners.y] - a),
                              glm::vec2(geometry.positions[corners.z] - a));
        const glm::vec2 shares = glm::inverse(sides) * glm::vec2(at - a);
        if (std::min({shares.x, shares.y, 1.0f - shares.x - shares.y}) > 0.03f)
            return SurfacePoint{t, shares};
    }
    return {};
}

// The twin of fetch_at() in the shader.
TEST(MapPicture, ShowsWhatFetchAtSays)
{
    for (const Pages kind : {Pages::one, Pages::tiles, Pages::blended}) {
        const Model model = make_model(turning_square(), UpAxis::z);
        const Mesh& mesh = *model.mesh;
        const MapLayout places = layout_of(mesh, kind);
        const ModelLayout layout{places, facts_of(mesh, places)};
        const ModelMap map = random_map(places);
        const Camera camera =
            frame_points(model.seen, UpAxis::z, 1.0f, {.azimuth_deg = 0, .elevation_deg = 90});
        const std::vector<Occlusion> nothing(model.answer_count());
        const Image image = render(model, nothing, {}, camera,
                                   of_map(Colors::visibility, {.layout = &layout, .map = &map}));
        int compared = 0;
        for (int y = 0; y < kPixels; ++y) {
            for (int x = 0; x < kPixels; ++x) {
                const auto point = seen_at(mesh, camera, {x, y});
                if (!point)
                    continue;
                const float shown = fetch_at(map.visibility, places_of(mesh, places, *point));
                ASSERT_NEAR(srgb_encode(image.at(x, y).r), 0.94f * shown, 0.004f)
                    << x << ' ' << y << ' ' << static_cast<int>(kind);
                ++compared;
            }
        }
        EXPECT_GT(compared, kPixels * kPixels / 2);
    }
}

TEST(MapPicture, TheDifferenceIsThatOfTheTexels)
{
    const Model model = make_model(turning_square(), UpAxis::z);
    const MapLayout places = layout_of(*model.mesh, Pages::one);
    const ModelLayout layout{places, facts_of(*model.mesh, places)};
    const ModelMap map = open_map(places);
    ModelMap rays = map;
    rays.visibility[0].values.assign(20, 204.0f / 255.0f);
    RenderOptions options =
        of_map(Colors::difference, {.layout = &layout, .map = &map, .reference = &rays});
    options.view.difference_scale = 0.4f;
    const Camera camera =
        frame_points(model.seen, UpAxis::z, 1.0f, {.azimuth_deg = 0, .elevation_deg = 90});
    const Image image =
        render(model, std::vector<Occlusion>(model.answer_count()), {}, camera, options);
    EXPECT_LT(glm::distance(glm::vec3(image.at(48, 30)), map_color(ColorMap::heat, 0.5f)), 0.01f);
    const Image flat = atlas_picture(*model.mesh, options.data, options.view, kPixels, kPixels);
    EXPECT_LT(glm::distance(glm::vec3(flat.at(48, 48)), map_color(ColorMap::heat, 0.5f)), 0.01f);
}

/// Each of the six sides that a surface may face in a sixth of the map.
UvSet box_places(const Scene& scene, double reach)
{
    UvSet page;
    for (const glm::uvec3 triangle : scene.triangles) {
        const glm::dvec3 a = scene.positions[triangle.x];
        const glm::dvec3 normal =
            glm::cross(scene.positions[triangle.y] - a, scene.positions[triangle.z] - a);
        const glm::dvec3 size = glm::abs(normal);
        const int axis = size.x > size.y && size.x > size.z ? 0 : size.y > size.z ? 1 : 2;
        const glm::dvec2 cell(axis, normal[axis] > 0.0 ? 0 : 1);
        const auto first = static_cast<std::uint32_t>(page.values.size());
        for (int k = 0; k < 3; ++k) {
            const glm::dvec3 p = 0.5 + 0.45 / reach * scene.positions[triangle[k]];
            page.values.push_back((cell + glm::dvec2(p[(axis + 1) % 3], p[(axis + 2) % 3])) /
                                  glm::dvec2(3, 2));
        }
        page.corners.emplace_back(first, first + 1, first + 2);
    }
    return page;
}

TEST(MapPicture, LooksAsItDidWhenItWasLookedAt)
{
    const Scene scene = scenes::bumpy_sphere(16);
    const Model model = make_model(make_mesh(scene), UpAxis::z);
    double reach = 0.0;
    for (const glm::dvec3 p : scene.positions)
        reach = std::max({reach, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    const MapLayout places{.size = {192, 128}, .pages = {box_places(scene, reach)}};
    const ModelLayout layout{places, facts_of(*model.mesh, places)};
    const EngineSettings engine;
    const ModelMap map = solve_map(model, places, engine, 2).map;
    // stripes along the map
    BasePaint paint;
    paint.materials.emplace_back().picture = 0;
    paint.pictures.emplace_back(2, 1, glm::vec4(1.0f));
    paint.pictures[0].at(1, 0) = glm::vec4(0.8f, 0.2f, 0.1f, 1.0f);
    paint.triangles.resize(model.geometry().triangles.size());
    for (const glm::dvec2 place : places.pages[0].values)
        paint.places.emplace_back(24.0 * place);
    const std::vector<Occlusion> ground =
        solve_model(prepare(model.geometry(), engine), model, engine, {.vertices = false}).values;
    const Camera camera =
        frame_points(model.seen, UpAxis::z, 4.0f / 3.0f, {.azimuth_deg = 40, .elevation_deg = 20});
    for (const auto& [name, colors] : {std::pair("map", Colors::visibility),
                                       {"charts", Colors::charts},
                                       {"density", Colors::density},
                                       {"textured", Colors::textured}}) {
        RenderOptions options = of_map(colors, {.layout = &layout, .map = &map, .paint = &paint});
        options.width = 200;
        options.height = 150;
        options.samples = 4;
        options.view.ground = true;
        test::expect_golden(name, render(model, ground, {}, camera, options));
        test::expect_golden(std::string("atlas_") + name,
                            atlas_picture(*model.mesh, options.data, options.view, 200, 150));
    }
}

}  // namespace
}  // namespace surfelao

// Who occludes, and who is baked.
#include "bake/world.h"

#include "bake/bake.h"
#include "bake/cut_out.h"
#include "bake/part_hints.h"
#include "files/scene_io.h"
#include "image/image_file.h"
#include "scenes.h"
#include "surfels/errors.h"
#include "surfels/labels.h"
#include "temporary_folder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace surfelao {
namespace {

using scenes::operator+=;

constexpr Engine kEnginesOfWorld[] = {Engine::masks, Engine::disks, Engine::rays};

/// Scenes one after the other, each an object of its name.
Scene named(const std::vector<std::pair<const char*, Scene>>& parts)
{
    Scene all;
    LabelMaker labels;
    for (const auto& [name, scene] : parts) {
        labels.add(LabelKind::object, name, static_cast<std::uint32_t>(all.triangles.size()),
                   static_cast<std::uint32_t>(scene.triangles.size()));
        all += scene;
    }
    all.labels = labels.finish();
    all.name = "scene";
    return all;
}

/// Occlusion at the vertices themselves.
std::vector<float> values_of(const Mesh& mesh, Engine engine)
{
    const auto shared = std::make_shared<const Mesh>(mesh);
    TargetSettings at_vertices;
    at_vertices.values = VertexValues::point;
    const VertexTarget target(shared, at_vertices);
    EngineSettings settings;
    settings.engine = engine;
    settings.rays = 64;
    std::vector<float> values;
    for (const Occlusion& value : target.values(
             solve(prepare(mesh.occluding(), settings), target.receivers(), settings).occlusion))
        values.push_back(value.occlusion);
    return values;
}

Mesh mesh_of(const Scene& scene, const PartChoice& choice)
{
    return std::move(make_world({scene}, {}, {}, choice).meshes.front());
}

Scene floor_scene()
{
    return scenes::sheet({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, 8);
}
Scene lid_scene()
{
    return scenes::box({-1, -1, 0.5}, {1, 1, 0.6}, 2);
}

std::vector<float> first_of(std::vector<float> values, std::size_t count)
{
    values.resize(count);
    return values;
}

/// But for what an answer owes to the list that it is asked in: masks and disks share work within
/// groups of receivers, rays have their directions by the place in the list.
void expect_alike(const std::vector<float>& values, const std::vector<float>& expected,
                  Engine engine)
{
    ASSERT_EQ(values.size(), expected.size());
    double squares = 0.0;
    for (std::size_t v = 0; v < values.size(); ++v)
        squares += (values[v] - expected[v]) * (values[v] - expected[v]);
    EXPECT_LT(std::sqrt(squares / static_cast<double>(values.size())),
              engine == Engine::rays ? 0.05 : 0.003)
        << name_of(engine);
}

// A dome above all, far larger than the rest: without it the values are those without it, and the
// frame is that of the rest.
TEST(World, WhatIsExcludedTakesNoPart)
{
    const Scene rest = named({{"floor", floor_scene()}, {"lid", lid_scene()}});
    const Scene all = named({{"floor", floor_scene()},
                             {"lid", lid_scene()},
                             {"sky", scenes::flipped(scenes::sphere({0, 0, 0}, 50, 8))}});
    const Mesh without = mesh_of(all, {.exclude = {"s?y"}});
    const Mesh plain = mesh_of(rest, {});
    EXPECT_EQ(without.geometry.frame.diagonal, plain.geometry.frame.diagonal);
    for (const Engine engine : kEnginesOfWorld) {
        const std::vector<float> values = values_of(without, engine);
        expect_alike(first_of(values, rest.positions.size()), values_of(plain, engine), engine);
        EXPECT_EQ(values.back(), 0.0f);
    }
}

// Who is asked changes no answer; who is asked without occluding changes only that.
TEST(World, ReceiversHaveTheValuesOfTheWhole)
{
    const Scene all = named({{"floor", floor_scene()}, {"lid", lid_scene()}});
    const Scene floor = named({{"floor", floor_scene()}});
    const std::size_t count = floor.positions.size();
    const Mesh some = mesh_of(all, {.receivers = {"floor"}});
    const Mesh ghost = mesh_of(all, {.exclude = {"lid"}, .receivers = {"*"}});
    const Mesh whole = mesh_of(all, {});
    for (const Engine engine : kEnginesOfWorld) {
        const std::vector<float> values = values_of(some, engine);
        expect_alike(first_of(values, count), first_of(values_of(whole, engine), count), engine);
        EXPECT_EQ(values.back(), 0.0f);
        const std::vector<float> of_ghost = values_of(ghost, engine);
        EXPECT_EQ(of_ghost[40], 0.0f);     // under the lid
        EXPECT_GT(of_ghost[count], 0.2f);  // the lid's underside over the floor
    }
}

TEST(World, FilesTogetherAreTheJoinedScene)
{
    const std::vector<Scene> files{floor_scene(), lid_scene()};
    const BakeWorld world = make_world(files, {}, {}, {});
    const Mesh joined = mesh_of(join(files), {});
    for (const Engine engine : kEnginesOfWorld) {
        std::vector<float> values = values_of(world.meshes[0], engine);
        const std::vector<float> of_lid = values_of(world.meshes[1], engine);
        values.insert(values.end(), of_lid.begin(), of_lid.end());
        const std::vector<float> expected = values_of(joined, engine);
        expect_alike(values, expected, engine);
    }
}

// A wall that goes on for a million times the scene: half of the sky over its foot, as ever.
TEST(World, HugeOccludersCostNoPrecision)
{
    constexpr double kFar = 1e6;
    const Scene wall = scenes::sheet({-0.01, -kFar, -kFar}, {0, 2 * kFar, 0}, {0, 0, 2 * kFar}, 1);
    const Scene table = scenes::sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 4);
    const BakeWorld world = make_world({table}, std::span(&wall, 1), {}, {});
    EXPECT_NEAR(world.meshes[0].geometry.frame.diagonal, std::numbers::sqrt2, 1e-12);
    for (const Engine engine : {Engine::masks, Engine::rays}) {
        for (const float value : values_of(world.meshes[0], engine))
            EXPECT_NEAR(value, 0.5f, engine == Engine::rays ? 0.03f : 0.005f) << name_of(engine);
    }
}

TEST(World, RefusesWhatMeansNothing)
{
    const Scene all = named({{"Floor", floor_scene()}, {"lid", lid_scene()}});
    const std::pair<PartChoice, const char*> rows[] = {
        {{.exclude = {"lid", "floor"}},
         "scene: --exclude floor means no part of it (near it: Floor); surfelao info lists all "
         "names"},
        {{.receivers = {"x*y"}},
         "scene: --receivers x*y means no part of it; surfelao info lists all names"},
        {{.exclude = {"*"}}, "scene: nothing of it is left to be baked"},
    };
    for (const auto& [choice, sentence] : rows) {
        try {
            static_cast<void>(make_world({all}, {}, {}, choice));
            ADD_FAILURE() << sentence;
        } catch (const InputError& error) {
            EXPECT_STREQ(error.what(), sentence);
        }
    }
    EXPECT_THROW(static_cast<void>(make_world({floor_scene()}, {}, {}, {.exclude = {"a"}})),
                 InputError);
}

/// A floor and a lid over it with texture coordinates, material "card".
const char* const kCardObj =
    "mtllib card.mtl\nv -2 -2 0\nv 2 -2 0\nv 2 2 0\nv -2 2 0\nv 0 0 0\n"
    "v -1 -1 .5\nv 1 -1 .5\nv 1 1 .5\nv -1 1 .5\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
    "o floor\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\no card\nusemtl card\nf 6/1 9/4 8/3 7/2\n";

// The picture takes away all of the card but a disc of radius .6: what is left occludes as that
// disc, sin^2 of the angle that it is seen under, for everyone; glass as a whole, or not at all.
TEST(World, HolesByAlphaDoNotOcclude)
{
    const TemporaryFolder folder;
    Image picture(64, 64, glm::vec4(1.0f));
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
            const glm::vec2 from_centre((glm::vec2(x, y) + 0.5f) / 32.0f - 1.0f);
            picture.at(x, y).a = glm::length(from_centre) < 0.6f ? 1.0f : 0.0f;
        }
    }
    write_image(folder / "alpha.png", picture);
    const std::filesystem::path input = folder.file("in.obj", kCardObj);
    constexpr std::size_t kCentre = 4;
    constexpr double kDisc = 0.36 / (0.36 + 0.25), kSquare = 0.8310;
    const struct {
        const char* material;
        ClearSurfaces clear;
        double occlusion;
    } rows[] = {
        {"map_d alpha.png", ClearSurfaces::solid, kDisc},
        {"Kd 1 1 1", ClearSurfaces::open, kSquare},
        {"d .3", ClearSurfaces::solid, kSquare},
        {"d .3", ClearSurfaces::open, 0.0},
        {"Tr .7", ClearSurfaces::open, 0.0},
    };
    for (const auto& row : rows) {
        folder.file("card.mtl", std::string("newmtl card\n") + row.material + "\n");
        const Mesh mesh = read_mesh(input, {}, {.clear = row.clear});
        EXPECT_EQ(mesh.geometry.triangles.size(), 6u);
        for (const Engine engine : kEnginesOfWorld)
            EXPECT_NEAR(values_of(mesh, engine)[kCentre], row.occlusion,
                        engine == Engine::disks  ? 0.06
                        : engine == Engine::rays ? 0.04
                                                 : 0.01)
                << row.material << " " << name_of(engine);
    }
}

// What is cut stays within the triangle and its area that of the picture; a picture that cannot be
// read leaves the card whole.
TEST(CutOut, PiecesHaveTheAreaThatThePictureLeaves)
{
    const TemporaryFolder folder;
    const Scene scene = read_scene(folder.file("in.obj", kCardObj));
    BaseColors colors;
    colors.materials.resize(2);
    colors.materials[1].opacity = Opacity::cut;
    colors.materials[1].alpha_picture = 0;
    colors.triangles = {0, 0, 0, 0, 1, 1};
    Image picture(32, 32, glm::vec4(1.0f));
    for (int y = 0; y < 32; ++y)
        for (int x = y; x < 32; ++x)
            picture.at(x, y).a = x % 2 == 0 || y < 8 ? 0.0f : 1.0f;
    write_image(folder / "alpha.png", picture);
    colors.pictures = {{"alpha.png", folder / "alpha.png", {}}};
    const CutOut cut = cut_out(scene, colors, {});
    double area = 0.0;
    for (const CutOut::Piece& piece : cut.pieces) {
        const glm::dvec2 a = piece.corners[1] - piece.corners[0];
        const glm::dvec2 b = piece.corners[2] - piece.corners[0];
        area += 0.5 * std::abs(a.x * b.y - a.y * b.x);
        for (const glm::dvec2 corner : piece.corners)
            EXPECT_TRUE(corner.x >= 0.0 && corner.y >= 0.0 && corner.x + corner.y <= 1.0);
    }
    std::size_t there = 0;
    for (const glm::vec4& pixel : picture.pixels)
        there += pixel.a > 0.5f ? 1 : 0;
    EXPECT_NEAR(area, static_cast<double>(there) / 1024.0, 0.02);
    EXPECT_NEAR(cut.share, 1.0 - static_cast<double>(there) / 1024.0, 0.02);
    EXPECT_FALSE(cut.is_coarse);

    colors.pictures[0].file = folder / "gone.png";
    const CutOut whole = cut_out(scene, colors, {});
    EXPECT_TRUE(whole.triangles.empty());
    EXPECT_EQ(whole.notes.size(), 1u);
}

TEST(PartHints, NameWhatIsBetterLeftOut)
{
    const Scene sky = scenes::flipped(scenes::sphere({0, 0, 0}, 50, 4));
    const Scene half_sky = scenes::moved(
        sky, [](glm::dvec3 p) { return glm::dvec3(p.x, p.y, std::max(p.z, 0.0) + 1e-9); });
    const Scene lid = lid_scene();
    const Scene aside = scenes::moved(lid, [](glm::dvec3 p) { return p + glm::dvec3(9, 0, 0); });
    const struct {
        std::vector<std::pair<const char*, Scene>> parts;
        std::vector<std::string> hints;
        std::string enclosing;
    } rows[] = {
        {{{"a", lid}, {"b", floor_scene()}}, {}, ""},
        {{{"a", lid}, {"my sky", sky}}, {}, "my sky"},
        {{{"a", lid}, {"dome", half_sky}}, {}, "dome"},
        {{{"a", lid}, {"b", aside}}, {}, ""},
        {{{"a", lid}, {"UCX_a", lid}, {"b_Collision", lid}},
         {"2 parts are called like collision hulls (UCX_a, b_Collision): --exclude '*Collision' "
          "'UCX_*' leaves them out"},
         ""},
        {{{"a_LOD0", lid}, {"a_LOD1", lid}, {"a_LOD2", aside}},
         {"levels of detail lie in each other (a_LOD1): --exclude '*LOD1' leaves the coarse ones "
          "out"},
         ""},
        {{{"a_LOD0", lid}, {"a_LOD1", aside}}, {}, ""},
        {{{"rock", lid}, {"rock_lod2", lid}, {"LOD0", aside}},
         {"levels of detail lie in each other (rock_lod2): --exclude '*lod2' leaves the coarse "
          "ones "
          "out"},
         ""},
    };
    for (const auto& row : rows) {
        const Mesh mesh = mesh_of(named(row.parts), {});
        EXPECT_EQ(hints_by_name(mesh), row.hints);
        EXPECT_EQ(name_of_enclosing(mesh), row.enclosing);
    }
}

TEST(PartHints, KnowHowProgramsNameHulls)
{
    const std::pair<const char*, const char*> rows[] = {
        {"COL_rock", "'COL_*'"},
        {"MCDCX_rock_00", "'MCDCX_*'"},
        {"rock-colonly.001", "'*-colonly.*'"},
        {"rock$col", "'*$col'"},
        {"rock_UCX", "'*_UCX'"},
        {"RockCollider", "'*Collider'"},
        {"rock collision", "'*collision'"},
        {"rock_Collision_02", "'*Collision_*'"},
        {"rock.hitbox", "'*hitbox'"},
        {"col_01", nullptr},  // a column
        {"protocol", nullptr},
        {"collisional", nullptr},
    };
    for (const auto& [name, pattern] : rows) {
        const Mesh mesh = mesh_of(named({{"rock", lid_scene()}, {name, lid_scene()}}), {});
        std::vector<std::string> hints;
        if (pattern != nullptr)
            hints = {std::string("1 part is called like a collision hull (") + name +
                     "): --exclude " + pattern + " leaves it out"};
        EXPECT_EQ(hints_by_name(mesh), hints) << name;
    }
}

TEST(PartHints, KnowHowProgramsNameLevels)
{
    const struct {
        const char *fine, *coarse, *pattern;
    } rows[] = {
        {"LOD0", "LOD2", "'*LOD2'"},
        {"rock_LOD0.001", "rock_LOD1.001", "'*LOD1.*'"},
        {"LOD0_rock", "LOD1_rock", "'LOD1_*'"},
        {"rock", "lod1-rock", "'lod1-*'"},
        {"rock LOD 0", "rock LOD 1", "'*LOD 1'"},
        {"rock_LOD0_mesh", "rock_LOD1_mesh", "'*LOD1_*'"},
        {"rock_LOD0", "stone_LOD1", nullptr},  // two things
        {"melody1", "melody2", nullptr},
    };
    for (const auto& row : rows) {
        const Mesh mesh = mesh_of(named({{row.fine, lid_scene()}, {row.coarse, lid_scene()}}), {});
        std::vector<std::string> hints;
        if (row.pattern != nullptr)
            hints = {std::string("levels of detail lie in each other (") + row.coarse +
                     "): --exclude " + row.pattern + " leaves the coarse ones out"};
        EXPECT_EQ(hints_by_name(mesh), hints) << row.coarse;
    }
}

TEST(PartHints, KnowHowProgramsNameSkies)
{
    for (const char* name : {"Sky", "SkyDome", "BP_Sky_Sphere", "skybox.001"})
        EXPECT_EQ(name_of_sky(mesh_of(named({{"a", lid_scene()}, {name, lid_scene()}}), {})), name);
    for (const char* name : {"Skyscraper", "risky", "dome"})
        EXPECT_EQ(name_of_sky(mesh_of(named({{"a", lid_scene()}, {name, lid_scene()}}), {})), "");
}

BakeSettings settings_for_parts(const TemporaryFolder& folder, const std::string& name)
{
    BakeSettings settings;
    settings.input = folder / (name + ".obj");
    settings.output = folder / (name + ".ply");
    settings.target.values = VertexValues::point;
    settings.check = 0;
    return settings;
}

// All bytes depend on what occludes: other parts, files beside it, and when those have changed.
TEST(BakeTogether, WritesEachFileAndKnowsWhenItIsFinished)
{
    const TemporaryFolder folder;
    write_obj(folder / "floor.obj", floor_scene());
    write_obj(folder / "lid.obj", lid_scene());
    std::vector<BakeSettings> both{settings_for_parts(folder, "floor"),
                                   settings_for_parts(folder, "lid")};
    both[0].beside = {both[1].input};
    both[1].beside = {both[0].input};
    const std::vector<BakeReport> reports = bake_together(both);
    EXPECT_NEAR(reports[0].mean_occlusion, 0.2, 0.15);
    EXPECT_EQ(reports[0].occluding_triangles, reports[1].occluding_triangles);
    EXPECT_LT(reports[0].baked_triangles, reports[0].occluding_triangles);
    EXPECT_TRUE(is_finished(both[0]));
    EXPECT_FALSE(is_finished(settings_for_parts(folder, "floor")));
    std::filesystem::last_write_time(
        both[1].input, std::filesystem::file_time_type::clock::now() + std::chrono::seconds(9));
    EXPECT_FALSE(is_finished(both[0]));

    BakeSettings alone = settings_for_parts(folder, "floor");
    alone.parts.occluders = {folder / "lid.obj"};
    EXPECT_NEAR(bake(alone).mean_occlusion, reports[0].mean_occlusion, 1e-4);
    EXPECT_FALSE(is_finished(alone));  // the lid is newer
    for (const auto& [parts, text] : std::initializer_list<std::pair<PartChoice, const char*>>{
             {{}, ""},
             {{.exclude = {"a", "b*"}}, " exclude=a exclude=b*"},
             {{.receivers = {"c"}, .occluders = {"x/d.ply"}, .clear = ClearSurfaces::open},
              " receivers=c occluders=d.ply transparent=open"}})
        EXPECT_EQ(text_of(parts), text);
}

}  // namespace
}  // namespace surfelao

// AO grids of parts that move in a cell of the window, without a window.

#include "viewer/cell_view.h"

#include "../gpu/contexts.h"
#include "../pixels/looks.h"
#include "bake/grid_target.h"
#include "bake/vertex_bake.h"
#include "files/gltf_maker.h"
#include "pixels/grid_sources.h"
#include "scenes.h"
#include "temporary_folder.h"
#include "viewer/mover.h"

#include <gtest/gtest.h>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <thread>
#include <vector>

namespace surfelao {
namespace {

constexpr PictureSize kPictured{72, 48};
constexpr float kOfTwin = 0.003f;  // pixels/grid_pass.h

/// A cell at grids and who moves its model.
struct MovingGrids : testing::Test {
    MovingGrids()
    {
        setenv("XDG_CACHE_HOME", (folder / "cache").c_str(), 1);
        GridSettings settings;
        settings.resolution = 8;
        set_where(cell, Where::grid, {.texels = {}, .grid = settings});
    }

    void open(const char* name)
    {
        view.session().open(folder / name, UpAxis::y, cell.settings);
        ASSERT_TRUE(look_until([&] { return view.has_pixels() && mover.movables(); }));
    }

    /// A frame for each time that the condition does not hold; at most half a minute.
    bool look_until(auto condition)
    {
        for (int i = 0; i < 30000; ++i) {
            look_once();
            if (view.session().state().is_solved && condition())
                return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        return false;
    }

    void look_once()
    {
        const CellView::Changes changes = view.update();
        now += 0.02;
        if (mover.update(view.session(), changes.file, now))
            view.show_moved(mover.base(), mover.shown(), true);
        view.session().solve(cell.settings);
        if (!view.session().state().model)
            return;
        camera = camera.value_or(frame_points(view.model()->seen, UpAxis::y, 1.5f));
        static_cast<void>(view.look(cell, *camera, kPictured, {}));
    }

    /// Until this pose is the model, with its grids.
    bool rests()
    {
        int idle = 0;  // what was found may not be taken yet
        return look_until([&] {
            const bool is_done = !view.is_moved() && !mover.is_busy() &&
                                 !view.session().solving() && !view.grid().is_busy() &&
                                 view.has_pixels();
            idle = is_done ? idle + 1 : 0;
            return idle > 3;
        });
    }

    std::vector<std::shared_ptr<const GridBake>> grids() const
    {
        return {view.grid().grids().begin(), view.grid().grids().end()};
    }

    /// An object, and what it leaves of the light at the vertices of the scene by itself.
    struct Twin {
        PlacedGrid grid;
        std::vector<bool> triangles;  ///< of the scene
        std::vector<Occlusion> own;
    };
    /// Of these parts of the file, made by itself, moved in the unit frame of the model.
    Twin twin_of(std::initializer_list<std::uint32_t> movables, const Placement& moved) const
    {
        const Scene& scene = mover.base()->mesh->scene;
        std::vector<bool> others;
        for (const glm::uvec3 triangle : scene.triangles)
            others.push_back(std::ranges::find(movables, mover.movables()->of_vertex[triangle.x]) ==
                             movables.end());
        const auto mesh = std::make_shared<const Mesh>(make_mesh(scene, {}, {.left_out = others}));
        const Geometry& alone = mesh->geometry;
        const Frame& frame = mover.base()->geometry().frame;
        const Placement at_rest{.scale = 1.0 / frame.diagonal,
                                .translation = -frame.centre / frame.diagonal};
        DistanceLimit limit = cell.settings.max_distance;
        if (limit.percent)  // of the model
            limit = {0.01 * limit.value * frame.diagonal, false, limit.falloff};
        EngineSettings engine;
        engine.definition = definition_of(limit, Kernel::cosine, alone.frame);
        GridSettings settings = *cell.grid;
        settings.extent *= kMovingShare;
        const GridBake bake = bake_grid(alone, settings, engine, 0);
        Twin twin{{std::make_shared<const AoGrid>(bake.grid), moved * at_rest, bake.lift},
                  std::move(others),
                  bake_vertices(*mesh, VertexTarget(mesh, {}), engine, {}, 0).values};
        twin.triangles.flip();
        return twin;
    }

    /// What pixels show is what these tell of the surface as it is shown.
    void expect_told_by(std::span<const Twin> twins) const
    {
        std::vector<PlacedGrid> grids;
        for (const Twin& twin : twins) {
            grids.push_back(twin.grid);
            grids.back().surface = static_cast<std::uint32_t>(grids.size());
        }
        Mesh shown = *view.model()->mesh;
        std::ranges::copy(view.positions(), shown.geometry.positions.begin());
        std::ranges::copy(view.wedge_normals(), shown.surface.normals.begin());
        const View eye = view_of(*camera, kPictured.width, kPictured.height);
        const Look look(shown, eye, kPictured);
        const std::vector<glm::vec4> surface = look.pixels.g_buffer().read_surface();
        float farthest = 0.0f, darkest = 0.0f;
        const SeenPixels& seen_pixels = look.pixels.seen();
        for (std::size_t i = 0; i < seen_pixels.pixels.size(); ++i) {
            const std::uint32_t pixel = seen_pixels.pixels[i];
            const SurfacePoint& point = seen_pixels.points[i];
            std::uint32_t number = 0;
            float left = 1.0f;
            for (std::uint32_t t = 0; t < twins.size(); ++t) {
                if (!twins[t].triangles[shown.geometry.scene_triangle(point.triangle)])
                    continue;
                number = t + 1;
                left = 1.0f - displayed(shown.geometry, twins[t].own, point);
            }
            const auto column = static_cast<int>(pixel) % kPictured.width;
            const auto row = static_cast<int>(pixel) / kPictured.width;
            const glm::vec2 middle(static_cast<float>(column) + 0.5f,
                                   static_cast<float>(row) + 0.5f);
            const PixelRay ray = pixel_ray(eye.lens, kPictured.width, kPictured.height, middle);
            const glm::vec4 seen = surface[pixel];
            const float expected =
                1.0f -
                left * visibility_at(grids, GridMerge::product,
                                     to_world(eye, ray.origin + seen.w * ray.direction),
                                     seen.x * eye.right + seen.y * eye.up + seen.z * eye.forward,
                                     number);
            const std::optional<float> told = view.told_by_picture({column, row});
            farthest = std::max(farthest, std::abs(told.value_or(-1.0f) - expected));
            darkest = std::max(darkest, expected);
        }
        EXPECT_LT(farthest, kOfTwin);
        EXPECT_GT(darkest, 0.2f) << "there is something to tell";
    }

    TemporaryFolder folder;
    Cell cell;
    std::optional<Camera> camera;
    CellView view{test_context()};
    Mover mover;
    double now = 0.0;
};

// Dragged and at rest alike. What is only taken hold of belongs to what rests. The distance is a
// share of the model's size, not of the part's.
TEST_F(MovingGrids, EachPartThatAHandMovesTakesItsGridAlong)
{
    using scenes::operator+;
    write_obj(folder / "three.obj", scenes::box({0, 0, 0}, {4, 1, 4}, 2) +
                                        scenes::box({1, 1.2, 1}, {2, 2.2, 2}, 2) +
                                        scenes::box({3, 1.1, 3}, {3.5, 1.6, 3.5}, 2));
    cell.settings.max_distance = {15.0, true};
    open("three.obj");
    const auto whole = grids();
    ASSERT_EQ(whole.size(), 1u);
    mover.select(2);
    mover.select(1);
    ASSERT_TRUE(rests());
    EXPECT_EQ(grids(), whole);

    PartMove move{.translation = {0.05, 0.02, 0.1}, .scale = 1.25};
    move.rotation = glm::angleAxis(0.7, glm::dvec3(0.0, 1.0, 0.0));
    const glm::dvec3 middle = mover.middle_of(1);
    std::vector<Twin> twins{twin_of({0, 2}, {}), twin_of({1}, placement_of(move, middle))};
    mover.set_move(1, move);
    mover.hold(true);
    const auto is_shown = [&](const PartMove& wanted) {
        return mover.shown() && mover.shown()->pose.moves.back() == wanted && view.has_pixels();
    };
    ASSERT_TRUE(look_until([&] { return is_shown(move); }));
    const auto made = grids();
    EXPECT_EQ(made.size(), 2u);
    expect_told_by(twins);

    move.translation.x = -0.1;
    twins.back() = twin_of({1}, placement_of(move, middle));
    mover.set_move(1, move);
    ASSERT_TRUE(look_until([&] { return is_shown(move); }));
    expect_told_by(twins);
    mover.hold(false);
    ASSERT_TRUE(rests());
    expect_told_by(twins);
    EXPECT_EQ(grids(), made) << "moving makes no grids";

    mover.reset_all();
    ASSERT_TRUE(rests());
    EXPECT_EQ(grids(), whole);
}

/// Squares, from second 1 to second 3: one stands still, one moves by .5 along x, one becomes wider
/// and then nothing, one bends.
void write_four_squares(const std::filesystem::path& path)
{
    test::GltfMaker maker = test::square();
    const int bend = maker.add_vectors<float>({0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0});
    maker.add("meshes", {{"primitives",
                          {{{"attributes", {{"POSITION", 0}}},
                            {"indices", 1},
                            {"targets", {{{"POSITION", bend}}}}}}}});
    maker.document["scenes"][0]["nodes"] = {0, 1, 2, 3};
    maker.document["nodes"] = {{{"mesh", 0}},
                               {{"mesh", 0}, {"translation", {0, 0, 0.5}}},
                               {{"mesh", 0}, {"translation", {0, 0, -0.5}}},
                               {{"mesh", 1}, {"translation", {0, 2, 0}}}};
    const int ends =
        maker.add_accessor(maker.add_view(test::bytes_of<float>({1, 3})), 5126, "SCALAR", 2);
    const int three =
        maker.add_accessor(maker.add_view(test::bytes_of<float>({1, 2, 3})), 5126, "SCALAR", 3);
    const int places = maker.add_vectors<float>({0, 0, 0.5, 0.5, 0, 0.5});
    const int scales = maker.add_vectors<float>({1, 1, 1, 2, 1, 1, 0, 0, 0});
    const int weights =
        maker.add_accessor(maker.add_view(test::bytes_of<float>({0, 1})), 5126, "SCALAR", 2);
    maker.document["animations"] = {
        {{"samplers",
          {{{"input", ends}, {"output", places}},
           {{"input", three}, {"output", scales}},
           {{"input", ends}, {"output", weights}}}},
         {"channels",
          {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "translation"}}}},
           {{"sampler", 1}, {"target", {{"node", 2}, {"path", "scale"}}}},
           {{"sampler", 2}, {"target", {{"node", 3}, {"path", "weights"}}}}}}}};
    std::ofstream(path, std::ios::binary) << maker.glb();
}

TEST_F(MovingGrids, AnAnimationPlacesThemInEveryFrame)
{
    write_four_squares(folder / "squares.glb");
    open("squares.glb");
    ASSERT_EQ(grids().size(), 1u);
    mover.choose(0);
    ASSERT_TRUE(rests());
    const auto made = grids();
    EXPECT_EQ(made.size(), 3u) << "also at the first key, where nothing is off its place yet";
    EXPECT_NE(view.pixel_message().find(": 1 part is left out"), std::string::npos);

    const double diagonal = mover.base()->geometry().frame.diagonal;
    const auto twins_at = [&](double seconds) {
        return std::vector<Twin>{
            twin_of({0}, {}),
            twin_of({1}, {.translation = {0.25 * (seconds - 1.0) / diagonal, 0.0, 0.0}})};
    };
    mover.player().seek(1.25);
    ASSERT_TRUE(rests());
    expect_told_by(twins_at(1.25));
    EXPECT_NE(view.pixel_message().find(": 2 parts are left out"), std::string::npos)
        << "one is wider than it was";
    mover.player().toggle();
    for (int frames = 0; frames < 5; ++frames) {
        const auto before = mover.shown();
        ASSERT_TRUE(look_until([&] { return mover.shown() != before; }));
        ASSERT_TRUE(view.has_pixels());
        expect_told_by(twins_at(mover.shown()->pose.seconds));
    }
    mover.player().toggle();
    mover.player().seek(3.0);
    ASSERT_TRUE(rests());
    EXPECT_NE(view.pixel_message().find(": 1 part is left out"), std::string::npos)
        << "what is gone is not told";
    expect_told_by(twins_at(3.0));
    EXPECT_EQ(grids(), made);

    set_where(cell, Where::vertices, {});
    ASSERT_TRUE(look_until([&] { return !view.has_pixels(); }));
    EXPECT_EQ(view.pixel_message(), "");
}

// Before it is played.
TEST_F(MovingGrids, AFileThatIsReadAtAMomentHasThem)
{
    write_four_squares(folder / "squares.glb");
    const Moment moment{1.25, ""};
    mover.begin_at(moment);
    view.session().open(folder / "squares.glb", UpAxis::y, cell.settings, {.moment = moment});
    ASSERT_TRUE(look_until([&] { return grids().size() == 3; }));
    const auto made = grids();
    mover.player().seek(1.0);
    ASSERT_TRUE(rests());
    EXPECT_EQ(grids(), made);
    mover.choose(std::nullopt);
    ASSERT_TRUE(rests());
    EXPECT_EQ(grids().size(), 1u);
}

// With nothing else in motion what bends has a grid of the whole once it rests.
TEST_F(MovingGrids, WhereOnlyWhatBendsMovesTheWholeHasAGridAtRest)
{
    write_four_squares(folder / "squares.glb");
    const Scene scene = read_scene(folder / "squares.glb");
    const Motion motion(scene);
    const auto base = std::make_shared<const Model>(make_model(make_mesh(scene), UpAxis::y));
    const Movables movables = movables_of(*base->mesh);
    const auto bodies = std::make_shared<const Bodies>(bodies_of(*base, movables, {}, &motion));
    ASSERT_EQ(bodies->list.size(), 4u);
    PosedBodies posed{base, bodies, std::vector<BodyPose>(4)};
    const GridObjects objects = grid_objects_of(*base, *bodies, resting_bodies(posed));
    EXPECT_EQ(objects.triangles, (std::vector<ObjectTriangles>{{0, 1}, {2, 3}, {4, 5}}));
    EXPECT_EQ(objects.of_body, (std::vector<std::uint32_t>{0, 1, 2, GridObjects::kNone}));
    // the others stand still
    const GridObjects whole = grid_objects_of(*base, *bodies, {true, true, true, false});
    EXPECT_TRUE(whole.triangles.empty());
}

}  // namespace
}  // namespace surfelao

#include "viewer/pixel_session.h"

#include "../gpu/contexts.h"
#include "../pixels/looks.h"
#include "differences.h"
#include "scenes.h"
#include "temporary_folder.h"
#include "viewer/cell_view.h"
#include "viewer/pixel_fill.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <chrono>
#include <cmath>
#include <set>
#include <thread>

namespace surfelao {
namespace {

constexpr PictureSize kSize{96, 64};

std::shared_ptr<const Model> ball_model(int cells = 12)
{
    return std::make_shared<const Model>(
        make_model(make_mesh(scenes::bumpy_sphere(cells)), UpAxis::y));
}

Camera camera_of(const Model& model, float azimuth)
{
    return frame_points(model.seen, model.up, 1.5f, {.azimuth_deg = azimuth});
}

PixelQuestion question_of(const std::shared_ptr<const Model>& model, const Look& look,
                          const EngineSettings& engine)
{
    return {.model = model,
            .view = look.pixels.g_buffer().view(),
            .width = look.pixels.g_buffer().width(),
            .height = look.pixels.g_buffer().height(),
            .triangles = look.pixels.g_buffer().read_triangles(),
            .engine = engine};
}

/// Updates until the condition holds; at most half a minute.
bool wait_until(PixelSession& session, auto condition)
{
    for (int i = 0; i < 30000; ++i) {
        if (session.update() && condition(session.answers()))
            return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
}

bool is_whole(const PixelAnswers& answers)
{
    return !answers.picture.empty() && !answers.is_draft;
}

std::vector<Occlusion> values_at(const PixelAnswers& answers, const SeenPixels& seen)
{
    std::vector<Occlusion> values;
    for (const std::uint32_t pixel : seen.pixels) {
        const glm::vec4& value = answers.picture[pixel];
        values.push_back({value.w, glm::vec3(value)});
    }
    return values;
}

// Whether the engine is the session's own or another's; the background has nothing.
TEST(PixelSession, TheWholePictureHasTheBytesOfAnAnswerAtTheSamePixels)
{
    const auto model = ball_model();
    const Look look(*model->mesh, view_of(camera_of(*model, 30.0f), kSize.width, kSize.height),
                    kSize);
    const SeenPixels& seen = look.pixels.seen();
    const EngineSettings engine;
    Occluders occluders(model->geometry());
    ScreenSpace screen(test_context());
    const std::vector<Occlusion> expected =
        answer(look.pixels, occluders, screen, engine, engine.definition).values;
    PixelSession session;
    PixelQuestion question = question_of(model, look, engine);
    for (const bool is_shared : {false, true}) {
        if (is_shared)
            question.prepared = std::make_shared<const Prepared>(prepare(*model, engine));
        question.sample = 50;
        session.solve(question);
        EXPECT_TRUE(session.answers().picture.empty());
        ASSERT_TRUE(wait_until(session, is_whole)) << session.answers().message;
        const PixelAnswers& found = session.answers();
        EXPECT_TRUE(same_bytes(values_at(found, seen), expected));
        EXPECT_EQ(found.sample.pixels.size(), 50u);
        std::size_t nothing = 0;
        for (const glm::vec4& value : found.picture)
            nothing += value == glm::vec4(0.0f);
        EXPECT_EQ(nothing, found.picture.size() - seen.pixels.size());
    }
}

// A picture that takes many seconds: its draft comes first, then the next question's answer.
TEST(PixelSession, ADraftComesFirstAndAnotherCameraGivesUpWhatRuns)
{
    const auto model = ball_model(40);
    const PictureSize size{960, 640};
    const Look slow(*model->mesh, view_of(camera_of(*model, 30.0f), size.width, size.height), size);
    EngineSettings finest;
    finest.quality = 4.0f;
    EngineSettings draft;
    draft.quality = kDraft;
    PixelSession session;
    session.solve(question_of(model, slow, finest));
    ASSERT_TRUE(wait_until(session, [](const PixelAnswers& found) { return found.is_draft; }));
    EXPECT_TRUE(session.solving());
    std::size_t shown = 0;
    for (const glm::vec4& value : session.answers().picture)
        shown += glm::length(glm::vec3(value)) > 0.0f;
    EXPECT_GT(shown, slow.pixels.seen().pixels.size() * 99 / 100);

    const Look other(*model->mesh, view_of(camera_of(*model, 80.0f), kSize.width, kSize.height),
                     kSize);
    session.solve(question_of(model, other, draft));
    ASSERT_TRUE(wait_until(session, is_whole));
    EXPECT_EQ(session.answers().width, kSize.width);
    while (session.solving())  // its thread tells the answer before it rests; else ctest's limit
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

TEST(PixelSession, AnEnginesFailureIsTold)
{
    const auto model = ball_model();
    const Look look(*model->mesh, view_of(camera_of(*model, 30.0f), kSize.width, kSize.height),
                    kSize);
    EngineSettings engine;
    engine.quality = 99.0f;
    PixelSession session;
    session.solve(question_of(model, look, engine));
    ASSERT_TRUE(wait_until(session, [](const PixelAnswers& f) { return !f.message.empty(); }));
    EXPECT_NE(session.answers().message.find("quality"), std::string::npos);
}

/// Two sheets that face the eye, the right one farther away: no column of the draft's grid is the
/// first of the right one.
SeenPixels two_sheets(int width, int height, int border)
{
    SeenPixels seen{.width = width, .height = height, .pixels = {}, .points = {}, .receivers = {}};
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            seen.pixels.push_back(static_cast<std::uint32_t>(x + width * y));
            const float forward = x < border ? 1.0f : 2.0f;
            const glm::vec2 place(forward * static_cast<float>(x) / static_cast<float>(height),
                                  forward * static_cast<float>(y) / static_cast<float>(height));
            seen.receivers.push_back({{place, -forward}, {0, 0, 1}});
        }
    }
    return seen;
}

TEST(PixelFill, ValuesStayOnTheirSurface)
{
    const SeenPixels seen = two_sheets(17, 11, 6);
    const std::vector<std::uint32_t> draft = draft_pixels(seen);
    EXPECT_EQ(draft.size(), 5u * 3u);
    std::vector<Occlusion> values;
    for (const std::uint32_t i : draft)
        values.push_back({seen.pixels[i] % 17 < 6 ? 0.25f : 0.75f, {0, 0, 1}});
    const std::vector<Occlusion> filled = fill_draft(seen, glm::vec3(0.0f), draft, values);
    for (std::size_t i = 0; i < filled.size(); ++i)
        EXPECT_NEAR(filled[i].occlusion, seen.pixels[i] % 17 < 6 ? 0.25f : 0.75f, 0.01f)
            << seen.pixels[i] % 17;
}

// A needle between the columns of the grid has no neighbour there.
TEST(PixelFill, WhatTheGridMissesIsSolved)
{
    SeenPixels seen = two_sheets(1, 9, 9);
    seen.width = 16;
    for (std::uint32_t y = 0; y < 9; ++y)
        seen.pixels[y] = 16 * y + 2;
    EXPECT_EQ(draft_pixels(seen).size(), 9u);
}

TEST(PixelFill, ASampleHasOnePixelOfEachRun)
{
    const SeenPixels seen = two_sheets(40, 30, 20);
    std::set<std::uint32_t> runs;
    for (const std::uint32_t i : spread_pixels(seen, 100))
        runs.insert(i / 12);
    EXPECT_EQ(runs.size(), 100u);
    EXPECT_EQ(spread_pixels(seen, 5000).size(), 1200u);
}

/// Updates and looks until there is an error of what is shown whole.
std::optional<ShownError> error_of_cell(CellView& view, const Cell& cell, const Camera& camera)
{
    for (int i = 0; i < 30000; ++i) {
        static_cast<void>(view.update());
        view.session().solve(cell.settings);
        if (view.session().state().model) {
            static_cast<void>(view.look(cell, camera, kSize, {.rays = 64, .whole = false}));
            const bool is_done = !view.is_busy() && !view.session().state().is_draft;
            if (is_done && view.pixel_error())
                return view.pixel_error();
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return {};
}

// At once where the picture answers; once the camera rests where the scene does.
TEST(CellView, PixelsAreForgottenWhenTheCameraMovesAndSolvedWhenItRests)
{
    const TemporaryFolder folder;
    write_obj(folder / "ball.obj", scenes::bumpy_sphere(12));
    const auto model = ball_model();
    Cell cell;
    cell.at_pixels = true;
    CellView view(test_context());
    view.session().open(folder / "ball.obj", UpAxis::y, cell.settings);
    const auto is_solved = [&](const Camera& camera) {
        for (int i = 0; i < 30000 && !view.has_pixels(); ++i) {
            static_cast<void>(view.update());
            if (view.session().state().model)
                static_cast<void>(view.look(cell, camera, kSize, {}));
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        return view.has_pixels();
    };
    ASSERT_TRUE(is_solved(camera_of(*model, 30.0f)));
    EXPECT_TRUE(view.look(cell, camera_of(*model, 40.0f), kSize, {}));
    EXPECT_FALSE(view.has_pixels());
    EXPECT_TRUE(is_solved(camera_of(*model, 40.0f)));

    cell.screen = screen_settings(ScreenMethod::gtao, 8);
    for (const float azimuth : {40.0f, 50.0f}) {
        EXPECT_TRUE(view.look(cell, camera_of(*model, azimuth), kSize, {}));
        EXPECT_TRUE(view.has_pixels());
        EXPECT_FALSE(view.look(cell, camera_of(*model, azimuth), kSize, {}));
    }
    cell.at_pixels = false;
    cell.screen.reset();
    EXPECT_TRUE(view.look(cell, camera_of(*model, 50.0f), kSize, {}));
    EXPECT_FALSE(view.has_pixels());
}

// A map shows what the eye saw there, and little of what lies behind; the middle of a ball is no
// place for one. Another engine solves it again.
TEST(CellView, ACubeMapIsPutWhereTheEyeIsAndShown)
{
    const TemporaryFolder folder;
    write_obj(folder / "ball.obj", scenes::bumpy_sphere(12));
    const auto model = ball_model();
    const Camera camera = camera_of(*model, 30.0f);
    Cell cell;
    set_where(cell, Where::cube_maps, {});
    PixelRays rays;
    CellView view(test_context());
    view.session().open(folder / "ball.obj", UpAxis::y, cell.settings);
    const auto look_until = [&](const Camera& from, auto condition) {
        for (int i = 0; i < 30000 && !condition(); ++i) {
            static_cast<void>(view.update());
            view.session().solve(cell.settings);
            if (view.session().state().model)
                static_cast<void>(view.look(cell, from, kSize, rays));
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        return condition();
    };
    ASSERT_TRUE(look_until(camera, [&] { return view.session().state().is_solved; }));
    EXPECT_FALSE(view.has_pixels());
    Camera inside = camera;
    inside.eye = glm::vec3(0.0f);
    inside.target = glm::vec3(0.0f, 0.0f, -1.0f);
    static_cast<void>(view.look(cell, inside, kSize, {}));
    EXPECT_NE(view.add_map().find("inside of a body"), std::string::npos);
    EXPECT_EQ(view.cubes().count(), 0u);
    static_cast<void>(view.look(cell, camera, kSize, {}));
    EXPECT_EQ(view.add_map(), "");
    const auto is_covered = [&] { return view.cubes().coverage().has_value(); };
    ASSERT_TRUE(look_until(camera, is_covered));
    const double from_there = *view.cubes().coverage();
    const Camera behind = camera_of(*model, 210.0f);
    EXPECT_TRUE(view.look(cell, behind, kSize, {}));
    EXPECT_FALSE(is_covered());
    ASSERT_TRUE(look_until(behind, is_covered));
    EXPECT_GT(from_there, *view.cubes().coverage() + 0.3);
    // what no map sees is solved itself, so that all of the picture is right
    rays.rays = 256;
    ASSERT_TRUE(
        look_until(behind, [&] { return !view.is_busy() && view.pixel_error().has_value(); }));
    EXPECT_LT(view.pixel_error()->found.rmse, 0.02);
    rays = {};

    cell.settings.engine.engine = Engine::disks;
    const auto is_solved_again = [&] { return !view.is_busy() && is_covered(); };
    static_cast<void>(view.look(cell, camera, kSize, {}));
    ASSERT_TRUE(look_until(camera, is_solved_again));
    EXPECT_EQ(view.cubes().count(), 1u);
    set_where(cell, Where::vertices, {});
    static_cast<void>(view.look(cell, camera, kSize, {}));
    EXPECT_FALSE(view.has_pixels());
}

// Disks of no strength answer 0: what is wrong then is all that rays find. Wherever it is asked.
TEST(CellView, TheErrorIsThatOfWhatIsShownAtTheSamePixels)
{
    const TemporaryFolder folder;
    const Scene ball = scenes::bumpy_sphere(12);
    write_obj(folder / "ball.obj", ball);
    for (const bool at_pixels : {false, true}) {
        Cell cell;
        cell.at_pixels = at_pixels;
        cell.settings.engine.engine = Engine::disks;
        cell.settings.engine.strength = 0.0f;
        CellView view(test_context());
        view.session().open(folder / "ball.obj", UpAxis::y, cell.settings);
        const auto model = ball_model();
        const std::optional<ShownError> error = error_of_cell(view, cell, camera_of(*model, 30.0f));
        ASSERT_TRUE(error.has_value());
        EXPECT_EQ(error->rays, 64u);
        // all the pixels: there are no 4,000
        const Look look(*model->mesh, view_of(camera_of(*model, 30.0f), kSize.width, kSize.height),
                        kSize);
        EngineSettings rays;
        rays.engine = Engine::rays;
        rays.rays = 64;
        const std::vector<Occlusion> traced =
            solve(prepare(*model, rays), look.pixels.seen().receivers, rays).occlusion;
        const std::vector<Occlusion> nothing(traced.size());
        const ErrorStatistics expected = error_statistics(nothing, traced);
        EXPECT_EQ(error->found.count, traced.size());
        EXPECT_NEAR(error->found.rmse, expected.rmse, 1e-4);
        EXPECT_NEAR(error->found.bias, expected.bias, 1e-4);
    }
}

}  // namespace
}  // namespace surfelao

#include "pixels/pixel_compare.h"

#include "scenes.h"
#include "surfels/errors.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace surfelao {
namespace {

using Json = nlohmann::json;

std::vector<Occlusion> occlusions(const std::vector<float>& values)
{
    std::vector<Occlusion> list;
    for (const float value : values)
        list.push_back({value, glm::vec3(0.0f)});
    return list;
}

// 90 answers a tenth too dark, 10 three tenths too bright.
TEST(PixelCompare, ErrorsOfKnownAnswersAreExact)
{
    std::vector<float> truth, told;
    for (int i = 0; i < 100; ++i) {
        truth.push_back(0.3f + 0.004f * static_cast<float>(i));
        told.push_back(truth.back() + (i % 10 == 7 ? -0.3f : 0.1f));
    }
    const PixelError error = pixel_error(occlusions(told), occlusions(truth), 0.0, 400);
    EXPECT_NEAR(error.rmse, 100.0 * std::sqrt(0.9 * 0.01 + 0.1 * 0.09), 1e-4);
    EXPECT_NEAR(error.rmse_whole, 0.5 * error.rmse, 1e-9);  // a quarter of the picture is surface
    EXPECT_NEAR(error.bias, 6.0, 1e-4);
    EXPECT_NEAR(error.p95, 30.0, 1e-4);
    EXPECT_NEAR(error.max, 30.0, 1e-4);
    const PixelError noisy = pixel_error(occlusions(told), occlusions(truth), 0.05, 100);
    EXPECT_NEAR(noisy.rmse, 100.0 * std::sqrt(0.018 - 0.0025), 1e-4);
    EXPECT_EQ(noisy.rmse_whole, noisy.rmse);
    EXPECT_NEAR(noisy.p95, 30.0, 1e-4);
}

TEST(PixelCompare, SpreadCamerasLookFromAllRound)
{
    const Mesh mesh = make_mesh(scenes::bumpy_sphere(4));
    const CameraWishes wishes{.points = mesh.geometry.positions, .aspect = 1.5f};
    const std::vector<NamedCamera> four = spread_cameras(4, wishes);
    const char* texts[] = {"azimuth=30.00,elevation=48.59", "azimuth=167.51,elevation=14.48",
                           "azimuth=305.02,elevation=-14.48", "azimuth=82.52,elevation=-48.59"};
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(four[i].text, texts[i]);
        EXPECT_EQ(four[i].camera.eye, parse_camera(texts[i], wishes).eye);
    }

    std::vector<glm::vec3> directions;
    for (const NamedCamera& one : spread_cameras(50, wishes))
        directions.push_back(glm::normalize(one.camera.eye - one.camera.target));
    glm::vec3 sum(0.0f);
    float nearest = 2.0f;
    for (std::size_t i = 0; i < directions.size(); ++i) {
        sum += directions[i];
        for (std::size_t j = 0; j < i; ++j)
            nearest = std::min(nearest, glm::distance(directions[i], directions[j]));
    }
    EXPECT_LT(glm::length(sum) / 50.0f, 0.02f);
    EXPECT_GT(nearest, 0.37f);  // 50 caps of this diameter cover 0.43 of the sphere
}

TEST(PixelCompare, SweepsTakeTheirEnds)
{
    const Sweep sweep = parse_sweep("hbao.bias=0:40:5");
    EXPECT_EQ(sweep.method, ScreenMethod::hbao);
    EXPECT_EQ(sweep.name, "bias");
    const std::vector<double> values = values_of(sweep);
    ASSERT_EQ(values.size(), 9u);
    EXPECT_EQ(values.back(), 40.0);
    EXPECT_EQ(values_of(parse_sweep("bitmask.thickness=0.1:0.7:0.1")).size(), 7u);
    EXPECT_EQ(values_of(parse_sweep("gtao.power=1:2:0.7")).size(), 2u);
    const std::vector<PixelEngine> engines = engines_of(sweep, screen_settings(sweep.method, 16));
    ASSERT_EQ(engines.size(), 9u);
    for (std::size_t i = 0; i < 9; ++i) {
        const ScreenSettings& settings = std::get<ScreenSettings>(engines[i]);
        EXPECT_EQ(settings.bias, static_cast<float>(5 * i));
        EXPECT_EQ(settings.samples, 16);
    }
    for (const char* text :
         {"", "bias=0:40:5", "masks.bias=0:40:5", "hbao.=0:40:5", "hbao.bias=0:40",
          "hbao.bias=40:0:5", "hbao.bias=0:40:0", "hbao.bias=0:40:5x", "hbao.bias=0:inf:5",
          "hbao.bias=0:40:0.001", "hbao.bias=0:40:5:5"})
        EXPECT_THROW(static_cast<void>(parse_sweep(text)), SettingsError) << text;
    EXPECT_THROW(
        static_cast<void>(engines_of(parse_sweep("hbao.bias=0:400:100"), ScreenSettings{})),
        SettingsError);
}

// Of (v - 15)^2 + 1, and of two equal ones the first.
TEST(PixelCompare, TheBestOfASweepHasTheLeastError)
{
    std::vector<PixelMean> means(9);
    for (std::size_t i = 0; i < 9; ++i)
        means[i].error.rmse = std::pow(5.0 * static_cast<double>(i) - 15.0, 2.0) + 1.0;
    EXPECT_EQ(best_of(means), 3u);
    means[7].error.rmse = 1.0;
    EXPECT_EQ(best_of(means), 3u);
}

class PixelComparing : public testing::Test {
protected:
    PixelComparing()
    {
        settings_.input = "bumpy.obj";
        settings_.backend = GlBackend::osmesa;
        settings_.size = {64, 48};
        settings_.views = 2;
        settings_.rounds = 1;
        settings_.use_cache = false;
    }
    const Mesh mesh_ = make_mesh(scenes::bumpy_sphere(12));
    PixelCompareSettings settings_;
};

EngineSettings engine_with(Engine engine)
{
    EngineSettings settings;
    settings.engine = engine;
    return settings;
}

// Disks of no strength answer 0 everywhere: their error is what rays see.
TEST_F(PixelComparing, JudgesAgainstRaysAtTheSamePixels)
{
    EngineSettings many = engine_with(Engine::rays), nothing = engine_with(Engine::disks);
    many.rays = 1024;
    nothing.strength = 0.0f;
    settings_.engines = {many, engine_with(Engine::masks), nothing,
                         screen_settings(ScreenMethod::gtao, 24)};
    settings_.reference_rays = 1024;
    const PixelComparison found = compare_pixels(mesh_, settings_);
    ASSERT_EQ(found.cameras.size(), 2u);
    ASSERT_EQ(found.rows.size(), 8u);
    ASSERT_EQ(found.means.size(), 4u);
    for (std::size_t c = 0; c < 2; ++c) {
        const PixelCamera& camera = found.cameras[c];
        EXPECT_EQ(camera.share, static_cast<double>(camera.surface_pixels) / (64.0 * 48.0));
        EXPECT_GT(camera.share, 0.3);
        EXPECT_LT(camera.share, 0.7);
        EXPECT_LT(camera.noise, 0.5);
        const PixelRow* const rows = &found.rows[4 * c];
        for (std::size_t e = 0; e < 4; ++e) {
            EXPECT_EQ(rows[e].camera, c);
            EXPECT_EQ(rows[e].engine, settings_.engines[e]);
            EXPECT_EQ(rows[e].error.rmse_whole, rows[e].error.rmse * std::sqrt(camera.share));
        }
        EXPECT_LT(rows[0].error.rmse, 0.5);
        EXPECT_LT(rows[1].error.rmse, 2.0);
        EXPECT_NEAR(rows[2].error.bias, -100.0 * camera.mean_occlusion, 1e-4);
        EXPECT_GT(rows[2].error.rmse, 100.0 * camera.mean_occlusion);
        EXPECT_GT(rows[3].error.rmse, rows[1].error.rmse);
    }
    EXPECT_NEAR(found.means[2].error.rmse,
                0.5 * (found.rows[2].error.rmse + found.rows[6].error.rmse), 1e-9);
    EXPECT_EQ(found.means[2].error.max, std::max(found.rows[2].error.max, found.rows[6].error.max));
}

TEST_F(PixelComparing, GivesTheSameErrorsInEveryRun)
{
    settings_.engines = {engine_with(Engine::masks), screen_settings(ScreenMethod::hbao, 16)};
    const PixelComparison first = compare_pixels(mesh_, settings_);
    settings_.rounds = 2;
    const PixelComparison second = compare_pixels(mesh_, settings_);
    for (std::size_t i = 0; i < first.rows.size(); ++i) {
        EXPECT_EQ(first.rows[i].error.rmse, second.rows[i].error.rmse);
        EXPECT_EQ(first.rows[i].error.max, second.rows[i].error.max);
    }
}

// A square that fills half of the picture's height and a quarter of its width.
TEST_F(PixelComparing, CountsTheBackground)
{
    const Mesh sheet = make_mesh(scenes::sheet({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 2));
    settings_.engines = {engine_with(Engine::masks)};
    settings_.size = {80, 40};
    settings_.cameras = {"eye=0:0:2,target=0:0:0,fov=90"};
    const PixelComparison found = compare_pixels(sheet, settings_);
    EXPECT_EQ(found.cameras[0].surface_pixels, 400u);
    EXPECT_EQ(found.cameras[0].mean_occlusion, 0.0);
    EXPECT_EQ(found.rows[0].error.max, 0.0);
}

TEST_F(PixelComparing, RefusesCamerasThatSeeNothingAndStopsWhenTold)
{
    settings_.engines = {engine_with(Engine::masks)};
    settings_.cameras = {"eye=0:0:5,target=0:0:9"};
    EXPECT_THROW(static_cast<void>(compare_pixels(mesh_, settings_)), InputError);
    settings_.cameras.clear();
    int told = 0;
    const auto stop = [&](std::string_view stage, double) {
        ++told;
        return !stage.starts_with("masks");
    };
    EXPECT_THROW(static_cast<void>(compare_pixels(mesh_, settings_, stop)), Cancelled);
    EXPECT_GT(told, 1);
    settings_.engines.clear();
    EXPECT_THROW(static_cast<void>(compare_pixels(mesh_, settings_)), SettingsError);
}

TEST_F(PixelComparing, ReportsSayTheSame)
{
    settings_.engines = {engine_with(Engine::masks), screen_settings(ScreenMethod::vo, 8)};
    settings_.pictures = true;
    settings_.max_distance = {.value = 20.0, .percent = true};
    const PixelComparison found = compare_pixels(mesh_, settings_);
    const Json json = Json::parse(json_of(found));
    EXPECT_EQ(json["width"], 64);
    EXPECT_EQ(json["reference"]["rays"], 256);
    EXPECT_EQ(json["max_distance"], 0.2f);
    EXPECT_EQ(json["unit"], "percent");
    EXPECT_TRUE(json["sweep"].is_null());
    ASSERT_EQ(json["rows"].size(), 4u);
    ASSERT_EQ(json["means"].size(), 2u);
    const Json& row = json["rows"][3];
    EXPECT_EQ(row["engine"], "vo");
    EXPECT_EQ(row["setting"], setting_of(settings_.engines[1]));
    EXPECT_EQ(row["camera"], 2);
    EXPECT_EQ(row["rmse"], found.rows[3].error.rmse);
    for (const char* key : {"rmse_whole", "bias", "p95", "max", "ms", "clock"})
        EXPECT_TRUE(row.contains(key)) << key;
    EXPECT_EQ(json["cameras"][1]["text"], found.cameras[1].from.text);

    const std::string csv = csv_of(found);
    EXPECT_EQ(std::ranges::count(csv, '\n'), 7);
    EXPECT_NE(csv.find("\nmasks,good,2,"), std::string::npos) << csv;
    EXPECT_NE(csv.find("\nmasks,good,mean,"), std::string::npos) << csv;
    const std::string table = table_of(found);
    EXPECT_NE(table.find("camera 2: azimuth="), std::string::npos) << table;

    const std::string html = html_of(found);
    std::size_t pictures = 0;
    for (std::size_t at = 0; (at = html.find("<img ", at)) != std::string::npos; ++at)
        ++pictures;
    EXPECT_EQ(pictures, 2u * (1 + 2 * 2));
    EXPECT_TRUE(html.starts_with("<!DOCTYPE html>"));
}

// A red line too dark, the rest right.
TEST(PixelPictures, AreCutToWhatIsSeenAndReduced)
{
    SeenPixels seen;
    seen.width = 2000;
    seen.height = 100;
    for (std::uint32_t x = 300; x < 1600; ++x)
        seen.pixels.push_back(2000 * 40 + x);
    const std::vector<Occlusion> half = occlusions(std::vector<float>(1300, 0.5f));
    const std::vector<Occlusion> full = occlusions(std::vector<float>(1300, 1.0f));
    const Picture grey = occlusion_picture(seen, half);
    // 1300 + 2 * 8 pixels in cells of 3 x 3; rows 32 to 48 from the top
    EXPECT_EQ(grey.width, 439);
    EXPECT_EQ(grey.height, 6);
    EXPECT_EQ(grey.pixels[0], (Rgb{216, 224, 236}));
    const auto middle = [](const Picture& picture) {
        return picture.pixels[2 * static_cast<std::size_t>(picture.width) + 200];
    };
    EXPECT_EQ(middle(grey), (Rgb{187, 192, 200}));  // a third 128, two thirds background
    Rgb red = error_color(0.5f, kFullPixelError);
    for (std::size_t c = 0; c < 3; ++c)
        red[c] = static_cast<std::uint8_t>((red[c] + 2 * grey.pixels[0][c] + 1) / 3);
    EXPECT_EQ(middle(difference_picture(seen, full, half)), red);
    EXPECT_EQ(middle(difference_picture(seen, half, half)), (Rgb{229, 234, 242}));
}

}  // namespace
}  // namespace surfelao

#include "gpu/screen_space.h"

#include "contexts.h"
#include "gpu/screen_samples.h"
#include "scenes.h"
#include "screen_twin.h"
#include "surfels/errors.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <vector>

namespace surfelao {
namespace {

using scenes::operator+;
using scenes::operator+=;

constexpr double kPi = std::numbers::pi;

/// A picture of a scene, with what draws in it.
struct Screen {
    Screen(const Scene& scene, const View& view, int width, int height)
        : mesh(make_mesh(scene, {.crease = 0.0f}, {.frame = Frame{}})),
          drawn(test_context(), mesh.geometry, mesh.surface),
          seen(test_context(), width, height),
          space(test_context()),
          target(space.make_target((seen.draw(drawn, view), seen)))
    {
    }
    std::vector<float> occlusion(const ScreenSettings& settings, const Definition& definition)
    {
        space.draw(seen, settings, definition, target);
        return target.read_red(target.rect());
    }
    ReadPicture read() const
    {
        return {seen.read_surface(), seen.width(), seen.height(), seen.view()};
    }
    Mesh mesh;
    DrawnMesh drawn;
    GBuffer seen;
    ScreenSpace space;
    Framebuffer target;
};

/// Looking down the z axis from a distance, at a rectangle of half that width and height in the
/// plane through the origin.
View from_above(double distance, double half_width, double half_height, bool orthographic)
{
    View view;
    view.eye = glm::vec3(0.0f, 0.0f, static_cast<float>(distance));
    const glm::vec2 half =
        glm::vec2(glm::dvec2(half_width, half_height) / (orthographic ? 1.0 : distance));
    view.lens = {-half, half, orthographic};
    return view;
}

double rms(const std::vector<float>& a, const std::vector<float>& b)
{
    EXPECT_EQ(a.size(), b.size());
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i)
        sum += std::pow(static_cast<double>(a[i]) - static_cast<double>(b[i]), 2);
    return std::sqrt(sum / static_cast<double>(a.size()));
}

/// Silhouettes, a wall behind, background around.
Scene mixture()
{
    const auto smaller = [](glm::dvec3 p) { return 0.35 * p; };
    return scenes::moved(scenes::bumpy_sphere(12), smaller) +
           scenes::box({0.25, -0.4, 0.1}, {0.5, 0.1, 0.5}, 2) +
           scenes::sheet({-0.5, -0.5, -0.5}, {0.8, 0.0, 0.3}, {0.0, 0.9, 0.2}, 3);
}

/// Each method, and each of its settings away from the usual ones.
std::vector<ScreenSettings> all_settings()
{
    std::vector<ScreenSettings> all;
    for (const ScreenMethod method : screen_methods()) {
        for (const ScreenNoise noise :
             {ScreenNoise::none, ScreenNoise::gradient, ScreenNoise::origin}) {
            all.push_back(screen_settings(method, 24));
            all.back().noise = noise;
        }
    }
    const auto add = [&](ScreenMethod method, auto change) {
        all.push_back(screen_settings(method, 16));
        all.back().frame = 5;
        change(all.back());
    };
    for (const ScreenMethod method : {ScreenMethod::ssao_disc, ScreenMethod::ssao_sphere}) {
        add(method, [](ScreenSettings& s) { s.pairs = false; });
        add(method, [](ScreenSettings& s) { s.ratio_test = true; });
        add(method, [](ScreenSettings& s) { s.reach = 0.3f; });
    }
    add(ScreenMethod::vo, [](ScreenSettings& s) { s.pairs = false; });
    add(ScreenMethod::vo, [](ScreenSettings& s) { s.dual = DualRadii::product; });
    add(ScreenMethod::vo, [](ScreenSettings& s) { s.dual = DualRadii::minimum; });
    for (int rule = 1; rule <= 6; ++rule)
        add(ScreenMethod::vo, [&](ScreenSettings& s) { s.rule = rule; });
    add(ScreenMethod::hbao, [](ScreenSettings& s) { s.normals = false; });
    add(ScreenMethod::hbao, [](ScreenSettings& s) { s.fade = false; });
    add(ScreenMethod::hbao, [](ScreenSettings& s) { s.bias = 55.0f; });
    add(ScreenMethod::gtao, [](ScreenSettings& s) { s.power = 1.5f; });
    add(ScreenMethod::gtao, [](ScreenSettings& s) { s.blur = true; });
    add(ScreenMethod::bitmask, [](ScreenSettings& s) { s.thickness = 0.05f; });
    return all;
}

std::string told(const ScreenSettings& settings)
{
    return name_of(settings.method) + ", " + setting_of(settings);
}

// The same noise, the same pixels: what differs is single samples at the border of two pixels.
TEST(ScreenSpace, EachMethodIsItsPlainTwin)
{
    for (const bool orthographic : {false, true}) {
        Screen screen(mixture(), from_above(1.6, 0.6, 0.4, orthographic), 60, 40);
        const ReadPicture picture = screen.read();
        for (const ScreenSettings& settings : all_settings()) {
            for (const Falloff falloff : {Falloff::none, Falloff::smooth}) {
                const Definition definition{.max_distance = 0.2f, .falloff = falloff};
                const std::vector<float> found = screen.occlusion(settings, definition);
                EXPECT_LE(rms(found, screen_twin(picture, settings, definition)), 0.003)
                    << told(settings) << (orthographic ? ", orthographic" : "")
                    << (falloff == Falloff::none ? "" : ", smooth");
                EXPECT_GT(std::ranges::count_if(found, [](float v) { return v > 0.02f; }), 20)
                    << told(settings);
            }
        }
    }
}

double mean_of(const std::vector<float>& values)
{
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

std::vector<ScreenSettings> plane_settings()
{
    std::vector<ScreenSettings> all;
    for (const ScreenMethod method : screen_methods()) {
        all.push_back(screen_settings(method, 24));
        all.back().bias = 0.0f;
    }
    all.push_back(screen_settings(ScreenMethod::hbao, 24));
    all.back().bias = 0.0f;
    all.back().normals = false;
    return all;
}

// From both kinds of lens, facing it and tilted, to the very border of the picture: where samples
// were taken from the border's pixels in place of none, it would not be open.
TEST(ScreenSpace, APlaneIsOpen)
{
    for (const bool orthographic : {false, true}) {
        for (const double tilt : {0.0, 35.0, 65.0}) {
            const double rise = std::tan(tilt * kPi / 180.0);
            // tilted about an axis that is none of the picture's
            const glm::dvec3 u(1.0, 0.0, 0.8 * rise), v(0.0, 1.0, 0.6 * rise);
            Screen screen(scenes::sheet(-3.0 * (u + v), 6.0 * u, 6.0 * v, 1),
                          from_above(4.0, 0.48, 0.32, orthographic), 96, 64);
            for (const ScreenSettings& settings : plane_settings()) {
                const std::vector<float> found = screen.occlusion(settings, {.max_distance = 0.3f});
                // a sample of ssao may be seen at the next pixel, and change sides
                const bool is_ssao = settings.method == ScreenMethod::ssao_disc ||
                                     settings.method == ScreenMethod::ssao_sphere;
                EXPECT_LE(is_ssao ? mean_of(found) : *std::ranges::max_element(found),
                          is_ssao ? 0.01 : 0.005)
                    << told(settings) << ", tilt " << tilt
                    << (orthographic ? ", orthographic" : "");
            }
        }
    }
}

/// Along y; the profile's points go from left to right, x and z.
Scene prism(const std::vector<glm::dvec2>& profile)
{
    Scene scene;
    for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
        const glm::dvec2 across = profile[i + 1] - profile[i];
        scene += scenes::sheet({profile[i].x, -4.0, profile[i].y}, {across.x, 0.0, across.y},
                               {0.0, 8.0, 0.0}, 1);
    }
    return scene;
}

/// Occlusion at a point of an endless prism seen against its normal's half plane: 1 - (sin a + sin
/// b) / 2 with the angles of the highest points on both sides from the normal (crossed strings).
double crossed_strings(const std::vector<glm::dvec2>& profile, glm::dvec2 point, glm::dvec2 normal)
{
    double left = kPi / 2, right = kPi / 2;
    for (const glm::dvec2 corner : profile) {
        const glm::dvec2 d = corner - point;
        const double angle = std::atan2(normal.y * d.x - normal.x * d.y, glm::dot(d, normal));
        double& side = d.x > 0.0 ? right : left;
        if (d.x != 0.0)
            side = std::min(side, std::abs(angle));
    }
    return 1.0 - 0.5 * (std::sin(left) + std::sin(right));
}

// A groove with walls of 45 degrees and a floor of one pixel. At its bottom the walls stand as high
// in every distance: the sky is between 45 degrees on both sides, 1 - sin 45; of the ball a quarter
// is free, half of what is free over a plane; and the mean sine over all directions in the picture,
// of a wall of the tangent cos t, is 1/2.
TEST(ScreenSpace, AGrooveOf90DegreesAtItsBottom)
{
    const double pixel = 0.01, half = 0.5 * pixel;
    const std::vector<glm::dvec2> profile = {
        {-1.0 - half, 1.0}, {-half, 0.0}, {half, 0.0}, {1.0 + half, 1.0}};
    Screen screen(prism(profile), from_above(3.0, 0.505, 0.505, true), 101, 101);
    const auto bottom = [&](ScreenMethod method, auto change) {
        ScreenSettings settings = screen_settings(method, 1024);
        change(settings);
        return static_cast<double>(
            screen.occlusion(settings, {.max_distance = 0.4f})[50 * 101 + 50]);
    };
    const auto as_it_is = [](ScreenSettings&) {};
    const double sky = 1.0 - std::sin(kPi / 4);
    EXPECT_NEAR(bottom(ScreenMethod::gtao, as_it_is), sky, 0.01);
    EXPECT_NEAR(
        bottom(ScreenMethod::bitmask,
               [](ScreenSettings& s) { s.thickness = std::numeric_limits<float>::infinity(); }),
        sky, 0.01);
    EXPECT_NEAR(bottom(ScreenMethod::hbao,
                       [](ScreenSettings& s) {
                           s.fade = false;
                           s.bias = 0.0f;
                       }),
                0.5, 0.01);
    EXPECT_NEAR(bottom(ScreenMethod::ssao_sphere, as_it_is), 0.5, 0.02);
    EXPECT_NEAR(bottom(ScreenMethod::vo, as_it_is), 0.5, 0.02);
    double disc = 0.0;  // the mirrored disk of one pixel is one disk: many stand for the ball
    for (int frame = 0; frame < 64; ++frame)
        disc += bottom(ScreenMethod::ssao_disc,
                       [&](ScreenSettings& s) {
                           s.samples = 256;
                           s.frame = frame;
                       }) /
                64;
    EXPECT_NEAR(disc, 0.5, 0.02);
}

// Grooves with walls of two slopes and with upright ones, between flat banks: every pixel of a row
// across. The radius is ten times as wide as they are: what lies farther along the groove stands
// low.
TEST(ScreenSpace, PrismsAreCrossedStrings)
{
    const std::vector<std::vector<glm::dvec2>> profiles = {
        {{-1.5, 0.2}, {-0.285, 0.2}, {-0.045, 0.0}, {0.045, 0.0}, {0.245, 0.2}, {1.5, 0.2}},
        {{-1.5, 0.15}, {-0.1591, 0.15}, {-0.159, 0.0}, {0.159, 0.0}, {0.1591, 0.15}, {1.5, 0.15}}};
    constexpr int kWidth = 81, kHeight = 301;
    for (const std::vector<glm::dvec2>& profile : profiles) {
        Screen screen(prism(profile), from_above(3.0, 0.405, 1.505, true), kWidth, kHeight);
        const ReadPicture picture = screen.read();
        for (const ScreenMethod method : {ScreenMethod::gtao, ScreenMethod::bitmask}) {
            ScreenSettings settings = screen_settings(method, 4096);
            settings.directions = 64;
            settings.thickness = std::numeric_limits<float>::infinity();
            const std::vector<float> found = screen.occlusion(settings, {.max_distance = 1.5f});
            double sum = 0.0, largest = 0.0;
            for (int x = 0; x < kWidth; ++x) {
                const std::size_t i = static_cast<std::size_t>(kHeight / 2 * kWidth + x);
                const glm::vec4 seen = picture.surface[i];
                const double expected = crossed_strings(
                    profile, {(x + 0.5) * 0.01 - 0.405, 3.0 - static_cast<double>(seen.w)},
                    {seen.x, -seen.z});
                const double error = static_cast<double>(found[i]) - expected;
                sum += error;
                largest = std::max(largest, std::abs(error));
            }
            EXPECT_NEAR(sum / kWidth, 0.0, 0.01) << name_of(method);
            EXPECT_LE(largest, 0.015) << name_of(method);
        }
    }
}

// What reaches back for ever hides as much as gtao's horizon; what is as thin as paper nothing.
TEST(ScreenSpace, BitmasksRunFromNothingToGtao)
{
    Screen screen(mixture(), from_above(1.6, 0.6, 0.4, false), 96, 64);
    for (const Falloff falloff : {Falloff::none, Falloff::smooth}) {
        const Definition definition{.max_distance = 0.2f, .falloff = falloff};
        ScreenSettings settings = screen_settings(ScreenMethod::gtao, 1024);
        settings.directions = 128;
        const std::vector<float> horizon = screen.occlusion(settings, definition);
        settings.method = ScreenMethod::bitmask;
        settings.thickness = 1e5f;
        const std::vector<float> endless = screen.occlusion(settings, definition);
        for (std::size_t i = 0; i < horizon.size(); ++i)
            ASSERT_NEAR(endless[i], horizon[i], 0.01f) << i;
        settings.thickness = 1e-6f;
        const std::vector<float> paper = screen.occlusion(settings, definition);
        EXPECT_LE(*std::ranges::max_element(paper), 0.002f);
        settings.thickness = 0.2f;
        const double between = mean_of(screen.occlusion(settings, definition));
        EXPECT_LT(between, 0.9 * mean_of(horizon));
        EXPECT_GT(between, 0.1 * mean_of(horizon));
    }
}

// Something small hovers over a tilted plane, beyond the reach: lines that meet it have their
// partners' rest, and the plane around it stays as open as it is; without pairs it has a rim.
TEST(ScreenSpace, LinesThatKnowNothingTakeTheirPartnersRest)
{
    const Scene world = scenes::sheet({-3, -3, -1.5}, {6, 0, 3}, {0, 6, 0}, 1) +
                        scenes::sheet({-0.05, -0.05, 1.2}, {0.1, 0, 0}, {0, 0.1, 0}, 1);
    Screen screen(world, from_above(4.0, 0.48, 0.32, true), 96, 64);
    const std::vector<glm::vec4> surface = screen.read().surface;
    ScreenSettings settings = screen_settings(ScreenMethod::vo, 24);
    const auto most_on_the_plane = [&] {
        const std::vector<float> found = screen.occlusion(settings, {.max_distance = 0.15f});
        float most = 0.0f;
        for (std::size_t i = 0; i < found.size(); ++i)
            most = std::max(most, surface[i].w > 3.0f ? found[i] : 0.0f);
        return most;
    };
    EXPECT_LE(most_on_the_plane(), 1e-5f);
    settings.reach = 1000.0f;
    EXPECT_GT(most_on_the_plane(), 0.3f);
}

// Turned by 64 frames' noise, few directions are as good as many.
TEST(ScreenSpace, NoiseIsFair)
{
    Screen screen(mixture(), from_above(1.6, 0.6, 0.4, false), 60, 40);
    const Definition definition{.max_distance = 0.2f};
    const auto mean_picture = [&](ScreenSettings settings, int frames) {
        std::vector<float> mean(60 * 40, 0.0f);
        for (settings.frame = 0; settings.frame < frames; ++settings.frame) {
            const std::vector<float> found = screen.occlusion(settings, definition);
            for (std::size_t i = 0; i < mean.size(); ++i)
                mean[i] += found[i] / static_cast<float>(frames);
        }
        return mean;
    };
    for (const ScreenMethod method : screen_methods()) {
        const ScreenSettings few = screen_settings(method, 24);
        ScreenSettings many = screen_settings(method, 1536);
        many.directions = 384;  // of 4 steps, as those of the few
        const std::vector<float> mean = mean_picture(few, 64), limit = mean_picture(many, 16);
        EXPECT_NEAR(mean_of(mean), mean_of(limit), 0.01) << told(few);
        // what ssao cuts off at a half is less with many: near it few are darker
        const bool is_ssao =
            method == ScreenMethod::ssao_disc || method == ScreenMethod::ssao_sphere;
        EXPECT_LE(rms(mean, limit), is_ssao ? 0.02 : 0.005) << told(few);
    }
}

// Of the rules that choose a radius: their twins, and what is plain to see: nothing stands over a
// plane that faces the eye; on a tilted one the nearest is at the rim, R away or nearly.
TEST(ScreenSpace, RulesChooseRadii)
{
    const Definition definition{.max_distance = 0.2f};
    ScreenSettings settings = screen_settings(ScreenMethod::vo, 24);
    Screen mixed(mixture(), from_above(1.6, 0.6, 0.4, false), 60, 40);
    Screen facing(scenes::sheet({-3, -3, 0}, {6, 0, 0}, {0, 6, 0}, 1),
                  from_above(4.0, 0.48, 0.32, true), 96, 64);
    Screen tilted(scenes::sheet({-3, -3, -1.5}, {6, 0, 3}, {0, 6, 0}, 1),
                  from_above(4.0, 0.48, 0.32, true), 96, 64);
    const auto radii = [&](Screen& screen) {
        screen.space.draw_radius(screen.seen, settings, definition, screen.target);
        return screen.target.read_red(screen.target.rect());
    };
    for (const int probes : {4, 9, 20, 328}) {
        settings.probes = probes;
        for (settings.rule = 1; settings.rule <= 6; ++settings.rule) {
            EXPECT_LE(rms(radii(mixed), radius_twin(mixed.read(), settings, definition)), 0.003)
                << told(settings);
            const float on_the_plane = settings.rule == 3 ? 1.0f : 0.0f;
            EXPECT_EQ(radii(facing)[32 * 96 + 48], on_the_plane) << told(settings);
        }
    }
    for (settings.rule = 5; settings.rule <= 6; ++settings.rule)
        EXPECT_NEAR(radii(tilted)[32 * 96 + 48], 1.0f, 0.05f) << told(settings);
}

// Balls and disks are filled evenly: shells and rings of the same volume hold the same number, and
// no direction is preferred.
TEST(ScreenSamples, FillTheirBallsEvenly)
{
    constexpr int kCount = 1000, kShells = 10;
    for (const bool paired : {true, false}) {
        for (const bool is_ball : {true, false}) {
            const auto samples = (is_ball ? ball_samples : disk_samples)(kCount, paired);
            ASSERT_EQ(samples.size(), static_cast<std::size_t>(kCount));
            std::vector<int> shells(kShells, 0);
            glm::dvec3 sum(0.0), squares(0.0);
            for (const glm::vec4& sample : samples) {
                const glm::dvec3 p(sample);
                const double share = std::pow(glm::length(p), is_ball ? 3.0 : 2.0);
                ++shells[static_cast<std::size_t>(kShells * share)];
                sum += p / static_cast<double>(kCount);
                squares += p * p / static_cast<double>(kCount);
            }
            for (const int shell : shells)
                EXPECT_EQ(shell, kCount / kShells);
            EXPECT_LT(glm::length(sum), 0.01);
            const double moment = is_ball ? 0.2 : 0.25;
            const glm::dvec3 expected(moment, moment, is_ball ? moment : 0.0);
            EXPECT_LT(glm::length(squares - expected), 0.01);
        }
    }
}

TEST(ScreenSamples, LinesShareTheBall)
{
    EXPECT_FLOAT_EQ(line_samples(1, false)[0].w, 1.0f);
    const std::vector<glm::vec4> two = line_samples(2, true);
    EXPECT_FLOAT_EQ(two[0].w, 0.5f);
    EXPECT_EQ(two[1], glm::vec4(-two[0].x, -two[0].y, two[0].z, two[0].w));
    const std::vector<glm::vec4> many = line_samples(64, true);
    double volume = 0.0;
    for (std::size_t i = 0; i < many.size(); ++i) {
        volume += static_cast<double>(many[i].w);
        EXPECT_NEAR(glm::length(glm::vec3(many[i])), 1.0f, 1e-6f);
        EXPECT_NEAR(many[i].w, many[i ^ 1].w, 1e-5f);
    }
    EXPECT_NEAR(volume, 1.0, 1e-6);
}

TEST(ScreenSettings, AreThoseOfTheirMethod)
{
    for (const ScreenMethod method : screen_methods()) {
        EXPECT_EQ(screen_method_of(name_of(method)), method);
        for (const int samples : {2, 8, 16, 24, 1024})
            EXPECT_NO_THROW(check_settings(screen_settings(method, samples))) << name_of(method);
        for (const ScreenParameter& parameter : screen_parameters()) {
            const bool knows = std::ranges::count(parameter.methods, method) > 0;
            ScreenSettings settings = screen_settings(method, 24);
            const ScreenSettings before = settings;
            // what no setting takes
            EXPECT_THROW(set_parameter(settings, parameter.name, "-1"), SettingsError);
            EXPECT_THROW(set_parameter(settings, parameter.name, ""), SettingsError);
            EXPECT_EQ(settings, before);
            const std::string_view name = parameter.name;
            const std::string_view text = name == "directions" ? "2"
                                          : name == "noise"    ? "origin"
                                          : name == "dual"     ? "minimum"
                                          : name == "probes"   ? "328"
                                          : name == "normals" || name == "pairs" || name == "fade"
                                              ? "off"
                                          : name == "blur" || name == "ratio-test" ? "on"
                                                                                   : "3";
            if (!knows) {
                EXPECT_THROW(set_parameter(settings, name, text), SettingsError) << name;
                continue;
            }
            EXPECT_NO_THROW(set_parameter(settings, name, text)) << name;
            EXPECT_NE(settings, before) << name;
            EXPECT_NE(setting_of(settings), setting_of(before)) << name;
            EXPECT_NO_THROW(check_settings(settings)) << name;
        }
    }
    EXPECT_EQ(setting_of(screen_settings(ScreenMethod::vo, 24)), "24 samples");
    EXPECT_EQ(setting_of(screen_settings(ScreenMethod::gtao, 8)), "4 x 2");
    ScreenSettings settings = screen_settings(ScreenMethod::hbao, 24);
    set_parameter(settings, "bias", "30");
    set_parameter(settings, "blur", "on");
    EXPECT_EQ(setting_of(settings), "6 x 4, bias 30, blur");
}

TEST(ScreenSettings, OutOfTheirRangesAreRefusedInASentence)
{
    const auto refused = [](ScreenMethod method, auto change) {
        ScreenSettings settings = screen_settings(method, 24);
        change(settings);
        try {
            check_settings(settings);
        } catch (const SettingsError& error) {
            return std::string(error.what());
        }
        return std::string("nothing");
    };
    EXPECT_EQ(refused(ScreenMethod::vo, [](auto& s) { s.samples = 4098; }),
              "the samples of vo must be 1 to 4096");
    EXPECT_EQ(refused(ScreenMethod::ssao_sphere, [](auto& s) { s.samples = 7; }),
              "the samples of ssao-sphere must be even");
    EXPECT_EQ(refused(ScreenMethod::gtao, [](auto& s) { s.directions = 5; }),
              "the samples of gtao must be a multiple of its 5 directions");
    EXPECT_EQ(refused(ScreenMethod::bitmask, [](auto& s) { s.directions = 3; }),
              "the directions of bitmask must be even: two a slice");
    EXPECT_EQ(refused(ScreenMethod::hbao, [](auto& s) { s.directions = 3; }), "nothing");
    EXPECT_EQ(refused(ScreenMethod::bitmask, [](auto& s) { s.thickness = 0.0f; }),
              "thickness of bitmask must be above 0");
    EXPECT_EQ(refused(ScreenMethod::vo, [](auto& s) { s.probes = 5; }),
              "probes of vo must be 4, 9, 20 or 328");
    EXPECT_EQ(refused(ScreenMethod::hbao,
                      [](auto& s) { s.bias = std::numeric_limits<float>::quiet_NaN(); }),
              "bias of hbao must be 0 to 90 degrees");
    ScreenSettings settings = screen_settings(ScreenMethod::hbao, 24);
    try {
        set_parameter(settings, "bias", "95");
        FAIL();
    } catch (const SettingsError& error) {
        EXPECT_STREQ(error.what(), "bias of hbao must be 0 to 90 degrees, not '95'");
    }
    Screen screen(mixture(), from_above(1.6, 0.6, 0.4, false), 6, 4);
    settings.bias = -1.0f;
    EXPECT_THROW(static_cast<void>(screen.occlusion(settings, {})), SettingsError);
}

// A pass can be timed, and says by which clock.
TEST(ScreenSpace, TellsItsClock)
{
    Screen screen(mixture(), from_above(1.6, 0.6, 0.4, false), 60, 40);
    const PassTime time = screen.space.time(screen.seen, screen_settings(ScreenMethod::gtao, 24),
                                            {.max_distance = 0.2f}, screen.target, 3);
    EXPECT_GT(time.seconds, 0.0);
    EXPECT_EQ(time.clock, "finish + steady_clock");
}

// A radius of less than a pixel answers 0; no limit at all is one diagonal.
TEST(ScreenSpace, RadiiOfNothingAndOfEverything)
{
    Screen screen(mixture(), from_above(1.6, 0.6, 0.4, false), 60, 40);
    for (const ScreenMethod method : screen_methods()) {
        const ScreenSettings settings = screen_settings(method, 8);
        const std::vector<float> none = screen.occlusion(settings, {.max_distance = 0.005f});
        EXPECT_EQ(*std::ranges::max_element(none), 0.0f) << name_of(method);
        EXPECT_EQ(screen.occlusion(settings, {}),
                  screen.occlusion(settings, {.max_distance = 1.0f}))
            << name_of(method);
    }
}

}  // namespace
}  // namespace surfelao

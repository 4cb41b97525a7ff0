#include "pixels/pixel_picture.h"

#include "engines/threads.h"
#include "looks.h"
#include "surfels/errors.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <vector>

namespace surfelao {
namespace {

using scenes::operator+;

glm::vec3 visibility_of(const AnsweredPixel& pixel)
{
    return glm::vec3(1.0f - pixel.value.occlusion);
}

PixelPicture picture_of(const Mesh& mesh, const View& view, const PixelPictureSettings& settings,
                        const PixelPaint& paint = {visibility_of},
                        const StageProgress& progress = {})
{
    const DrawnMesh drawn(test_context(), mesh.geometry, mesh.surface);
    Occluders occluders(mesh.occluding());
    return pixel_picture(test_context(), mesh, drawn, occluders, view, settings, paint, progress);
}

const Mesh& bumpy()
{
    static const Mesh mesh = make_mesh(scenes::bumpy_sphere(12));
    return mesh;
}

View framed(const Mesh& mesh, PictureSize size)
{
    const float aspect = static_cast<float>(size.width) / static_cast<float>(size.height);
    return view_of(frame_points(mesh.geometry.positions, UpAxis::y, aspect), size.width,
                   size.height);
}

/// Along -z at a square of that half size, without perspective.
View from_above(float half)
{
    View view = view_of(Camera{}, 8, 8);
    view.eye = glm::vec3(0.0f, 0.0f, 2.0f);
    view.right = glm::vec3(1, 0, 0);
    view.up = glm::vec3(0, 1, 0);
    view.forward = glm::vec3(0, 0, -1);
    view.lens = {glm::vec2(-half), glm::vec2(half), true};
    return view;
}

/// The row of the picture that stands at y pixels from the bottom.
const glm::vec4& at_bottom(const Image& image, int x, int y)
{
    return image.at(x, image.height - 1 - y);
}

bool are_same_bytes(const Image& a, const Image& b)
{
    return a.pixels.size() == b.pixels.size() &&
           std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(glm::vec4)) == 0;
}

TEST(PixelPicture, ItsValuesAreThoseOfTheSameReceivers)
{
    const PictureSize size{60, 40};
    const View view = framed(bumpy(), size);
    const SeenPixels seen =
        seen_pixels(bumpy(), Projected(bumpy().geometry, view, size.width, size.height));
    const EngineSettings masks;
    const std::vector<Occlusion> answers =
        solve(prepare(bumpy().geometry), seen.receivers, masks).occlusion;
    Image expected(size.width, size.height);
    for (std::size_t i = 0; i < answers.size(); ++i) {
        const auto pixel = static_cast<int>(seen.pixels[i]);
        expected.at(pixel % 60, 39 - pixel / 60) =
            glm::vec4(glm::vec3(1.0f - answers[i].occlusion), 1.0f);
    }
    const PixelPicture picture =
        picture_of(bumpy(), view, {.size = size, .samples = 1, .engine = masks});
    EXPECT_TRUE(are_same_bytes(picture.image, expected));
    EXPECT_EQ(picture.middles, seen.pixels.size());
    EXPECT_EQ(picture.extras, 0u);
}

TEST(PixelPicture, IsTheSameBytesForAnyNumberOfThreads)
{
    const PixelPictureSettings settings{.size = {60, 40}, .samples = 8, .engine = EngineSettings{}};
    const View view = framed(bumpy(), settings.size);
    const PixelPicture many = picture_of(bumpy(), view, settings);
    const ThreadLimit limit(1);
    const PixelPicture one = picture_of(bumpy(), view, settings);
    EXPECT_TRUE(are_same_bytes(many.image, one.image));
    EXPECT_GT(many.extras, 100u);
    EXPECT_EQ(many.extras, one.extras);
    EXPECT_EQ(many.edge_pixels, one.edge_pixels);
}

// Two sheets face each other, close together. Their backs are open, whichever way they were wound.
TEST(PixelPicture, ASheetSeenFromBehindIsAskedOnTheSideThatIsSeen)
{
    const Scene near = scenes::sheet({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 1);
    const Scene far = scenes::sheet({-1, -1, -0.1}, {2, 0, 0}, {0, 2, 0}, 1);
    const PixelPictureSettings settings{.size = {8, 8}, .samples = 4, .engine = EngineSettings{}};
    for (const Scene& scene :
         {near + far, scenes::flipped(near) + far, scenes::flipped(near + far)}) {
        const PixelPicture picture = picture_of(make_mesh(scene), from_above(0.2f), settings);
        for (const glm::vec4& pixel : picture.image.pixels)
            EXPECT_EQ(pixel, glm::vec4(1.0f));
    }
    // and between them it is dark
    View between = from_above(0.02f);
    between.eye.z = 0.0f;  // of the unit frame: half way
    const PixelPicture picture = picture_of(make_mesh(near + far), between, settings);
    for (const glm::vec4& pixel : picture.image.pixels)
        EXPECT_LT(pixel.x, 0.1f);
}

// Each sample of a pixel that a triangle's straight edge divides is on one side of it.
TEST(PixelPicture, AlphaIsTheShareOfSamplesThatSeeSomething)
{
    constexpr int kSamples = 64;
    // below the line y = x / 3 + .05 and larger than the picture otherwise
    const Mesh mesh = make_mesh(scenes::triangle({-3, -0.95, 0}, {0, -9, 0}, {3, 1.05, 0}));
    View view = from_above(0.05f);
    const glm::dvec3 centre(mesh.geometry.frame.centre);
    const auto scale = static_cast<float>(mesh.geometry.frame.diagonal);
    view.eye -= glm::vec3(centre / mesh.geometry.frame.diagonal);  // the file's origin
    const PictureSize size{16, 16};
    const PixelPicture picture = picture_of(mesh, view, {.size = size, .samples = kSamples});
    double covered = 0.0;
    for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
            int below = 0;
            for (int i = 0; i < kSamples; ++i) {
                const glm::vec2 place = glm::vec2(x, y) + 0.5f + sample_shift(i);
                const glm::vec2 at = scale * (0.1f * place / 16.0f - 0.05f);
                below += at.y < at.x / 3.0f + 0.05f ? 1 : 0;
            }
            const glm::vec4& pixel = at_bottom(picture.image, x, y);
            // the device rounds corners to 1/256 pixel: a sample or two change sides
            EXPECT_NEAR(pixel.w, static_cast<float>(below) / kSamples, 2.5f / kSamples);
            EXPECT_EQ(pixel.x, pixel.w > 0.0f ? 1.0f : 0.0f);
            covered += pixel.w;
        }
    }
    EXPECT_GT(covered, 60.0);
    EXPECT_LT(covered, 200.0);
}

/// A white sheet over a black one, its border at x = 0.
Mesh white_over_black()
{
    return make_mesh(scenes::sheet({-1, -1, 0.5}, {1, 0, 0}, {0, 2, 0}, 1) +
                     scenes::sheet({-1, -1, -0.5}, {2, 0, 0}, {0, 2, 0}, 1));
}

glm::vec3 white_above(const AnsweredPixel& pixel)
{
    return glm::vec3(pixel.receiver.position.z > 0.0f ? 1.0f : 0.0f);
}

// 5 pixels over the border: it divides the third of them 30 to 70.
TEST(PixelPicture, AnEdgeIsTheMeanOfItsTwoSides)
{
    constexpr int kSamples = 16;
    View view = from_above(0.05f);
    view.lens.low.x = -0.046f;
    view.lens.high.x = 0.054f;
    const PixelPictureSettings settings{.size = {5, 5}, .samples = kSamples};
    const PixelPicture picture = picture_of(white_over_black(), view, settings, {white_above});
    int left = 0;
    for (int i = 0; i < kSamples; ++i)
        left += sample_shift(i).x + 0.5f < 0.3f ? 1 : 0;
    const float expected[] = {1.0f, 1.0f, static_cast<float>(left) / kSamples, 0.0f, 0.0f};
    for (int y = 0; y < 5; ++y) {
        for (int x = 0; x < 5; ++x) {
            EXPECT_FLOAT_EQ(picture.image.at(x, y).x, expected[x]) << x;
            EXPECT_EQ(picture.image.at(x, y).w, 1.0f);
        }
    }
    EXPECT_EQ(picture.extras, 5u);
    EXPECT_EQ(picture.edge_pixels, 5u);
}

// Where a pixel sees one plane in many triangles, at whatever angle, its middle is all that is
// asked; what is painted on it is taken at every sample.
TEST(PixelPicture, OneSurfaceIsAskedOnceAPixelAndPaintedAtEverySample)
{
    const Mesh mesh = make_mesh(scenes::sheet({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 40));
    View view = from_above(0.1f);
    view.forward = glm::normalize(glm::vec3(0.0f, 1.0f, -0.05f));
    view.up = glm::normalize(glm::vec3(0.0f, 0.05f, 1.0f));
    view.eye = -2.0f * view.forward;
    view.lens.low.y = -0.005f;
    view.lens.high.y = 0.005f;
    const auto stripes = [&](const SurfacePoint& point) {
        return glm::vec3(point.triangle % 2 == 0 ? 1.0f : 0.0f);
    };
    const PixelPictureSettings settings{.size = {8, 8}, .samples = 64};
    const PixelPicture picture = picture_of(mesh, view, settings, {visibility_of, stripes});
    EXPECT_EQ(picture.extras, 0u);
    EXPECT_EQ(picture.middles, 64u);
    double mean = 0.0;
    int mixed = 0;
    for (const glm::vec4& pixel : picture.image.pixels) {
        mean += pixel.x / 64.0;
        mixed += pixel.x > 0.0f && pixel.x < 1.0f ? 1 : 0;
    }
    EXPECT_NEAR(mean, 0.5, 0.1);
    EXPECT_GT(mixed, 32);
}

// A picture of places, which masks' groups do not change.
TEST(PixelPicture, BandsMakeUpTheSamePicture)
{
    PixelPictureSettings settings{.size = {60, 40}, .samples = 4};
    const View view = framed(bumpy(), settings.size);
    const PixelPaint places = {[](const AnsweredPixel& pixel) { return pixel.receiver.position; }};
    const PixelPicture whole = picture_of(bumpy(), view, settings, places);
    settings.band_pixels = 7 * 60;
    const PixelPicture banded = picture_of(bumpy(), view, settings, places);
    EXPECT_EQ(whole.bands, 1);
    EXPECT_EQ(banded.bands, 6);
    int others = 0;
    for (std::size_t i = 0; i < whole.image.pixels.size(); ++i)
        others += glm::distance(whole.image.pixels[i], banded.image.pixels[i]) < 1e-4f ? 0 : 1;
    // the device rounds corners to 1/256 pixel, differently in each band
    EXPECT_LE(others, 20);
}

TEST(PixelPicture, MethodsOfThePictureSeeItWhole)
{
    PixelPictureSettings settings{.size = {60, 40},
                                  .samples = 2,
                                  .engine = screen_settings(ScreenMethod::gtao, 16),
                                  .band_pixels = 600};
    EXPECT_EQ(picture_of(bumpy(), framed(bumpy(), settings.size), settings).bands, 1);
    settings.size.width = test_context().info().max_texture_size;
    settings.guard = 1;
    EXPECT_THROW(static_cast<void>(picture_of(bumpy(), framed(bumpy(), settings.size), settings)),
                 InputError);
}

TEST(PixelPicture, ScreenMethodsStandAtTheirPixels)
{
    const PictureSize size{48, 40};
    const View view = framed(bumpy(), size);
    const ScreenSettings method = screen_settings(ScreenMethod::gtao, 16);
    for (const int guard : {0, 5}) {
        const Look look(bumpy(), view, size, guard);
        ScreenSpace screen(test_context());
        Occluders occluders(bumpy().geometry);
        const PixelAnswer alone = answer(look.pixels, occluders, screen, method, {});
        const PixelPicture picture = picture_of(
            bumpy(), view, {.size = size, .samples = 1, .engine = method, .guard = guard});
        for (std::size_t i = 0; i < alone.values.size(); ++i) {
            const auto pixel = static_cast<int>(look.pixels.seen().pixels[i]);
            EXPECT_EQ(at_bottom(picture.image, pixel % 48, pixel / 48).x,
                      1.0f - alone.values[i].occlusion);
        }
    }
}

TEST(PixelPicture, StopsWhenItsListenerSaysSo)
{
    const PixelPictureSettings settings{
        .size = {60, 40}, .samples = 64, .engine = EngineSettings{}, .band_pixels = 600};
    const View view = framed(bumpy(), settings.size);
    for (const std::string_view stage : {"solve", "edges"}) {
        double last = 0.0;
        const auto stop = [&](std::string_view name, double done) {
            last = done;
            return name != stage;
        };
        EXPECT_THROW(static_cast<void>(picture_of(bumpy(), view, settings, {visibility_of}, stop)),
                     Cancelled);
        EXPECT_LT(last, 1.0) << stage;
    }
}

}  // namespace
}  // namespace surfelao

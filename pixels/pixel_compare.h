/// pixel_compare.h: one scene as cameras see it, by engines of the scene and by methods that know
/// its picture alone: how wrong, how long.
///
/// Whoever answers is asked at the same pixels, and rays cast from the receivers of these very
/// pixels (pixels/seen.h) say what is right. Of each camera all pixels count that see a surface;
/// none is left out. Errors are in per cent of full occlusion:
///
///     surface   RMSE over the pixels that see a surface
///     whole     over all pixels of the picture, the background's error being 0:
///               whole = surface * sqrt(share of the pixels that see a surface)
///     bias      mean of answer - rays: positive = too dark
///
/// The variance of the rays' noise, known from two independent halves, is taken out of the squares;
/// p95 and largest error still have it.
///
/// A screen-space pass is timed by itself: without G-buffer, blur (unless settings ask for it) and
/// reading back. An engine's time is that of solve(), without what it builds once for a scene, and
/// without the G-buffer as well. In each round all rows run one after the other; medians count.
#pragma once

#include "bake/bake.h"
#include "bake/picture.h"
#include "bake/statistics.h"
#include "gpu/context.h"
#include "pixels/cameras.h"
#include "pixels/pixel_engine.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace surfelao {

/// One parameter of a screen-space method, tried from `from` to `to` in steps.
struct Sweep {
    ScreenMethod method = ScreenMethod::hbao;
    std::string name;                         ///< of screen_parameters()
    double from = 0.0, to = 0.0, step = 1.0;  ///< from <= to, step > 0; kMostSweep values at most
};
inline constexpr int kMostSweep = 1000;

/// "hbao.bias=0:40:5". Throws SettingsError for anything else.
[[nodiscard]] Sweep parse_sweep(std::string_view text);
/// from, from + step, ... not beyond `to`, but for rounding.
[[nodiscard]] std::vector<double> values_of(const Sweep& sweep);
/// The settings with each of these values. Throws as set_parameter() and check_settings().
[[nodiscard]] std::vector<PixelEngine> engines_of(const Sweep& sweep,
                                                  const ScreenSettings& settings);

struct PixelCompareSettings {
    std::filesystem::path input;
    std::vector<PixelEngine> engines;  ///< rows; their definition is made from the members below
    std::optional<Sweep> sweep;        ///< of which `engines` are the values
    std::vector<std::string> cameras;  ///< parse_camera()'s; empty: `views` spread ones
    int views = 4;                     ///< >= 1
    UpAxis up = UpAxis::y;
    PictureSize size;
    int guard = 0;  ///< pixels beyond each edge that screen-space methods see
    DistanceLimit max_distance;
    Kernel kernel = Kernel::cosine;     ///< methods of the picture know only this one
    std::optional<GroundPlane> ground;  ///< they know none
    TargetSettings target;              ///< normals and offset
    PartChoice parts;
    ReadOptions reading;
    std::uint32_t reference_rays = 256;  ///< a pixel, an even number
    int rounds = 3;                      ///< >= 1
    bool use_cache = true;               ///< of references
    bool pictures = false;               ///< for html_of()
    GridSources grids;                   ///< of engines that are GridPixels
    GlBackend backend = GlBackend::automatic;
};

/// In per cent.
struct PixelError {
    double rmse = 0.0, rmse_whole = 0.0, bias = 0.0, p95 = 0.0, max = 0.0;
};

/// answers and reference: one per pixel that sees a surface. noise: RMS error of the reference's
/// occlusion (not in per cent). picture_pixels: of the whole picture.
[[nodiscard]] PixelError pixel_error(std::span<const Occlusion> answers,
                                     std::span<const Occlusion> reference, double noise,
                                     std::size_t picture_pixels);

struct PixelCamera {
    NamedCamera from;
    std::uint64_t surface_pixels = 0;
    double share = 0.0;  ///< of the picture
    double noise = 0.0;  ///< of the reference, RMS, in per cent
    bool reference_from_cache = false;
    double mean_occlusion = 0.0;  ///< by rays, over the surface's pixels
    std::string reference_png;    ///< with pictures
};

/// One engine at one camera.
struct PixelRow {
    PixelEngine engine;
    std::size_t camera = 0;
    PixelError error;
    double ms = 0.0;                          ///< median
    std::string clock;                        ///< what told it
    std::string picture_png, difference_png;  ///< with pictures
};

/// One engine over all cameras: means of the errors and times, the largest of `max`.
struct PixelMean {
    PixelEngine engine;
    PixelError error;
    double ms = 0.0;
    std::string clock;
};

struct PixelComparison {
    std::filesystem::path input;
    std::uint64_t triangles = 0;
    PictureSize size;
    int guard = 0;
    int threads = 0, rounds = 0;
    std::uint32_t reference_rays = 0;
    Definition definition;
    std::string ground;     ///< where it lies; empty: there is none
    double diagonal = 1.0;  ///< of the scene, in the file's units
    std::string renderer;   ///< what draws, in the driver's words
    bool software = false;  ///< it is the processor
    std::optional<Sweep> sweep;
    std::vector<PixelCamera> cameras;
    std::vector<PixelRow> rows;    ///< all engines of the first camera, then of the next
    std::vector<PixelMean> means;  ///< one per engine
};

/// Throws InputError for a file without faces and as read_mesh(), SettingsError for settings out of
/// their ranges, Cancelled, std::runtime_error where there is no OpenGL. Costs of a camera: the
/// reference's rays, and the rounds of all engines.
[[nodiscard]] PixelComparison compare_pixels(const PixelCompareSettings& settings,
                                             const StageProgress& progress = {});
/// The same of a mesh: `input`, `reading`, `parts` and `grids` do not count.
[[nodiscard]] PixelComparison compare_pixels(const Mesh& mesh, const PixelCompareSettings& settings,
                                             const StageProgress& progress = {});

/// The mean with the least RMSE on surface pixels, the first of several: of a sweep the best value.
/// means: not empty.
[[nodiscard]] std::size_t best_of(std::span<const PixelMean> means);

/// Widest picture of a report: larger ones are reduced by the least whole number that will do.
inline constexpr int kWidestPicture = 640;
/// Full colour in its differences, of occlusion: what screen-space methods err by.
inline constexpr float kFullPixelError = 0.25f;

/// The part of the picture that sees a surface, with a margin. values: at seen.pixels, as grey:
/// white is open; what sees nothing is pale blue. seen: not empty.
[[nodiscard]] Picture occlusion_picture(const SeenPixels& seen, std::span<const Occlusion> values);
/// answers less reference as error_color(), full at kFullPixelError.
[[nodiscard]] Picture difference_picture(const SeenPixels& seen, std::span<const Occlusion> answers,
                                         std::span<const Occlusion> reference);

/// Keys input, triangles, width, height, guard, threads, rounds, max_distance (diagonals, null =
/// none), falloff, ground, diagonal, renderer, software, unit ("percent": of all errors),
/// reference{rays}, cameras[{camera, text, eye, target, fovy_deg, surface_pixels, share, noise,
/// mean_occlusion, from_cache}], rows[{engine, setting, camera, rmse, rmse_whole, bias, p95, max,
/// ms, clock}], means[the same without camera], sweep{name, best, values[{value, rmse, rmse_whole,
/// bias}]} or null. Cameras are numbered from 1.
[[nodiscard]] std::string json_of(const PixelComparison& comparison);

/// One line of names, then one line per row, then the means, whose camera is "mean".
[[nodiscard]] std::string csv_of(const PixelComparison& comparison);

/// For people: means of several cameras, then the rows of each; of a sweep its values, the best
/// marked.
[[nodiscard]] std::string table_of(const PixelComparison& comparison);

/// A page of its own: settings, table, and of each camera a strip of pictures: rays, each engine,
/// its difference. Of a comparison with pictures. Marked as a result of `compare`.
[[nodiscard]] std::string html_of(const PixelComparison& comparison);

}  // namespace surfelao

#include "cli/engine_options.h"

#include "bake/subdivide.h"
#include "cli/commands.h"
#include "cli/did_you_mean.h"
#include "cli/value_checks.h"
#include "reference/rays.h"
#include "surfels/number_text.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>

namespace surfelao {
namespace {

constexpr int kMostPasses = 100;
constexpr const char* kLowest = "lowest";  // of --ground
constexpr int kMostThreads = 1024;

/// The whole text as a finite number.
std::optional<double> number_of(std::string_view text)
{
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
        return std::nullopt;
    return value;
}

glm::vec3 axis_of(const std::string& name)
{
    return name == "z" ? glm::vec3(0.0f, 0.0f, 1.0f) : glm::vec3(0.0f, 1.0f, 0.0f);
}

void refuse_unless(bool allowed, const char* option, const char* engines)
{
    if (!allowed)
        throw UsageError(std::string(option) + " is only for --engine " + engines + ".");
}

}  // namespace

Length length_of(std::string_view text, const std::string& option)
{
    Length length;
    std::string_view digits = text;
    if (digits.ends_with('%')) {
        length.percent = true;
        digits.remove_suffix(1);
    }
    const std::optional<double> value = number_of(digits);
    if (!value || !(*value > 0.0)) {
        throw UsageError(option + ": \"" + std::string(text) +
                         "\" is not a number above 0, with or without %.");
    }
    length.value = *value;
    return length;
}

glm::dvec3 place_of(std::string_view text, const std::string& option)
{
    glm::dvec3 place;
    std::string_view rest = text;
    for (int axis = 0; axis < 3; ++axis) {
        const std::size_t end = axis < 2 ? std::min(rest.find(':'), rest.size()) : rest.size();
        const std::optional<double> value = number_of(rest.substr(0, end));
        if (!value || (axis < 2 && end == rest.size()))
            throw UsageError(option + ": \"" + std::string(text) + "\" is not X:Y:Z.");
        place[axis] = *value;
        rest.remove_prefix(std::min(rest.size(), end + 1));
    }
    return place;
}

void add_engine_options(CLI::App& command, EngineOptions& options,
                        const std::vector<std::string>& names)
{
    command.add_option("--engine", options.engine, "Who computes")
        ->check(one_of(names))
        ->type_name(CLI::detail::join(names, "|"))
        ->default_str("masks")
        ->group("Engine");
    command
        .add_option("--device", options.device,
                    "Where masks and disks run; gpu: OpenGL, no window needed")
        ->check(one_of({"cpu", "gpu"}))
        ->type_name("cpu|gpu")
        ->default_str("cpu")
        ->group("Engine");
    command
        .add_option("--quality", options.quality,
                    "Exactness against time, for masks and disks: draft, good, best, or a number "
                    "(0 = draft, 1 = good, 2 = best; masks: -1 to 4, disks: 0 to 2)")
        ->type_name("draft|good|best|Q")
        ->default_str("good")
        ->group("Engine");
    command.add_option("--rays", options.rays, "Rays per vertex, for --engine rays")
        ->check(whole_from(1, kMostRays))
        ->type_name("N")
        ->default_str("256")
        ->group("Engine");
    command
        .add_option("--passes", options.passes,
                    "For --engine disks: 1 = plain sum, more correct it where layers overlap")
        ->check(whole_from(1, kMostPasses))
        ->type_name("N")
        ->default_str(std::to_string(SolveSettings{}.passes))
        ->group("Engine");
    command
        .add_option("--strength", options.strength,
                    "For --engine disks: occlusion is multiplied by it (0 to 10)")
        ->check(number_from(0.0, 10.0))
        ->type_name("S")
        ->default_str("1")
        ->group("Engine");
}

void add_measure_options(CLI::App& command, MeasureOptions& options)
{
    command
        .add_option("--max-distance", options.max_distance,
                    "Surfaces farther away do not occlude: in the file's units, or with % of the "
                    "bounding box's diagonal (0.5, 10%)")
        ->type_name("D|P%")
        ->group("What is measured");
    command
        .add_option("--falloff", options.falloff,
                    "smooth: near surfaces count more, up to --max-distance")
        ->check(one_of({"none", "smooth"}))
        ->type_name("none|smooth")
        ->default_str("none")
        ->group("What is measured");
    command
        .add_option("--kernel", options.kernel,
                    "Weight of directions; bunnell is that of the classic disk method, for "
                    "--engine disks and rays: full enclosure gives 7/8")
        ->check(one_of({"cosine", "bunnell"}))
        ->type_name("cosine|bunnell")
        ->default_str("cosine")
        ->group("What is measured");
    command
        .add_option("--ground", options.ground,
                    "An endless ground occludes too: at this height along --up, in the file's "
                    "units, or just below the lowest point; it never changes the bounding box")
        ->expected(0, 1)
        ->default_str(kLowest)
        ->type_name("[H]")
        ->group("What is measured");
}

void add_up_option(CLI::App& command, std::optional<std::string>& up, const char* group)
{
    command.add_option("--up", up, "The file's axis that points to the sky")
        ->check(one_of({"y", "z"}))
        ->type_name("y|z")
        ->default_str("y; z for --normals up")
        ->group(group);
}

void add_surface_options(CLI::App& command, SurfaceOptions& options)
{
    command
        .add_option("--normals", options.normals,
                    "Corner normals: the file's where they are usable (auto) or wherever it has "
                    "any (file), smooth within --crease, or flat. Of points: the file's or else "
                    "fitted to the neighbours (auto), the file's (file), fitted (smooth), or up "
                    "(z, or --up): 1 - occlusion is then the sky view factor")
        ->check(one_of({"auto", "file", "smooth", "flat", "up"}))
        ->type_name("auto|file|smooth|flat|up")
        ->default_str("auto")
        ->group("What is measured");
    command
        .add_option("--crease", options.crease,
                    "Degrees: faces that meet at more are not smoothed together")
        ->check(number_from(0.0, 180.0))
        ->type_name("DEG")
        ->default_str("40")
        ->group("What is measured");
    command
        .add_option("--values", options.values,
                    "fit: the values whose interpolation is nearest to the truth all over the "
                    "surface; point: the truth at the vertices themselves")
        ->check(one_of({"fit", "point"}))
        ->type_name("fit|point")
        ->default_str("fit")
        ->group("What is measured");
    command
        .add_option("--offset", options.offset,
                    "How far off the surface occlusion is asked: in the file's units, or with % of "
                    "the bounding box's diagonal (default: a hundredth of each triangle, at most "
                    "0.01%; of points, the radius of their share of the surface)")
        ->type_name("D|P%")
        ->group("What is measured");
    command
        .add_option("--viewpoint", options.viewpoint,
                    "Of points: where the scanner stood, in the file's units; normals are turned "
                    "to it (default: the file's normals or viewpoint, else where it is more open)")
        ->type_name("X:Y:Z")
        ->group("What is measured");
    command
        .add_option("--occluder-spacing", options.occluder_spacing,
                    "Of points: one in each cube of this size occludes, in the file's units, or "
                    "with % of the bounding box's diagonal (default: all, up to 20 million)")
        ->type_name("D|P%")
        ->group("What is measured");
}

bool has_any(const SurfaceOptions& options)
{
    return options.normals || options.crease || options.values || options.offset ||
           options.viewpoint || options.occluder_spacing;
}

void add_subdivide_option(CLI::App& command, std::optional<double>& tolerance)
{
    command
        .add_option("--subdivide", tolerance,
                    "Cut triangles at the middles of their edges where what is seen bends by more "
                    "than this, down to edges of 0.2% of the diagonal: coarse meshes get the "
                    "vertices that shades need. The file's own vertices come first")
        ->expected(0, 1)
        ->default_str(exact(kSubdivideTolerance))
        ->check(number_from(1e-4, 1.0))
        ->type_name("[TOL]")
        ->group("What is measured");
}

void add_color_options(CLI::App& command, ColorOptions& options)
{
    command
        .add_option("--colors", options.colors,
                    "What the vertices' colours show: grey = visibility; shaded = the file's own "
                    "colours times visibility; keep = the file's own; bent = bent normals; auto = "
                    "grey where the file has no colours and no textures, else kept (.obj, .off: "
                    "shaded)")
        ->check(one_of({"auto", "grey", "shaded", "keep", "bent"}))
        ->type_name("auto|grey|shaded|keep|bent")
        ->default_str("auto")
        ->group("What is written");
    command
        .add_option("--encoding", options.encoding,
                    "Numbers of colours: auto = as readers of the format take them (glTF linear, "
                    ".ply .obj .off sRGB)")
        ->check(one_of({"auto", "linear", "srgb"}))
        ->type_name("auto|linear|srgb")
        ->default_str("auto")
        ->group("What is written");
}

void add_thread_option(CLI::App& command, std::optional<int>& threads)
{
    command.add_option("--threads", threads, "Use at most this many cores (default: all)")
        ->check(whole_from(1, kMostThreads))
        ->type_name("N");
}

Engine engine_of(const std::string& name)
{
    for (const Engine engine : {Engine::masks, Engine::disks}) {
        if (name == name_of(engine))
            return engine;
    }
    return Engine::rays;
}

Device device_of(const std::string& name)
{
    return name == "gpu" ? Device::gpu : Device::cpu;
}

void check_device(Engine engine, Device device)
{
    refuse_unless(runs_on(engine, device), "--device gpu", "masks or disks");
}

float quality_of(const std::string& text, Engine engine)
{
    if (text == "draft")
        return kDraft;
    if (text == "good")
        return kGood;
    if (text == "best")
        return kBest;
    const std::optional<double> number = number_of(text);
    const float least = least_quality(engine);
    const float most = most_quality(engine);
    if (!number || *number < least || *number > most) {
        const std::vector<std::string> words = {"draft", "good", "best"};
        throw UsageError("--quality: \"" + text + "\" is not draft, good, best or a number from " +
                         exact(least) + " to " + exact(most) + did_you_mean(text, words, "."));
    }
    return static_cast<float>(*number);
}

EngineSettings settings_of(const EngineOptions& options)
{
    EngineSettings settings;
    if (options.engine)
        settings.engine = engine_of(*options.engine);
    const bool disks = settings.engine == Engine::disks;
    const bool rays = settings.engine == Engine::rays;
    refuse_unless(!options.quality || !rays, "--quality", "masks or disks");
    refuse_unless(!options.rays || rays, "--rays", "rays");
    refuse_unless(!options.passes || disks, "--passes", "disks");
    refuse_unless(!options.strength || disks, "--strength", "disks");

    if (options.device)
        settings.device = device_of(*options.device);
    check_device(settings.engine, settings.device);
    if (options.quality)
        settings.quality = quality_of(*options.quality, settings.engine);
    settings.rays = options.rays.value_or(settings.rays);
    settings.passes = options.passes.value_or(settings.passes);
    settings.strength = options.strength.value_or(settings.strength);
    return settings;
}

TargetSettings target_settings_of(const SurfaceOptions& options,
                                  const std::optional<std::string>& up)
{
    TargetSettings settings;
    for (const NormalSource source : {NormalSource::automatic, NormalSource::file,
                                      NormalSource::smooth, NormalSource::flat, NormalSource::up}) {
        if (options.normals == name_of(source))
            settings.normals.source = source;
    }
    settings.normals.crease = options.crease.value_or(settings.normals.crease);
    if (options.values == name_of(VertexValues::point))
        settings.values = VertexValues::point;
    if (options.offset)
        settings.offset = length_of(*options.offset, "--offset");
    if (options.viewpoint)
        settings.viewpoint = place_of(*options.viewpoint, "--viewpoint");
    if (up)
        settings.sky = axis_of(*up);
    if (options.occluder_spacing)
        settings.occluder_spacing = length_of(*options.occluder_spacing, "--occluder-spacing");
    return settings;
}

DistanceLimit distance_limit_of(const MeasureOptions& options)
{
    DistanceLimit limit;
    if (options.max_distance) {
        const Length length = length_of(*options.max_distance, "--max-distance");
        limit.percent = length.percent;
        limit.value = length.value;
    }
    if (options.falloff == "smooth") {
        if (!options.max_distance)
            throw UsageError("--falloff smooth needs --max-distance.");
        limit.falloff = Falloff::smooth;
    }
    return limit;
}

void check_kernel(Engine engine, Kernel kernel)
{
    if (!knows_kernel(engine, kernel))
        throw UsageError("--kernel bunnell is only for --engine disks or rays.");
}

VertexColors colors_of(const ColorOptions& options)
{
    for (const VertexColors colors :
         {VertexColors::grey, VertexColors::shaded, VertexColors::keep, VertexColors::bent})
        if (name_of(colors) == options.colors)
            return colors;
    return VertexColors::automatic;
}

Encoding encoding_of(const ColorOptions& options)
{
    for (const Encoding encoding : {Encoding::linear, Encoding::srgb})
        if (name_of(encoding) == options.encoding)
            return encoding;
    return Encoding::automatic;
}

Kernel kernel_of(const MeasureOptions& options)
{
    return options.kernel == "bunnell" ? Kernel::bunnell : Kernel::cosine;
}

std::optional<GroundPlane> ground_plane_of(const MeasureOptions& options,
                                           const std::optional<std::string>& up)
{
    if (!options.ground)
        return std::nullopt;
    if (kernel_of(options) != Kernel::cosine)
        throw UsageError("--ground is for --kernel cosine only.");
    GroundPlane plane;
    plane.up = axis_of(up.value_or("y"));
    if (*options.ground == kLowest)
        return plane;
    plane.height = number_of(*options.ground);
    if (!plane.height)
        throw UsageError("--ground: \"" + *options.ground + "\" is not a number.");
    return plane;
}

}  // namespace surfelao

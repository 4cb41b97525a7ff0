/// engine_options.h: the options that say what is computed, for every command that computes.
#pragma once

#include "bake/vertex_target.h"
#include "engines/engine.h"
#include "files/vertex_colors.h"

#include <glm/vec3.hpp>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
}

namespace surfelao {

/// "0.5" or "2%", above 0. Throws UsageError naming the option.
[[nodiscard]] Length length_of(std::string_view text, const std::string& option);

/// "1.5:0:-2", finite numbers. Throws UsageError naming the option.
[[nodiscard]] glm::dvec3 place_of(std::string_view text, const std::string& option);

/// What was asked for: empty where an option was not given.
struct EngineOptions {
    std::optional<std::string> engine;
    std::optional<std::string> device;
    std::optional<std::string> quality;
    std::optional<std::uint32_t> rays;
    std::optional<int> passes;
    std::optional<float> strength;
};

/// What is measured, apart from who measures it.
struct MeasureOptions {
    std::optional<std::string> max_distance;
    std::optional<std::string> falloff;
    std::optional<std::string> kernel;
    std::optional<std::string> ground;  ///< a number or "lowest"
};

/// Where it is measured: on which surface, and for which values.
struct SurfaceOptions {
    std::optional<std::string> normals;
    std::optional<float> crease;
    std::optional<std::string> values;
    std::optional<std::string> offset;
    std::optional<std::string> viewpoint;
    std::optional<std::string> occluder_spacing;
};

/// Whether any of them was given.
[[nodiscard]] bool has_any(const SurfaceOptions& options);

/// What a result's colours show.
struct ColorOptions {
    std::optional<std::string> colors;
    std::optional<std::string> encoding;
};

/// names: of the engines that may be asked.
void add_engine_options(CLI::App& command, EngineOptions& options,
                        const std::vector<std::string>& names = {"masks", "disks", "rays"});
void add_measure_options(CLI::App& command, MeasureOptions& options);

/// `--up y|z`, in this group.
void add_up_option(CLI::App& command, std::optional<std::string>& up, const char* group);

void add_surface_options(CLI::App& command, SurfaceOptions& options);

/// `--subdivide [TOL]`; without a number it is kSubdivideTolerance.
void add_subdivide_option(CLI::App& command, std::optional<double>& tolerance);

void add_color_options(CLI::App& command, ColorOptions& options);

/// Adds `--threads N`.
void add_thread_option(CLI::App& command, std::optional<int>& threads);

/// Throw UsageError for what contradicts itself; nothing is dropped silently.
[[nodiscard]] EngineSettings settings_of(const EngineOptions& options);
[[nodiscard]] DistanceLimit distance_limit_of(const MeasureOptions& options);
[[nodiscard]] TargetSettings target_settings_of(const SurfaceOptions& options,
                                                const std::optional<std::string>& up);
[[nodiscard]] VertexColors colors_of(const ColorOptions& options);
[[nodiscard]] Encoding encoding_of(const ColorOptions& options);
[[nodiscard]] Kernel kernel_of(const MeasureOptions& options);
/// up: of add_up_option().
[[nodiscard]] std::optional<GroundPlane> ground_plane_of(const MeasureOptions& options,
                                                         const std::optional<std::string>& up);

/// Throws UsageError where this engine does not know this kernel.
void check_kernel(Engine engine, Kernel kernel);

/// "draft", "good", "best", or a number in the engine's range.
[[nodiscard]] float quality_of(const std::string& text, Engine engine);
[[nodiscard]] Engine engine_of(const std::string& name);
[[nodiscard]] Device device_of(const std::string& name);

/// Throws UsageError where this engine does not run there.
void check_device(Engine engine, Device device);

}  // namespace surfelao

/// bake.h: the job: a mesh file in, the same mesh with occlusion at every vertex out.
#pragma once

#include "atlas/seams.h"
#include "bake/grid_target.h"
#include "bake/map_bake.h"
#include "bake/part_file.h"
#include "bake/point_target.h"
#include "bake/subdivide_job.h"
#include "bake/texel_layout.h"
#include "bake/vertex_bake.h"
#include "bake/vertex_target.h"
#include "bake/world.h"
#include "engines/engine.h"
#include "files/scene_io.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace surfelao {

/// A share of a bake on one machine of several.
struct BakeShare {
    Share share;
    std::vector<std::string> arguments;  ///< PartFile::arguments
};

struct BakeSettings {
    std::filesystem::path input;
    std::filesystem::path output;
    EngineSettings engine;  ///< its definition is made from the members below
    DistanceLimit max_distance;
    Kernel kernel = Kernel::cosine;
    std::optional<GroundPlane> ground = {};
    TargetSettings target;
    PartChoice parts = {};  ///< who occludes, who is baked
    /// The other files that are baked together with it (bake_together): for marks.
    std::vector<std::filesystem::path> beside = {};
    std::uint32_t check = kCheckPoints;  ///< points at which the result is measured; 0: not at all
    /// The engine is then the cheapest whose stated error lies below it (bake_to_error): > 0, and
    /// check >= 1. Of `engine` only the instructions count.
    std::optional<double> error = {};
    std::optional<TexelSettings> texels = {};  ///< a map instead of values at vertices
    std::optional<GridSettings> grid = {};     ///< an AO grid round the object instead
    /// Whether the input is a cloud of points, as the user says; empty: as it is.
    std::optional<bool> at_points = {};
    /// At vertices: the mesh is cut where what is seen bends by more (bake/subdivide.h); > 0.
    std::optional<double> subdivide = {};
    VertexColors colors = VertexColors::automatic;
    Encoding encoding = Encoding::automatic;
    ReadOptions reading = {};  ///< of the input
    /// In place of the scene's own: frames of an animation have one in common (world.h). For a
    /// single file with faces.
    std::optional<Frame> frame = {};
    /// Only this share is solved; in place of the output stands its file, part_path(output). For
    /// values at vertices by an engine on the CPU.
    std::optional<BakeShare> share = {};
    /// The answers of all shares, in place of an engine's.
    std::shared_ptr<const MergedAnswers> merged = {};
};

/// Wall-clock seconds of each stage.
struct BakeSeconds : VertexBakeSeconds {
    double read = 0.0;    ///< the file, and the clean geometry
    double points = 0.0;  ///< clouds: neighbours, normals and their sides
    double subdivide = 0.0;
    double charts = 0.0;  ///< texels: charts of our own
    double raster = 0.0;  ///< texels: which of them, and where each is asked
    double fill = 0.0;    ///< texels: those that nothing covers or nobody sees, and seams
    double repair = 0.0;  ///< grids: cells inside of the object
    double write = 0.0;   ///< the file, and the notes meanwhile
    double total = 0.0;
};

struct TexelReport {
    MapSize size;
    std::optional<std::uint32_t> uv_set;        ///< of the file; empty: charts of our own
    std::vector<std::uint32_t> tiles;           ///< UDIM
    std::vector<std::string> materials;         ///< that have a map each
    std::optional<ChartReport> charts;          ///< of our own
    std::uint64_t covered = 0;                  ///< texels
    std::uint64_t overlapping = 0;              ///< texels of several sheets: they hold the mean
    double spread = 0.0;                        ///< of these: RMS difference of a sheet to it
    std::uint64_t hidden = 0;                   ///< texels that nobody sees (hidden_texels.h)
    std::uint64_t seams = 0, smooth_seams = 0;  ///< edges of the surface (atlas/seams.h)
    SeamJump jump;                              ///< at the smooth ones
    std::uint64_t flat_triangles = 0;
    std::uint64_t outside_triangles = 0;
    std::uint64_t misses = 0;                    ///< points that met nothing of the high mesh
    std::uint64_t high_triangles = 0;            ///< 0: there is none
    std::size_t matched_parts = 0;               ///< that found high parts of their name
    std::vector<std::filesystem::path> written;  ///< but the output where it is a mesh
};

/// Of a frame of a sequence (moving_bake.h), besides BakeSeconds.
struct MotionReport {
    double pose = 0.0;         ///< seconds: from the keys to where everything is
    double place = 0.0;        ///< seconds: bodies and receivers to their places
    std::uint64_t solved = 0;  ///< receivers that were answered anew
    float bound = 0.0f;        ///< FrameReport::bound
};

struct GridReport {
    AoGrid grid;               ///< without values
    std::uint64_t inside = 0;  ///< cells that were moved out of the object
    glm::dvec3 closest{0.0};   ///< how far the closest cells are apart along each axis, in the
                               ///< file's units: thinner things leak light
    std::uint64_t bytes = 0;   ///< of the cells, as they stand in the file
};

struct BakeReport {
    BakeSettings settings;
    std::uint64_t vertices = 0;
    std::uint64_t triangles = 0;
    std::uint64_t dropped_triangles = 0;        ///< without area: they occlude nothing
    std::uint64_t baked_triangles = 0;          ///< with an area, of the parts that are baked
    std::uint64_t occluding_triangles = 0;      ///< of all files, with an area
    std::uint64_t vertices_without_normal = 0;  ///< they get occlusion 0
    std::uint64_t surfels = 0;
    int threads = 0;
    BakeSeconds seconds;
    std::uint64_t peak_rss_bytes = 0;
    std::optional<double> residual;       ///< of the disk engine's correction
    double mean_occlusion = 0.0;          ///< over vertices with a normal
    std::string ground;                   ///< where it lies, "y = -0.25"; empty: there is none
    std::uint64_t receivers = 0;          ///< where occlusion was asked
    std::uint64_t corners_from_file = 0;  ///< corners shaded with the file's normals
    std::uint64_t replaced_corners = 0;   ///< the file's were not usable there
    std::optional<Misfit> misfit;         ///< of the values at vertices, as displayed
    std::optional<StatedError> error;     ///< as displayed
    std::optional<TexelReport> texels;
    std::optional<GridReport> grid;
    std::optional<PointReport> points;
    std::optional<SubdivisionReport> subdivision;
    std::optional<MotionReport> motion;
    std::vector<Trial> trials;       ///< of settings.error
    bool is_met = false;             ///< settings.error is kept
    std::uint64_t solved = 0;        ///< of a part: receivers of its share
    std::vector<std::string> notes;  ///< bake/notes.h, then those of write_scene()
};

/// What the bake says of itself goes into the report; its values stay. Internal to bake/.
void take(const VertexBake& bake, BakeReport& report);

/// Reads, solves, writes. The output appears complete or not at all: after any exception an older
/// file is still there untouched. Throws InputError, std::runtime_error, Cancelled, and
/// SettingsError for settings that are not for such a file, as a map of points.
/// An output that cannot be written is refused before any work.
[[nodiscard]] BakeReport bake(const BakeSettings& settings, const StageProgress& progress = {});

/// What a bake without files gives: values, or a map and where the surface lies in it.
struct SceneBake {
    BakeReport report;
    std::vector<Occlusion> values;  ///< one per vertex or point of the scene
    std::optional<MapLayout> layout;
    std::optional<MapBake> map;
};

/// bake() of a scene at hand. others: they occlude too (PartChoice::occluders). Where
/// settings.output is empty, nothing is written; settings.input is for marks alone. For vertices,
/// points and maps. Throws as bake().
[[nodiscard]] SceneBake bake_scene(Scene scene, std::span<const Scene> others,
                                   const BakeSettings& settings,
                                   const StageProgress& progress = {});

/// Several files as one scene: all occlude each other, each is written by itself. Equal parts and
/// normals, which are those of the first. All are read and an engine is prepared once; what that
/// takes is told with the first. Normals are smoothed within a file. Throws as bake(), with the
/// results of earlier files written; settings with a high mesh are refused (InputError).
[[nodiscard]] std::vector<BakeReport> bake_together(const std::vector<BakeSettings>& settings,
                                                    const StageProgress& progress = {});

/// One file of a batch: done, failed (`error` says why) or, with neither, skipped.
struct BatchEntry {
    std::filesystem::path input;
    std::filesystem::path output;
    std::optional<BakeReport> report;
    std::string error;
};

/// Keys input, output, vertices, triangles, dropped_triangles, vertices_without_normal,
/// baked_triangles, occluding_triangles, surfels, engine, settings, seconds{a key for each of
/// BakeSeconds}, receivers, corners_from_file, replaced_corners, peak_rss_bytes, residual,
/// mean_occlusion, misfit{rms, share}, error, texels, grid, points, subdivision{tolerance,
/// old_vertices, old_triangles, rounds, asked}, motion{pose, place, tree, solve, fit, write,
/// solved, bound} (seconds but for the last two), part{share, shares, solved, file}, asked, notes.
/// What an engine, a target or a sequence does not have is null. Failed: input, output, error.
/// Skipped: input, output, skipped. A list of such objects for several files.
[[nodiscard]] std::string json_of(std::span<const BatchEntry> batch);

/// Where bent normals stand beside a map: "ao.bent.png" for "ao.png".
[[nodiscard]] std::filesystem::path bent_path(const std::filesystem::path& output);

/// The picture of a UDIM tile: "ao.1001.png" for "ao.png".
[[nodiscard]] std::filesystem::path tile_path(const std::filesystem::path& picture,
                                              std::uint32_t tile);

/// Where a batch puts the result for `input`: the folder and the input's name; STL, which cannot
/// hold occlusion, becomes .ply, and what is read through assimp .glb.
[[nodiscard]] std::filesystem::path output_in_folder(const std::filesystem::path& input,
                                                     const std::filesystem::path& folder);

/// The mark of the result (files/maker_mark.h): all settings on which its bytes depend, as they
/// were asked for; neither the input nor threads, but what occludes it. Of what only another engine
/// has, nothing.
///
///     surfelao 0.1.0 bake: engine=masks device=cpu quality=1 kernel=cosine max_distance=none
///     falloff=none normals=auto crease=40 values=fit colors=auto encoding=auto
[[nodiscard]] std::string mark_of(const BakeSettings& settings);

/// Whether the output exists with the mark that a bake would give it now and is not older than its
/// input, the files that occlude or are baked beside it, and those that a .gltf or .obj of these
/// refers to. Outputs are complete when they exist.
[[nodiscard]] bool is_finished(const BakeSettings& settings);

}  // namespace surfelao

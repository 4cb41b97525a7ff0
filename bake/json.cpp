// All reports as JSON: one file, since nlohmann's header takes seconds to compile.
#include "bake/bake.h"
#include "bake/compare.h"
#include "bake/frontier.h"
#include "bake/grid_job.h"
#include "bake/info.h"
#include "bake/moving_compare.h"
#include "surfels/labels.h"
#include "surfels/number_text.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <optional>
#include <span>
#include <string>

namespace surfelao {
namespace {

/// Keys in the order in which they were set.
using Json = nlohmann::ordered_json;

/// What this engine was told; settings of other engines are left out. Lengths in diagonals, null =
/// unlimited.
Json json_of(const EngineSettings& settings)
{
    const Definition& definition = settings.definition;
    Json json;
    json["device"] = settings.device == Device::gpu ? "gpu" : "cpu";
    if (settings.engine == Engine::rays) {
        json["rays"] = settings.rays;
    } else {
        json["quality"] = settings.quality;
    }
    if (settings.engine == Engine::disks) {
        json["passes"] = settings.passes;
        json["strength"] = settings.strength;
    }
    if (settings.instructions == Instructions::avx2)
        json["instructions"] = "avx2";
    json["kernel"] = definition.kernel == Kernel::cosine ? "cosine" : "bunnell";
    json["max_distance"] =
        std::isfinite(definition.max_distance) ? Json(definition.max_distance) : Json();
    json["falloff"] = definition.falloff == Falloff::none ? "none" : "smooth";
    if (const auto& ground = definition.ground)
        json["ground"] = {{"up", {ground->up.x, ground->up.y, ground->up.z}},
                          {"height", ground->height}};
    return json;
}

void add(Json& json, const TargetSettings& target)
{
    json["normals"] = name_of(target.normals.source);
    json["crease"] = target.normals.crease;
    json["values"] = name_of(target.values);
    json["offset"] = Json();
    if (target.offset)
        json["offset"] = exact(target.offset->value) + (target.offset->percent ? "%" : "");
    if (const auto& eye = target.viewpoint)
        json["viewpoint"] = {eye->x, eye->y, eye->z};
    if (const auto& spacing = target.occluder_spacing)
        json["occluder_spacing"] = exact(spacing->value) + (spacing->percent ? "%" : "");
}

Json json_of(const std::optional<Misfit>& misfit)
{
    return misfit ? Json{{"rms", misfit->rms}, {"share", misfit->share}} : Json();
}

Json json_of(const std::optional<StatedError>& error)
{
    if (!error)
        return {};
    return {{"rmse", error->rmse},
            {"low", error->low},
            {"high", error->high},
            {"bias", error->bias},
            {"p95", error->p95},
            {"floor", error->floor ? Json(*error->floor) : Json()},
            {"points", error->points},
            {"rays", error->rays},
            {"ill_defined", error->ill_defined}};
}

/// What was asked with an error, and what was tried.
Json search_json_of(const BakeReport& report)
{
    Json trials = Json::array();
    for (const Trial& trial : report.trials)
        trials.push_back({{"engine", name_of(trial.engine.engine)},
                          {"setting", setting_of(trial.engine)},
                          {"error", json_of(std::optional(trial.error))}});
    return {{"error", *report.settings.error}, {"met", report.is_met}, {"trials", trials}};
}

Json json_of(const ChartReport& charts)
{
    return {{"count", charts.count},
            {"use", charts.use},
            {"seam_length", charts.seam_length},
            {"mean_stretch", charts.mean_stretch},
            {"largest_stretch", charts.largest_stretch},
            {"texels_per_unit", charts.texels_per_unit}};
}

Json json_of(const BakeReport& report, const TexelReport& texels)
{
    Json written = Json::array();
    for (const std::filesystem::path& path : texels.written)
        written.push_back(path.string());
    return {{"size", texels.size.width},
            {"padding", report.settings.texels->padding},
            {"uv_set", texels.uv_set ? Json(*texels.uv_set) : Json()},
            {"tiles", texels.tiles},
            {"materials", texels.materials},
            {"charts", texels.charts ? json_of(*texels.charts) : Json()},
            {"misses", texels.misses},
            {"high_triangles", texels.high_triangles},
            {"matched_parts", texels.matched_parts},
            {"covered", texels.covered},
            {"overlapping", texels.overlapping},
            {"spread", texels.spread},
            {"hidden", texels.hidden},
            {"seams",
             {{"count", texels.seams},
              {"smooth", texels.smooth_seams},
              {"jump_rms", texels.jump.rms},
              {"jump_max", texels.jump.most}}},
            {"flat_triangles", texels.flat_triangles},
            {"outside_triangles", texels.outside_triangles},
            {"written", written}};
}

Json json_of(const PointReport& points)
{
    const PointCounts& counts = points.counts;
    return {{"occluders", points.occluders},
            {"spacing", points.spacing},
            {"thinned_to", points.thinned_to ? Json(*points.thinned_to) : Json()},
            {"noise", points.noise},
            {"flattened", points.is_flattened},
            {"orientation", name_of(points.orientation)},
            {"normals_from_file", counts.from_file},
            {"without_normal", counts.without_normal},
            {"duplicates", counts.duplicates},
            {"thinned", counts.thinned},
            {"outliers", counts.outliers},
            {"uneven", counts.uneven},
            {"weak", counts.weak}};
}

Json json_of(const PartChoice& parts)
{
    Json occluders = Json::array();
    for (const std::filesystem::path& file : parts.occluders)
        occluders.push_back(file.string());
    return {{"exclude", parts.exclude},
            {"receivers", parts.receivers},
            {"occluders", occluders},
            {"transparent", name_of(parts.clear)}};
}

Json json_of(const BakeReport& report, const GridReport& told)
{
    const GridSettings& settings = *report.settings.grid;
    const AoGrid& grid = told.grid;
    const auto list = [](auto v) { return Json{v.x, v.y, v.z}; };
    return {{"cells", list(grid.cells)},
            {"box", {{"low", list(grid.low)}, {"high", list(grid.high)}}},
            {"closest_cells", list(told.closest)},
            {"extent", settings.extent},
            {"uniform", settings.uniform},
            {"store", name_of(grid.store)},
            {"border", name_of(grid.border)},
            {"border_value", grid.border_value},
            {"inside", told.inside},
            {"depth", settings.depth == MapDepth::byte ? 8 : 16},
            {"bytes", told.bytes}};
}

Json json_of(const BakeReport& report, const SubdivisionReport& subdivision)
{
    return {{"tolerance", *report.settings.subdivide},
            {"old_vertices", subdivision.old_vertices},
            {"old_triangles", subdivision.old_triangles},
            {"rounds", subdivision.rounds},
            {"asked", subdivision.asked}};
}

Json json_of(const BatchEntry& entry)
{
    Json json;
    json["input"] = entry.input.string();
    json["output"] = entry.output.string();
    if (!entry.report) {
        if (entry.error.empty())
            json["skipped"] = true;
        else
            json["error"] = entry.error;
        return json;
    }
    const BakeReport& report = *entry.report;
    const BakeSeconds& seconds = report.seconds;
    json["vertices"] = report.vertices;
    json["triangles"] = report.triangles;
    json["dropped_triangles"] = report.dropped_triangles;
    json["vertices_without_normal"] = report.vertices_without_normal;
    json["baked_triangles"] = report.baked_triangles;
    json["occluding_triangles"] = report.occluding_triangles;
    json["surfels"] = report.motion ? Json() : Json(report.surfels);  // each body has its own
    json["engine"] = name_of(report.settings.engine.engine);
    json["settings"] = json_of(report.settings.engine);
    json["settings"]["threads"] = report.threads;
    add(json["settings"], report.settings.target);
    json["settings"]["parts"] = json_of(report.settings.parts);
    json["settings"]["beside"] = Json::array();
    for (const std::filesystem::path& file : report.settings.beside)
        json["settings"]["beside"].push_back(file.string());
    json["settings"]["colors"] = name_of(report.settings.colors);
    json["settings"]["encoding"] = name_of(report.settings.encoding);
    json["seconds"] = {
        {"read", seconds.read},     {"points", seconds.points}, {"subdivide", seconds.subdivide},
        {"charts", seconds.charts}, {"raster", seconds.raster}, {"surfels", seconds.surfels},
        {"tree", seconds.tree},     {"solve", seconds.solve},   {"fit", seconds.fit},
        {"fill", seconds.fill},     {"repair", seconds.repair}, {"check", seconds.check},
        {"write", seconds.write},   {"total", seconds.total}};
    json["receivers"] = report.receivers;
    json["corners_from_file"] = report.corners_from_file;
    json["replaced_corners"] = report.replaced_corners;
    json["peak_rss_bytes"] = report.peak_rss_bytes;
    json["residual"] = report.residual ? Json(*report.residual) : Json();
    json["mean_occlusion"] = report.mean_occlusion;
    json["misfit"] = json_of(report.misfit);
    json["error"] = json_of(report.error);
    json["texels"] = report.texels ? json_of(report, *report.texels) : Json();
    json["grid"] = report.grid ? json_of(report, *report.grid) : Json();
    json["points"] = report.points ? json_of(*report.points) : Json();
    json["subdivision"] = report.subdivision ? json_of(report, *report.subdivision) : Json();
    json["motion"] = Json();
    if (const auto& motion = report.motion)
        json["motion"] = {{"pose", motion->pose},     {"place", motion->place},
                          {"tree", seconds.tree},     {"solve", seconds.solve},
                          {"fit", seconds.fit},       {"write", seconds.write},
                          {"solved", motion->solved}, {"bound", motion->bound}};
    json["part"] = Json();
    if (const auto& part = report.settings.share)
        json["part"] = {{"share", part->share.index + 1},
                        {"shares", part->share.count},
                        {"solved", report.solved},
                        {"file", part_path(report.settings.output, part->share).string()}};
    json["asked"] = report.settings.error ? search_json_of(report) : Json();
    json["notes"] = report.notes;
    return json;
}

Json json_of(const std::optional<EmbreeRatio>& ratio)
{
    return ratio ? Json(ratio->ratio) : Json();
}

Json json_of(const ErrorStatistics& error)
{
    return {{"rmse", error.rmse},
            {"bias", error.bias},
            {"p95", error.p95},
            {"max", error.max},
            {"bent_mean_deg", error.bent_mean_deg},
            {"bent_p95_deg", error.bent_p95_deg}};
}

/// A map holds no bent normals: null.
void without_bent(Json& error)
{
    error["bent_mean_deg"] = error["bent_p95_deg"] = nullptr;
}

Json json_of(const Comparison& comparison, const CompareRow& row)
{
    Json worst = Json::array();
    for (const WorstPoint& point : row.worst) {
        worst.push_back({{"triangle", point.triangle},
                         {"position", {point.position.x, point.position.y, point.position.z}},
                         {"displayed", point.displayed},
                         {"reference", point.reference}});
    }
    Json seen = json_of(row.seen);
    if (comparison.texels)
        without_bent(seen);
    return {{"engine", name_of(row.settings.engine)},
            {"setting", setting_of(row.settings)},
            {"settings", json_of(row.settings)},
            {"rounds", row.rounds},
            {"raster_s", row.raster_s},
            {"build_s", row.build_s},
            {"solve_s", row.solve_s},
            {"fit_s", row.fit_s},
            {"fill_s", row.fill_s},
            {"us_per_receiver", row.us_per_receiver},
            {"seen", seen},
            {"solve", json_of(row.solve)},
            {"beyond", row.beyond},
            {"beyond_by_squares", beyond_by_squares(comparison, row)},
            {"embree_ratio", json_of(row.ratio)},
            {"embree_ratio_with_builds", json_of(row.ratio_with_builds)},
            {"extrapolated", row.ratio && row.ratio->extrapolated},
            {"worst", worst}};
}

Json json_object_of(const Comparison& comparison)
{
    Json json;
    json["input"] = comparison.input.string();
    json["vertices"] = comparison.vertices;
    json["triangles"] = comparison.triangles;
    json["dropped_triangles"] = comparison.dropped_triangles;
    json["receivers"] = comparison.receivers;
    json["cloud"] = comparison.points_report ? json_of(*comparison.points_report) : Json();
    json["threads"] = comparison.threads;
    json["rounds"] = comparison.rounds;
    json["read_s"] = comparison.read_s;
    json["target"] = Json::object();
    add(json["target"], comparison.target);
    json["target"]["subdivide"] = comparison.subdivide ? Json(*comparison.subdivide) : Json();
    if (comparison.texels) {
        json["target"]["values"] = nullptr;
        json["target"]["texels"] = {
            {"width", comparison.page.width},
            {"height", comparison.page.height},
            {"pages", comparison.pages},
            {"uv_set", comparison.uv_set ? Json(*comparison.uv_set) : Json()},
            {"padding", comparison.texels->padding}};
    } else {
        json["target"]["texels"] = nullptr;
    }
    json["reference"] = {{"rays", comparison.reference_rays},
                         {"noise", comparison.reference_noise},
                         {"from_cache", comparison.reference_from_cache},
                         {"points", comparison.points},
                         {"ill_defined", comparison.ill_defined},
                         {"hidden", comparison.hidden}};
    json["floor"] = json_of(comparison.floor);
    if (comparison.texels)
        without_bent(json["floor"]);
    json["floor"]["rays"] = comparison.floor_rays;
    json["floor"]["noise"] = comparison.floor_noise;
    json["rows"] = Json::array();
    for (const CompareRow& row : comparison.rows)
        json["rows"].push_back(json_of(comparison, row));
    return json;
}

Json json_of(const RatioSummary& summary)
{
    if (!stands_for_all(summary)) {
        return {{"median_ratio", nullptr},  {"worst_ratio", nullptr},
                {"best_ratio", nullptr},    {"quartiles", nullptr},
                {"scenes", summary.scenes}, {"left_out", summary.left_out}};
    }
    return {{"median_ratio", summary.median},
            {"worst_ratio", summary.worst},
            {"best_ratio", summary.best},
            {"quartiles", {summary.low_quartile, summary.high_quartile}},
            {"scenes", summary.scenes},
            {"left_out", summary.left_out}};
}

/// at_010 and at_005, filled by what `value` gives for (beyond, cost), and the same with builds and
/// with files.
template <class Value>
Json by_target(const Value& value)
{
    const auto targets = [&](Cost cost) {
        return Json{{"at_010", value(kTargets[0], cost)}, {"at_005", value(kTargets[1], cost)}};
    };
    Json json = targets(Cost::solve);
    json["with_builds"] = targets(Cost::build);
    json["with_files"] = targets(Cost::file);
    return json;
}

}  // namespace

std::string json_of(std::span<const BatchEntry> batch)
{
    Json list = Json::array();
    for (const BatchEntry& entry : batch)
        list.push_back(json_of(entry));
    return (batch.size() == 1 ? list.front() : list).dump(2) + '\n';
}

std::string json_of(const Info& info)
{
    const Topology& topology = info.topology;
    Json parts = Json::array();
    for (const Part& part : info.parts) {
        parts.push_back({{"name", part.name},
                         {"vertices", part.vertex_count},
                         {"triangles", part.triangle_count}});
    }
    Json labels = Json::array();
    for (const Label& label : info.labels)
        labels.push_back({{"kind", name_of(label.kind)},
                          {"name", label.name},
                          {"triangles", triangle_count(label)}});
    Json uvs = Json::array();
    for (const UvReport& report : info.uvs) {
        uvs.push_back({{"set", report.set},
                       {"triangles", report.triangles},
                       {"flat", report.flat},
                       {"outside", report.outside},
                       {"sheets", report.sheets},
                       {"overlap", report.overlap ? Json(*report.overlap) : Json()}});
    }
    const auto point = [](glm::dvec3 p) { return Json{p.x, p.y, p.z}; };
    const Json json = {{"input", info.input.string()},
                       {"vertices", info.vertices},
                       {"positions", info.positions},
                       {"triangles", info.triangles},
                       {"dropped_triangles", info.dropped_triangles},
                       {"duplicate_triangles", topology.duplicate_triangle_count},
                       {"unused_vertices", info.unused_vertices},
                       {"vertices_without_normal", info.vertices_without_normal},
                       {"normals_in_file", info.normals_in_file},
                       {"corners_from_file", info.corners_from_file},
                       {"replaced_corners", info.replaced_corners},
                       {"uvs", uvs},
                       {"points", info.points ? json_of(*info.points) : Json()},
                       {"receivers", info.receivers},
                       {"ill_defined", info.ill_defined},
                       {"examined", info.examined},
                       {"components", topology.component_count},
                       {"closed_components", topology.closed_component_count},
                       {"boundary_edges", topology.boundary_edge_count},
                       {"nonmanifold_edges", topology.nonmanifold_edge_count},
                       {"misoriented_edges", topology.misoriented_edge_count},
                       {"complex_triangles", info.half_edges.complex_triangle_count},
                       {"holes", info.half_edges.hole_count},
                       {"largest_hole_edges", info.half_edges.largest_hole_edges},
                       {"handles", info.half_edges.handle_count},
                       {"low", point(info.low)},
                       {"high", point(info.high)},
                       {"diagonal", info.diagonal},
                       {"area", info.area},
                       {"inward_pieces", topology.inward_count},
                       {"mean_occlusion", info.mean_occlusion},
                       {"misfit", json_of(info.misfit)},
                       {"notes", info.notes},
                       {"parts", parts},
                       {"labels", labels}};
    return json.dump(2) + '\n';
}

std::string json_of(const Comparison& comparison)
{
    return json_object_of(comparison).dump(2) + '\n';
}

std::string json_of(const Frontier& frontier)
{
    const auto summary = [&](Engine engine) {
        return by_target([&](double beyond, Cost cost) {
            return json_of(summary_of(frontier, engine, beyond, cost));
        });
    };
    Json json;
    json["summary"] = summary(frontier.engines.front());
    json["summary"]["engine"] = name_of(frontier.engines.front());
    for (const Engine engine : frontier.engines)
        json["summary_of_engines"][name_of(engine)] = summary(engine);
    json["scenes"] = Json::array();
    for (const FrontierScene& scene : frontier.scenes) {
        if (!scene.comparison) {
            json["scenes"].push_back({{"input", scene.input.string()}, {"error", scene.error}});
            continue;
        }
        Json entry = json_object_of(*scene.comparison);
        for (const Engine engine : frontier.engines) {
            entry["ratios"][name_of(engine)] = by_target([&](double beyond, Cost cost) {
                const auto ratio = ratio_at(*scene.comparison, engine, beyond, cost);
                return ratio ? Json{{"ratio", ratio->ratio}, {"extrapolated", ratio->extrapolated}}
                             : Json();
            });
        }
        json["scenes"].push_back(entry);
    }
    return json.dump(2) + '\n';
}

std::string json_of(const MovingComparison& comparison)
{
    Json rows = Json::array();
    for (const MovingRow& row : comparison.rows)
        rows.push_back({{"engine", name_of(row.engine.engine)},
                        {"setting", setting_of(row.engine)},
                        {"smoothed", row.is_smoothed},
                        {"rmse", row.rmse},
                        {"bias", row.bias},
                        {"p95", row.p95},
                        {"max", row.max},
                        {"flicker", {{"rms", row.flicker_rms}, {"max", row.flicker_max}}},
                        {"untouched_max", row.untouched_max},
                        {"ms",
                         {{"place", row.place_ms},
                          {"tree", row.tree_ms},
                          {"solve", row.solve_ms},
                          {"fit", row.fit_ms},
                          {"frame", row.total_ms()}}},
                        {"solved", row.solved},
                        {"rmse_by_frame", row.rmse_by_frame}});
    const Json json = {{"input", comparison.settings.input.string()},
                       {"animation", comparison.animation},
                       {"seconds", comparison.settings.seconds},
                       {"vertices", comparison.vertices},
                       {"triangles", comparison.triangles},
                       {"bodies", comparison.bodies},
                       {"receivers", comparison.receivers},
                       {"points", comparison.points},
                       {"still_points", comparison.still_points},
                       {"untouched", comparison.untouched},
                       {"reference_rays", comparison.settings.reference_rays},
                       {"pose_ms", comparison.pose_ms},
                       {"threads", comparison.threads},
                       {"rows", rows}};
    return json.dump(2) + '\n';
}

std::string grid_notes_of(const BakeReport& report)
{
    const BakeSettings& settings = report.settings;
    Json json;
    json["source"] = settings.input.filename().string();
    json["parts"] = json_of(settings.parts);
    json["engine"] = name_of(settings.engine.engine);
    json["settings"] = json_of(settings.engine);
    json["extent"] = settings.grid->extent;
    json["uniform"] = settings.grid->uniform;
    json["inside"] = report.grid->inside;
    json["error"] = json_of(report.error);
    return json.dump();
}

}  // namespace surfelao

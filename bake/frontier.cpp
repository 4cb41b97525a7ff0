#include "bake/frontier.h"

#include "bake/compare_text.h"
#include "bake/picture.h"
#include "bake/table.h"
#include "surfels/errors.h"
#include "surfels/number_text.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace surfelao {
namespace {

constexpr int kPictureWidth = 400, kPictureHeight = 300;
constexpr std::uint32_t kMapSide = 512;

/// Settings of one engine from coarse to fine: its family, the same for every scene.
std::vector<float> qualities_of(Engine engine)
{
    std::vector<float> qualities = {0.0f, 0.5f, 1.0f, 1.5f, 2.0f};
    if (engine == Engine::masks) {
        qualities.insert(qualities.begin(), least_quality(engine));
        qualities.push_back(3.0f);
    }
    return qualities;
}

/// The pages of a map side by side: of so many texels in each direction one, where they are more
/// than a picture shows.
Picture draw_texels(const Comparison& comparison, const std::vector<Rgb>& colors)
{
    const auto [width, height] = comparison.page;
    const std::size_t step = (std::max(width, height) + kMapSide - 1) / kMapSide;
    const std::size_t columns = (width + step - 1) / step, rows = (height + step - 1) / step;
    Picture picture;
    picture.width = static_cast<int>(columns * comparison.pages);
    picture.height = static_cast<int>(rows);
    for (std::size_t y = 0; y < rows; ++y)
        for (std::size_t page = 0; page < comparison.pages; ++page)
            for (std::size_t x = 0; x < columns; ++x)
                picture.pixels.push_back(colors[(page * height + y * step) * width + x * step]);
    return picture;
}

/// colors: one per point.
Picture draw_points(const PointTarget& target, const std::vector<Rgb>& colors)
{
    std::vector<Rgb> corners;
    for (const std::uint32_t point : target.cloud.occluders)
        corners.insert(corners.end(), 4, colors[point]);
    return draw_vertices(target.squares, corners, kPictureWidth, kPictureHeight);
}

/// What the floor's values look like, and how far from them each engine's are at `good`.
std::vector<ReportPicture> pictures_of(const Comparison& comparison)
{
    std::vector<ReportPicture> pictures;
    const auto add = [&](std::string caption, const std::vector<Rgb>& colors) {
        const bool is_error = !pictures.empty();  // visibility comes first
        pictures.push_back(
            {std::move(caption),
             png_of(comparison.texels  ? draw_texels(comparison, colors)
                    : comparison.cloud ? draw_points(*comparison.cloud, colors)
                                       : draw_vertices(comparison.mesh->geometry, colors,
                                                       kPictureWidth, kPictureHeight)),
             is_error});
    };
    std::vector<Rgb> colors;
    for (const float occlusion : comparison.reference) {
        const auto grey = static_cast<std::uint8_t>(std::lround(255.0f * (1.0f - occlusion)));
        colors.push_back({grey, grey, grey});
    }
    add(comparison.texels ? "visibility by rays" : "visibility by rays, fitted", colors);
    for (const CompareRow& row : comparison.rows) {
        if (row.errors.empty() || row.settings.quality != kGood)
            continue;
        colors.clear();
        for (const float error : row.errors)
            colors.push_back(error_color(error, kFullColorError));
        add("error of " + name_of(row.settings.engine) + ", " + setting_of(row.settings), colors);
    }
    return pictures;
}

}  // namespace

double seconds_of(const Comparison& comparison, const CompareRow& row, Cost cost)
{
    double seconds = job_seconds(row, cost != Cost::solve);
    if (cost == Cost::file)
        seconds += comparison.read_s + row.raster_s;
    return seconds;
}

bool stands_for_all(const RatioSummary& summary)
{
    return summary.scenes > 0 && summary.scenes >= 2 * summary.left_out;
}

std::string scenes_text(const RatioSummary& summary)
{
    return std::to_string(summary.scenes) + " of " +
           std::to_string(summary.scenes + summary.left_out);
}

std::optional<EmbreeRatio> ratio_at(const Comparison& comparison, Engine engine, double beyond,
                                    Cost cost)
{
    std::vector<CurvePoint> ours, theirs;
    for (const CompareRow& row : comparison.rows) {
        const CurvePoint point{row.beyond, seconds_of(comparison, row, cost)};
        if (is_opponent(row))
            theirs.push_back(point);
        else if (row.settings.engine == engine)
            ours.push_back(point);
    }
    const std::optional<CurveTime> their_time = time_at(theirs, beyond);
    const std::optional<CurveTime> our_time = time_at(ours, beyond);
    if (!their_time || !our_time)
        return std::nullopt;
    return EmbreeRatio{their_time->seconds / our_time->seconds,
                       their_time->extrapolated || our_time->extrapolated};
}

RatioSummary summary_of(const Frontier& frontier, Engine engine, double beyond, Cost cost)
{
    RatioSummary summary;
    std::vector<double> ratios;
    for (const FrontierScene& scene : frontier.scenes) {
        if (!scene.comparison)
            continue;
        const std::optional<EmbreeRatio> ratio = ratio_at(*scene.comparison, engine, beyond, cost);
        if (ratio && !ratio->extrapolated)
            ratios.push_back(ratio->ratio);
        else
            ++summary.left_out;
    }
    summary.scenes = ratios.size();
    if (ratios.empty())
        return summary;
    summary.median = quantile(ratios, 0.5);
    summary.low_quartile = quantile(ratios, 0.25);
    summary.high_quartile = quantile(ratios, 0.75);
    summary.worst = quantile(ratios, 0.0);
    summary.best = quantile(ratios, 1.0);
    return summary;
}

FrontierScene frontier_scene(Comparison comparison)
{
    FrontierScene scene;
    scene.input = comparison.input;
    scene.pictures = pictures_of(comparison);
    comparison.mesh = nullptr;
    comparison.cloud = nullptr;
    comparison.reference = {};
    for (CompareRow& row : comparison.rows)
        row.errors = {};
    scene.comparison = std::move(comparison);
    return scene;
}

Frontier frontier(const FrontierSettings& settings, const StageProgress& progress)
{
    CompareSettings compare_settings = settings.compare;
    compare_settings.candidates.clear();
    for (const Engine engine : settings.engines) {
        for (const float quality : qualities_of(engine)) {
            EngineSettings& candidate = compare_settings.candidates.emplace_back();
            candidate.engine = engine;
            candidate.quality = quality;
        }
    }
    compare_settings.rays = {1, 2, 4, 16, 64, 256};
    if (!compare_settings.texels)  // of maps once, where it is needed (compare())
        compare_settings.rays.push_back(1024);

    Frontier result;
    result.engines = settings.engines;
    for (const std::filesystem::path& input : settings.inputs) {
        compare_settings.input = input;
        StageProgress named;
        if (progress) {
            named = [&](std::string_view stage, double done) {
                return progress(input.filename().string() + " " + std::string(stage), done);
            };
        }
        try {
            result.scenes.push_back(frontier_scene(compare(compare_settings, named)));
        } catch (const Cancelled&) {
            throw;
        } catch (const std::exception& error) {
            result.scenes.emplace_back().input = input;
            result.scenes.back().error = error.what();
        }
    }
    return result;
}

std::string csv_of(const Frontier& frontier)
{
    std::string text = csv_head();
    for (const FrontierScene& scene : frontier.scenes) {
        if (scene.comparison)
            text += csv_rows_of(*scene.comparison);
    }
    return text;
}

std::string table_of(const Frontier& frontier)
{
    Table table({"scene", "engine", "points", "ill-defined", "floor", "seen good", "solve good",
                 "beyond good", "0.010 solve", "0.005 solve", "0.010 +build", "0.005 +build",
                 "0.010 +file", "0.005 +file"});
    const auto each_ratio = [](std::vector<std::string> cells, const auto& text) {
        for (const Cost cost : {Cost::solve, Cost::build, Cost::file}) {
            for (const double beyond : kTargets)
                cells.push_back(text(beyond, cost));
        }
        return cells;
    };
    std::string failures;
    for (const FrontierScene& scene : frontier.scenes) {
        if (!scene.comparison) {
            failures += scene.error + '\n';
            continue;
        }
        for (const Engine engine : frontier.engines) {
            const Comparison& comparison = *scene.comparison;
            std::vector<std::string> cells = {
                scene.input.filename().string(), name_of(engine), std::to_string(comparison.points),
                std::to_string(comparison.ill_defined), fixed(comparison.floor.rmse, 4)};
            const auto& rows = comparison.rows;
            const auto good = std::ranges::find_if(rows, [&](const CompareRow& row) {
                return row.settings.engine == engine && row.settings.quality == kGood;
            });
            const bool found = good != rows.end();
            cells.push_back(found ? fixed(good->seen.rmse, 4) : "-");
            cells.push_back(found ? fixed(good->solve.rmse, 4) : "-");
            cells.push_back(found ? fixed(good->beyond, 4) : "-");
            table.add(each_ratio(std::move(cells), [&](double beyond, Cost cost) {
                return text_of(ratio_at(comparison, engine, beyond, cost));
            }));
        }
    }
    for (const Engine engine : frontier.engines) {
        const auto line = [&](const std::string& name, const auto& text) {
            table.add(each_ratio({name, name_of(engine), "", "", "", "", "", ""},
                                 [&](double beyond, Cost cost) {
                                     return text(summary_of(frontier, engine, beyond, cost));
                                 }));
        };
        line("reached on", scenes_text);
        for (const auto& [name, value] :
             {std::pair("MEDIAN", &RatioSummary::median),
              std::pair("lower quartile", &RatioSummary::low_quartile),
              std::pair("upper quartile", &RatioSummary::high_quartile),
              std::pair("worst", &RatioSummary::worst), std::pair("best", &RatioSummary::best)}) {
            line(name, [member = value](const RatioSummary& summary) {
                return stands_for_all(summary) ? fixed(summary.*member, 2) : std::string("-");
            });
        }
    }
    return "Embree's time over ours for the same job at equal error beyond the floor, 0.010 and "
           "0.005\n(* = extrapolated, left out of the summary, which needs two of three "
           "scenes)\n\n" +
           table.text() + failures;
}

}  // namespace surfelao

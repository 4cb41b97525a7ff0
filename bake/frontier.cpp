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

double seconds_of(const Comparison& comparison, const CompareRow& row, Cost cost)
{
    double seconds = row.solve_s;
    if (cost != Cost::solve)
        seconds += row.build_s;
    if (cost == Cost::file)
        seconds += comparison.read_s;
    return seconds;
}

/// The most exact answers' error, and what the reference looks like.
std::vector<std::pair<std::string, std::string>> pictures_of(const Comparison& comparison)
{
    const Geometry& geometry = comparison.mesh->geometry;
    std::vector<std::pair<std::string, std::string>> pictures;
    const auto add = [&](std::string caption, const std::vector<Rgb>& colors) {
        pictures.emplace_back(
            std::move(caption),
            png_of(draw_vertices(geometry, colors, kPictureWidth, kPictureHeight)));
    };
    std::vector<Rgb> colors;
    for (const float occlusion : comparison.reference) {
        const float visibility = std::isnan(occlusion) ? 0.5f : 1.0f - occlusion;
        const auto grey = static_cast<std::uint8_t>(std::lround(255.0f * visibility));
        colors.push_back({grey, grey, grey});
    }
    add("visibility by rays", colors);
    for (const CompareRow& row : comparison.rows) {
        if (row.errors.empty() || row.settings.quality != kGood)
            continue;
        colors.clear();
        for (const float error : row.errors)
            colors.push_back(error_color(error, kFullColorError));
        add("error of " + name_of(row.settings.engine) + ", " + setting_of(row), colors);
    }
    return pictures;
}

}  // namespace

std::optional<EmbreeRatio> ratio_at(const Comparison& comparison, Engine engine, double rmse,
                                    Cost cost)
{
    std::vector<CurvePoint> ours, theirs;
    for (const CompareRow& row : comparison.rows) {
        const CurvePoint point{row.error.rmse, seconds_of(comparison, row, cost)};
        if (is_opponent(row))
            theirs.push_back(point);
        else if (row.settings.engine == engine)
            ours.push_back(point);
    }
    const std::optional<CurveTime> their_time = time_at(theirs, rmse);
    const std::optional<CurveTime> our_time = time_at(ours, rmse);
    if (!their_time || !our_time)
        return std::nullopt;
    return EmbreeRatio{their_time->seconds / our_time->seconds,
                       their_time->extrapolated || our_time->extrapolated};
}

RatioSummary summary_of(const Frontier& frontier, Engine engine, double rmse, Cost cost)
{
    RatioSummary summary;
    std::vector<double> ratios;
    for (const FrontierScene& scene : frontier.scenes) {
        if (!scene.comparison)
            continue;
        const std::optional<EmbreeRatio> ratio = ratio_at(*scene.comparison, engine, rmse, cost);
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
    compare_settings.rays = {4, 16, 64, 256, 1024};
    compare_settings.smoothed_rays = {4, 16, 64, 256};

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
    Table table({"scene", "engine", "vertices", "RMSE good", "0.010 solve", "0.005 solve",
                 "0.010 +build", "0.005 +build", "0.010 +file", "0.005 +file"});
    const auto each_ratio = [](std::vector<std::string> cells, const auto& text) {
        for (const Cost cost : {Cost::solve, Cost::build, Cost::file}) {
            for (const double rmse : kTargets)
                cells.push_back(text(rmse, cost));
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
            std::string good = "-";
            for (const CompareRow& row : scene.comparison->rows) {
                if (row.settings.engine == engine && row.settings.quality == kGood)
                    good = fixed(row.error.rmse, 4);
            }
            table.add(each_ratio({scene.input.filename().string(), name_of(engine),
                                  std::to_string(scene.comparison->vertices), good},
                                 [&](double rmse, Cost cost) {
                                     return text_of(
                                         ratio_at(*scene.comparison, engine, rmse, cost));
                                 }));
        }
    }
    for (const Engine engine : frontier.engines) {
        const auto line = [&](const std::string& name, double RatioSummary::*value) {
            table.add(each_ratio({name, name_of(engine), "", ""}, [&](double rmse, Cost cost) {
                const RatioSummary summary = summary_of(frontier, engine, rmse, cost);
                return summary.scenes > 0 ? fixed(summary.*value, 2) : "-";
            }));
        };
        line("MEDIAN", &RatioSummary::median);
        line("lower quartile", &RatioSummary::low_quartile);
        line("upper quartile", &RatioSummary::high_quartile);
        line("worst", &RatioSummary::worst);
        line("best", &RatioSummary::best);
    }
    return "Embree's time over ours at equal RMSE (* = extrapolated, left out of the summary)\n\n" +
           table.text() + failures;
}

}  // namespace surfelao

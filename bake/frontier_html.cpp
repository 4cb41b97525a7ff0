#include "bake/compare_text.h"
#include "bake/frontier.h"
#include "bake/html.h"
#include "bake/plot.h"
#include "files/maker_mark.h"
#include "image/color_map.h"
#include "surfels/number_text.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace surfelao {
namespace {

/// A time or an error with three digits that count: "0.0250", "2.20", "156".
std::string rounded(double value)
{
    const double size = std::fabs(value);
    const int before_point = size > 0.0 ? static_cast<int>(std::floor(std::log10(size))) + 1 : 1;
    return fixed(value, std::clamp(3 - before_point, 0, 7));
}

/// Rays are the opponent.
std::string shown_name(const CompareRow& row)
{
    return is_opponent(row) ? "Embree" : name_of(row.settings.engine);
}

/// To be found in the scene, no more.
std::string place_text(const glm::dvec3& place)
{
    constexpr int kPlaceDigits = 6;
    return significant(place.x, kPlaceDigits) + ", " + significant(place.y, kPlaceDigits) + ", " +
           significant(place.z, kPlaceDigits);
}

/// "64" of 64 rays, "0.5" of quality 0.5: short enough to stand at a point.
std::string point_label(const EngineSettings& settings)
{
    if (settings.engine == Engine::rays)
        return std::to_string(settings.rays);
    const std::string setting = setting_of(settings);
    constexpr std::string_view kWord = "quality ";
    return setting.starts_with(kWord) ? setting.substr(kWord.size()) : setting;
}

/// Lower left is better. Rows without an error beyond the floor, or without a time, have no place.
std::optional<Plot> plot_of(const Comparison& comparison, Cost cost)
{
    const bool is_map = comparison.texels.has_value();
    Plot plot;
    plot.title = comparison.input.filename().string() +
                 (cost == Cost::solve ? ": error against time of solving"
                                      : ": error against time of the whole job");
    plot.x_title = std::string(cost == Cost::solve ? "seconds: solve and "
                                                   : "seconds: read, build, solve and ") +
                   (is_map ? "fill" : "fit");
    plot.y_title = "RMS error beyond the floor";
    for (const CompareRow& row : comparison.rows) {
        const std::string name = shown_name(row);
        const double seconds = seconds_of(comparison, row, cost);
        if (!(row.beyond > 0.0) || !(seconds > 0.0))
            continue;
        auto line = std::ranges::find(plot.lines, name, &PlotLine::name);
        if (line == plot.lines.end())
            line = plot.lines.insert(line, {name, {}});
        line->points.push_back({seconds, row.beyond, point_label(row.settings)});
    }
    return plot.lines.empty() ? std::nullopt : std::optional(std::move(plot));
}

std::string plots_html(const Comparison& comparison)
{
    const std::string name = comparison.input.stem().string();
    std::string html = "<div class=\"plots\">\n";
    for (const auto& [cost, kind] :
         {std::pair(Cost::solve, "-solve"), std::pair(Cost::file, "-job")}) {
        const std::optional<Plot> plot = plot_of(comparison, cost);
        if (!plot)
            return "<p>No errors to plot: nobody has any beyond the floor.</p>\n";
        html += plot_html(*plot, name + kind);
    }
    return html + "</div>\n";
}

std::string rows_html(const Comparison& comparison)
{
    const bool is_map = comparison.texels.has_value();
    std::vector<std::vector<std::string>> rows;
    for (const CompareRow& row : comparison.rows) {
        rows.push_back({shown_name(row), setting_of(row.settings), rounded(row.build_s),
                        rounded(row.solve_s), rounded(is_map ? row.fill_s : row.fit_s),
                        rounded(seconds_of(comparison, row, Cost::file)),
                        rounded(row.us_per_receiver), rounded(row.seen.rmse),
                        signed_fixed(row.seen.bias, 4), rounded(row.seen.p95),
                        rounded(row.seen.max), bent_text(comparison, row.seen.bent_mean_deg),
                        bent_text(comparison, row.seen.bent_p95_deg), rounded(row.solve.rmse),
                        rounded(row.solve.max), rounded(row.beyond), text_of(row.ratio),
                        text_of(row.ratio_with_builds)});
    }
    return table_html(
        {"engine", "setting", "build s", "solve s", is_map ? "fill s" : "fit s", "whole job s",
         "µs/receiver", "seen RMSE", "bias", "p95", "max", "bent mean °", "bent p95 °",
         "solve RMSE", "solve max", "beyond", "Embree/ours", "with builds"},
        rows);
}

std::string worst_html(const Comparison& comparison)
{
    std::vector<std::vector<std::string>> rows;
    for (const CompareRow& row : comparison.rows) {
        if (is_opponent(row) || row.settings.quality != kGood)
            continue;
        for (const WorstPoint& point : row.worst) {
            rows.push_back({name_of(row.settings.engine) + ", " + setting_of(row.settings),
                            std::to_string(point.triangle), place_text(point.position),
                            fixed(point.displayed, 3), fixed(point.reference, 3),
                            signed_fixed(point.displayed - point.reference, 3)});
        }
    }
    return table_html(
        {"engine", "worst point, in triangle", "position", "displayed", "by rays", "error"}, rows);
}

std::string scene_html(const FrontierScene& scene)
{
    std::string html = "<h2>" + escaped(scene.input.filename().string()) + "</h2>\n";
    if (!scene.comparison)
        return html + "<p>Refused: " + escaped(scene.error) + "</p>\n";
    const Comparison& comparison = *scene.comparison;
    const Definition& definition = comparison.rows.front().settings.definition;
    html += "<p>" + std::to_string(comparison.vertices) + " vertices, " +
            std::to_string(comparison.receivers) + " receivers, " +
            std::to_string(comparison.triangles) + " triangles (" +
            std::to_string(comparison.dropped_triangles) + " without area dropped); " +
            (comparison.texels ? "a map of " + target_text(comparison) + "; " : "") +
            lines_html(errors_text(comparison)) + ". " + std::to_string(comparison.threads) +
            " threads, medians of " + std::to_string(comparison.rounds) + " rounds" +
            (std::isfinite(definition.max_distance)
                 ? ". Distance limit " + significant(definition.max_distance) + " diagonals"
                 : ". No distance limit") +
            (definition.falloff == Falloff::smooth ? " with smooth falloff" : "") +
            (comparison.ground.empty() ? "" : ", a ground at " + comparison.ground) + ".</p>\n";
    html += plots_html(comparison) + rows_html(comparison) + "<p>" +
            lines_html(rows_run_once(comparison)) + "</p>\n<div class=\"pictures\">\n";
    for (const ReportPicture& picture : scene.pictures)
        html += figure_html(
            picture.png, picture.caption,
            picture.is_error ? error_bar(significant(kFullColorError)) : visibility_bar());
    return html + "</div>\n" + worst_html(comparison);
}

std::string summary_html(const Frontier& frontier)
{
    std::vector<std::vector<std::string>> rows;
    for (const Engine engine : frontier.engines) {
        for (const auto& [cost, words] :
             {std::pair(Cost::solve, "solve, fit or fill"), std::pair(Cost::build, "with builds"),
              std::pair(Cost::file, "with builds and file")}) {
            for (const double beyond : kTargets) {
                const RatioSummary s = summary_of(frontier, engine, beyond, cost);
                const auto number = [&](double value) {
                    return stands_for_all(s) ? rounded(value) : std::string("-");
                };
                rows.push_back(
                    {name_of(engine), words, fixed(beyond, 3), scenes_text(s), number(s.median),
                     stands_for_all(s) ? rounded(s.low_quartile) + " to " + rounded(s.high_quartile)
                                       : "-",
                     number(s.worst), number(s.best)});
            }
        }
    }
    return "<h2>Summary</h2>\n<p>Embree's time over ours for the same job at equal error beyond "
           "the floor, each side interpolated inside its own family of settings. A scene counts "
           "where both sides reach the error; where fewer than two of three scenes do, no median "
           "is given, for they do not stand for all.</p>\n" +
           table_html({"engine", "time", "at beyond", "reached on", "median", "quartiles", "worst",
                       "best"},
                      rows);
}

}  // namespace

std::string html_of(const Frontier& frontier)
{
    std::string html =
        open_page(make_mark("compare", "speed against error"), "surfelao: speed against error",
                  "Speed against error") +
        "<p>Occlusion, fitted to every vertex or as a map, by point-based engines and by Embree in "
        "its strongest mode, which do the same job; all in one process on the same threads, in "
        "turns. "
        "<i>Seen</i> "
        "is the error of what is displayed at points all over the surface against many robust "
        "rays, "
        "<i>solve</i> that of the engine's own answers there. The <i>floor</i> is the seen error "
        "of "
        "the best values that vertices or texels can hold, and <i>beyond</i> what an engine adds "
        "to it: "
        "seen² = floor² + beyond². In the plots lower left is better; "
        "points are named by quality, those of Embree by rays. In the pictures red is "
        "too dark, blue too bright against the floor's values, full colour at an error of " +
        fixed(kFullColorError, 1) + ".</p>\n" + facts_html(run_facts()) +
        csv_link(csv_of(frontier), "surfelao-compare");
    if (frontier.scenes.size() > 1)
        html += summary_html(frontier);
    for (const FrontierScene& scene : frontier.scenes)
        html += scene_html(scene);
    return html + close_page();
}

}  // namespace surfelao

#include "bake/html.h"
#include "bake/plot.h"
#include "bake/table.h"
#include "files/maker_mark.h"
#include "pixels/pixel_compare.h"
#include "surfels/number_text.h"

#include <algorithm>
#include <cmath>

namespace surfelao {
namespace {

const std::vector<std::string> kPixelColumns = {"engine", "setting", "surface %", "whole %",
                                                "bias %", "p95 %",   "max %",     "ms"};

std::vector<std::string> cells_of(const PixelEngine& engine, const PixelError& error, double ms)
{
    return {name_of(engine),
            setting_of(engine),
            fixed(error.rmse, 2),
            fixed(error.rmse_whole, 2),
            signed_fixed(error.bias, 2),
            fixed(error.p95, 1),
            fixed(error.max, 1),
            fixed(ms, ms < 10.0 ? 3 : 1)};
}

/// "max distance 0.1, smooth falloff": in diagonals.
std::string distance_text(const Definition& definition)
{
    if (!std::isfinite(definition.max_distance))
        return "no max distance";
    return "max distance " + significant(static_cast<double>(definition.max_distance)) +
           " diagonals" + (definition.falloff == Falloff::smooth ? ", smooth falloff" : "");
}

/// Every clock that told a time of a pass or an engine.
std::string clocks_text(const PixelComparison& comparison)
{
    std::string engines, passes;
    for (const PixelMean& mean : comparison.means)
        (std::holds_alternative<ScreenSettings>(mean.engine) ? passes : engines) = mean.clock;
    std::string text = "ms: medians of " +
                       count_text(static_cast<std::uint64_t>(comparison.rounds), "round") + "; ";
    if (!engines.empty())
        text += "engines of the scene by " + engines + ", " +
                count_text(static_cast<std::uint64_t>(comparison.threads), "thread");
    if (!passes.empty())
        text += (engines.empty() ? "" : "; ") + std::string("passes by ") + passes + " on " +
                comparison.renderer + (comparison.software ? " (software)" : "");
    return text;
}

/// Without the last line's end.
std::string settings_text(const PixelComparison& comparison)
{
    double noise = 0.0;
    for (const PixelCamera& camera : comparison.cameras)
        noise = std::max(noise, camera.noise);
    return comparison.input.string() + ": " + count_text(comparison.triangles, "triangle") + ", " +
           std::to_string(comparison.size.width) + " x " + std::to_string(comparison.size.height) +
           " pixels, " + count_text(comparison.cameras.size(), "camera") +
           (comparison.guard > 0
                ? ", a guard of " +
                      count_text(static_cast<std::uint64_t>(comparison.guard), "pixel")
                : "") +
           ", " + distance_text(comparison.definition) +
           (comparison.ground.empty() ? "" : ", a ground at " + comparison.ground) +
           "\nreference: " + std::to_string(comparison.reference_rays) +
           " robust rays a pixel, noise up to " + fixed(noise, 2) +
           " %; errors in % of full occlusion\n" + clocks_text(comparison);
}

std::string camera_text(const PixelComparison& comparison, std::size_t index)
{
    const PixelCamera& camera = comparison.cameras[index];
    return "camera " + std::to_string(index + 1) + ": " + camera.from.text + ", " +
           fixed(100.0 * camera.share, 1) + " % of the picture is surface, mean occlusion " +
           fixed(camera.mean_occlusion, 3);
}

std::string means_text(const PixelComparison& comparison)
{
    return "mean of " + count_text(comparison.cameras.size(), "camera") + ", largest max";
}

/// The rows of one camera.
std::span<const PixelRow> rows_at(const PixelComparison& comparison, std::size_t camera)
{
    const std::size_t engines = comparison.means.size();
    return std::span(comparison.rows).subspan(camera * engines, engines);
}

std::string sweep_table(const PixelComparison& comparison, const Sweep& sweep)
{
    const std::vector<double> values = values_of(sweep);
    const std::size_t best = best_of(comparison.means);
    Table table({name_of(sweep.method), sweep.name, "surface %", "whole %", "bias %", ""});
    for (std::size_t i = 0; i < values.size(); ++i) {
        const PixelError& error = comparison.means[i].error;
        table.add({"", significant(values[i], 6), fixed(error.rmse, 3), fixed(error.rmse_whole, 3),
                   signed_fixed(error.bias, 3), i == best ? "<- best" : ""});
    }
    return table.text();
}

std::string csv_cells(const PixelEngine& engine, const std::string& camera, const PixelError& error,
                      double ms, const std::string& clock)
{
    std::string line =
        name_of(engine) + ',' + csv_field(setting_of(engine)) + ',' + csv_field(camera);
    for (const double value : {error.rmse, error.rmse_whole, error.bias, error.p95, error.max, ms})
        line += ',' + exact(value);
    return line + ',' + csv_field(clock) + '\n';
}

/// Rows of PixelRow or PixelMean.
template <class Rows>
std::string rows_html(const Rows& rows)
{
    std::vector<std::vector<std::string>> cells;
    for (const auto& row : rows)
        cells.push_back(cells_of(row.engine, row.error, row.ms));
    return table_html(kPixelColumns, cells);
}

/// Error against time; nothing where nobody errs. Lower left is better.
std::string plot_html(const PixelComparison& comparison)
{
    Plot plot{comparison.input.filename().string() + ": error against time at pixels",
              "milliseconds a picture, of solving or of the pass",
              "RMSE on surfaces, % of full occlusion",
              {}};
    for (const PixelMean& mean : comparison.means) {
        if (!(mean.ms > 0.0) || !(mean.error.rmse > 0.0))
            continue;
        auto line = std::ranges::find(plot.lines, name_of(mean.engine), &PlotLine::name);
        if (line == plot.lines.end())
            line = plot.lines.insert(line, {name_of(mean.engine), {}});
        line->points.push_back({mean.ms, mean.error.rmse, setting_of(mean.engine)});
    }
    return plot.lines.empty() ? std::string()
                              : plot_html(plot, comparison.input.stem().string() + "-pixels");
}

std::string camera_html(const PixelComparison& comparison, std::size_t index)
{
    const PixelCamera& camera = comparison.cameras[index];
    const std::string full = significant(static_cast<double>(kFullPixelError), 2);
    std::string html =
        "<h2>" + escaped(camera_text(comparison, index)) + "</h2>\n" +
        rows_html(rows_at(comparison, index)) + "<div class=\"strip\">\n" +
        figure_html(camera.reference_png,
                    "rays, " + std::to_string(comparison.reference_rays) + " a pixel",
                    visibility_bar());
    for (const PixelRow& row : rows_at(comparison, index)) {
        const std::string name = name_of(row.engine) + ", " + setting_of(row.engine);
        html += "<div>" + figure_html(row.picture_png, name, visibility_bar()) +
                figure_html(row.difference_png,
                            name + ": " + fixed(row.error.rmse, 2) + " %, bias " +
                                signed_fixed(row.error.bias, 2) + " %",
                            error_bar(full)) +
                "</div>\n";
    }
    return html + "</div>\n";
}

}  // namespace

std::string csv_of(const PixelComparison& comparison)
{
    std::string text = "engine,setting,camera,rmse,rmse_whole,bias,p95,max,ms,clock\n";
    for (const PixelRow& row : comparison.rows)
        text += csv_cells(row.engine, std::to_string(row.camera + 1), row.error, row.ms, row.clock);
    for (const PixelMean& mean : comparison.means)
        text += csv_cells(mean.engine, "mean", mean.error, mean.ms, mean.clock);
    return text;
}

std::string table_of(const PixelComparison& comparison)
{
    std::string text = settings_text(comparison) + '\n';
    if (comparison.sweep)
        return text + '\n' + means_text(comparison) + '\n' +
               sweep_table(comparison, *comparison.sweep);
    if (comparison.cameras.size() > 1) {
        Table means(kPixelColumns);
        for (const PixelMean& mean : comparison.means)
            means.add(cells_of(mean.engine, mean.error, mean.ms));
        text += '\n' + means_text(comparison) + '\n' + means.text();
    }
    for (std::size_t camera = 0; camera < comparison.cameras.size(); ++camera) {
        Table table(kPixelColumns);
        for (const PixelRow& row : rows_at(comparison, camera))
            table.add(cells_of(row.engine, row.error, row.ms));
        text += '\n' + camera_text(comparison, camera) + '\n' + table.text();
    }
    return text;
}

std::string html_of(const PixelComparison& comparison)
{
    std::string html =
        open_page(make_mark("compare", "at pixels"), "surfelao: occlusion at pixels",
                  "Occlusion at pixels") +
        "<p>Answers at the pixels of a picture against rays from the same places. <i>Surface</i>: "
        "RMSE over the pixels that see a surface; <i>whole</i>: over all pixels, the background's "
        "error being 0. Under each answer its difference to the rays: red is too dark, blue too "
        "bright, full colour at " +
        fixed(100.0 * static_cast<double>(kFullPixelError), 0) +
        " %. Pictures are cut to what is seen, and reduced to at most " +
        std::to_string(kWidestPicture) + " pixels.</p>\n" + facts_html(run_facts()) +
        csv_link(csv_of(comparison), "surfelao-pixels") + "<p>" +
        lines_html(settings_text(comparison)) + "</p>\n" + plot_html(comparison);
    if (comparison.cameras.size() > 1)
        html += "<h2>" + escaped(means_text(comparison)) + "</h2>\n" + rows_html(comparison.means);
    if (comparison.sweep)
        html += "<pre>" + escaped(sweep_table(comparison, *comparison.sweep)) + "</pre>\n";
    for (std::size_t camera = 0; camera < comparison.cameras.size(); ++camera)
        html += camera_html(comparison, camera);
    return html + close_page();
}

}  // namespace surfelao

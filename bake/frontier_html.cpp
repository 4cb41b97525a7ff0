#include "bake/compare_text.h"
#include "bake/frontier.h"
#include "bake/html.h"
#include "files/maker_mark.h"
#include "image/color_map.h"
#include "surfels/number_text.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace surfelao {
namespace {

/// One line of the plot.
struct Series {
    std::string name;
    std::string color;
    std::vector<const CompareRow*> rows;
};

std::vector<Series> series_of(const Comparison& comparison)
{
    std::vector<Series> series = {
        {"masks", "#c0392b", {}}, {"disks", "#2471a3", {}}, {"Embree", "#1e8449", {}}};
    for (const CompareRow& row : comparison.rows) {
        const std::string name = is_opponent(row) ? "Embree" : name_of(row.settings.engine);
        for (Series& one : series) {
            if (one.name == name && row.beyond > 0.0 && row.solve_s > 0.0)
                one.rows.push_back(&row);
        }
    }
    std::erase_if(series, [](const Series& one) { return one.rows.empty(); });
    for (Series& one : series) {
        std::stable_sort(one.rows.begin(), one.rows.end(), [](const auto* a, const auto* b) {
            return job_seconds(*a, false) < job_seconds(*b, false);
        });
    }
    return series;
}

/// A logarithmic axis over whole decades.
struct Axis {
    double low = std::numeric_limits<double>::max();
    double high = 0.0;
    double from = 0.0, to = 0.0;  ///< pixels

    void include(double value)
    {
        low = std::min(low, value);
        high = std::max(high, value);
    }
    void to_decades()
    {
        low = std::pow(10.0, std::floor(std::log10(low)));
        high = std::max(10.0 * low, std::pow(10.0, std::ceil(std::log10(high))));
    }
    double at(double value) const
    {
        return from + (to - from) * std::log(value / low) / std::log(high / low);
    }
};

/// Error beyond the floor against seconds of the job without builds, log-log. Lower left is better.
std::string plot_of(const Comparison& comparison)
{
    const std::vector<Series> series = series_of(comparison);
    if (series.empty())
        return "<p>No errors to plot: nobody has any beyond the floor.</p>\n";
    Axis x, y;
    for (const Series& one : series) {
        for (const CompareRow* row : one.rows) {
            x.include(job_seconds(*row, false));
            y.include(row->beyond);
        }
    }
    x.to_decades();
    y.to_decades();
    x.from = 60;
    x.to = 700;
    y.from = 360;
    y.to = 20;

    const auto number = [](double value) { return fixed(value, 1); };
    std::string svg = "<svg viewBox=\"0 0 860 410\" width=\"860\" role=\"img\">\n";
    const auto line = [&](double x1, double y1, double x2, double y2, const char* color) {
        svg += "<line x1=\"" + number(x1) + "\" y1=\"" + number(y1) + "\" x2=\"" + number(x2) +
               "\" y2=\"" + number(y2) + "\" stroke=\"" + color + "\"/>\n";
    };
    const auto text = [&](double px, double py, const char* anchor, const std::string& words) {
        svg += "<text x=\"" + number(px) + "\" y=\"" + number(py) + "\" text-anchor=\"" + anchor +
               "\">" + escaped(words) + "</text>\n";
    };
    for (double decade = x.low; decade < x.high * 1.01; decade *= 10.0) {
        for (int i = 1; i < 10 && decade * i < x.high * 1.01; ++i)
            line(x.at(decade * i), y.from, x.at(decade * i), y.to, i == 1 ? "#bbb" : "#eee");
        text(x.at(decade), y.from + 16, "middle", exact(decade));
    }
    for (double decade = y.low; decade < y.high * 1.01; decade *= 10.0) {
        for (int i = 1; i < 10 && decade * i < y.high * 1.01; ++i)
            line(x.from, y.at(decade * i), x.to, y.at(decade * i), i == 1 ? "#bbb" : "#eee");
        text(x.from - 6, y.at(decade) + 4, "end", exact(decade));
    }
    text(0.5 * (x.from + x.to), y.from + 38, "middle",
         "seconds of solving, and of fitting or filling");
    text(x.from, 12, "start", "beyond the floor, RMS");
    double legend = y.to + 16;
    for (const Series& one : series) {
        std::string points;
        for (const CompareRow* row : one.rows)
            points +=
                number(x.at(job_seconds(*row, false))) + ',' + number(y.at(row->beyond)) + ' ';
        svg += "<polyline fill=\"none\" stroke-width=\"2\" stroke=\"" + one.color + "\" points=\"" +
               points + "\"/>\n";
        for (const CompareRow* row : one.rows) {
            svg +=
                "<circle r=\"4\" fill=\"" + one.color + "\" cx=\"" +
                number(x.at(job_seconds(*row, false))) + "\" cy=\"" + number(y.at(row->beyond)) +
                "\"><title>" +
                escaped(one.name + ", " + setting_of(row->settings) + ": beyond " +
                        fixed(row->beyond, 4) + ", " + fixed(job_seconds(*row, false), 4) + " s") +
                "</title></circle>\n";
        }
        svg += "<circle r=\"4\" fill=\"" + one.color + "\" cx=\"720\" cy=\"" + number(legend - 4) +
               "\"/>\n";
        text(730, legend, "start", one.name);
        legend += 20;
    }
    return svg + "</svg>\n";
}

std::string rows_html(const Comparison& comparison)
{
    std::string html = "<table>\n";
    const bool is_map = comparison.texels.has_value();
    html +=
        row_of_cells({"engine", "setting", "build s", "solve s", is_map ? "fill s" : "fit s",
                      "µs/receiver", "seen RMSE", "bias", "p95", "max", "bent mean °", "bent p95 °",
                      "solve RMSE", "solve max", "beyond", "Embree/ours", "with builds"},
                     "th");
    for (const CompareRow& row : comparison.rows) {
        html += row_of_cells(
            {name_of(row.settings.engine), setting_of(row.settings), fixed(row.build_s, 4),
             fixed(row.solve_s, 4), fixed(is_map ? row.fill_s : row.fit_s, 4),
             fixed(row.us_per_receiver, 3), fixed(row.seen.rmse, 4), signed_fixed(row.seen.bias, 4),
             fixed(row.seen.p95, 4), fixed(row.seen.max, 3),
             bent_text(comparison, row.seen.bent_mean_deg),
             bent_text(comparison, row.seen.bent_p95_deg), fixed(row.solve.rmse, 4),
             fixed(row.solve.max, 3), fixed(row.beyond, 4), text_of(row.ratio),
             text_of(row.ratio_with_builds)},
            "td");
    }
    return html + "</table>\n";
}

std::string worst_html(const Comparison& comparison)
{
    std::string html = "<table>\n" + row_of_cells({"engine", "worst point, in triangle", "position",
                                                   "displayed", "by rays", "error"},
                                                  "th");
    for (const CompareRow& row : comparison.rows) {
        if (is_opponent(row) || row.settings.quality != kGood)
            continue;
        for (const WorstPoint& point : row.worst) {
            const glm::dvec3 p = point.position;
            html += row_of_cells(
                {name_of(row.settings.engine) + ", " + setting_of(row.settings),
                 std::to_string(point.triangle), exact(p.x) + ", " + exact(p.y) + ", " + exact(p.z),
                 fixed(point.displayed, 3), fixed(point.reference, 3),
                 signed_fixed(point.displayed - point.reference, 3)},
                "td");
        }
    }
    return html + "</table>\n";
}

std::string scene_html(const FrontierScene& scene)
{
    std::string html = "<h2>" + escaped(scene.input.filename().string()) + "</h2>\n";
    if (!scene.comparison)
        return html + "<p>Refused: " + escaped(scene.error) + "</p>\n";
    const Comparison& comparison = *scene.comparison;
    const Definition& definition = comparison.rows.front().settings.definition;
    html +=
        "<p>" + std::to_string(comparison.vertices) + " vertices, " +
        std::to_string(comparison.receivers) + " receivers, " +
        std::to_string(comparison.triangles) + " triangles (" +
        std::to_string(comparison.dropped_triangles) + " without area dropped); " +
        (comparison.texels ? "a map of " + target_text(comparison) + "; " : "") +
        errors_text(comparison) + ". " + std::to_string(comparison.threads) +
        " threads, medians of " + std::to_string(comparison.rounds) + " rounds. Distance limit " +
        (std::isfinite(definition.max_distance) ? exact(definition.max_distance) : "none") +
        (definition.falloff == Falloff::smooth ? " with smooth falloff" : "") + " (in diagonals)" +
        (comparison.ground.empty() ? "" : ", a ground at " + comparison.ground) + ".</p>\n";
    html +=
        plot_of(comparison) + rows_html(comparison) + "<p>" + rows_run_once(comparison) + "</p>\n";
    for (const auto& [caption, png] : scene.pictures)
        html += figure_html(png, caption);
    return html + worst_html(comparison);
}

std::string summary_html(const Frontier& frontier)
{
    std::string html =
        "<h2>Summary</h2>\n<p>Embree's time over ours for the same job at equal error beyond the "
        "floor, each side interpolated inside its own family of settings; scenes where one side "
        "had to be extrapolated are left out.</p>\n<table>\n";
    html += row_of_cells({"engine", "at beyond", "counted", "median", "quartiles", "worst", "best",
                          "scenes", "left out"},
                         "th");
    for (const Engine engine : frontier.engines) {
        for (const auto& [cost, words] :
             {std::pair(Cost::solve, "solve, fit or fill"), std::pair(Cost::build, "with builds"),
              std::pair(Cost::file, "with builds and file")}) {
            for (const double beyond : kTargets) {
                const RatioSummary s = summary_of(frontier, engine, beyond, cost);
                const auto number = [&](double value) {
                    return s.scenes > 0 ? fixed(value, 2) : std::string("-");
                };
                html += row_of_cells(
                    {name_of(engine), fixed(beyond, 3), words, number(s.median),
                     number(s.low_quartile) + " to " + number(s.high_quartile), number(s.worst),
                     number(s.best), std::to_string(s.scenes), std::to_string(s.left_out)},
                    "td");
            }
        }
    }
    return html + "</table>\n";
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
        "seen² = floor² + beyond². In the plots lower left is better. In the pictures red is "
        "too dark, blue too bright against the floor's values, full colour at an error of " +
        fixed(kFullColorError, 1) + ".</p>\n";
    if (frontier.scenes.size() > 1)
        html += summary_html(frontier);
    for (const FrontierScene& scene : frontier.scenes)
        html += scene_html(scene);
    return html + close_page();
}

}  // namespace surfelao

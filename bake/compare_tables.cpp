#include "bake/compare_text.h"

#include "bake/table.h"
#include "files/maker_mark.h"
#include "files/ply_io.h"
#include "image/color_map.h"
#include "surfels/atomic_file.h"
#include "surfels/number_text.h"

#include <cmath>
#include <sstream>

namespace surfelao {

std::string csv_head()
{
    return "input,vertices,triangles,engine,setting,build_s,solve_s,us_per_vertex,rmse,bias,p95,"
           "max,"
           "bent_mean_deg,bent_p95_deg,embree_ratio,embree_ratio_with_builds,extrapolated\n";
}

std::string csv_of(const Comparison& comparison)
{
    return csv_head() + csv_rows_of(comparison);
}

std::string csv_rows_of(const Comparison& comparison)
{
    std::string text;
    for (const CompareRow& row : comparison.rows) {
        const auto number = [](double value) { return ',' + exact(value); };
        const auto ratio = [](const std::optional<EmbreeRatio>& value) {
            return ',' + (value ? exact(value->ratio) : std::string());
        };
        text += csv_field(comparison.input.string()) + ',' + std::to_string(comparison.vertices) +
                ',' + std::to_string(comparison.triangles) + ',' + name_of(row.settings.engine) +
                ',' + csv_field(setting_of(row)) + number(row.build_s) + number(row.solve_s) +
                number(row.us_per_vertex) + number(row.error.rmse) + number(row.error.bias) +
                number(row.error.p95) + number(row.error.max) + number(row.error.bent_mean_deg) +
                number(row.error.bent_p95_deg) + ratio(row.solve_ratio) + ratio(row.total_ratio) +
                (row.solve_ratio && row.solve_ratio->extrapolated ? ",1\n" : ",0\n");
    }
    return text;
}

std::string text_of(const std::optional<EmbreeRatio>& ratio)
{
    if (!ratio)
        return "-";
    return fixed(ratio->ratio, 2) + (ratio->extrapolated ? "*" : "");
}

std::string rows_run_once(const Comparison& comparison)
{
    std::string text;
    for (const CompareRow& row : comparison.rows) {
        if (row.rounds == 1 && comparison.rounds != 1)
            text += name_of(row.settings.engine) + ' ' + setting_of(row) + " ran once\n";
    }
    return text;
}

std::string table_of(const Comparison& comparison)
{
    Table table({"engine", "setting", "build s", "solve s", "us/vertex", "RMSE", "bias", "p95",
                 "max", "bent deg", "Embree/ours", "with builds"});
    for (const CompareRow& row : comparison.rows) {
        table.add({name_of(row.settings.engine), setting_of(row), fixed(row.build_s, 4),
                   fixed(row.solve_s, 4), fixed(row.us_per_vertex, 3), fixed(row.error.rmse, 4),
                   signed_fixed(row.error.bias, 4), fixed(row.error.p95, 4),
                   fixed(row.error.max, 3), fixed(row.error.bent_mean_deg, 2),
                   text_of(row.solve_ratio), text_of(row.total_ratio)});
    }
    std::string text = comparison.input.string() + ": " + std::to_string(comparison.vertices) +
                       " vertices, " + std::to_string(comparison.triangles) + " triangles, " +
                       std::to_string(comparison.threads) + " threads, median of " +
                       std::to_string(comparison.rounds) +
                       "\nreference: " + std::to_string(comparison.reference_rays) +
                       " robust rays at " + std::to_string(comparison.judged) +
                       " vertices, noise " + fixed(comparison.reference_noise, 4);
    if (comparison.ill_defined > 0) {
        text += "; " + std::to_string(comparison.ill_defined) + " ill-defined left out";
    }
    if (comparison.without_normal > 0)
        text += "; " + std::to_string(comparison.without_normal) + " without a normal left out";
    text += "\n\n" + table.text();
    text += rows_run_once(comparison);
    for (const CompareRow& row : comparison.rows) {
        if (row.solve_ratio && row.solve_ratio->extrapolated) {
            text += "* extrapolated beyond the rows of rays\n";
            break;
        }
    }
    return text;
}

void write_difference(const std::filesystem::path& path, const Comparison& comparison,
                      const CompareRow& row)
{
    std::ostringstream what;
    what << "error of " << name_of(row.settings.engine) << ' ' << setting_of(row)
         << " against rays; full colour at " << kFullColorError
         << ": red = too dark, blue = too bright, grey = not judged";
    const PlyValues values{
        {"uchar red", "uchar green", "uchar blue", "float error"},
        [&](std::string& bytes, std::size_t v) {
            for (const std::uint8_t channel : error_color(row.errors[v], kFullColorError))
                append_bytes(bytes, channel);
            append_bytes(bytes, std::isnan(row.errors[v]) ? 0.0f : row.errors[v]);
        }};
    write_atomically(path, new_ply(comparison.mesh->scene, values, make_mark("compare", what.str()),
                                   PlyCoordinates::exact));
}

}  // namespace surfelao

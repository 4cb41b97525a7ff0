#include "bake/compare_text.h"

#include "bake/table.h"
#include "files/maker_mark.h"
#include "files/ply_io.h"
#include "image/color_map.h"
#include "surfels/atomic_file.h"
#include "surfels/number_text.h"

#include <algorithm>
#include <sstream>

namespace surfelao {

namespace {

/// Columns of one kind of error.
std::string csv_names(const std::string& kind)
{
    std::string names;
    for (const char* name : {"rmse", "bias", "p95", "max", "bent_mean_deg", "bent_p95_deg"})
        names += ',' + kind + '_' + name;
    return names;
}

std::string csv_number(double value)
{
    return ',' + exact(value);
}

std::string csv_numbers(const ErrorStatistics& error, bool has_bent)
{
    return csv_number(error.rmse) + csv_number(error.bias) + csv_number(error.p95) +
           csv_number(error.max) +
           (has_bent ? csv_number(error.bent_mean_deg) + csv_number(error.bent_p95_deg) : ",,");
}

}  // namespace

std::string csv_head()
{
    return "input,vertices,triangles,receivers,points,ill_defined,floor,engine,setting,raster_s,"
           "build_s,solve_s,fit_s,fill_s,us_per_receiver" +
           csv_names("seen") + csv_names("solve") +
           ",beyond,embree_ratio,embree_ratio_with_builds,extrapolated\n";
}

std::string csv_of(const Comparison& comparison)
{
    return csv_head() + csv_rows_of(comparison);
}

std::string csv_rows_of(const Comparison& comparison)
{
    std::string scene = csv_field(comparison.input.string());
    for (const std::uint64_t count :
         {comparison.vertices, comparison.triangles, comparison.receivers, comparison.points,
          comparison.ill_defined})
        scene += ',' + std::to_string(count);
    scene += csv_number(comparison.floor.rmse);
    const auto ratio = [](const std::optional<EmbreeRatio>& value) {
        return value ? csv_number(value->ratio) : std::string(",");
    };
    std::string text;
    for (const CompareRow& row : comparison.rows) {
        text += scene + ',' + name_of(row.settings.engine) + ',' +
                csv_field(setting_of(row.settings)) + csv_number(row.raster_s) +
                csv_number(row.build_s) + csv_number(row.solve_s) + csv_number(row.fit_s) +
                csv_number(row.fill_s) + csv_number(row.us_per_receiver) +
                csv_numbers(row.seen, !comparison.texels) + csv_numbers(row.solve, true) +
                csv_number(row.beyond) + ratio(row.ratio) + ratio(row.ratio_with_builds) +
                (row.ratio && row.ratio->extrapolated ? ",1\n" : ",0\n");
    }
    return text;
}

std::string target_text(const Comparison& comparison)
{
    return std::to_string(comparison.page.width) + " x " + std::to_string(comparison.page.height) +
           " texels" +
           (comparison.pages > 1 ? " on " + std::to_string(comparison.pages) + " pages" : "") +
           (comparison.uv_set ? " (texture coordinates " + std::to_string(*comparison.uv_set) + ")"
                              : " (new texture coordinates)");
}

std::string bent_text(const Comparison& comparison, double degrees)
{
    return comparison.texels ? "-" : fixed(degrees, 2);
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
            text += name_of(row.settings.engine) + ", " + setting_of(row.settings) + ": ran once\n";
    }
    return text;
}

std::string errors_text(const Comparison& comparison)
{
    const std::uint64_t all = comparison.points + comparison.ill_defined;
    const double share = 100.0 * static_cast<double>(comparison.ill_defined) /
                         static_cast<double>(std::max<std::uint64_t>(1, all));
    return (comparison.points_report ? "error against rays at the same squares at "
                                     : "surface error (seen) over ") +
           std::to_string(comparison.points) + " points, floor " + fixed(comparison.floor.rmse, 4) +
           "; " + std::to_string(comparison.ill_defined) + " ill-defined points left out (" +
           fixed(share, 2) + " %)" +
           (comparison.hidden > 0 ? ", " + std::to_string(comparison.hidden) + " hidden ones"
                                  : "") +
           "\nreference: " + std::to_string(comparison.reference_rays) +
           " robust rays a point, noise " + fixed(comparison.reference_noise, 4) +
           "; floor: " + std::to_string(comparison.floor_rays) + " rays a receiver, noise " +
           fixed(comparison.floor_noise, 4);
}

std::string table_of(const Comparison& comparison)
{
    const bool is_map = comparison.texels.has_value();
    std::vector<std::string> head = {
        "engine", "setting", "build s",  "solve s",    "fit s",  "seen RMSE",   "bias",
        "p95",    "max",     "bent deg", "solve RMSE", "beyond", "Embree/ours", "with builds"};
    if (is_map) {
        head[4] = "fill s";
        head.insert(head.begin() + 2, "raster s");
    }
    Table table(head);
    for (const CompareRow& row : comparison.rows) {
        std::vector<std::string> cells = {name_of(row.settings.engine),
                                          setting_of(row.settings),
                                          fixed(row.build_s, 4),
                                          fixed(row.solve_s, 4),
                                          fixed(is_map ? row.fill_s : row.fit_s, 4),
                                          fixed(row.seen.rmse, 4),
                                          signed_fixed(row.seen.bias, 4),
                                          fixed(row.seen.p95, 4),
                                          fixed(row.seen.max, 3),
                                          bent_text(comparison, row.seen.bent_mean_deg),
                                          fixed(row.solve.rmse, 4),
                                          fixed(row.beyond, 4),
                                          text_of(row.ratio),
                                          text_of(row.ratio_with_builds)};
        if (is_map)
            cells.insert(cells.begin() + 2, fixed(row.raster_s, 4));
        table.add(std::move(cells));
    }
    std::string text =
        comparison.input.string() + ": " + std::to_string(comparison.vertices) +
        (comparison.points_report
             ? " points, "
             : " vertices, " + std::to_string(comparison.triangles) + " triangles, ") +
        (is_map ? target_text(comparison) + ", " : "") +
        (comparison.ground.empty() ? "" : "a ground at " + comparison.ground + ", ") +
        std::to_string(comparison.receivers) + " receivers, " + std::to_string(comparison.threads) +
        " threads, median of " + std::to_string(comparison.rounds) + '\n' +
        errors_text(comparison) + "\n\n" + table.text() + rows_run_once(comparison);
    for (const CompareRow& row : comparison.rows) {
        if (row.ratio && row.ratio->extrapolated) {
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
    what << "error of " << name_of(row.settings.engine) << ' ' << setting_of(row.settings)
         << " against fitted rays; full colour at " << kFullColorError
         << ": red = too dark, blue = too bright";
    const PlyValues values{
        {"uchar red", "uchar green", "uchar blue", "float error"},
        [&](std::string& bytes, std::size_t v) {
            for (const std::uint8_t channel : error_color(row.errors[v], kFullColorError))
                append_bytes(bytes, channel);
            append_bytes(bytes, row.errors[v]);
        }};
    write_atomically(path, new_ply(comparison.mesh->scene, values, make_mark("compare", what.str()),
                                   PlyCoordinates::exact));
}

}  // namespace surfelao

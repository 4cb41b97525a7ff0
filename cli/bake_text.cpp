#include "cli/bake_text.h"

#include "surfels/number_text.h"

#include <iostream>
#include <string>

namespace surfelao {
namespace {

/// "38 new charts, use 0.78, seams 12.1"
std::string charts_text(const ChartReport& charts)
{
    return count_text(charts.count, "new chart") + ", use " + fixed(charts.use, 2) + ", seams " +
           fixed(charts.seam_length, 1) + ", stretch " + fixed(charts.mean_stretch, 2);
}

/// "masks, good, at 8192 places fitted to the vertices, normals of the file at 960 corners"
std::string question_of(const BakeReport& report)
{
    const BakeSettings& settings = report.settings;
    std::string text = name_of(settings.engine.engine) + ", " + setting_of(settings.engine) +
                       ", at " + std::to_string(report.receivers) + " places";
    if (report.texels)
        text +=
            " of " + std::to_string(report.texels->covered) + " texels (" +
            (report.texels->uv_set ? "texture coordinates " + std::to_string(*report.texels->uv_set)
                                   : charts_text(*report.texels->charts)) +
            ")";
    else if (const auto& told = report.grid)
        text += " about " + std::to_string(told->grid.cell_count()) + " cells (" +
                name_of(told->grid.store) + ", " + name_of(told->grid.border) + ", " +
                std::to_string(told->inside) + " of them moved out of the object)";
    else if (report.points)
        text = name_of(settings.engine.engine) + ", " + setting_of(settings.engine) + ", at " +
               count_text(report.receivers, "point");
    else if (settings.target.values == VertexValues::fit)
        text += " fitted to the vertices";
    if (!report.ground.empty())
        text += ", over a ground at " + report.ground;
    if (report.corners_from_file > 0)
        text += ", normals of the file at " + std::to_string(report.corners_from_file) + " corners";
    return text;
}

/// "subdivided in 7 rounds, from 1499 and 2694"
std::string subdivision_text(const SubdivisionReport& subdivision)
{
    return "subdivided in " + count_text(static_cast<std::uint64_t>(subdivision.rounds), "round") +
           ", from " + std::to_string(subdivision.old_vertices) + " and " +
           std::to_string(subdivision.old_triangles);
}

/// "error 0.0041 (0.0037 to 0.0046), bias -0.0006, 95 % within 0.0101, floor 0.0038; 400 points"
std::string statement_of(const StatedError& error)
{
    std::string text = "error " + fixed(error.rmse, 4) + " (" + fixed(error.low, 4) + " to " +
                       fixed(error.high, 4) + "), bias " + (error.bias < 0.0 ? "" : "+") +
                       fixed(error.bias, 4) + ", 95 % within " + fixed(error.p95, 4);
    if (error.floor)
        text += ", floor " + fixed(*error.floor, 4);
    text += "; " + std::to_string(error.points) + " points";
    if (error.ill_defined > 0)
        text += ", " + std::to_string(error.ill_defined) + " ill-defined left out";
    return text;
}

/// "49980 occlude, about 0.42 apart, normals fitted, turned to where it is more open"
std::string points_of(const PointReport& points)
{
    const PointCounts& counts = points.counts;
    std::string text = std::to_string(points.occluders) + " occlude, about " +
                       significant(points.spacing) + " apart, normals " +
                       (counts.from_file > 0 ? "of the file" : "fitted");
    switch (points.orientation) {
        case Orientation::file:
            return text;
        case Orientation::viewpoint:
            return text + ", turned to the viewpoint";
        case Orientation::openness:
            return text + ", turned to where it is more open";
        case Orientation::up:
            return text + ", asked towards the sky";
    }
    return text;
}

/// What was tried for --error, and whether that was enough.
std::string search_of(const BakeReport& report)
{
    std::string text = "error asked " + exact(*report.settings.error) + ":";
    for (const Trial& trial : report.trials)
        text += " " + name_of(trial.engine.engine) + " " + setting_of(trial.engine) + " " +
                fixed(trial.error.rmse, 4) + ",";
    text.back() = ';';
    if (report.is_met)
        return text + " met by the last";
    const StatedError& last = *report.error;
    if (last.floor && *last.floor > *report.settings.error)
        return text + " not met: values at these vertices err by " + fixed(*last.floor, 4) +
               " whoever answers (floor); --subdivide or a map helps";
    if (last.floor && last.high > 0.0 &&
        *last.floor * last.high > *report.settings.error * last.rmse)
        return text + " not met for sure: the floor of these vertices, " + fixed(*last.floor, 4) +
               ", is too near; more points (--check) or --subdivide help";
    return text + " not met";
}

}  // namespace

void print_report(const BakeReport& report)
{
    const BakeSeconds& seconds = report.seconds;
    const auto time = [](double s) { return fixed(s, 3) + " s"; };
    std::cout << report.settings.input.string() << " -> " << report.settings.output.string() << '\n'
              << "  ";
    if (report.points)
        std::cout << count_text(report.vertices, "point") << ", " << points_of(*report.points);
    else
        std::cout << report.vertices << " vertices, " << report.triangles << " triangles";
    if (report.subdivision)
        std::cout << " (" << subdivision_text(*report.subdivision) << ")";
    if (report.dropped_triangles > 0)
        std::cout << " (" << report.dropped_triangles << " without area dropped)";
    if (report.baked_triangles + report.dropped_triangles < report.triangles ||
        report.occluding_triangles != report.baked_triangles)
        std::cout << ", " << report.baked_triangles << " baked, " << report.occluding_triangles
                  << " occlude";
    if (report.vertices_without_normal > 0 && !report.points)
        std::cout << ", " << report.vertices_without_normal << " vertices without a normal";
    if (const auto& part = report.settings.share) {
        std::cout << "\n  " << question_of(report) << "\n  share " << part->share.index + 1
                  << " of " << part->share.count << ": " << report.solved << " places; read "
                  << time(seconds.read) << ", build " << time(seconds.surfels + seconds.tree)
                  << ", solve " << time(seconds.solve) << ", write " << time(seconds.write) << "; "
                  << report.threads << (report.threads == 1 ? " thread" : " threads") << '\n';
        return;
    }
    std::cout << "\n  " << question_of(report)
              << (report.grid ? ": mean share hidden " : ": mean occlusion ")
              << fixed(report.mean_occlusion, 4);
    if (const auto& told = report.grid)
        std::cout << ", cells " << significant(told->closest.x) << ", "
                  << significant(told->closest.y) << ", " << significant(told->closest.z)
                  << " apart at the closest, " << told->bytes / 1024 << " KiB";
    if (report.residual)
        std::cout << ", residual " << fixed(*report.residual, 4);
    if (report.settings.error && report.error)
        std::cout << "\n  " << search_of(report);
    if (report.error)
        std::cout << "\n  " << statement_of(*report.error)
                  << (report.points ? ", against rays at the same squares"
                      : report.grid ? " about the object"
                                    : "");
    std::cout << "\n  read " << time(seconds.read);
    if (const auto& motion = report.motion)
        std::cout << ", pose " << time(motion->pose) << ", place " << time(motion->place);
    if (report.points)
        std::cout << ", points " << time(seconds.points);
    if (report.subdivision)
        std::cout << ", subdivide " << time(seconds.subdivide);
    if (report.texels && report.texels->charts)
        std::cout << ", charts " << time(seconds.charts);
    if (report.texels)
        std::cout << ", raster " << time(seconds.raster);
    std::cout << ", surfels " << time(seconds.surfels) << ", tree " << time(seconds.tree)
              << ", solve " << time(seconds.solve)
              << (report.texels ? ", fill " + time(seconds.fill)
                  : report.grid ? ", repair " + time(seconds.repair)
                                : ", fit " + time(seconds.fit))
              << ", check " << time(seconds.check) << ", write " << time(seconds.write)
              << ", total " << time(seconds.total) << "; " << report.threads
              << (report.threads == 1 ? " thread, " : " threads, ")
              << report.peak_rss_bytes / (1024 * 1024) << " MiB\n";
    for (const std::string& note : report.notes)
        std::cout << "  note: " << note << '\n';
}

}  // namespace surfelao

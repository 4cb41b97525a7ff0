#include "bake/map_bake.h"

#include "bake/vertex_fit.h"
#include "surfels/errors.h"
#include "surfels/stopwatch.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace surfelao {
namespace {

/// Takes the answers of one band into the map.
class MapWriter {
public:
    MapWriter(MapBake& bake, std::vector<std::uint8_t>& known) : bake_(bake), known_(known) {}

    void add(const std::vector<Texel>& texels, std::span<const Occlusion> answers)
    {
        for (std::size_t first = 0, end = 0; first < texels.size(); first = end) {
            for (end = first + 1; end < texels.size() && texels[end].x == texels[first].x &&
                                  texels[end].y == texels[first].y;)
                ++end;
            write(texels[first], answers.subspan(first, end - first));
        }
        bake_.receivers += texels.size();
    }

    /// After the last band.
    void finish()
    {
        if (bake_.covered > 0)
            bake_.mean_occlusion = occlusion_ / static_cast<double>(bake_.covered);
        if (bake_.overlapping > 0)
            bake_.spread = std::sqrt(squares_ / static_cast<double>(sheets_));
    }

private:
    /// The sheets of one texel are whole ones, or it has one part: all weigh alike.
    void write(const Texel& texel, std::span<const Occlusion> sheets)
    {
        double sum = 0.0;
        glm::dvec3 bent(0.0);
        for (const Occlusion& sheet : sheets) {
            sum += sheet.occlusion;
            bent += (1.0 - sheet.occlusion) * glm::dvec3(sheet.bent_normal);
        }
        const double mean = sum / static_cast<double>(sheets.size());
        const std::size_t index = bake_.visibility.index(texel.x, texel.y);
        bake_.visibility.values[index] = static_cast<float>(1.0 - mean);
        if (!bake_.bent.values.empty()) {
            const double length = glm::length(bent);
            const glm::vec3 normal =
                length > kLeastBent ? glm::vec3(bent / length) : sheets.front().bent_normal;
            for (int k = 0; k < 3; ++k)
                bake_.bent.values[3 * index + static_cast<std::size_t>(k)] = normal[k];
        }
        known_[index] = 1;
        occlusion_ += mean;
        ++bake_.covered;
        if (sheets.size() < 2)
            return;
        ++bake_.overlapping;
        sheets_ += sheets.size();
        for (const Occlusion& sheet : sheets)
            squares_ += (sheet.occlusion - mean) * (sheet.occlusion - mean);
    }

    MapBake& bake_;
    std::vector<std::uint8_t>& known_;
    double squares_ = 0.0, occlusion_ = 0.0;
    std::uint64_t sheets_ = 0;
};

/// The means of directions are shorter than one; from directions to what files hold.
void encode_directions(Map& directions)
{
    for (std::size_t i = 0; i + 2 < directions.values.size(); i += 3) {
        float* value = &directions.values[i];
        const glm::vec3 direction(value[0], value[1], value[2]);
        const float length = glm::length(direction);
        for (int k = 0; k < 3; ++k)
            value[k] = 0.5f + 0.5f * (length > 0.0f ? direction[k] / length : 0.0f);
    }
}

StatedError error_of(const Mesh& mesh, const UvSet& uvs, const MapBake& bake,
                     const MapSettings& settings, const Definition& definition,
                     const Offset& offset, const Progress& progress)
{
    std::vector<double> density;
    density.reserve(mesh.geometry.triangles.size());
    for (std::uint32_t t = 0; t < mesh.geometry.triangles.size(); ++t)
        density.push_back(uv_at(mesh.geometry, uvs, {t, {0.25f, 0.25f}}) ? 1.0 : 0.0);
    const Shown shown = [&](const SurfacePoint& point) {
        return 1.0f - fetch(bake.visibility, 0, *uv_at(mesh.geometry, uvs, point));
    };
    ErrorCheck check(mesh, density, offset, settings.check);
    check.trace(definition, shown, progress);
    return check.error_of(shown);
}

}  // namespace

MapBake bake_map(const Mesh& mesh, const UvSet& uvs, const MapSettings& settings,
                 const EngineSettings& engine, const Offset& offset, const StageProgress& progress)
{
    const auto enter = [&](std::string_view stage, double done) {
        if (progress && !progress(stage, done))
            throw Cancelled();
    };
    MapBake bake;
    Stopwatch watch;
    enter("raster", 0.0);
    const MapRaster raster(mesh.geometry, uvs, settings.size);
    bake.flat_triangles = raster.flat_triangles();
    bake.outside_triangles = raster.outside_triangles();
    bake.visibility = Map(settings.size.width, settings.size.height, 1);
    if (settings.bent)
        bake.bent = Map(settings.size.width, settings.size.height, 3);
    bake.seconds.raster = watch.lap();

    enter("build", 0.0);
    const Prepared prepared = prepare(mesh.geometry, engine);
    bake.seconds.surfels = prepared.seconds().surfels;
    bake.seconds.tree = prepared.seconds().tree;

    std::vector<std::uint8_t> known(settings.size.count(), 0);
    MapWriter writer(bake, known);
    const std::uint32_t height = settings.size.height;
    const auto rows = static_cast<std::uint32_t>(
        std::clamp<std::uint64_t>(kBandTexels / settings.size.width, 1, height));
    for (std::uint32_t first = 0; first < height; first += rows) {
        watch.lap();
        const std::vector<Texel> texels = raster.texels(first, rows);
        std::vector<SurfacePoint> points;
        points.reserve(texels.size());
        for (const Texel& texel : texels)
            points.push_back(texel.point);
        const std::vector<Receiver> receivers =
            receivers_at(mesh.geometry, mesh.surface, points, offset);
        bake.seconds.raster += watch.lap();
        const double begin = first, share = std::min(rows, height - first);
        const Solution solution = solve(prepared, receivers, engine, [&](double done) {
            return !progress || progress("solve", (begin + share * done) / height);
        });
        bake.seconds.solve += solution.seconds;
        writer.add(texels, solution.occlusion);
    }
    writer.finish();

    enter("fill", 0.0);
    watch.lap();
    if (settings.bent) {
        std::vector<std::uint8_t> bent_known = known;
        fill_around(bake.bent, bent_known, settings.padding);
        encode_directions(bake.bent);
        round_to_depth(bake.bent, settings.depth, settings.half_is_whole);
    }
    fill_around(bake.visibility, known, settings.padding);
    round_to_depth(bake.visibility, settings.depth, settings.half_is_whole);
    bake.seconds.fill = watch.lap();
    if (settings.check > 0) {
        enter("check", 0.0);
        bake.error = error_of(mesh, uvs, bake, settings, engine.definition, offset,
                              [&](double done) { return !progress || progress("check", done); });
        bake.seconds.check = watch.lap();
    }
    return bake;
}

}  // namespace surfelao

#include "bake/map_bake.h"

#include "bake/hidden_texels.h"
#include "bake/high_to_low.h"
#include "bake/sparse_texels.h"
#include "bake/texel_fit.h"
#include "bake/vertex_fit.h"
#include "surfels/errors.h"
#include "surfels/for_all.h"
#include "surfels/stopwatch.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace surfelao {
namespace {

/// Whether texels of each page hold an answer.
using Known = std::vector<std::vector<std::uint8_t>>;

/// Takes the answers of one band into a page.
class MapWriter {
public:
    MapWriter(MapBake& bake, Known& known, const BentEncoder& bent)
        : bake_(bake), known_(known), encode_(bent)
    {
    }

    void add(std::size_t page, std::span<const Texel> texels, std::span<const Occlusion> answers)
    {
        for (std::size_t first = 0, end = 0; first < texels.size(); first = end) {
            for (end = first + 1; end < texels.size() && texels[end].x == texels[first].x &&
                                  texels[end].y == texels[first].y;)
                ++end;
            write(page, texels.subspan(first, end - first), answers.subspan(first, end - first));
        }
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
    void write(std::size_t page, std::span<const Texel> texels, std::span<const Occlusion> sheets)
    {
        double sum = 0.0;
        for (const Occlusion& sheet : sheets)
            sum += sheet.occlusion;
        const double mean = sum / static_cast<double>(sheets.size());
        Map& visibility = bake_.visibility[page];
        const std::size_t index = visibility.index(texels.front().x, texels.front().y);
        visibility.values[index] = static_cast<float>(1.0 - mean);
        if (encode_)
            write_bent(page, index, texels, sheets);
        known_[page][index] = 1;
        occlusion_ += mean;
        ++bake_.covered;
        if (sheets.size() < 2)
            return;
        ++bake_.overlapping;
        sheets_ += sheets.size();
        for (const Occlusion& sheet : sheets)
            squares_ += (sheet.occlusion - mean) * (sheet.occlusion - mean);
    }

    /// Their mean by visibility.
    void write_bent(std::size_t page, std::size_t index, std::span<const Texel> texels,
                    std::span<const Occlusion> sheets)
    {
        glm::dvec3 bent(0.0);
        glm::vec3 first(0.0f);
        for (std::size_t i = 0; i < sheets.size(); ++i) {
            const glm::vec3 direction = encode_(page, texels[i].point, sheets[i].bent_normal);
            first = i == 0 ? direction : first;
            bent += (1.0 - sheets[i].occlusion) * glm::dvec3(direction);
        }
        const double length = glm::length(bent);
        const glm::vec3 normal = length > kLeastBent ? glm::vec3(bent / length) : first;
        for (int k = 0; k < 3; ++k)
            bake_.bent[page].values[3 * index + static_cast<std::size_t>(k)] = normal[k];
    }

    MapBake& bake_;
    Known& known_;
    const BentEncoder& encode_;
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

std::vector<SurfacePoint> points_of(std::span<const Texel> texels)
{
    std::vector<SurfacePoint> points(texels.size());
    for_all(points.size(), [&](std::size_t i) { points[i] = texels[i].point; });
    return points;
}

/// What is displayed at any point of the surface.
Shown shown_by(const Mesh& mesh, const MapLayout& layout, const std::vector<Map>& visibility)
{
    return [&](const SurfacePoint& point) {
        return 1.0f - fetch_at(visibility, places_of(mesh, layout, point));
    };
}

class MapBaker : public JudgedBaker {
public:
    MapBaker(const Mesh& mesh, const MapLayout& layout, const MapSettings& settings,
             const Offset& offset, const HighDetail* high, Occluders* occluders,
             const StageProgress& progress, std::optional<double> error = {})
        : JudgedBaker(high ? high->mesh().geometry : mesh.occluding(), occluders, settings.check,
                      progress, error),
          mesh_(mesh),
          layout_(layout),
          settings_(settings),
          offset_(offset),
          high_(high)
    {
    }

    /// The seconds are those of all calls so far.
    MapBake bake(const EngineSettings& engine)
    {
        const MapSize size = layout_.size;
        MapBake bake;
        bake.engine = engine;
        bake.visibility.assign(layout_.pages.size(), Map(size.width, size.height, 1));
        if (settings_.bent)
            bake.bent.assign(layout_.pages.size(), Map(size.width, size.height, 3));
        const Prepared& prepared = prepared_for(engine, seconds_.surfels, seconds_.tree);
        bake.surfels = prepared.surfel_count();
        Known known(layout_.pages.size(), std::vector<std::uint8_t>(size.count(), 0));
        solve_texels(prepared, engine, bake, known);

        enter("fill");
        Stopwatch watch;
        const Known hidden = leave_out_hidden(engine.definition, bake, known);
        const Seams seams = fill_pages(bake, known);
        seconds_.fill += watch.lap();
        for (std::size_t page = 0; page < layout_.pages.size(); ++page)
            fit_steps(prepared, engine, page, known[page], hidden[page], bake);
        watch.lap();
        bake.jump = seam_jump(seams, bake.visibility);
        for (Map& map : bake.bent)
            encode_directions(map);
        for (std::vector<Map>* maps : {&bake.visibility, &bake.bent})
            for (Map& map : *maps)
                round_to_depth(map, settings_.depth, settings_.half_is_whole);
        seconds_.fill += watch.lap();
        bake.seconds = seconds_;
        judge(bake);
        return bake;
    }

    /// Measures what has been baked last, if at all.
    void judge(MapBake& bake)
    {
        Stopwatch watch;
        if (count_ > 0)
            bake.error = error_of(bake);
        bake.seconds.check = seconds_.check += watch.lap();
    }

private:
    [[nodiscard]] std::uint32_t band_rows() const
    {
        return static_cast<std::uint32_t>(
            std::clamp<std::uint64_t>(kBandTexels / layout_.size.width, 1, layout_.size.height));
    }

    std::vector<Receiver> receivers_of(std::span<const SurfacePoint> points,
                                       std::uint64_t* misses = nullptr) const
    {
        return high_ ? high_->receivers(points, offset_, misses)
                     : receivers_at(mesh_.geometry, mesh_.surface, points, offset_);
    }

    /// Asks at the texels of all pages, band by band.
    void solve_texels(const Prepared& prepared, const EngineSettings& engine, MapBake& bake,
                      Known& known)
    {
        MapWriter writer(bake, known, settings_.bent);
        const std::uint32_t height = layout_.size.height;
        const std::uint32_t rows = band_rows();
        const auto pages = static_cast<double>(layout_.pages.size());
        std::vector<std::uint8_t> shown(mesh_.geometry.triangles.size(), 0);
        for (std::size_t page = 0; page < layout_.pages.size(); ++page) {
            enter("raster");
            Stopwatch watch;
            const MapRaster raster(mesh_.geometry, layout_.pages[page], layout_.size);
            raster.mark_shown(shown);
            bake.outside_triangles += raster.outside_triangles();
            for (std::uint32_t first = 0; first < height; first += rows) {
                const std::vector<Texel> texels = raster.texels(first, rows);
                const std::vector<Receiver> receivers =
                    receivers_of(points_of(texels), &bake.misses);
                seconds_.raster += watch.lap();
                const double begin = first, share = std::min(rows, height - first);
                const auto progress = [&](double done) {
                    const double of_page = (begin + share * done) / height;
                    return !progress_ ||
                           progress_("solve", (static_cast<double>(page) + of_page) / pages);
                };
                const auto ask = [&](std::span<const Receiver> asked) {
                    Solution solution = solve(prepared, asked, engine, progress);
                    bake.residual = solution.residual;
                    bake.receivers += asked.size();
                    return std::move(solution.occlusion);
                };
                // rays have noise of their own in each texel
                writer.add(page, texels,
                           engine.engine == Engine::rays
                               ? ask(receivers)
                               : sparse_answers(texels, receivers, layout_.size.width, ask));
                seconds_.solve += watch.lap();
            }
        }
        writer.finish();
        bake.flat_triangles = static_cast<std::uint64_t>(std::ranges::count(shown, 0));
    }

    /// Texels that nobody sees are no longer known; they themselves, or nothing where a page has
    /// none.
    Known leave_out_hidden(const Definition& definition, MapBake& bake, Known& known)
    {
        Known of_pages(known.size());
        for (std::size_t page = 0; page < known.size(); ++page) {
            std::vector<std::uint8_t>& hidden = of_pages[page];
            hidden = texels_maybe_hidden(bake.visibility[page], known[page]);
            if (hidden.empty())
                continue;
            const std::vector<Texel> texels = marked_texels(page, hidden);
            const std::vector<std::uint8_t> inside = inside_bodies(
                occluding(), ray_scene(), receivers_of(points_of(texels)), definition.max_distance);
            for (std::size_t i = 0; i < texels.size(); ++i)
                if (inside[i] == 0)  // one sheet of a texel that is seen is enough
                    hidden[index_of(texels[i])] = 0;
            for (std::size_t i = 0; i < hidden.size(); ++i) {
                bake.hidden += hidden[i];
                known[page][i] &= hidden[i] == 0;
            }
        }
        return of_pages;
    }

    /// As many rows of the map as fill a band with samples.
    [[nodiscard]] std::uint32_t rows_of_samples(const std::vector<std::uint8_t>& marked,
                                                std::uint32_t first) const
    {
        const std::size_t width = layout_.size.width;
        std::uint64_t count = 0;
        std::uint32_t row = first;
        while (row < layout_.size.height && (row == first || count < kBandTexels)) {
            const auto begin = marked.begin() + static_cast<std::ptrdiff_t>(row * width);
            count += kFitSide * kFitSide *
                     static_cast<std::uint64_t>(
                         std::count(begin, begin + static_cast<std::ptrdiff_t>(width), 1));
            ++row;
        }
        return row - first;
    }

    /// Nonzero for closed samples beside hidden texels that are hidden as these are; or nothing.
    std::vector<std::uint8_t> samples_inside(std::span<const Texel> texels,
                                             std::span<const Receiver> receivers,
                                             std::span<const Occlusion> answers,
                                             const std::vector<std::uint8_t>& hidden,
                                             const Definition& definition)
    {
        if (hidden.empty())
            return {};
        std::vector<std::size_t> asked;
        std::vector<Receiver> there;
        const Map grid(layout_.size.width, layout_.size.height, 0);
        for (std::size_t i = 0; i < texels.size(); ++i) {
            if (1.0f - answers[i].occlusion > kHiddenVisibility)
                continue;
            bool is_beside = false;
            const std::size_t texel =
                std::size_t{texels[i].y / kFitSide} * grid.width + texels[i].x / kFitSide;
            for_each_around(grid, texel,
                            [&](std::size_t other) { is_beside |= hidden[other] != 0; });
            if (!is_beside)
                continue;
            asked.push_back(i);
            there.push_back(receivers[i]);
        }
        if (asked.empty())
            return {};
        const std::vector<std::uint8_t> found =
            inside_bodies(occluding(), ray_scene(), there, definition.max_distance);
        std::vector<std::uint8_t> inside(texels.size(), 0);
        for (std::size_t k = 0; k < asked.size(); ++k)
            inside[asked[k]] = found[k];
        return inside;
    }

    const RayScene& ray_scene()
    {
        if (!rays_)
            rays_.emplace(occluding(), RayScene::Build::quick);
        return *rays_;
    }

    /// Gives texels of a page beside steps values that show these best. hidden: or nothing.
    void fit_steps(const Prepared& prepared, const EngineSettings& engine, std::size_t page,
                   const std::vector<std::uint8_t>& known, const std::vector<std::uint8_t>& hidden,
                   MapBake& bake)
    {
        Stopwatch watch;
        const auto [width, height] = layout_.size;
        Map& visibility = bake.visibility[page];
        const std::vector<std::uint8_t> marked = texels_with_steps(visibility, known);
        if (marked.empty() || std::max(width, height) > kMostTexels / kFitSide)
            return;
        const MapRaster raster(mesh_.geometry, layout_.pages[page],
                               {kFitSide * width, kFitSide * height});
        std::vector<TexelSample> samples;
        for (std::uint32_t first = 0, rows = 0; first < height; first += rows) {
            rows = rows_of_samples(marked, first);
            const std::vector<Texel> texels =
                raster.texels(kFitSide * first, kFitSide * rows, {marked, kFitSide});
            const std::vector<Receiver> receivers = receivers_of(points_of(texels));
            seconds_.raster += watch.lap();
            const std::vector<Occlusion> answers =
                solve(prepared, receivers, engine, progress_in("fit")).occlusion;
            seconds_.solve += watch.lap();
            bake.receivers += texels.size();
            const std::vector<std::uint8_t> inside =
                samples_inside(texels, receivers, answers, hidden, engine.definition);
            for (std::size_t i = 0; i < texels.size(); ++i)
                if (inside.empty() || inside[i] == 0)
                    samples.push_back({*uv_at(mesh_.geometry, layout_.pages[page], texels[i].point),
                                       1.0f - answers[i].occlusion, texels[i].share});
            seconds_.fill += watch.lap();
        }
        fit_texels(visibility, known, marked, samples);
        seconds_.fill += watch.lap();
    }

    [[nodiscard]] std::size_t index_of(const Texel& texel) const
    {
        return std::size_t{texel.y} * layout_.size.width + texel.x;
    }

    std::vector<Texel> marked_texels(std::size_t page,
                                     const std::vector<std::uint8_t>& marked) const
    {
        const MapRaster raster(mesh_.geometry, layout_.pages[page], layout_.size);
        const std::uint32_t width = layout_.size.width;
        std::vector<Texel> texels;
        for (std::uint32_t first = 0; first < layout_.size.height; first += band_rows()) {
            const std::uint32_t rows = std::min(band_rows(), layout_.size.height - first);
            const auto begin = marked.begin() + std::ptrdiff_t{first} * width;
            if (std::find(begin, begin + std::ptrdiff_t{rows} * width, 1) ==
                begin + std::ptrdiff_t{rows} * width)
                continue;
            const std::vector<Texel> some = raster.texels(first, rows, {marked, 1});
            texels.insert(texels.end(), some.begin(), some.end());
        }
        return texels;
    }

    /// What has no value gets one, and smooth seams show the same on both sides.
    Seams fill_pages(MapBake& bake, const Known& known) const
    {
        Seams seams = seams_of(mesh_, layout_);
        const std::uint32_t rings =
            bake.hidden == 0 ? settings_.padding : std::max(settings_.padding, kHiddenRings / 2);
        const auto fill = [&](std::vector<Map>& maps, bool joins) {
            Known filled = known;
            if (joins)
                fill_across(mesh_, layout_, seams, settings_.padding, maps, filled);
            for (std::size_t page = 0; page < maps.size(); ++page)
                fill_around(maps[page], filled[page], rings);
            if (joins)
                stitch(seams, maps, progress_in("fill"));
        };
        fill(bake.visibility, true);
        if (!bake.bent.empty())
            fill(bake.bent, settings_.joins_bent);
        bake.seams = seams.list.size();
        bake.smooth_seams = seams.smooth_count();
        return seams;
    }

    StatedError error_of(const MapBake& bake)
    {
        enter("check");
        const Shown shown = shown_by(mesh_, layout_, bake.visibility);
        if (!check_) {
            std::vector<double> density;
            density.reserve(mesh_.geometry.triangles.size());
            for (std::uint32_t t = 0; t < mesh_.geometry.triangles.size(); ++t)
                density.push_back(places_of(mesh_, layout_, {t, {0.25f, 0.25f}}).count > 0 ? 1.0
                                                                                           : 0.0);
            check_.emplace(
                mesh_.geometry, density,
                [&](std::span<const SurfacePoint> points) { return receivers_of(points); },
                occluding(), count_);
            check_->leave_out_hidden();
            check_->trace(bake.engine.definition, shown, progress_in("check"), asked_);
        }
        return check_->error_of(shown);
    }

    const Mesh& mesh_;
    const MapLayout& layout_;
    const MapSettings& settings_;
    const Offset& offset_;
    const HighDetail* high_;
    std::optional<RayScene> rays_;  ///< where there are hidden texels
    MapSeconds seconds_;
};

}  // namespace

MapBake bake_map(const Mesh& mesh, const MapLayout& layout, const MapSettings& settings,
                 const EngineSettings& engine, const Offset& offset, const StageProgress& progress,
                 const HighDetail* high, Occluders* occluders)
{
    return MapBaker(mesh, layout, settings, offset, high, occluders, progress).bake(engine);
}

MapBake bake_map_to_error(const Mesh& mesh, const MapLayout& layout, const MapSettings& settings,
                          const EngineSettings& engine, const Offset& offset, double error,
                          const StageProgress& progress, const HighDetail* high,
                          Occluders* occluders)
{
    MapBaker baker(mesh, layout, settings, offset, high, occluders, progress, error / 2.0);
    // fetching between four texels leaves two thirds of independent noise (2/3 in each direction
    // of its variance)
    constexpr double kKept = 2.0 / 3.0;
    return search_error(baker, engine, error, kKept);
}

}  // namespace surfelao

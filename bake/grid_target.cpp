#include "bake/grid_target.h"

#include "bake/cone_fit.h"
#include "bake/grid_fit.h"
#include "grid/cone.h"
#include "reference/closest_hit.h"
#include "surfels/errors.h"
#include "surfels/for_all.h"
#include "surfels/number_text.h"
#include "surfels/stopwatch.h"
#include "surfels/vertex_clusters.h"

#include <Eigen/Dense>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace surfelao {
namespace {

/// As many as a group of receivers holds (tree/receiver_groups.h).
constexpr std::size_t kHemispheres = 16;

/// Cells that are solved at once: a million receivers, 44 bytes each and what groups them.
constexpr std::size_t kBandCells = std::size_t{1} << 16;

/// Cells that are worth a thread's start: the fit of one is some thousand instructions.
constexpr std::size_t kCellGrain = 256;

/// The closer cells reach so far beyond the object, and are about this share of all (bunny, wingnut
/// and a table, 32 cells, against 1.05 and .65: errors .85 to .95 of the cones, .77 to .87 of the
/// harmonics).
constexpr float kInnerRoom = 1.2f;
constexpr double kInnerShare = 0.74;

/// An object counts as at least so thick beside its longest side: a sheet has a box too.
constexpr double kLeastThickness = 0.01;

/// How far out of the surface cells inside are moved, in diagonals.
constexpr float kMovedOut = 2e-3f;

/// Objects of more triangles are seen by cells with the vertices in each cube of this share of the
/// closest cells' distance as one: 1.1 million triangles take 0.84 of the time, and the error stays
/// (skull, sh: .0069 -> .0067; at 0.35 .0071, and no faster, as what is left is less even). A tree
/// of fewer triangles is built as fast as they are clustered.
constexpr std::size_t kClusteredFrom = 100'000;
constexpr double kClusterShare = 0.15;

/// To tell whether a place is inside; where the first of them agree, they are enough: a quarter of
/// the rays, and so four places a cube (grid_fit.cpp) take the time that two took.
constexpr std::size_t kInsideRays = 64, kFirstInsideRays = 16;

/// The box near an object beside its own, in which half of places_about() are.
constexpr double kNearShare = 1.2;

/// Directions even over the sphere along a spiral.
template <std::size_t count>
std::array<glm::vec3, count> spiral_directions()
{
    std::array<glm::vec3, count> directions;
    const double golden = std::numbers::pi * (3.0 - std::sqrt(5.0));
    for (std::size_t k = 0; k < count; ++k) {
        const double turn = static_cast<double>(k);
        const double z = 1.0 - (2.0 * turn + 1.0) / static_cast<double>(count);
        const double r = std::sqrt(1.0 - z * z);
        directions[k] = glm::vec3(r * std::cos(golden * turn), r * std::sin(golden * turn), z);
    }
    return directions;
}

/// From answers in the directions to harmonics.
class SphereFit {
public:
    SphereFit()
    {
        Eigen::Matrix<double, kHemispheres, kHarmonics> answers;
        for (std::size_t k = 0; k < kHemispheres; ++k) {
            const Harmonics along = harmonics_along(directions[k]);
            for (std::size_t c = 0; c < kHarmonics; ++c)
                answers(static_cast<int>(k), static_cast<int>(c)) = cosine_weight(c) * along[c];
        }
        inverse_ = answers.completeOrthogonalDecomposition().pseudoInverse().cast<float>();
    }

    /// answers: kHemispheres. values: channels_of(store).
    void fit(const Occlusion* answers, GridStore store, float* values) const
    {
        Harmonics found{};
        for (std::size_t c = 0; c < kHarmonics; ++c)
            for (std::size_t k = 0; k < kHemispheres; ++k)
                found[c] +=
                    inverse_(static_cast<int>(c), static_cast<int>(k)) * answers[k].occlusion;
        if (store == GridStore::sh) {
            std::ranges::copy(found, values);
            return;
        }
        glm::vec4 moments = moments_of(GridStore::sh, found.data());
        moments.w = std::clamp(moments.w, 0.0f, 1.0f);
        moments = fit_cone(moments, directions, {answers, kHemispheres});
        for (int c = 0; c < 4; ++c)
            values[c] = moments[c];
    }

    const std::array<glm::vec3, kHemispheres> directions = spiral_directions<kHemispheres>();

private:
    Eigen::Matrix<float, kHarmonics, kHemispheres> inverse_;
};

const SphereFit& sphere_fit()
{
    static const SphereFit fit;
    return fit;
}

glm::vec3 in_frame(glm::dvec3 place, const Frame& frame)
{
    return glm::vec3((place - frame.centre) / frame.diagonal);
}

/// Solves cells, and keeps count.
class GridSolver {
public:
    GridSolver(const Prepared& prepared, const EngineSettings& engine,
               const StageProgress& progress, AoGrid& grid, GridBake& bake)
        : prepared_(prepared), engine_(engine), progress_(progress), grid_(grid), bake_(bake)
    {
    }

    /// What cells would hold at these places; unit frame.
    [[nodiscard]] std::vector<float> values_at(std::string_view stage,
                                               std::span<const glm::vec3> places)
    {
        const std::size_t channels = channels_of(grid_.store);
        const SphereFit& sphere = sphere_fit();
        std::vector<float> values(places.size() * channels);
        std::vector<Receiver> receivers;
        for (std::size_t begin = 0; begin < places.size(); begin += kBandCells) {
            const std::size_t count = std::min(kBandCells, places.size() - begin);
            receivers.resize(count * kHemispheres);
            for_all(count, kCellGrain, [&](std::size_t i) {
                for (std::size_t k = 0; k < kHemispheres; ++k)
                    receivers[i * kHemispheres + k] = {places[begin + i], sphere.directions[k]};
            });
            const auto in_stage = [&](double done) {
                return progress_(stage,
                                 (static_cast<double>(begin) + done * static_cast<double>(count)) /
                                     static_cast<double>(places.size()));
            };
            const Solution solution =
                solve(prepared_, receivers, engine_, progress_ ? Progress(in_stage) : Progress());
            bake_.residual = solution.residual;
            bake_.receivers += receivers.size();
            for_all(count, kCellGrain, [&](std::size_t i) {
                sphere.fit(&solution.occlusion[i * kHemispheres], grid_.store,
                           &values[(begin + i) * channels]);
            });
        }
        return values;
    }

    /// places: of these cells.
    void solve_cells(std::string_view stage, std::span<const std::size_t> cells,
                     std::span<const glm::vec3> places)
    {
        const std::size_t channels = channels_of(grid_.store);
        const std::vector<float> values = values_at(stage, places);
        for (std::size_t i = 0; i < cells.size(); ++i)
            std::copy_n(&values[i * channels], channels, &grid_.values[cells[i] * channels]);
    }

private:
    const Prepared& prepared_;
    const EngineSettings& engine_;
    const StageProgress& progress_;
    AoGrid& grid_;
    GridBake& bake_;
};

/// All places of a grid, in the order of its cells.
std::vector<glm::vec3> places_of_cells(const AoGrid& grid, const Frame& frame)
{
    std::vector<glm::vec3> places;
    places.reserve(grid.cell_count());
    for (int z = 0; z < grid.cells.z; ++z)
        for (int y = 0; y < grid.cells.y; ++y)
            for (int x = 0; x < grid.cells.x; ++x)
                places.push_back(in_frame(place_of(grid, {x, y, z}), frame));
    return places;
}

/// Of these directions, in how many a ray from each place first meets the inner side of a surface.
/// Unit frame. scene: of the object.
std::vector<std::uint8_t> count_backs(const RayScene& scene, std::span<const glm::vec3> places,
                                      std::span<const glm::vec3> directions)
{
    constexpr std::size_t kAtOnce = 4096;  // 6 MB of rays at most
    std::vector<std::uint8_t> counts;
    std::vector<Ray> rays;
    for (std::size_t begin = 0; begin < places.size(); begin += kAtOnce) {
        const std::size_t end = std::min(begin + kAtOnce, places.size());
        rays.clear();
        for (std::size_t i = begin; i < end; ++i)
            for (const glm::vec3 direction : directions)
                rays.push_back({places[i], direction, std::numeric_limits<float>::infinity()});
        const std::vector<ClosestHit> hits = closest_hits(scene, rays);
        for (std::size_t first = 0; first < hits.size(); first += directions.size())
            counts.push_back(static_cast<std::uint8_t>(std::ranges::count_if(
                std::span(hits).subspan(first, directions.size()), [](const ClosestHit& hit) {
                    return hit.triangle != ClosestHit::kNone && hit.is_back;
                })));
    }
    return counts;
}

/// 1 for places from which most of kInsideRays rays first meet the inner side of a surface, else 0.
/// Where the first of them agree, the others are not asked. Unit frame. scene: of the object.
std::vector<std::uint8_t> inside_object(const RayScene& scene, std::span<const glm::vec3> places)
{
    static const auto first = spiral_directions<kFirstInsideRays>();
    static const auto others = spiral_directions<kInsideRays - kFirstInsideRays>();
    const std::vector<std::uint8_t> backs = count_backs(scene, places, first);
    std::vector<std::uint8_t> is_inside;
    std::vector<std::size_t> open;
    std::vector<glm::vec3> of_open;
    for (std::size_t i = 0; i < places.size(); ++i) {
        is_inside.push_back(backs[i] == kFirstInsideRays ? 1 : 0);
        if (backs[i] == 0 || backs[i] == kFirstInsideRays)
            continue;
        open.push_back(i);
        of_open.push_back(places[i]);
    }
    const std::vector<std::uint8_t> more = count_backs(scene, of_open, others);
    for (std::size_t k = 0; k < open.size(); ++k)
        is_inside[open[k]] = backs[open[k]] + more[k] > kInsideRays / 2 ? 1 : 0;
    return is_inside;
}

/// The same by what cells at these places hold: where half of all directions are open, nobody
/// needs to look.
std::vector<std::uint8_t> inside_object(const RayScene& scene, std::span<const glm::vec3> places,
                                        GridStore store, std::span<const float> values)
{
    std::vector<std::size_t> suspects;
    std::vector<glm::vec3> of_suspects;
    for (std::size_t i = 0; i < places.size(); ++i) {
        if (moments_of(store, &values[i * channels_of(store)]).w <= 0.5f)
            continue;
        suspects.push_back(i);
        of_suspects.push_back(places[i]);
    }
    const std::vector<std::uint8_t> found = inside_object(scene, of_suspects);
    std::vector<std::uint8_t> is_inside(places.size(), 0);
    for (std::size_t s = 0; s < suspects.size(); ++s)
        is_inside[suspects[s]] = found[s];
    return is_inside;
}

/// Cells inside of the object take what is seen from its surface.
void move_cells_out(const Geometry& object, const RayScene& scene,
                    std::span<const glm::vec3> places, std::span<const std::uint8_t> is_inside,
                    GridSolver& solver, GridBake& bake)
{
    std::vector<std::size_t> inside;
    std::vector<glm::vec3> from;
    for (std::size_t cell = 0; cell < places.size(); ++cell) {
        if (is_inside[cell] == 0)
            continue;
        inside.push_back(cell);
        from.push_back(places[cell]);
    }
    std::vector<glm::vec3> to;
    for (const NearestPlace& nearest : nearest_places(scene, object, from)) {
        const glm::vec3 way = nearest.position - from[to.size()];
        const glm::uvec3 t = object.triangles[nearest.triangle];
        const glm::vec3 face = glm::cross(object.positions[t.y] - object.positions[t.x],
                                          object.positions[t.z] - object.positions[t.x]);
        const bool is_away = nearest.distance > 1e-3f * kMovedOut;
        to.push_back(nearest.position + kMovedOut * glm::normalize(is_away ? way : face));
    }
    bake.inside = inside.size();
    solver.solve_cells("repair", inside, to);
}

/// Cells inside of the object: which, and what they hold.
void repair_cells(const Geometry& object, const RayScene& scene, std::span<const glm::vec3> places,
                  GridSolver& solver, GridBake& bake)
{
    AoGrid& grid = bake.grid;
    const std::vector<std::uint8_t> is_inside =
        inside_object(scene, places, grid.store, grid.values);
    move_cells_out(object, scene, places, is_inside, solver, bake);
    // places inside are left out before anybody is asked there: more than half of them
    std::vector<glm::dvec3> beside = places_beside(grid, is_inside);
    std::vector<glm::vec3> in_unit;
    for (const glm::dvec3 place : beside)
        in_unit.push_back(in_frame(place, object.frame));
    const std::vector<std::uint8_t> is_hidden = inside_object(scene, in_unit);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < beside.size(); ++i) {
        if (is_hidden[i] != 0)
            continue;
        beside[kept] = beside[i];
        in_unit[kept++] = in_unit[i];
    }
    beside.resize(kept);
    in_unit.resize(kept);
    fit_inside(grid, is_inside, beside, solver.values_at("repair", in_unit));
}

float largest_on_faces(const AoGrid& grid)
{
    float largest = 0.0f;
    for (int z = 0; z < grid.cells.z; ++z) {
        for (int y = 0; y < grid.cells.y; ++y) {
            for (int x = 0; x < grid.cells.x; ++x) {
                const glm::ivec3 cell(x, y, z);
                const bool is_face = glm::any(glm::equal(cell, glm::ivec3(0))) ||
                                     glm::any(glm::equal(cell, grid.cells - 1));
                if (is_face)
                    largest = std::max(
                        largest,
                        moments_of(grid.store,
                                   &grid.values[channels_of(grid.store) * grid.index_of(cell)])
                            .w);
            }
        }
    }
    return std::min(largest, 0.99f);  // of an object that fills its box
}

/// A small generator with the same numbers everywhere (SplitMix64).
class PlaceNumbers {
public:
    explicit PlaceNumbers(std::uint64_t seed) : state_(seed) {}

    /// uniform in [-1, 1)
    double next()
    {
        std::uint64_t z = state_ += 0x9E3779B97F4A7C15u;
        z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9u;
        z = (z ^ z >> 27) * 0x94D049BB133111EBu;
        return static_cast<double>((z ^ z >> 31) >> 11) * 0x1p-52 - 1.0;
    }
    glm::dvec3 in_cube()
    {
        const double x = next(), y = next();
        return {x, y, next()};
    }
    glm::vec3 direction()
    {
        const double z = next(), a = std::numbers::pi * next(), r = std::sqrt(1.0 - z * z);
        return glm::normalize(glm::vec3(r * std::cos(a), r * std::sin(a), z));
    }

private:
    std::uint64_t state_;
};

/// The error at random places about the object.
StatedError stated_error_of(const Geometry& object, const RayScene& scene, const AoGrid& grid,
                            const Definition& definition, std::uint32_t check,
                            const Progress& progress)
{
    constexpr std::uint64_t kSeed = 0x6121D;
    const std::vector<Receiver> places = places_about(object, grid, scene, check, kSeed);
    const auto receivers_of = [&](std::span<const SurfacePoint> points) {
        std::vector<Receiver> receivers;
        for (const SurfacePoint& point : points)
            receivers.push_back(places[point.triangle]);
        return receivers;
    };
    const std::vector<double> even(places.size(), 1.0);
    ErrorCheck judged(even, even, receivers_of, object, check);
    const Shown shown = [&](const SurfacePoint& point) {
        return occlusion_at(grid, object.frame, places[point.triangle]);
    };
    judged.trace(definition, shown, progress);
    return judged.error_of(shown);
}

}  // namespace

void check_grid(const GridSettings& settings)
{
    require(settings.resolution >= kLeastGrid && settings.resolution <= kMostGrid,
            "the resolution of a grid must be between " + std::to_string(kLeastGrid) + " and " +
                std::to_string(kMostGrid));
    require(settings.extent > 0.0 && settings.extent <= kMostExtent,
            "the extent of a grid must be above 0 and at most 0.5");
    require(settings.depth != MapDepth::whole, "grids have 8 or 16 bits");
}

namespace {

/// The share nearest to kInnerShare at which a cell stands: between two cells values are blended
/// evenly in u, which is even in space on either side of the bend, but not across it (bunny, 32
/// cells: twice the error).
float inner_share_of(int cells)
{
    const double last = cells - 1;
    const double cell = std::min(std::round((kInnerShare + 1.0) / 2.0 * last), last - 1.0);
    return static_cast<float>(2.0 * cell / last - 1.0);
}

/// Of half the box, where the object takes `object` of it: at most half of what is left.
float closer_part(float object)
{
    return std::min(kInnerRoom * object, 0.5f * (1.0f + object));
}

/// What its cells need to see of an object; empty: all of it.
std::optional<Geometry> clustered_for(const AoGrid& grid, const Geometry& object)
{
    if (object.triangles.size() <= kClusteredFrom)
        return std::nullopt;
    const glm::ivec3 middle = grid.cells / 2;
    const glm::dvec3 apart = place_of(grid, middle) - place_of(grid, middle - 1);
    const double closest = std::min({apart.x, apart.y, apart.z});
    return cluster_vertices(object,
                            static_cast<float>(kClusterShare * closest / object.frame.diagonal));
}

}  // namespace

std::string text_of(const GridSettings& settings)
{
    std::string text = "at=grid resolution=" + std::to_string(settings.resolution) + " extent=";
    append_shortest(text, settings.extent);
    text += " store=" + name_of(settings.store) + " border=" + name_of(settings.border);
    text += settings.uniform ? " uniform" : "";
    return text + (settings.depth == MapDepth::byte ? " depth=8" : " depth=16");
}

glm::dvec3 lift_of(const Box& object, const AoGrid& grid)
{
    const glm::dvec3 size = object.high - object.low;
    const double longest = std::max({size.x, size.y, size.z});
    glm::dvec3 lift(0.0);
    for (int axis = 0; axis < 3; ++axis) {
        const double half_box = 0.5 * (grid.high[axis] - grid.low[axis]);
        if (size[axis] < kLeastThickness * longest)
            lift[axis] = half_box * double{grid.inner[axis] / grid.inner_share} *
                         (grid.cells[axis] % 2 == 0 ? 1.0 : 2.0) / (grid.cells[axis] - 1);
    }
    return lift;
}

AoGrid empty_grid(const Box& object, const GridSettings& settings)
{
    AoGrid grid;
    grid.cells = glm::ivec3(settings.resolution);
    grid.store = settings.store;
    grid.border = settings.border;
    grid.inner_share = inner_share_of(settings.resolution);
    const glm::dvec3 middle = 0.5 * (object.low + object.high);
    glm::dvec3 half = 0.5 * (object.high - object.low);
    const double longest = std::max({half.x, half.y, half.z, 1e-300});
    half = glm::max(half, glm::dvec3(kLeastThickness * longest));
    for (int axis = 0; axis < 3; ++axis) {
        const double face = 4.0 * half[(axis + 1) % 3] * half[(axis + 2) % 3];
        const double reach =
            half[axis] + std::sqrt(face / (4.0 * std::numbers::pi * settings.extent));
        grid.low[axis] = middle[axis] - reach;
        grid.high[axis] = middle[axis] + reach;
        grid.inner[axis] = settings.uniform ? grid.inner_share
                                            : closer_part(static_cast<float>(half[axis] / reach));
    }
    return grid;
}

std::vector<Receiver> places_about(const Geometry& object, const AoGrid& box, const RayScene& scene,
                                   std::size_t count, std::uint64_t seed)
{
    const Box own = box_of(object);
    PlaceNumbers numbers(seed);
    std::vector<Receiver> found;
    // an object that fills its box leaves no place outside
    for (int round = 0; round < 100 && found.size() < count; ++round) {
        std::vector<glm::vec3> places;
        for (std::size_t i = 0; i < count; ++i) {
            const bool is_near = i % 2 == 1;
            const glm::dvec3 low = is_near ? own.low : box.low;
            const glm::dvec3 high = is_near ? own.high : box.high;
            const glm::dvec3 half = (is_near ? kNearShare : 1.0) * 0.5 * (high - low);
            places.push_back(in_frame(0.5 * (low + high) + half * numbers.in_cube(), object.frame));
        }
        const std::vector<std::uint8_t> is_inside = inside_object(scene, places);
        for (std::size_t i = 0; i < count && found.size() < count; ++i)
            if (is_inside[i] == 0)
                found.push_back({places[i], numbers.direction()});
    }
    return found;
}

float occlusion_at(const AoGrid& grid, const Frame& frame, const Receiver& receiver)
{
    return occlusion_at(grid, frame.centre + frame.diagonal * glm::dvec3(receiver.position),
                        receiver.normal);
}

GridBake bake_grid(const Geometry& object, const GridSettings& settings,
                   const EngineSettings& engine, std::uint32_t check, const StageProgress& progress)
{
    check_grid(settings);
    check_settings(engine, engine);
    require(engine.definition.kernel == Kernel::cosine && !engine.definition.ground,
            "grids know the cosine kernel and no ground");
    if (object.triangles.empty())
        throw InputError("an object without triangles hides nothing: there is no grid round it");
    const auto enter = [&](std::string_view stage) {
        if (progress && !progress(stage, 0.0))
            throw Cancelled();
    };
    GridBake bake;
    bake.engine = engine;
    const Box box = box_of(object);
    bake.grid = empty_grid(box, settings);
    bake.lift = lift_of(box, bake.grid);
    bake.grid.values.resize(bake.grid.cell_count() * channels_of(settings.store));
    enter("build");
    Stopwatch watch;
    const std::optional<Geometry> clustered = clustered_for(bake.grid, object);
    const Geometry& seen = clustered ? *clustered : object;
    const Prepared prepared = prepare(seen, engine);
    const RayScene scene(seen, RayScene::Build::quick);
    bake.seconds.surfels = prepared.seconds().surfels;
    bake.seconds.tree = watch.lap() - bake.seconds.surfels;
    bake.surfels = prepared.surfel_count();

    enter("solve");
    const std::vector<glm::vec3> places = places_of_cells(bake.grid, object.frame);
    std::vector<std::size_t> cells(places.size());
    for (std::size_t i = 0; i < cells.size(); ++i)
        cells[i] = i;
    GridSolver solver(prepared, engine, progress, bake.grid, bake);
    solver.solve_cells("solve", cells, places);
    bake.seconds.solve = watch.lap();
    enter("repair");
    repair_cells(seen, scene, places, solver, bake);
    bake.grid.border_value = largest_on_faces(bake.grid);
    bake.seconds.repair = watch.lap();
    if (check > 0) {
        enter("check");
        const auto in_stage = [&](double done) { return progress("check", done); };
        std::optional<RayScene> whole;
        if (clustered)
            whole.emplace(object, RayScene::Build::quick);
        bake.error = stated_error_of(object, whole ? *whole : scene, bake.grid, engine.definition,
                                     check, progress ? Progress(in_stage) : Progress());
        bake.seconds.check = watch.lap();
    }
    return bake;
}

}  // namespace surfelao

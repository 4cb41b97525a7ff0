#include "bake/point_target.h"

#include "surfels/errors.h"
#include "surfels/number_text.h"
#include "surfels/stopwatch.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

namespace surfelao {
namespace {

/// Where the outside is, draft tells as well as good.
constexpr float kOrientQuality = kDraft;

void enter_stage(const StageProgress& progress, std::string_view stage)
{
    if (progress && !progress(stage, 0.0))
        throw Cancelled();
}

Progress part_of(const Progress& whole, double from, double to)
{
    if (!whole)
        return {};
    return [&whole, from, to](double done) { return whole(from + (to - from) * done); };
}

/// Both sides of all voters, band by band.
void orient_by_openness(PointTarget& target, const Prepared& prepared, const Progress& progress)
{
    PointCloud& cloud = target.cloud;
    const std::vector<std::uint32_t> voters = voters_of(cloud);
    std::vector<Occlusion> sides[2];
    for (std::size_t first = 0; first < voters.size(); first += kBandPoints) {
        const std::size_t count = std::min(kBandPoints, voters.size() - first);
        std::vector<Receiver> receivers =
            receivers_at(cloud, std::span(voters).subspan(first, count), target.offset);
        for (int side = 0; side < 2; ++side) {
            const double done = static_cast<double>(first), whole = double(voters.size());
            const double from = (done + 0.5 * side * double(count)) / whole;
            const std::vector<Occlusion> answers =
                solve(prepared, receivers, {.quality = kOrientQuality},
                      part_of(progress, from, from + 0.5 * double(count) / whole))
                    .occlusion;
            sides[side].insert(sides[side].end(), answers.begin(), answers.end());
            std::ranges::transform(receivers, receivers.begin(), turned_round);
        }
    }
    orient(cloud, voters, sides[0], sides[1]);
}

/// Of a cloud: every point counts alike, those without a normal not at all.
class PointBaker : public JudgedBaker {
public:
    PointBaker(const PointTarget& target, Occluders& occluders, std::uint32_t check,
               const StageProgress& progress, std::optional<double> asked = {})
        : JudgedBaker(target.squares, &occluders, check, progress, asked), target_(target)
    {
    }

    VertexBake bake(const EngineSettings& engine)
    {
        const Prepared& prepared = prepared_for(engine, seconds_.surfels, seconds_.tree);
        VertexBake bake;
        bake.engine = engine;
        bake.surfels = prepared.surfel_count();
        enter("solve");
        Solution solution = solve_points(prepared, target_, engine, progress_in("solve"));
        seconds_.solve += solution.seconds;
        bake.residual = solution.residual;
        bake.values = std::move(solution.occlusion);
        bake.seconds = seconds_;
        judge(bake);
        return bake;
    }

    /// Measures what has been baked last, if at all.
    void judge(VertexBake& bake)
    {
        Stopwatch watch;
        if (count_ > 0)
            bake.error = error_of(bake);
        bake.seconds.check = seconds_.check += watch.lap();
    }

private:
    std::optional<StatedError> error_of(const VertexBake& bake)
    {
        const PointCloud& cloud = target_.cloud;
        std::vector<double> counts(cloud.normals.size());
        for (std::size_t i = 0; i < counts.size(); ++i)
            counts[i] = cloud.normals[i] == glm::vec3(0.0f) ? 0.0 : 1.0;
        if (std::ranges::count(counts, 1.0) == 0)
            return {};
        enter("check");
        const Shown shown = [&](const SurfacePoint& point) {
            return bake.values[point.triangle].occlusion;
        };
        if (!check_) {
            check_.emplace(
                counts, std::vector<double>(counts.size(), 1.0),
                [&](std::span<const SurfacePoint> points) {
                    std::vector<std::uint32_t> asked;
                    for (const SurfacePoint& point : points)
                        asked.push_back(point.triangle);
                    return receivers_at(target_.cloud, asked, target_.offset);
                },
                occluding(), count_);
            check_->trace(bake.engine.definition, shown, progress_in("check"), asked_);
        }
        return check_->error_of(shown);
    }

    const PointTarget& target_;
    VertexBakeSeconds seconds_;
};

std::string some_points(std::uint64_t count, std::uint64_t all)
{
    return std::to_string(count) + " of " + count_text(all, "point");
}

}  // namespace

void check_target(const Scene& scene, const TargetSettings& settings, const PartChoice& parts)
{
    const bool is_cloud = scene.triangles.empty();
    const bool has_cloud_option = settings.viewpoint || settings.occluder_spacing ||
                                  settings.normals.source == NormalSource::up;
    require(is_cloud || !has_cloud_option,
            scene.name +
                ": has faces, --viewpoint, --occluder-spacing and --normals up are for points");
    require(!is_cloud || settings.normals.source != NormalSource::flat,
            scene.name + ": has points only, no faces: --normals flat is for faces");
    require(!is_cloud || (settings.values == VertexValues::fit &&
                          settings.normals.crease == NormalSettings{}.crease),
            scene.name + ": has points only, no faces: --values and --crease are for faces");
    require(!is_cloud || parts == PartChoice{},
            scene.name + ": has points only, no faces, and no parts to be chosen");
}

PointTarget make_point_target(const Scene& scene, const TargetSettings& settings,
                              const StageProgress& progress, std::optional<Prepared>* masks)
{
    enter_stage(progress, "points");
    Stopwatch watch;
    PointSettings points;
    points.normals = settings.normals.source;
    points.viewpoint = settings.viewpoint;
    points.up = settings.sky.value_or(points.up);
    if (const auto& spacing = settings.occluder_spacing) {
        Box box;
        for (const glm::dvec3& p : scene.positions)
            box.include(p);
        points.spacing =
            spacing->percent ? spacing->value / 100.0 * frame_of(box).diagonal : spacing->value;
    }
    PointTarget target;
    target.cloud = make_point_cloud(scene, points);
    target.offset = offset_of(settings, target.cloud.frame);
    target.squares = squares_of(target.cloud);
    if (target.cloud.asked)
        target.orientation = Orientation::up;
    else if (settings.viewpoint || (target.cloud.counts.from_file == 0 && scene.viewpoint))
        target.orientation = Orientation::viewpoint;
    else if (target.cloud.counts.from_file > 0)
        target.orientation = Orientation::file;
    if (target.cloud.is_unoriented) {
        enter_stage(progress, "orient");
        const auto in_stage = [&](double done) { return !progress || progress("orient", done); };
        Prepared prepared = prepare(target.cloud, target.squares);
        orient_by_openness(target, prepared, in_stage);
        if (masks != nullptr)
            *masks = std::move(prepared);
    }
    target.seconds = watch.lap();
    return target;
}

std::optional<Ground> ground_below(const PointTarget& target,
                                   const std::optional<GroundPlane>& plane)
{
    const PointCloud& cloud = target.cloud;
    const double usual = cloud.spacing / std::sqrt(std::numbers::pi) / cloud.frame.diagonal;
    return ground_of(plane, {target.squares},
                     target.offset.value_or(kLift * static_cast<float>(usual)));
}

Mesh point_mesh(Scene scene, const std::shared_ptr<const PointTarget>& target)
{
    const PointCloud& cloud = target->cloud;
    Mesh mesh{std::move(scene), {}, {}};
    Geometry& geometry = mesh.geometry;
    const std::size_t count = cloud.positions.size();
    geometry.frame = cloud.frame;
    geometry.positions = cloud.positions;
    geometry.normals = cloud.normals;
    std::ranges::replace(geometry.normals, glm::vec3(0.0f), glm::vec3(0.0f, 0.0f, 1.0f));
    geometry.welded.resize(count);
    std::iota(geometry.welded.begin(), geometry.welded.end(), 0u);
    for (const float radius : cloud.radii)
        geometry.areas.push_back(std::numbers::pi_v<float> * radius * radius);
    mesh.surface.normals = cloud.normals;
    mesh.occluders = std::shared_ptr<const Geometry>(target, &target->squares);
    return mesh;
}

PointReport report_of(const PointTarget& target)
{
    const PointCloud& cloud = target.cloud;
    return {cloud.occluders.size(), cloud.spacing,      cloud.thinned_to, cloud.noise,
            cloud.is_flattened,     target.orientation, cloud.counts};
}

std::string name_of(Orientation orientation)
{
    switch (orientation) {
        case Orientation::file:
            return "file";
        case Orientation::viewpoint:
            return "viewpoint";
        case Orientation::openness:
            return "openness";
        case Orientation::up:
            return "up";
    }
    throw SettingsError("an orientation must be file, viewpoint, openness or up");
}

std::vector<std::string> point_notes(const PointTarget& target)
{
    const PointCloud& cloud = target.cloud;
    const PointCounts& counts = cloud.counts;
    const std::uint64_t all = cloud.positions.size();
    std::vector<std::string> notes;
    const auto add = [&](std::uint64_t count, const std::string& what) {
        if (count > 0)
            notes.push_back(some_points(count, all) + ' ' + what);
    };
    add(counts.duplicates, "where another one stands: they occlude once");
    if (cloud.thinned_to)
        notes.push_back(
            some_points(cloud.occluders.size(), all) + " occlude, one in each cube of " +
            exact(static_cast<float>(*cloud.thinned_to)) + " units: what is finer is not seen");
    add(counts.outliers, "far off all others: they do not occlude");
    if (cloud.is_flattened)
        notes.push_back(
            "the points scatter about their surface: each is moved onto the plane "
            "through its neighbours");
    add(counts.without_normal,
        "without a normal, since their neighbours lie in a line or there are none: open");
    if (static_cast<double>(counts.weak) > kNotableWeak * static_cast<double>(all))
        add(counts.weak, "might face the other way: --viewpoint tells where the scanner stood");
    return notes;
}

Solution solve_points(const Prepared& prepared, const PointTarget& target,
                      const SolveSettings& settings, const Progress& progress)
{
    const std::span<const std::uint32_t> order = target.cloud.order;
    Solution whole;
    whole.occlusion.resize(order.size());
    for (std::size_t first = 0; first < order.size(); first += kBandPoints) {
        const auto band = order.subspan(first, std::min(kBandPoints, order.size() - first));
        const double size = static_cast<double>(order.size());
        const Solution solution =
            solve(prepared, receivers_at(target.cloud, band, target.offset), settings,
                  part_of(progress, double(first) / size, double(first + band.size()) / size));
        for (std::size_t i = 0; i < band.size(); ++i)
            whole.occlusion[band[i]] = solution.occlusion[i];
        whole.seconds += solution.seconds;
        whole.residual = solution.residual;
    }
    return whole;
}

VertexBake bake_points(const PointTarget& target, const EngineSettings& engine, std::uint32_t check,
                       const StageProgress& progress, const Prepared* ready)
{
    Occluders occluders(target.cloud, target.squares, ready);
    return PointBaker(target, occluders, check, progress).bake(engine);
}

VertexBake bake_points_to_error(const PointTarget& target, const EngineSettings& engine,
                                double error, std::uint32_t check, const StageProgress& progress,
                                const Prepared* ready)
{
    Occluders occluders(target.cloud, target.squares, ready);
    PointBaker baker(target, occluders, check, progress, error / 2.0);
    return search_error(baker, engine, error, 1.0);
}

}  // namespace surfelao

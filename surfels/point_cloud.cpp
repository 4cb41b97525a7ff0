#include "surfels/point_cloud.h"

#include "surfels/errors.h"
#include "surfels/for_all.h"
#include "surfels/nearest.h"

#include <tbb/parallel_sort.h>
#include <Eigen/Eigenvalues>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>
#include <type_traits>
#include <utility>

namespace surfelao {
namespace {

constexpr std::size_t kPointGrain = 1024;
constexpr std::uint32_t kNobody = PointCloud::kNobody;

/// Cubes along each axis of the curve: what 63 bits hold.
constexpr std::uint32_t kCurveCubes = 1u << 21;

/// Neighbours in a line tell no plane: their second axis is this share of the first, squared.
constexpr double kLine = 1e-6;

/// Neighbours, and the point, that tell noise from curvature beside all kNormalNeighbours.
constexpr std::uint32_t kFewNeighbours = 9;

/// Points whose noise is told, at most: the median of so many is that of all to .5 % (their spread
/// over the root of their number).
constexpr std::size_t kNoiseSamples = std::size_t{1} << 17;

/// Half the side of a square of a disk's area, radius 1: sqrt(pi) / 2.
const float kHalfSide = 0.5f * std::sqrt(std::numbers::pi_v<float>);

/// Radians: neighbours' squares never turn alike (Vogel. A Better Way to Construct the Sunflower
/// Head. 1979).
constexpr float kGoldenAngle = 2.39996323f;

template <class Each>
void for_each_point(std::size_t count, const Each& each)
{
    for_all(count, kPointGrain, each);
}

/// Every third bit, from 21 bits.
std::uint64_t spread(std::uint64_t bits)
{
    bits = (bits | bits << 32) & 0x001f00000000ffffu;
    bits = (bits | bits << 16) & 0x001f0000ff0000ffu;
    bits = (bits | bits << 8) & 0x100f00f00f00f00fu;
    bits = (bits | bits << 4) & 0x10c30c30c30c30c3u;
    return (bits | bits << 2) & 0x1249249249249249u;
}

/// A point's cube on a Morton curve.
struct Cell {
    std::uint64_t code = 0;
    std::uint32_t point = 0;
};

/// Points in the order of their cubes of that size (unit frame), those of one cube by their places.
std::vector<Cell> cells_of(std::span<const glm::vec3> positions, double size)
{
    std::vector<Cell> cells(positions.size());
    for_each_point(cells.size(), [&](std::size_t i) {
        const auto along = [&](float at) {
            const double cube = std::floor((double{at} + 0.5) / size);
            return spread(static_cast<std::uint64_t>(std::clamp(cube, 0.0, kCurveCubes - 1.0)));
        };
        const glm::vec3 p = positions[i];
        cells[i] = {along(p.x) | along(p.y) << 1 | along(p.z) << 2, static_cast<std::uint32_t>(i)};
    });
    tbb::parallel_sort(cells.begin(), cells.end(), [&](const Cell& a, const Cell& b) {
        if (a.code != b.code)
            return a.code < b.code;
        const glm::vec3 p = positions[a.point], q = positions[b.point];
        return std::tie(p.x, p.y, p.z, a.point) < std::tie(q.x, q.y, q.z, b.point);
    });
    return cells;
}

/// The points of a scene while they become a cloud. A point's number is its place along the curve,
/// where its neighbours are near in memory too; in the scene they may be anywhere.
class PointsMaker {
public:
    PointsMaker(const Scene& scene, const PointSettings& settings)
        : scene_(scene), settings_(settings), count_(scene.positions.size())
    {
    }

    PointCloud make()
    {
        place_points();
        choose_members();
        take_file_normals();
        look_around();
        flatten_noise();
        judge_members();
        turn_normals();
        number_as_scene();
        return std::move(cloud_);
    }

private:
    static constexpr float kNotAsked = -1.0f;

    /// What a point sees of the members around it.
    struct Around {
        std::array<std::uint32_t, kPlaneNeighbours + 1> points;  ///< of the scene, nearest first
        std::array<float, kPlaneNeighbours + 1> distances2;
        std::uint32_t count = 0;
    };
    struct Plane {
        glm::vec3 normal{0.0f};  ///< zero where there is none
        glm::vec3 middle{0.0f};  ///< seen from the point
        float scatter = 0.0f;    ///< standard deviation about it
    };

    void place_points()
    {
        Box box;
        for (const glm::dvec3& p : scene_.positions)
            box.include(p);
        cloud_.frame = frame_of(box);
        std::vector<glm::vec3> places(count_);
        for_each_point(count_, [&](std::size_t i) {
            places[i] =
                glm::vec3((scene_.positions[i] - cloud_.frame.centre) / cloud_.frame.diagonal);
        });
        cells_ = cells_of(places, 1.0 / kCurveCubes);
        cloud_.order.resize(count_);
        cloud_.positions.resize(count_);
        for_each_point(count_, [&](std::size_t i) {
            cloud_.order[i] = cells_[i].point;
            cloud_.positions[i] = places[cells_[i].point];
            cells_[i].point = static_cast<std::uint32_t>(i);
        });
        cloud_.normals.resize(count_);
        cloud_.radii.resize(count_);
        cloud_.is_uneven.resize(count_);
        cloud_.neighbours.resize(count_);
    }

    /// Those of which neighbourhoods are made: one at each place, or in each cube.
    void choose_members()
    {
        std::optional<double> spacing = settings_.spacing;
        members_ = first_of_each(cells_, false);
        cells_ = {};
        cloud_.counts.duplicates = count_ - members_.size();
        if (!spacing && members_.size() > kMostOccluders)
            spacing = spacing_for(kMostOccluders);
        if (!spacing)
            return;
        const double size = *spacing / cloud_.frame.diagonal;
        if (!(size * kCurveCubes >= 1.0))
            throw InputError(scene_.name +
                             ": the spacing of occluders vanishes beside the size of "
                             "the cloud");
        cloud_.thinned_to = spacing;
        std::vector<glm::vec3> places;
        for (const std::uint32_t member : members_)
            places.push_back(cloud_.positions[member]);
        std::vector<Cell> cells = cells_of(places, size);
        for (Cell& cell : cells)
            cell.point = members_[cell.point];
        const std::size_t before = members_.size();
        members_ = first_of_each(cells, true);
        cloud_.counts.thinned = before - members_.size();
    }

    /// One point of each run: those of a cube, or at one place.
    std::vector<std::uint32_t> first_of_each(std::span<const Cell> cells, bool of_cubes) const
    {
        std::vector<std::uint32_t> first;
        first.reserve(cells.size());
        for (std::size_t i = 0; i < cells.size(); ++i) {
            const auto is_alike = [&](const Cell& a, const Cell& b) {
                return of_cubes ? a.code == b.code
                                : cloud_.positions[a.point] == cloud_.positions[b.point];
            };
            if (i == 0 || !is_alike(cells[i - 1], cells[i]))
                first.push_back(cells[i].point);
        }
        return first;
    }

    /// The size of cubes of which so many are occupied, to a few per cent; the scene's units. A
    /// surface of A has A / size^2 of them: the size is the finest of those that halve.
    double spacing_for(std::uint64_t most) const
    {
        double size = 1.0 / kCurveCubes;
        std::size_t count = members_.size();
        std::vector<glm::vec3> places;
        for (const std::uint32_t member : members_)
            places.push_back(cloud_.positions[member]);
        while (count > most) {
            size *= std::max(1.05, size * kCurveCubes < 1.5 ? 64.0
                                                            : std::sqrt(static_cast<double>(count) /
                                                                        static_cast<double>(most)));
            const std::vector<Cell> cells = cells_of(places, size);
            count = 0;
            for (std::size_t i = 0; i < cells.size(); ++i)
                count += i == 0 || cells[i - 1].code != cells[i].code;
        }
        return size * cloud_.frame.diagonal;
    }

    void take_file_normals()
    {
        const bool has_normals = !scene_.normals.empty();
        if (settings_.normals == NormalSource::file && !has_normals)
            throw InputError(scene_.name + ": has no normals");
        if (!has_normals || settings_.normals == NormalSource::smooth)
            return;
        from_file_ = true;
        for_each_point(count_, [&](std::size_t i) {
            const glm::dvec3 normal = scene_.normals.values[cloud_.order[i]];
            const double length = glm::length(normal);
            if (length > 0.0 && std::isfinite(length))
                cloud_.normals[i] = glm::vec3(normal / length);
        });
        for (const glm::vec3& normal : cloud_.normals)
            cloud_.counts.from_file += normal != glm::vec3(0.0f);
    }

    /// The nearest members on the point's own side of a thin sheet: where the file has normals,
    /// those that face the other way do not count.
    Around around(std::size_t point, std::uint32_t wanted) const
    {
        return around(point, cloud_.positions[point], wanted);
    }
    Around around(std::size_t point, glm::vec3 place, std::uint32_t wanted) const
    {
        Around found;
        std::array<std::uint32_t, kPlaneNeighbours + 1> indices;
        const std::size_t count = nearest_->find(place, std::span(indices).first(wanted),
                                                 std::span(found.distances2).first(wanted));
        for (std::size_t i = 0; i < count; ++i) {
            const std::uint32_t other = members_[indices[i]];
            if (from_file_ && glm::dot(file_normals_[other], file_normals_[point]) < 0.0f)
                continue;
            found.points[found.count] = other;
            found.distances2[found.count++] = found.distances2[i];
        }
        return found;
    }

    Plane plane_through(const Around& seen, glm::vec3 from, std::span<const glm::vec3> places) const
    {
        Eigen::Vector3d mean = Eigen::Vector3d::Zero();
        Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
        for (std::uint32_t i = 0; i < seen.count; ++i) {
            const glm::vec3 to = places[seen.points[i]] - from;
            const Eigen::Vector3d q(to.x, to.y, to.z);
            mean += q;
            squares += q * q.transpose();
        }
        const double count = std::max(1u, seen.count);
        mean /= count;
        const Eigen::Matrix3d covariance = squares / count - mean * mean.transpose();
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes;
        axes.computeDirect(covariance);
        const Eigen::Vector3d sizes = axes.eigenvalues(), normal = axes.eigenvectors().col(0);
        Plane plane;
        if (!(sizes[1] > kLine * sizes[2]) || !normal.allFinite())
            return plane;
        plane.normal = glm::normalize(glm::vec3(normal[0], normal[1], normal[2]));
        plane.middle = glm::vec3(mean[0], mean[1], mean[2]);
        plane.scatter = static_cast<float>(std::sqrt(std::max(0.0, sizes[0])));
        return plane;
    }

    /// Variance of the noise about the surface, in r: that of few neighbours about their plane has
    /// as much of it as that of many, but less of the curvature, which adds in proportion to the
    /// square of their number. Three of them determine the plane.
    float noise2_of(const Around& many, float many_scatter, std::size_t point) const
    {
        if (many.count <= kFewNeighbours || !(cloud_.radii[point] > 0.0f))
            return 0.0f;
        Around few = many;
        few.count = kFewNeighbours;
        const auto unbiased = [](float scatter, std::uint32_t count) {
            return scatter * scatter * static_cast<float>(count) / static_cast<float>(count - 3);
        };
        const float few_scatter =
            plane_through(few, cloud_.positions[point], cloud_.positions).scatter;
        const float grown = static_cast<float>(many.count) / kFewNeighbours;
        const float noise2 = (grown * grown * unbiased(few_scatter, few.count) -
                              unbiased(many_scatter, many.count)) /
                             (grown * grown - 1.0f);
        return std::max(0.0f, noise2) / (cloud_.radii[point] * cloud_.radii[point]);
    }

    /// Radius, neighbours and normal of every point, from the members around it.
    void look_around()
    {
        std::vector<glm::vec3> places;
        places.reserve(members_.size());
        for (const std::uint32_t member : members_)
            places.push_back(cloud_.positions[member]);
        nearest_.emplace(std::move(places));
        if (from_file_)
            file_normals_ = cloud_.normals;
        noise2_.assign(count_, kNotAsked);
        const std::size_t step = (members_.size() + kNoiseSamples - 1) / kNoiseSamples;
        for (std::size_t m = 0; m < members_.size(); m += step)
            noise2_[members_[m]] = 0.0f;
        for_each_point(count_, [&](std::size_t i) {
            const Around seen = around(i, kNormalNeighbours + 1);
            const std::uint32_t within = std::min(seen.count, kAreaNeighbours + 1);
            if (within > 1)
                cloud_.radii[i] =
                    std::sqrt(seen.distances2[within - 1] / static_cast<float>(within));
            auto& neighbours = cloud_.neighbours[i];
            neighbours.fill(kNobody);
            for (std::uint32_t s = 0, n = 0; s < seen.count && n < neighbours.size(); ++s)
                if (seen.points[s] != i)
                    neighbours[n++] = seen.points[s];
            const bool asks_noise = noise2_[i] != kNotAsked;
            if (!asks_noise && cloud_.normals[i] != glm::vec3(0.0f))
                return;
            const Plane plane = plane_through(seen, cloud_.positions[i], cloud_.positions);
            if (asks_noise)
                noise2_[i] = noise2_of(seen, plane.scatter, i);
            if (cloud_.normals[i] == glm::vec3(0.0f))
                cloud_.normals[i] = plane.normal;
        });
    }

    /// A scanner's noise is that of the whole cloud: all points are moved onto the planes of their
    /// neighbours, or none. Some among others would lie beside the squares of these.
    void flatten_noise()
    {
        std::vector<float> noise2;
        for (const std::uint32_t member : members_) {
            if (noise2_[member] != kNotAsked)
                noise2.push_back(noise2_[member]);
        }
        const auto middle = noise2.begin() + static_cast<std::ptrdiff_t>(noise2.size() / 2);
        std::ranges::nth_element(noise2, middle);
        cloud_.noise = std::sqrt(*middle);
        if (cloud_.noise > kScatter) {
            const std::vector<glm::vec3> scattered = cloud_.positions;
            for_each_point(count_, [&](std::size_t i) {
                const Plane plane = plane_through(around(i, scattered[i], kPlaneNeighbours + 1),
                                                  scattered[i], scattered);
                cloud_.positions[i] += glm::dot(plane.middle, plane.normal) * plane.normal;
                if (!from_file_ || file_normals_[i] == glm::vec3(0.0f))
                    cloud_.normals[i] = plane.normal;
            });
            cloud_.is_flattened = true;
        }
        for (const glm::vec3& normal : cloud_.normals)
            cloud_.counts.without_normal += normal == glm::vec3(0.0f);
    }

    /// Who occludes, and where the density changes.
    void judge_members()
    {
        std::vector<std::uint8_t> is_outlier(count_, 0);
        for_each_point(members_.size(), [&](std::size_t m) {
            const std::uint32_t i = members_[m];
            std::array<float, kAreaNeighbours> radii;
            radii.fill(std::numeric_limits<float>::infinity());
            std::size_t count = 0;
            for (const std::uint32_t other : cloud_.neighbours[i])
                if (other != kNobody)
                    radii[count++] = cloud_.radii[other];
            if (count == 0)
                return;
            std::ranges::sort(radii);
            const float own = cloud_.radii[i];
            is_outlier[i] = own > kOutlier * radii[count / 2];
            cloud_.is_uneven[i] =
                std::max(own, radii[count - 1]) > kUneven * std::min(own, radii[0]);
        });
        std::vector<float> radii;
        for (const std::uint32_t i : members_) {
            cloud_.counts.outliers += is_outlier[i];
            cloud_.counts.uneven += cloud_.is_uneven[i];
            if (is_outlier[i] == 0 && cloud_.radii[i] > 0.0f &&
                cloud_.normals[i] != glm::vec3(0.0f)) {
                cloud_.occluders.push_back(i);
                radii.push_back(cloud_.radii[i]);
            }
        }
        if (radii.empty())
            return;
        const auto middle = radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2);
        std::nth_element(radii.begin(), middle, radii.end());
        cloud_.spacing = std::sqrt(std::numbers::pi) * double{*middle} * cloud_.frame.diagonal;
    }

    void turn_normals()
    {
        const bool all = settings_.viewpoint.has_value();
        const std::optional<glm::dvec3> viewpoint = all ? settings_.viewpoint : scene_.viewpoint;
        if (settings_.normals == NormalSource::up)
            cloud_.asked = settings_.up;
        if (viewpoint && (all || !from_file_)) {
            const glm::dvec3 eye = (*viewpoint - cloud_.frame.centre) / cloud_.frame.diagonal;
            for_each_point(count_, [&](std::size_t i) {
                const glm::dvec3 to_eye = eye - glm::dvec3(cloud_.positions[i]);
                if (glm::dot(to_eye, glm::dvec3(cloud_.normals[i])) < 0.0)
                    cloud_.normals[i] = -cloud_.normals[i];
            });
        } else if (from_file_) {
            follow_file_normals();
        } else {
            turn_along_curve();
            cloud_.is_unoriented = !cloud_.asked;  // squares have no front
        }
        if (!cloud_.is_unoriented)
            cloud_.neighbours = {};
    }

    /// Points without a normal of the file are turned as their nearest with one.
    void follow_file_normals()
    {
        for_each_point(count_, [&](std::size_t i) {
            if (file_normals_[i] != glm::vec3(0.0f))
                return;
            for (const std::uint32_t other : cloud_.neighbours[i]) {
                if (other == kNobody || file_normals_[other] == glm::vec3(0.0f))
                    continue;
                if (glm::dot(file_normals_[other], cloud_.normals[i]) < 0.0f)
                    cloud_.normals[i] = -cloud_.normals[i];
                return;
            }
        });
    }

    /// Each as the nearest of those before it, so that clusters of points are one sheet, whichever
    /// way it faces.
    void turn_along_curve()
    {
        for (std::uint32_t i = 0; i < count_; ++i) {
            for (const std::uint32_t other : cloud_.neighbours[i]) {
                if (other >= i)
                    continue;
                if (glm::dot(cloud_.normals[i], cloud_.normals[other]) < 0.0f)
                    cloud_.normals[i] = -cloud_.normals[i];
                break;
            }
        }
    }

    void number_as_scene()
    {
        const auto number = [&](auto& values) {
            std::remove_reference_t<decltype(values)> numbered(count_);
            for_each_point(count_, [&](std::size_t i) { numbered[cloud_.order[i]] = values[i]; });
            values = std::move(numbered);
        };
        number(cloud_.positions);
        number(cloud_.normals);
        number(cloud_.radii);
        number(cloud_.is_uneven);
        for (std::uint32_t& occluder : cloud_.occluders)
            occluder = cloud_.order[occluder];
    }

    const Scene& scene_;
    const PointSettings& settings_;
    std::size_t count_;
    PointCloud cloud_;
    std::vector<Cell> cells_;               ///< of the points
    std::vector<std::uint32_t> members_;    ///< along the curve
    std::optional<NearestPoints> nearest_;  ///< of the members
    std::vector<float> noise2_;             ///< per point (noise2_of), or kNotAsked
    std::vector<glm::vec3> file_normals_;   ///< empty where they do not count
    bool from_file_ = false;
};

float share_of(const PointCloud& cloud, std::uint32_t point)
{
    return cloud.is_uneven[point] != 0 ? kUnevenShare : kSquareShare;
}

}  // namespace

PointCloud make_point_cloud(const Scene& scene, const PointSettings& settings)
{
    require(settings.normals != NormalSource::flat, "a cloud of points has no flat normals");
    require(!settings.spacing || (*settings.spacing > 0.0 && std::isfinite(*settings.spacing)),
            "the spacing of occluders must be above 0");
    require(!settings.viewpoint || std::isfinite(settings.viewpoint->x + settings.viewpoint->y +
                                                 settings.viewpoint->z),
            "a viewpoint must be finite");
    SURFELAO_CHECK(scene.triangles.empty());
    return PointsMaker(scene, settings).make();
}

Geometry squares_of(const PointCloud& cloud)
{
    const std::size_t count = cloud.occluders.size();
    Geometry geometry;
    geometry.frame = cloud.frame;
    do_both(
        [&] {
            geometry.positions.resize(4 * count);
            geometry.triangles.resize(2 * count);
        },
        [&] {
            geometry.normals.resize(4 * count);
            geometry.welded.resize(4 * count);
            geometry.areas.resize(4 * count);
        });
    for_each_point(count, [&](std::size_t k) {
        const std::uint32_t i = cloud.occluders[k];
        const glm::vec3 n = cloud.normals[i];
        const float half = share_of(cloud, i) * kHalfSide * cloud.radii[i];
        const glm::vec3 aside = glm::normalize(glm::cross(
            n, std::abs(n.x) < 0.7f ? glm::vec3(1.0f, 0.0f, 0.0f) : glm::vec3(0.0f, 1.0f, 0.0f)));
        const float angle = kGoldenAngle * static_cast<float>(i % 4096);
        const glm::vec3 to_corner =
            std::numbers::sqrt2_v<float> * half *
            (std::cos(angle) * aside + std::sin(angle) * glm::cross(n, aside));
        const glm::vec3 to_next = glm::cross(n, to_corner);
        const auto first = static_cast<std::uint32_t>(4 * k);
        const std::array corners{to_corner, to_next, -to_corner, -to_next};
        const float third = 4.0f * half * half / 3.0f;
        for (std::uint32_t c = 0; c < 4; ++c) {
            geometry.positions[first + c] = cloud.positions[i] + corners[c];
            geometry.normals[first + c] = n;
            geometry.welded[first + c] = first + c;
            geometry.areas[first + c] = c % 2 == 0 ? third : 0.5f * third;
        }
        geometry.triangles[2 * k] = {first, first + 1, first + 2};
        geometry.triangles[2 * k + 1] = {first, first + 2, first + 3};
    });
    return geometry;
}

std::vector<Surfel> disks_of(const PointCloud& cloud)
{
    std::vector<Surfel> disks(cloud.occluders.size());
    for_each_point(disks.size(), [&](std::size_t k) {
        const std::uint32_t i = cloud.occluders[k];
        disks[k] = {cloud.positions[i], std::numbers::pi_v<float> * cloud.radii[i] * cloud.radii[i],
                    cloud.normals[i]};
    });
    return disks;
}

std::vector<Receiver> receivers_at(const PointCloud& cloud, std::span<const std::uint32_t> points,
                                   const Offset& offset)
{
    std::vector<Receiver> receivers(points.size());
    for_each_point(receivers.size(), [&](std::size_t k) {
        const std::uint32_t i = points[k];
        const float lift = offset.value_or(kLift * cloud.radii[i]);
        const glm::vec3 normal = cloud.asked.value_or(cloud.normals[i]);
        receivers[k] = {cloud.positions[i] + lift * normal, normal, lift};
    });
    return receivers;
}

Receiver turned_round(const Receiver& receiver)
{
    return {receiver.position - 2.0f * receiver.offset * receiver.normal, -receiver.normal,
            receiver.offset};
}

}  // namespace surfelao

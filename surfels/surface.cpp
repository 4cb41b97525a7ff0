#include "surfels/surface.h"

#include "surfels/buckets.h"
#include "surfels/errors.h"
#include "surfels/for_all.h"
#include "surfels/owner_ranges.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <utility>

namespace surfelao {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// Of the faces around one place, how many are told apart exactly. More come together in the hubs
/// of fans, whose faces take the normal of the kind that is nearest to theirs.
constexpr std::size_t kMostKinds = 64;

/// A mean shorter than this share of its weights has cancelled.
constexpr float kCancelled = 1e-4f;

struct Face {
    glm::vec3 normal{0.0f};
    glm::vec3 angles{0.0f};  ///< at its corners, radians
};

/// In doubles from the file's own positions: a sliver's normal would not survive the unit frame.
Face face_of(const Scene& scene, glm::uvec3 triangle)
{
    const std::array<glm::dvec3, 3> p{scene.positions[triangle.x], scene.positions[triangle.y],
                                      scene.positions[triangle.z]};
    Face face;
    const glm::dvec3 doubled = glm::cross(p[1] - p[0], p[2] - p[0]);
    const double length = glm::length(doubled);
    if (!(length > 0.0) || !std::isfinite(length))
        return face;
    face.normal = glm::vec3(doubled / length);
    for (int corner = 0; corner < 3; ++corner) {
        const glm::dvec3 a = p[(corner + 1) % 3] - p[corner], b = p[(corner + 2) % 3] - p[corner];
        face.angles[corner] = static_cast<float>(std::atan2(length, glm::dot(a, b)));
    }
    return face;
}

std::vector<Face> faces_of(const Scene& scene, const Geometry& geometry)
{
    std::vector<Face> faces(geometry.triangles.size());
    for_all(faces.size(), [&](std::size_t t) { faces[t] = face_of(scene, geometry.triangles[t]); });
    return faces;
}

/// v of unit length; `instead` where it has no direction to speak of beside `weight`.
glm::vec3 direction_of(glm::vec3 v, float weight, glm::vec3 instead)
{
    const float length = glm::length(v);
    return length > kCancelled * weight ? v / length : instead;
}

/// Smooth normals of any corner, asked for one after the other.
class SmoothNormals {
public:
    SmoothNormals(const Geometry& geometry, const std::vector<Face>& faces, float crease)
        : geometry_(geometry), faces_(faces), crease_cosine_(std::cos(glm::radians(crease)))
    {
        const std::vector<std::uint32_t>& welded = geometry.welded;
        means_.assign(welded.size(), glm::vec3(0.0f));
        for_owner_ranges(means_.size(), [&](OwnerRange range) {
            for (std::size_t t = 0; t < faces.size(); ++t) {
                for (int corner = 0; corner < 3; ++corner) {
                    const std::uint32_t place = welded[geometry.triangles[t][corner]];
                    if (range.has(place))
                        means_[place] += faces[t].angles[corner] * faces[t].normal;
                }
            }
        });
        for_all(means_.size(), [&](std::size_t place) {
            means_[place] = direction_of(means_[place], 1.0f, glm::vec3(0.0f));
        });

        // where all are within half the angle of their mean, all are within the angle of each other
        const float half_cosine = std::cos(0.5f * glm::radians(crease));
        std::vector<std::uint8_t> is_bent(welded.size(), 0);
        for_all(faces.size(), [&](std::size_t t) {
            for (int corner = 0; corner < 3; ++corner) {
                const std::uint32_t place = welded[geometry.triangles[t][corner]];
                if (!(glm::dot(means_[place], faces[t].normal) >= half_cosine))
                    std::atomic_ref(is_bent[place]).store(1, std::memory_order_relaxed);
            }
        });
        bend_of_.assign(welded.size(), kNone);
        std::uint32_t bends = 0;
        for (std::size_t place = 0; place < bend_of_.size(); ++place) {
            if (is_bent[place] != 0)
                bend_of_[place] = bends++;
        }
        if (bends > 0)
            solve_bends(bends);
    }

    /// Whether all corners at the place of a vertex have one normal, mean_at() of it.
    [[nodiscard]] bool is_smooth_at(std::uint32_t vertex) const
    {
        return bend_of_[geometry_.welded[vertex]] == kNone && mean_at(vertex) != glm::vec3(0.0f);
    }
    [[nodiscard]] glm::vec3 mean_at(std::uint32_t vertex) const
    {
        return means_[geometry_.welded[vertex]];
    }

    [[nodiscard]] glm::vec3 at(std::size_t triangle, int corner) const
    {
        const std::uint32_t vertex = geometry_.triangles[triangle][corner];
        const std::uint32_t bend = bend_of_[geometry_.welded[vertex]];
        if (bend == kNone)
            return mean_at(vertex);
        const std::uint32_t index =
            static_cast<std::uint32_t>(3 * triangle) + static_cast<std::uint32_t>(corner);
        const std::span<const std::uint32_t> corners = (*bends_)[bend];
        return bent_normals_[first_of(corners) +
                             static_cast<std::size_t>(std::ranges::lower_bound(corners, index) -
                                                      corners.begin())];
    }

private:
    void solve_bends(std::uint32_t bends)
    {
        bends_.emplace(bends, [&](const auto& put) {
            for (std::uint32_t t = 0; t < faces_.size(); ++t) {
                for (std::uint32_t corner = 0; corner < 3; ++corner) {
                    const std::uint32_t vertex = geometry_.triangles[t][static_cast<int>(corner)];
                    const std::uint32_t bend = bend_of_[geometry_.welded[vertex]];
                    if (bend != kNone)
                        put(bend, 3 * t + corner);
                }
            }
        });
        const std::span<const std::uint32_t> last = (*bends_)[bends - 1];
        bent_normals_.resize(first_of(last) + last.size());
        for_all(bends, [&](std::size_t bend) {
            const std::span<const std::uint32_t> corners = (*bends_)[bend];
            solve_bend(corners, bent_normals_.data() + first_of(corners));
        });
    }

    /// Which of all corners at bends is the first of these.
    [[nodiscard]] std::size_t first_of(std::span<const std::uint32_t> corners) const
    {
        return static_cast<std::size_t>(corners.data() - (*bends_)[0].data());
    }

    /// The corners at one place, and the first of their normals.
    void solve_bend(std::span<const std::uint32_t> corners, glm::vec3* solved) const
    {
        struct Kind {
            glm::vec3 normal;
            float angle;
        };
        std::vector<Kind> kinds;
        std::vector<std::size_t> kind_of;
        for (const std::uint32_t corner : corners) {
            const Face& face = faces_[corner / 3];
            const float angle = face.angles[static_cast<int>(corner % 3)];
            std::size_t kind = kinds.size();
            if (kind == kMostKinds) {
                kind = static_cast<std::size_t>(
                    std::ranges::max_element(
                        kinds, {},
                        [&](const Kind& other) { return glm::dot(other.normal, face.normal); }) -
                    kinds.begin());
                kinds[kind].angle += angle;
            } else {
                kinds.push_back({face.normal, angle});
            }
            kind_of.push_back(kind);
        }
        std::vector<glm::vec3> normals;
        for (const Kind& own : kinds) {
            glm::vec3 sum(0.0f);
            float weight = 0.0f;
            for (const Kind& other : kinds) {
                if (glm::dot(own.normal, other.normal) >= crease_cosine_ || &own == &other) {
                    sum += other.angle * other.normal;
                    weight += other.angle;
                }
            }
            normals.push_back(direction_of(sum, weight, own.normal));
        }
        for (std::size_t i = 0; i < corners.size(); ++i)
            solved[i] = normals[kind_of[i]];
    }

    const Geometry& geometry_;
    const std::vector<Face>& faces_;
    float crease_cosine_;
    std::vector<glm::vec3> means_;        ///< per place, over all faces
    std::vector<std::uint32_t> bend_of_;  ///< per place: its number among those that are not all
                                          ///< smooth, or kNone
    std::optional<Buckets<std::uint32_t>> bends_;  ///< their corners, rising
    std::vector<glm::vec3> bent_normals_;          ///< of these
};

/// Gives wedges to corners in rising order.
class Wedges {
public:
    Wedges(const Geometry& geometry, Surface& surface) : geometry_(geometry), surface_(surface)
    {
        surface_.normals.assign(geometry.positions.size(), glm::vec3(0.0f));
    }

    void add(std::size_t triangle, int corner, glm::vec3 normal)
    {
        const std::uint32_t vertex = geometry_.triangles[triangle][corner];
        const std::uint32_t wedge = wedge_of(vertex, normal);
        if (wedge != vertex)
            surface_.split_corners[triangle][corner] = wedge;
    }

    void finish()
    {
        surface_.extra_vertices.shrink_to_fit();
        surface_.normals.reserve(surface_.normals.size() + extra_normals_.size());
        surface_.normals.insert(surface_.normals.end(), extra_normals_.begin(),
                                extra_normals_.end());
    }

private:
    static constexpr int kMostWedges = 64;  ///< of one vertex that are told apart, but for a few

    std::uint32_t wedge_of(std::uint32_t vertex, glm::vec3 normal)
    {
        glm::vec3& own = surface_.normals[vertex];
        if (own == glm::vec3(0.0f))
            own = normal;
        if (glm::dot(own, normal) >= kSameNormal)
            return vertex;
        if (first_extra_.empty()) {
            first_extra_.assign(surface_.normals.size(), kNone);
            surface_.split_corners = geometry_.triangles;
        }
        int looked_at = 0;
        for (std::uint32_t e = first_extra_[vertex]; e != kNone; e = next_extra_[e]) {
            if (glm::dot(extra_normals_[e], normal) >= kSameNormal || ++looked_at == kMostWedges)
                return static_cast<std::uint32_t>(first_extra_.size()) + e;
        }
        const auto extra = static_cast<std::uint32_t>(extra_normals_.size());
        extra_normals_.push_back(normal);
        surface_.extra_vertices.push_back(vertex);
        next_extra_.push_back(first_extra_[vertex]);
        first_extra_[vertex] = extra;
        return static_cast<std::uint32_t>(first_extra_.size()) + extra;
    }

    const Geometry& geometry_;
    Surface& surface_;
    std::vector<glm::vec3> extra_normals_;
    std::vector<std::uint32_t> first_extra_, next_extra_;
};

/// The file's normal of a corner; zero where it gives none, or none with a direction.
class FileNormals {
public:
    FileNormals(const Scene& scene, const Geometry& geometry)
        : normals_(scene.normals), geometry_(geometry)
    {
    }

    struct Given {
        glm::vec3 normal{0.0f};
        bool given = false;  ///< the file says something, be it usable or not
    };

    [[nodiscard]] Given at(std::size_t triangle, int corner) const
    {
        if (normals_.empty())
            return {};
        const std::uint32_t index =
            normals_.corners.empty() ? geometry_.triangles[triangle][corner]
                                     : normals_.corners[geometry_.scene_triangle(triangle)][corner];
        if (index == CornerNormals::kNone)
            return {};
        const glm::vec3 value = normals_.values[index];
        if (value == glm::vec3(0.0f))
            return {};
        const glm::dvec3 wide(value);
        const double length = glm::length(wide);
        if (!(length > 0.0) || !std::isfinite(length))
            return {glm::vec3(0.0f), true};
        return {glm::vec3(wide / length), true};
    }

private:
    const CornerNormals& normals_;
    const Geometry& geometry_;
};

/// Gives the vertices at smooth places their normals: the corners there have the vertices' own
/// wedges. Returns per triangle whether it has other corners too.
std::vector<std::uint8_t> take_smooth(const Geometry& geometry, const SmoothNormals& smooth,
                                      Surface& surface)
{
    std::vector<std::uint8_t> is_left(geometry.triangles.size(), 0);
    std::vector<std::uint8_t> takes(surface.normals.size(), 0);
    for_all(is_left.size(), [&](std::size_t t) {
        for (int corner = 0; corner < 3; ++corner) {
            const std::uint32_t vertex = geometry.triangles[t][corner];
            if (smooth.is_smooth_at(vertex))
                std::atomic_ref(takes[vertex]).store(1, std::memory_order_relaxed);
            else
                is_left[t] = 1;
        }
    });
    for_all(takes.size(), [&](std::size_t v) {
        if (takes[v] != 0)
            surface.normals[v] = smooth.mean_at(static_cast<std::uint32_t>(v));
    });
    return is_left;
}

}  // namespace

void check_normals(const NormalSettings& settings)
{
    require(settings.crease >= 0.0f && settings.crease <= 180.0f,
            "crease must be between 0 and 180 degrees");
}

Surface make_surface(const Scene& scene, const Geometry& geometry, const NormalSettings& settings)
{
    check_normals(settings);
    const std::vector<Face> faces = faces_of(scene, geometry);
    const bool flat = settings.source == NormalSource::flat;
    const bool from_file =
        settings.source == NormalSource::automatic || settings.source == NormalSource::file;
    const SmoothNormals smooth(geometry, faces, flat ? 0.0f : settings.crease);
    const FileNormals file(scene, geometry);
    Surface surface;
    Wedges wedges(geometry, surface);
    std::vector<std::uint8_t> is_left(faces.size(), 1);
    if (!flat && !(from_file && !scene.normals.empty()))
        is_left = take_smooth(geometry, smooth, surface);
    for (std::size_t t = 0; t < faces.size(); ++t) {
        if (is_left[t] == 0)
            continue;
        for (int corner = 0; corner < 3; ++corner) {
            const FileNormals::Given given = from_file ? file.at(t, corner) : FileNormals::Given{};
            const bool usable =
                given.normal != glm::vec3(0.0f) && (settings.source == NormalSource::file ||
                                                    glm::dot(given.normal, faces[t].normal) > 0.0f);
            surface.corners_from_file += usable;
            surface.replaced_corners += given.given && !usable;
            const glm::vec3 normal = usable ? given.normal
                                     : flat ? faces[t].normal
                                            : smooth.at(t, corner);
            wedges.add(t, corner, normal);
        }
    }
    wedges.finish();
    // vertices that no triangle uses: the geometry's, where it has one
    for (std::size_t v = 0; v < geometry.normals.size(); ++v) {
        if (surface.normals[v] == glm::vec3(0.0f))
            surface.normals[v] = geometry.normals[v];
    }
    return surface;
}

float offset_at(const Geometry& geometry, std::uint32_t triangle, const Offset& offset)
{
    if (offset)
        return *offset;
    const glm::uvec3 t = geometry.triangles[triangle];
    const glm::vec3 a = geometry.positions[t.y] - geometry.positions[t.x];
    const glm::vec3 b = geometry.positions[t.z] - geometry.positions[t.x];
    const float size = std::sqrt(glm::length(glm::cross(a, b)));
    return std::clamp(kOffsetShare * size, kLeastOffset, kMostOffset);
}

void receivers_at(const Geometry& geometry, const Surface& surface,
                  std::span<const SurfacePoint> points, const Offset& offset,
                  std::span<Receiver> receivers)
{
    const std::vector<glm::uvec3>& corners = surface.corners(geometry);
    const auto place = [&](const SurfacePoint& point) {
        const glm::uvec3 t = geometry.triangles[point.triangle];
        const glm::uvec3 wedges = corners[point.triangle];
        const glm::vec3 a = geometry.positions[t.x];
        const glm::vec3 b = geometry.positions[t.y] - a, c = geometry.positions[t.z] - a;
        const glm::vec3 up = glm::normalize(glm::cross(b, c));
        const glm::vec3 shading = (1.0f - point.at.x - point.at.y) * surface.normals[wedges.x] +
                                  point.at.x * surface.normals[wedges.y] +
                                  point.at.y * surface.normals[wedges.z];
        const glm::vec3 normal = direction_of(shading, 1.0f, up);
        const float side = glm::dot(normal, up) < 0.0f ? -1.0f : 1.0f;
        const float height = offset_at(geometry, point.triangle, offset);
        return Receiver{a + (point.at.x * b + point.at.y * c) + side * height * up, normal, height};
    };
    for_all(points.size(), [&](std::size_t i) { receivers[i] = place(points[i]); });
}

std::vector<Receiver> receivers_at(const Geometry& geometry, const Surface& surface,
                                   std::span<const SurfacePoint> points, const Offset& offset)
{
    std::vector<Receiver> receivers(points.size());
    receivers_at(geometry, surface, points, offset, receivers);
    return receivers;
}

namespace {

/// What the corners of a wedge have in common.
struct WedgeShape {
    glm::vec3 inward{0.0f};        ///< their bisectors, by angle
    std::uint32_t tear = 0;        ///< 0 where they close around the vertex (as in weld.cpp)
    std::uint32_t middle = kNone;  ///< corner whose bisector is nearest to `inward`
    float nearest = 0.0f;
};

/// Of a corner, into its triangle, times its angle.
glm::vec3 bisector_of(const Geometry& geometry, glm::uvec3 t, int corner)
{
    const glm::vec3 p = geometry.positions[t[corner]];
    const glm::vec3 a = glm::normalize(geometry.positions[t[(corner + 1) % 3]] - p);
    const glm::vec3 b = glm::normalize(geometry.positions[t[(corner + 2) % 3]] - p);
    const float angle = std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
    return angle * direction_of(a + b, 1.0f, a);
}

std::vector<WedgeShape> shapes_of(const Geometry& geometry, const Surface& surface)
{
    const std::vector<glm::uvec3>& corners = surface.corners(geometry);
    std::vector<WedgeShape> shapes(surface.normals.size());
    const auto hash = [&](std::uint32_t v) { return (geometry.welded[v] + 1) * 0x9E3779B1u; };
    for (std::size_t t = 0; t < geometry.triangles.size(); ++t) {
        const glm::uvec3 triangle = geometry.triangles[t];
        for (int corner = 0; corner < 3; ++corner) {
            WedgeShape& shape = shapes[corners[t][corner]];
            shape.inward += bisector_of(geometry, triangle, corner);
            shape.tear += hash(triangle[(corner + 1) % 3]) - hash(triangle[(corner + 2) % 3]);
        }
    }
    for (std::size_t t = 0; t < geometry.triangles.size(); ++t) {
        for (int corner = 0; corner < 3; ++corner) {
            WedgeShape& shape = shapes[corners[t][corner]];
            if (shape.tear == 0)
                continue;
            const float near =
                glm::dot(shape.inward, bisector_of(geometry, geometry.triangles[t], corner));
            if (shape.middle == kNone || near > shape.nearest) {
                shape.nearest = near;
                shape.middle =
                    static_cast<std::uint32_t>(3 * t) + static_cast<std::uint32_t>(corner);
            }
        }
    }
    return shapes;
}

/// Just inside of a wedge that ends at its vertex: a little way into it, on its middle triangle.
Receiver just_inside(const Geometry& geometry, const Surface& surface, std::uint32_t wedge,
                     const WedgeShape& shape, float height)
{
    const glm::vec3 normal = surface.normals[wedge];
    const glm::uvec3 t = geometry.triangles[shape.middle / 3];
    const auto corner = static_cast<int>(shape.middle % 3);
    const glm::vec3 p = geometry.positions[t[corner]];
    glm::vec3 up = glm::normalize(glm::cross(geometry.positions[t.y] - geometry.positions[t.x],
                                             geometry.positions[t.z] - geometry.positions[t.x]));
    const glm::vec3 flat = shape.inward - glm::dot(shape.inward, up) * up;
    const glm::vec3 way = direction_of(flat, 1.0f, bisector_of(geometry, t, corner));
    up *= glm::dot(normal, up) < 0.0f ? -1.0f : 1.0f;
    return {p + kInset * height * way + height * up, normal, height};
}

}  // namespace

std::vector<Receiver> receivers_at_wedges(const Geometry& geometry, const Surface& surface,
                                          const Offset& offset)
{
    const std::vector<WedgeShape> shapes = shapes_of(geometry, surface);
    const std::vector<glm::uvec3>& corners = surface.corners(geometry);
    std::vector<float> heights(surface.normals.size(),
                               kMostOffset);  // of what is asked at vertices
    for (std::uint32_t t = 0; t < geometry.triangles.size(); ++t) {
        for (int corner = 0; corner < 3; ++corner) {
            float& height = heights[corners[t][corner]];
            height = std::min(height, offset_at(geometry, t, offset));
        }
    }
    std::vector<Receiver> receivers(surface.normals.size());
    for (std::uint32_t wedge = 0; wedge < receivers.size(); ++wedge) {
        const glm::vec3 normal = surface.normals[wedge];
        const float height = offset.value_or(heights[wedge]);
        receivers[wedge] =
            shapes[wedge].middle == kNone
                ? Receiver{geometry.positions[surface.vertex_of(wedge)] + height * normal, normal,
                           height}
                : just_inside(geometry, surface, wedge, shapes[wedge], height);
    }
    return receivers;
}

std::vector<float> angles_of_wedges(const Geometry& geometry, const Surface& surface)
{
    std::vector<float> angles(surface.normals.size(), 0.0f);
    const std::vector<glm::uvec3>& corners = surface.corners(geometry);
    for (std::size_t t = 0; t < geometry.triangles.size(); ++t) {
        for (int corner = 0; corner < 3; ++corner)
            angles[corners[t][corner]] +=
                glm::length(bisector_of(geometry, geometry.triangles[t], corner));
    }
    return angles;
}

bool are_smooth(glm::vec3 a, glm::vec3 b, const NormalSettings& settings)
{
    return glm::dot(a, b) >= std::min(std::cos(0.5f * glm::radians(settings.crease)), kSameNormal);
}

}  // namespace surfelao

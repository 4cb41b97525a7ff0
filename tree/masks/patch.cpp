#include "tree/masks/patch.h"

#include "tree/lanes.h"
#include "tree/masks/constants.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace surfelao {
namespace {

/// The same bytes, four floats at a time.
using PatchRows = std::array<Float4, sizeof(MaskPatch) / sizeof(Float4)>;
using NodeRows = std::array<Float4, sizeof(MaskNode) / sizeof(Float4)>;

glm::vec3 spread_along(const MaskPatch& p, glm::vec3 v)
{
    return {p.xx * v.x + p.xy * v.y + p.xz * v.z, p.xy * v.x + p.yy * v.y + p.yz * v.z,
            p.xz * v.x + p.yz * v.y + p.zz * v.z};
}

/// All but radius and thickness.
void set_sums(MaskPatch& patch, const MaskPatch& left, const MaskPatch& right)
{
    patch.area = left.area + right.area;
    const float share = patch.area > 0.0f ? right.area / patch.area : 0.5f;
    const glm::vec3 apart = right.center - left.center;
    patch.center = left.center + share * apart;
    patch.bulge = left.bulge + right.bulge +
                  glm::dot(left.vector_area, left.center - patch.center) +
                  glm::dot(right.vector_area, right.center - patch.center);
    patch.vector_area = left.vector_area + right.vector_area;
    patch.seen_area = glm::length(patch.vector_area);
    patch.normal = patch.seen_area > 0.0f ? patch.vector_area / patch.seen_area : left.normal;
    const glm::vec3 weighted = left.area * share * apart;
    patch.xx = left.xx + right.xx + weighted.x * apart.x;
    patch.xy = left.xy + right.xy + weighted.x * apart.y;
    patch.xz = left.xz + right.xz + weighted.x * apart.z;
    patch.yy = left.yy + right.yy + weighted.y * apart.y;
    patch.yz = left.yz + right.yz + weighted.y * apart.z;
    patch.zz = left.zz + right.zz + weighted.z * apart.z;
}

using Vector = std::array<Float4, 3>;

Vector operator+(const Vector& u, const Vector& v)
{
    return {u[0] + v[0], u[1] + v[1], u[2] + v[2]};
}
Vector operator-(const Vector& u, const Vector& v)
{
    return {u[0] - v[0], u[1] - v[1], u[2] - v[2]};
}
Vector operator*(const Vector& u, Float4 f)
{
    return {u[0] * f, u[1] * f, u[2] * f};
}
Float4 dot(const Vector& u, const Vector& v)
{
    return u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
}
Vector half_cross(const Vector& u, const Vector& v)
{
    return {0.5f * (u[1] * v[2] - v[1] * u[2]), 0.5f * (u[2] * v[0] - v[2] * u[0]),
            0.5f * (u[0] * v[1] - v[0] * u[1])};
}

/// What set_rectangles reads and what it finds, for as many patches as there are lanes.
struct Columns {
    Float4 normal_x, normal_y, normal_z, xx, xy, xz, yy, yz, zz, area, seen_area, radius;
    Float4 axis_x, axis_y, axis_z, length_u, length_v, open_radius;
    Float4 rim;  ///< how much larger a side is drawn where it is cut
    Bool4 sheet, may_be_whole;
};

/// Axes of the second moments in the plane; sides in the ratio of the spreads, scaled to the area,
/// never longer than the node.
void set_rectangles(Columns& of)
{
    const Float4 zero = all_lanes(0.0f), one = all_lanes(1.0f);
    const Float4 nx = of.normal_x, ny = of.normal_y, nz = of.normal_z;

    // t and b across the normal: the branchless basis of Duff et al., Building an Orthonormal
    // Basis, Revisited, JCGT 2017
    const Float4 sign = with_sign(one, nz);
    const Float4 a = -1.0f / (sign + nz);
    const Float4 tx = 1.0f + sign * nx * nx * a, ty = sign * nx * ny * a, tz = -sign * nx;
    const Float4 bx = ny * tz - ty * nz, by = nz * tx - tz * nx, bz = nx * ty - tx * ny;

    // mean squares, not integrals: the products below must not underflow at small triangles
    const Float4 per_area = of.area > 0.0f ? 1.0f / of.area : zero;
    const Float4 tt = per_area * ((of.xx * tx + of.xy * ty + of.xz * tz) * tx +
                                  (of.xy * tx + of.yy * ty + of.yz * tz) * ty +
                                  (of.xz * tx + of.yz * ty + of.zz * tz) * tz);
    const Float4 sbx = per_area * (of.xx * bx + of.xy * by + of.xz * bz);
    const Float4 sby = per_area * (of.xy * bx + of.yy * by + of.yz * bz);
    const Float4 sbz = per_area * (of.xz * bx + of.yz * by + of.zz * bz);
    const Float4 tb = sbx * tx + sby * ty + sbz * tz;
    const Float4 bb = sbx * bx + sby * by + sbz * bz;

    // eigenvalues of ((tt, tb), (tb, bb)): mean +- deviation; the axis by half angles
    const Float4 mean = 0.5f * (tt + bb);
    const Float4 half = 0.5f * (tt - bb);
    const Float4 deviation = root(half * half + tb * tb);
    const Float4 c2 = deviation > 0.0f ? half / deviation : one;
    const Float4 cosine = root(most(zero, 0.5f * (1.0f + c2)));
    const Float4 sine = with_sign(root(most(zero, 0.5f * (1.0f - c2))), tb);
    of.axis_x = cosine * tx + sine * bx;
    of.axis_y = cosine * ty + sine * by;
    of.axis_z = cosine * tz + sine * bz;
    const Float4 wide = mean + deviation;
    const Float4 narrow = most(mean - deviation, kMaskNarrowest * mean);
    const Float4 spread_area = 12.0f * root(wide * narrow);

    const Float4 flatness = of.area > 0.0f ? least(one, of.seen_area / of.area) : zero;
    const Float4 cover = spread_area > 0.0f ? of.area / spread_area : one;
    // half the diagonal of the box of these second moments: bounds grow with every level that they
    // follow from, sums do not; and no less than what keeps a cluster off those inside of it
    const Float4 spread_radius = root(3.0f * per_area * (of.xx + of.yy + of.zz));
    of.open_radius =
        most(kMaskRelaxedCluster * of.radius,
             spread_radius *
                 (1.0f + kMaskFlatnessPenalty * (1.0f - flatness) +
                  kMaskGapPenalty * most(zero, kMaskSheetCover - cover)) *
                 (1.0f + kMaskFlatPenalty * most(zero, 1.0f - kMaskFlatSlope * (1.0f - flatness))));
    of.may_be_whole = (flatness > 1.0f - kMaskWhole) &
                      (absolute(spread_area - of.area) < kMaskWholeMoments * kMaskWhole * of.area);

    // sheets that lie on each other count once: their spread tells how wide they are together
    const Float4 quarter = 0.25f * least(of.seen_area, kMaskSpreadMargin * spread_area);
    const Bool4 any = (quarter > 0.0f) & (narrow > 0.0f);
    const Float4 length_u = least(root(quarter * root(wide / narrow)), of.radius);
    const Float4 length_v = quarter / length_u;
    const Float4 diagonal = root(length_u * length_u + length_v * length_v);
    const Float4 shrink = least(one, of.radius / diagonal);
    of.sheet = (flatness > kMaskSheetFlatness) & (of.area > kMaskSheetCover * spread_area) & any;
    of.rim =
        of.sheet ? kMaskDilation * most(zero, 1.0f - kMaskDilationSlope * (1.0f - flatness)) : zero;
    of.length_u = any ? length_u * shrink : zero;
    of.length_v = any ? length_v * shrink : zero;
}

/// How much narrower strips of bulging bodies are drawn between their folds.
Float4 folds_of(const Columns& of, Float4 bulge)
{
    const Float4 zero = all_lanes(0.0f), one = all_lanes(1.0f);
    const Float4 full = kMaskFoldBulge * of.area * of.length_v;
    const Float4 bent = full > 0.0f ? least(one, most(zero, bulge) / full) : zero;
    const Float4 longer = of.length_u > 0.0f ? one - of.length_v / of.length_u : zero;
    return kMaskFold * longer * bent * bent;
}

/// MaskRoom of as many patches as there are lanes.
struct RoomColumns {
    std::array<Vector, 3> axes;
    Vector below, above;
};

RoomColumns room_columns(std::span<const MaskPatchNode> nodes)
{
    RoomColumns columns;
    for (std::size_t i = 0; i < kFloat4Lanes; ++i) {
        const MaskRoom& room = *nodes[std::min(i, nodes.size() - 1)].room;
        for (std::size_t k = 0; k < 3; ++k) {
            const int axis = static_cast<int>(k);
            columns.below[k][i] = room.below[axis];
            columns.above[k][i] = room.above[axis];
            for (std::size_t j = 0; j < 3; ++j)
                columns.axes[k][j][i] = room.axes[axis][static_cast<int>(j)];
        }
    }
    return columns;
}

/// Lengthens a half axis of a rectangle by `rim` at the ends that are cut and shortens it by `fold`
/// at the others. Returns how far the middle moves.
Vector move_ends(Vector& axis, const RoomColumns& room, Float4 rim, Float4 fold)
{
    Bool4 ahead{}, behind{};
    for (std::size_t k = 0; k < 3; ++k) {
        const Float4 along = dot(room.axes[k], axis);
        const Float4 reach = kMaskCutReach * absolute(along);
        ahead |= (along > 0.0f ? room.above[k] : room.below[k]) < reach;
        behind |= (along > 0.0f ? room.below[k] : room.above[k]) < reach;
    }
    const Float4 longer = 0.5f * rim, shorter = -0.5f * fold;
    const Float4 forward = ahead ? longer : shorter, backward = behind ? longer : shorter;
    const Vector move = axis * (forward - backward);
    axis = axis * (1.0f + forward + backward);
    return move;
}

/// Whether the triangles tile a rectangle with sides along and across `axis`; if so, shows it.
bool make_whole_along(glm::vec3 axis, const MaskPatch& patch, const MaskCorners& corners,
                      MaskNode& node)
{
    const glm::vec3 across = glm::cross(patch.normal, axis);
    glm::vec3 low(std::numeric_limits<float>::max());
    glm::vec3 high(-std::numeric_limits<float>::max());
    for (std::size_t i = 0; i < corners.count; ++i) {
        for (std::size_t corner = 0; corner < 4; ++corner) {
            const glm::vec3 d = corners.at(corner, i) - patch.center;
            const glm::vec3 at(glm::dot(d, axis), glm::dot(d, across), glm::dot(d, patch.normal));
            low = glm::min(low, at);
            high = glm::max(high, at);
        }
    }
    const glm::vec3 half = 0.5f * (high - low);
    const float along2 = glm::dot(spread_along(patch, axis), axis) / patch.area;
    const float across2 = glm::dot(spread_along(patch, across), across) / patch.area;
    const auto differ = [](float a, float b, float limit) {
        return !(std::abs(a - b) <= limit * b);
    };
    if (half.z > kMaskWhole * patch.radius ||
        differ(patch.area, 4.0f * half.x * half.y, kMaskWhole) ||
        differ(along2, half.x * half.x / 3.0f, kMaskWholeMoments * kMaskWhole) ||
        differ(across2, half.y * half.y / 3.0f, kMaskWholeMoments * kMaskWhole))
        return false;
    const glm::vec3 middle = 0.5f * (low + high);
    node.center = patch.center + middle.x * axis + middle.y * across;
    node.radius = std::sqrt(half.x * half.x + half.y * half.y);
    node.open_radius = 0.0f;
    node.skew = glm::vec3(0.0f);
    node.axis_a = half.x * axis + half.y * across;
    node.axis_b = half.y * across - half.x * axis;
    node.links &= ~kMaskSheet;
    return true;
}

/// A column for each number of as many patches, or nodes, as there are lanes.
using PatchColumns = std::array<std::array<Float4, kFloat4Lanes>, 5>;
using NodeColumns = std::array<std::array<Float4, kFloat4Lanes>, 4>;

/// Tiles as patches.
struct TileColumns {
    PatchColumns patch;
    Vector center, normal;
    std::array<Vector, 4> from_center;  ///< to the corners
};

/// Of the triangles (a, b, c) and (c, d, a); the second of a single one has no area.
TileColumns patches_of(const std::array<Vector, 4>& corners)
{
    const auto& [a, b, c, d] = corners;
    const Float4 zero = all_lanes(0.0f);
    const Vector diagonal = c - a;
    const Vector first = half_cross(b - a, diagonal);
    const Vector second = half_cross(diagonal, d - a);
    const Vector vector_area = first + second;
    const Float4 first_area = root(dot(first, first)), second_area = root(dot(second, second));
    const Float4 area = first_area + second_area;
    const Float4 seen_area = root(dot(vector_area, vector_area));
    const Float4 share = area > 0.0f ? second_area / area : zero;
    const Vector first_center = (a + b + c) * all_lanes(1.0f / 3.0f);
    const Vector apart = (d - b) * all_lanes(1.0f / 3.0f);
    const Vector center = first_center + apart * share;
    const Vector from_a = a - center, from_b = b - center, from_c = c - center, from_d = d - center;
    const Vector to_first = apart * -share;
    const Vector to_second = apart * (1.0f - share);
    const Vector normal = {seen_area > 0.0f ? vector_area[0] / seen_area : zero,
                           seen_area > 0.0f ? vector_area[1] / seen_area : zero,
                           seen_area > 0.0f ? vector_area[2] / seen_area : zero + 1.0f};
    const Float4 bulge = dot(first, to_first) + dot(second, to_second);
    const Float4 radius = root(most(most(dot(from_a, from_a), dot(from_b, from_b)),
                                    most(dot(from_c, from_c), dot(from_d, from_d))));
    const Float4 thickness =
        most(most(absolute(dot(from_a, normal)), absolute(dot(from_b, normal))),
             most(absolute(dot(from_c, normal)), absolute(dot(from_d, normal))));
    // the integral of x x^T over a triangle is a twelfth of its area times the sum of those of its
    // corners and nine times that of its centroid
    const Float4 first_weight = first_area * (1.0f / 12.0f);
    const Float4 second_weight = second_area * (1.0f / 12.0f);
    const auto spread = [&](std::size_t i, std::size_t k) {
        const Float4 both = from_a[i] * from_a[k] + from_c[i] * from_c[k];
        return first_weight * (both + from_b[i] * from_b[k] + 9.0f * to_first[i] * to_first[k]) +
               second_weight * (both + from_d[i] * from_d[k] + 9.0f * to_second[i] * to_second[k]);
    };
    return {{{{center[0], center[1], center[2], area},
              {vector_area[0], vector_area[1], vector_area[2], seen_area},
              {normal[0], normal[1], normal[2], radius},
              {spread(0, 0), spread(0, 1), spread(0, 2), thickness},
              {spread(1, 1), spread(1, 2), spread(2, 2), bulge}}},
            center,
            normal,
            {from_a, from_b, from_c, from_d}};
}

/// The quadrilaterals themselves. The fourth corner of a triangle is its centroid.
NodeColumns nodes_of(const TileColumns& tiles, Bool4 is_triangle)
{
    const Float4 zero = all_lanes(0.0f);
    const auto& [from_a, from_b, from_c, from_d] = tiles.from_center;
    Vector fourth;
    for (std::size_t axis = 0; axis < 3; ++axis)
        fourth[axis] = is_triangle ? zero : from_d[axis];
    const Vector even = (from_a + from_c) * all_lanes(0.25f);
    const Vector odd = (from_b + fourth) * all_lanes(0.25f);
    const Vector middle = even + odd;
    const Vector skew = even - odd;
    const Vector axis_a = (from_a - from_c) * all_lanes(0.5f);
    const Vector axis_b = (from_b - fourth) * all_lanes(0.5f);
    const auto beyond = [&](const Vector& corner) {
        const Vector from = corner - middle;
        return dot(from, from);
    };
    const Float4 radius =
        root(most(most(beyond(from_a), beyond(from_b)), most(beyond(from_c), beyond(fourth))));
    const Vector center = tiles.center + middle;
    const Float4 thickness = is_triangle ? zero : absolute(dot(skew, tiles.normal));
    return {{{center[0], center[1], center[2], radius},
             {skew[0], skew[1], skew[2], thickness},
             {axis_a[0], axis_a[1], axis_a[2], all_lanes(-1.0f)},
             {axis_b[0], axis_b[1], axis_b[2], zero}}};
}

/// From a column for each number to a row for each patch or node, and back.
template <std::size_t kRows>
void turn(std::array<std::array<Float4, kFloat4Lanes>, kRows>& columns)
{
    for (auto& [x, y, z, w] : columns)
        transpose(x, y, z, w);
}

/// The i-th of transposed columns.
MaskNode node_of(const NodeColumns& rows, std::size_t i)
{
    return std::bit_cast<MaskNode>(NodeRows{rows[0][i], rows[1][i], rows[2][i], rows[3][i]});
}
MaskPatch patch_of(const PatchColumns& rows, std::size_t i)
{
    return std::bit_cast<MaskPatch>(
        PatchRows{rows[0][i], rows[1][i], rows[2][i], rows[3][i], rows[4][i]});
}

}  // namespace

void set_tiles(std::span<const MaskPatchNode> nodes, const MaskCorners& corners)
{
    for (std::size_t begin = 0; begin < nodes.size(); begin += kFloat4Lanes) {
        // as many tiles as lanes: [corner][axis]
        std::array<Vector, 4> p;
        for (std::size_t corner = 0; corner < 4; ++corner) {
            for (std::size_t axis = 0; axis < 3; ++axis)
                p[corner][axis] = load_lanes(corners.column(corner, axis) + begin);
        }
        const auto& [a, b, c, d] = p;
        const Bool4 is_triangle = (c[0] == d[0]) & (c[1] == d[1]) & (c[2] == d[2]);
        TileColumns tiles = patches_of(p);
        NodeColumns node = nodes_of(tiles, is_triangle);
        turn(tiles.patch);
        turn(node);
        for (std::size_t i = 0; i < std::min(kFloat4Lanes, nodes.size() - begin); ++i) {
            const MaskPatchNode& out = nodes[begin + i];
            *out.patch = patch_of(tiles.patch, i);
            *out.node = node_of(node, i);
            out.node->links = is_triangle[i] != 0 ? kMaskTriangle : 0;
        }
    }
}

void join(MaskPatch& patch, const MaskPatch& left, const MaskPatch& right)
{
    set_sums(patch, left, right);
    patch.radius = 0.0f;
    patch.thickness = 0.0f;
    for (const MaskPatch* child : {&left, &right}) {
        const glm::vec3 d = child->center - patch.center;
        patch.radius = std::max(patch.radius, glm::length(d) + child->radius);
        const float rise = glm::length(glm::cross(child->normal, patch.normal)) * child->radius;
        patch.thickness =
            std::max(patch.thickness, std::abs(glm::dot(d, patch.normal)) +
                                          std::min(child->radius, child->thickness + rise));
    }
}

void join(MaskPatch& patch, const MaskPatch& left, const MaskPatch& right,
          const MaskCorners& corners)
{
    set_sums(patch, left, right);
    const glm::vec3 c = patch.center, n = patch.normal;
    Float4 farthest = all_lanes(0.0f), highest = all_lanes(0.0f);
    for (std::size_t i = 0; i < corners.count; i += kFloat4Lanes) {
        const auto rest = static_cast<std::int32_t>(corners.count - i);
        const Bool4 inside = Bool4{0, 1, 2, 3} < rest;
        for (std::size_t corner = 0; corner < 4; ++corner) {
            const Float4 x = load_lanes(corners.column(corner, 0) + i) - c.x;
            const Float4 y = load_lanes(corners.column(corner, 1) + i) - c.y;
            const Float4 z = load_lanes(corners.column(corner, 2) + i) - c.z;
            const Float4 distance2 = x * x + y * y + z * z;
            const Float4 height = absolute(x * n.x + y * n.y + z * n.z);
            farthest = most(farthest, inside ? distance2 : all_lanes(0.0f));
            highest = most(highest, inside ? height : all_lanes(0.0f));
        }
    }
    patch.radius = std::sqrt(std::max({farthest[0], farthest[1], farthest[2], farthest[3]}));
    patch.thickness = std::max({highest[0], highest[1], highest[2], highest[3]});
}

MaskRoom room_of(const MaskPatch& patch, const MaskCuts& cuts)
{
    MaskRoom room{cuts.axes, {}, {}};
    for (int k = 0; k < 3; ++k) {
        const glm::vec3 axis = cuts.axes[k];
        const float at =
            axis.x * patch.center.x + axis.y * patch.center.y + axis.z * patch.center.z;
        room.below[k] = at - cuts.low[k];
        room.above[k] = cuts.high[k] - at;
    }
    return room;
}

void show_patches(std::span<MaskPatchNode> nodes)
{
    const Float4 zero = all_lanes(0.0f);
    for (std::size_t begin = 0; begin < nodes.size(); begin += kFloat4Lanes) {
        const std::size_t count = std::min(kFloat4Lanes, nodes.size() - begin);
        // from a row for each patch to a column for each number
        PatchColumns patch;
        for (std::size_t i = 0; i < kFloat4Lanes; ++i) {
            const auto rows =
                std::bit_cast<PatchRows>(*nodes[begin + std::min(i, count - 1)].patch);
            for (std::size_t row = 0; row < rows.size(); ++row)
                patch[row][i] = rows[row];
        }
        turn(patch);
        Columns columns;
        columns.area = patch[0][3];
        columns.seen_area = patch[1][3];
        columns.normal_x = patch[2][0];
        columns.normal_y = patch[2][1];
        columns.normal_z = patch[2][2];
        columns.radius = patch[2][3];
        columns.xx = patch[3][0];
        columns.xy = patch[3][1];
        columns.xz = patch[3][2];
        columns.yy = patch[4][0];
        columns.yz = patch[4][1];
        columns.zz = patch[4][2];
        set_rectangles(columns);

        const Columns& of = columns;
        const Vector center = {patch[0][0], patch[0][1], patch[0][2]};
        const Vector normal = {of.normal_x, of.normal_y, of.normal_z};
        const Vector axis = {of.axis_x, of.axis_y, of.axis_z};
        Vector along = axis * of.length_u;
        Vector across = half_cross(normal, axis) * (2.0f * of.length_v);
        const RoomColumns room = room_columns(nodes.subspan(begin, count));
        const Float4 depth =
            of.area > 0.0f ? kMaskBulgeDepth * most(zero, patch[4][3]) / of.area : zero;
        // what is torn at a cut is as wide as the strip, however long that is
        const Float4 slender = of.length_u > 0.0f ? of.length_v / of.length_u : zero;
        const Vector move = move_ends(along, room, of.rim * slender, zero) +
                            move_ends(across, room, of.rim, folds_of(of, patch[4][3])) -
                            normal * depth;
        const Vector middle = center + move;
        const Vector axis_a = along + across, axis_b = across - along;

        // and back
        NodeColumns node = {{{middle[0], middle[1], middle[2], of.radius + root(dot(move, move))},
                             {zero, zero, zero, patch[3][3] + depth},
                             {axis_a[0], axis_a[1], axis_a[2], of.open_radius},
                             {axis_b[0], axis_b[1], axis_b[2], zero}}};
        turn(node);
        for (std::size_t i = 0; i < count; ++i) {
            MaskPatchNode& out = nodes[begin + i];
            *out.node = node_of(node, i);
            out.node->links = columns.sheet[i] != 0 ? kMaskSheet : 0;
            const MaskPatch& of_node = *out.patch;
            if (of_node.bulge < -kMaskHollowBulge * of_node.area * of_node.radius)
                out.node->links |= kMaskHollow;
            out.may_be_whole = columns.may_be_whole[i] != 0;
        }
    }
}

void make_whole(const MaskPatch& patch, const MaskCorners& corners, MaskNode& node)
{
    const glm::vec3 u = node.axis_a - node.axis_b, v = node.axis_a + node.axis_b;
    if (make_whole_along(glm::normalize(u), patch, corners, node) ||
        glm::dot(u, u) > kMaskSquare * glm::dot(v, v))
        return;
    // a square has no axes of its own: its triangles' edges lie along them
    const glm::vec3 a = corners.at(0, 0), b = corners.at(1, 0), c = corners.at(2, 0);
    for (const glm::vec3 edge : {b - a, c - b, a - c}) {
        if (make_whole_along(glm::normalize(edge), patch, corners, node))
            return;
    }
}

}  // namespace surfelao

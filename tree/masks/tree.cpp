#include "tree/masks/tree.h"

#include "surfels/errors.h"
#include "surfels/for_all.h"
#include "surfels/raw_vector.h"
#include "tree/discard.h"
#include "tree/masks/constants.h"
#include "tree/masks/masks.h"
#include "tree/masks/patch.h"
#include "tree/masks/refit.h"
#include "tree/masks/solids.h"
#include "tree/masks/splits.h"
#include "tree/masks/tiles.h"
#include "tree/masks/winding.h"
#include "tree/part.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <span>
#include <string>
#include <vector>

namespace surfelao {
namespace {

/// Nodes over up to kMaskBundle triangles while they are built. Node 0 is the root; children stand
/// side by side, after their parent.
struct Bundle {
    struct Node {
        std::uint8_t begin, end;
        std::uint8_t first_child;  ///< 0 = triangle
        std::uint8_t side;         ///< of `keys`: they go to and fro from level to level
    };
    static constexpr std::size_t kNodes = 2 * kMaskBundle - 1;
    static constexpr std::size_t kStride = kMaskBundle + MaskCorners::kSlack;

    std::array<std::array<MaskKey, kMaskBundle>, 2> keys;
    std::array<Node, kNodes> nodes;
    std::array<std::uint8_t, kMaskBundle> leaf;   ///< the node of each triangle
    std::array<std::uint8_t, kMaskBundle> inner;  ///< parents first
    std::array<float, 12 * kStride> corners;      ///< columns, as in MaskCorners
    std::array<MaskPatch, kNodes> patches;
    std::array<MaskCuts, kNodes> cuts;
    std::array<MaskRoom, kMaskBundle> rooms;
    std::array<MaskPatchNode, kMaskBundle> shown;
};

/// How the cuts about a patch have turned with it since it was built. left, right: the patches of
/// its children. No cuts where a patch does not tell how it has turned.
MaskRoom turned_room(const MaskPlan& plan, std::size_t index, std::size_t first_child,
                     const MaskPatch& patch, const MaskPatch& left, const MaskPatch& right)
{
    const MaskPlanNode& rest = plan.nodes[index];
    const auto across = [](glm::vec3 apart, glm::vec3 normal) {
        return apart - glm::dot(apart, normal) * normal;
    };
    const glm::vec3 then =
        across(plan.nodes[first_child + 1].center - plan.nodes[first_child].center, rest.normal);
    const glm::vec3 now = across(right.center - left.center, patch.normal);
    const float then_length = glm::length(then), now_length = glm::length(now);
    if (!(then_length > 0.0f && now_length > 0.0f))
        return {kMaskFrame, glm::vec3(std::numeric_limits<float>::infinity()),
                glm::vec3(std::numeric_limits<float>::infinity())};
    const glm::vec3 u = then / then_length, v = now / now_length;
    const glm::mat3 from(u, glm::cross(rest.normal, u), rest.normal);
    const glm::mat3 to(v, glm::cross(patch.normal, v), patch.normal);
    const float growth = now_length / then_length;
    return {to * glm::transpose(from) * rest.room.axes, growth * rest.room.below,
            growth * rest.room.above};
}

class Builder {
public:
    /// plan: becomes how it is built; null where nobody asks.
    Builder(const Geometry& geometry, MaskPairs pairs, MaskPlan* plan)
        : geometry_(geometry), pairs_(pairs), made_(plan), solid_(small_solids(geometry))
    {
    }

    /// Follows a plan.
    Builder(const Geometry& form, const MaskPlan& plan)
        : geometry_(form), tiles_(plan.tiles), followed_(&plan), order_(plan.order)
    {
        // solids are few: what is closed may be seen from its middle no longer
        solid_ = plan.has_solids ? small_solids(form)
                                 : std::vector<std::uint8_t>(form.triangles.size(), 0);
    }

    RawVector<MaskNode> build()
    {
        if (geometry_.triangles.empty())
            return {};
        if (followed_ == nullptr)
            make_keys();
        const std::size_t count = tiles_.size();
        turn_positions();
        nodes_.resize(2 * count - 1);
        if (made_ != nullptr)
            made_->nodes.resize(nodes_.size());
        build_node(0, 1, 0, count, 0, {});
        if (made_ != nullptr) {
            made_->tiles = std::move(tiles_);
            made_->order = std::move(order_);
            made_->has_solids = std::ranges::any_of(solid_, [](std::uint8_t s) { return s != 0; });
        }
        return std::move(nodes_);
    }

private:
    void make_keys()
    {
        const std::size_t triangles = geometry_.triangles.size();
        RawVector<glm::vec3> normals;
        normals.resize(geometry_.triangles.size());
        for_blocks(std::span(normals), [&](std::span<glm::vec3> block, std::size_t i) {
            for (std::size_t t = 0; t < block.size(); ++t)
                block[t] = normal_of(i * kPartBlock + t);
        });
        tiles_ = tiles_of(geometry_, normals, pairs_);
        const std::size_t count = tiles_.size();
        check_mask_tiles(count, triangles);
        for (RawVector<MaskKey>& side : keys_)
            side.resize(count);
        for_blocks(std::span(keys_[0]), [&](std::span<MaskKey> block, std::size_t i) {
            for (std::size_t t = 0; t < block.size(); ++t)
                block[t] = key_of(i * kPartBlock + t, normals);
        });
        order_.resize(count);
    }

    void turn_positions()
    {
        positions_.resize(geometry_.positions.size());
        for_blocks(std::span(positions_), [&](std::span<glm::vec3> block, std::size_t i) {
            for (std::size_t v = 0; v < block.size(); ++v)
                block[v] = kMaskFrame * geometry_.positions[i * kPartBlock + v];
        });
    }

    /// Zero where a triangle has no area.
    glm::vec3 normal_of(std::size_t triangle) const
    {
        const glm::uvec3 t = geometry_.triangles[triangle];
        const glm::vec3 a = geometry_.positions[t.x];
        const glm::vec3 cross =
            glm::cross(geometry_.positions[t.y] - a, geometry_.positions[t.z] - a);
        const float length = glm::length(cross);
        return length > 0.0f ? cross / length : glm::vec3(0.0f);
    }

    MaskKey key_of(std::size_t tile, std::span<const glm::vec3> normals) const
    {
        const auto& [t, triangles] = tiles_[tile];
        const glm::vec3 a = geometry_.positions[t.x], b = geometry_.positions[t.y],
                        c = geometry_.positions[t.z], d = geometry_.positions[t.w];
        const glm::vec3 center = t.z != t.w ? (a + b + c + d) * 0.25f : (a + b + c) * (1.0f / 3.0f);
        const glm::vec3 normal = normals[triangles[0]];
        return {{center.x, center.y, center.z, normal.x, normal.y, normal.z},
                static_cast<std::uint32_t>(tile),
                0};
    }

    /// Node `index` over keys [begin, end) of one side; its descendants stand in nodes [first,
    /// first + 2 (n-1)).
    MaskPatch build_node(std::size_t index, std::size_t first, std::size_t begin, std::size_t end,
                         int side, const MaskCuts& cuts)
    {
        const std::size_t count = end - begin;
        if (count <= kMaskBundle)
            return build_bundle(index, first, begin, end, side, cuts);

        MaskCuts left_cuts = cuts, right_cuts = cuts;
        const std::size_t middle = followed_ != nullptr
                                       ? begin + followed_->nodes[index].below
                                       : split(begin, end, side, left_cuts, right_cuts);
        const std::size_t left_first = first + 2;
        const std::size_t right_first = left_first + 2 * (middle - begin - 1);
        MaskPatch left, right;
        const auto build_left = [&] {
            left = build_node(first, left_first, begin, middle, 1 - side, left_cuts);
        };
        const auto build_right = [&] {
            right = build_node(first + 1, right_first, middle, end, 1 - side, right_cuts);
        };
        if (count > kMaskParallelNode) {
            do_both(build_left, build_right);
        } else {
            build_left();
            build_right();
        }
        if (followed_ == nullptr) {
            for (RawVector<MaskKey>& keys : keys_)
                discard(std::span(keys).subspan(begin, end - begin));
        }

        MaskPatch patch;
        join(patch, left, right);
        const MaskRoom room = room_at(index, first, patch, left, right, cuts);
        note(index, patch, &room, middle - begin);
        MaskPatchNode shown{&patch, &nodes_[index], &room, false};
        show_patches({&shown, 1});
        if (shown.may_be_whole) {
            const std::size_t stride = count + MaskCorners::kSlack;
            std::vector<float> columns(12 * stride);
            for (std::size_t i = 0; i < count; ++i)
                gather_corners(order_[begin + i], columns.data(), stride, i);
            make_whole(patch, {columns.data(), stride, count}, order_.data() + begin,
                       nodes_[index]);
        }
        nodes_[index].links |= static_cast<std::uint32_t>(first);
        return patch;
    }

    /// About node `index`, whose children stand from `first_child` on.
    MaskRoom room_at(std::size_t index, std::size_t first_child, const MaskPatch& patch,
                     const MaskPatch& left, const MaskPatch& right, const MaskCuts& cuts) const
    {
        return followed_ != nullptr
                   ? turned_room(*followed_, index, first_child, patch, left, right)
                   : room_of(patch, cuts);
    }

    /// Into the plan. room: null for a leaf.
    void note(std::size_t index, const MaskPatch& patch, const MaskRoom* room, std::size_t below)
    {
        if (made_ == nullptr)
            return;
        made_->nodes[index] = {patch.center, patch.normal, room != nullptr ? *room : MaskRoom{},
                               static_cast<std::uint32_t>(below)};
    }

    /// Parts keys [begin, end) of one side into the other side. Returns where the second part
    /// begins. What the plane does not part is cut in two halves.
    std::size_t split(std::size_t begin, std::size_t end, int side, MaskCuts& left_cuts,
                      MaskCuts& right_cuts)
    {
        const std::span<MaskKey> keys(keys_[side].data() + begin, end - begin);
        const MaskPlane plane = split_plane(keys, tiles_, geometry_.positions, left_cuts);
        right_cuts = left_cuts;
        const std::size_t below =
            part(std::span<const MaskKey>(keys), plane, keys_[1 - side].data() + begin);
        if (below == 0 || below == keys.size())
            return begin + keys.size() / 2;
        cut(plane, left_cuts, right_cuts);
        return begin + below;
    }

    /// The corners of a tile into row `i` of twelve columns.
    void gather_corners(std::uint32_t tile, float* columns, std::size_t stride, std::size_t i) const
    {
        gather_corners(tiles_[tile].corners, columns, stride, i);
    }
    void gather_corners(glm::uvec4 t, float* columns, std::size_t stride, std::size_t i) const
    {
        for (int corner = 0; corner < 4; ++corner) {
            const glm::vec3 p = positions_[t[corner]];
            for (int axis = 0; axis < 3; ++axis, columns += stride)
                columns[i] = p[axis];
        }
    }

    /// Of the tiles order[0 ...].
    void make_whole(const MaskPatch& patch, const MaskCorners& corners, const std::uint32_t* order,
                    MaskNode& node) const
    {
        surfelao::make_whole(patch, corners, node);
        const bool is_whole = node.open_radius == 0.0f;
        if (is_whole &&
            std::all_of(order, order + corners.count, [&](std::uint32_t t) { return is_solid(t); }))
            node.links |= kMaskSolid;
    }

    bool is_solid(std::uint32_t tile) const
    {
        const auto [first, second] = tiles_[tile].triangles;
        return solid_[first] != 0 && solid_[second] != 0;
    }

    /// build_node for few triangles.
    MaskPatch build_bundle(std::size_t index, std::size_t first, std::size_t begin, std::size_t end,
                           int side, const MaskCuts& cuts)
    {
        Bundle bundle;
        bundle.cuts[0] = cuts;
        const std::size_t count = end - begin;
        // memory is asked for long before it is needed: triangles stand anywhere
        for (std::size_t k = 0; k < 2 * (count - 1); ++k)
            __builtin_prefetch(&nodes_[first + k], 1);
        const auto place = [&](std::size_t k) { return k == 0 ? index : first + k - 1; };
        std::uint32_t* const order = order_.data() + begin;
        std::size_t inner_count = 0;
        if (followed_ != nullptr) {
            inner_count = follow_bundle(bundle, count, place);
        } else {
            for (std::size_t i = 0; i < count; ++i) {
                bundle.keys[0][i] = keys_[side][begin + i];
                __builtin_prefetch(&tiles_[bundle.keys[0][i].tile]);
            }
            inner_count = split_bundle(bundle, count, order);
        }
        for (std::size_t i = 0; i < count; ++i) {
            const glm::uvec4 t = tiles_[order[i]].corners;
            for (int corner = 0; corner < 4; ++corner)
                __builtin_prefetch(&positions_[t[corner]]);
        }

        for (std::size_t i = 0; i < count; ++i)
            gather_corners(order[i], bundle.corners.data(), Bundle::kStride, i);
        for (std::size_t column = 0; column < 12; ++column)
            std::fill_n(bundle.corners.data() + column * Bundle::kStride + count,
                        MaskCorners::kSlack, 0.0f);
        const MaskCorners corners{bundle.corners.data(), Bundle::kStride, count};
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t k = bundle.leaf[i];
            bundle.shown[i] = {&bundle.patches[k], &nodes_[place(k)], nullptr, false};
        }
        set_tiles({bundle.shown.data(), count}, corners);
        for (std::size_t i = 0; i < count; ++i) {
            bundle.shown[i].node->links |= is_solid(order[i]) ? kMaskSolid : 0;
            note(place(bundle.leaf[i]), *bundle.shown[i].patch, nullptr, 0);
        }

        // children before their parents
        for (std::size_t i = inner_count; i-- > 0;) {
            const std::size_t k = bundle.inner[i];
            const Bundle::Node node = bundle.nodes[k];
            const MaskPatch &left = bundle.patches[node.first_child],
                            &right = bundle.patches[node.first_child + 1];
            join(bundle.patches[k], left, right, corners.part(node.begin, node.end));
            bundle.rooms[i] = room_at(place(k), place(node.first_child), bundle.patches[k], left,
                                      right, bundle.cuts[k]);
            note(place(k), bundle.patches[k], &bundle.rooms[i],
                 bundle.nodes[node.first_child].end - node.begin);
            bundle.shown[i] = {&bundle.patches[k], &nodes_[place(k)], &bundle.rooms[i], false};
        }
        show_patches({bundle.shown.data(), inner_count});
        for (std::size_t i = 0; i < inner_count; ++i) {
            const Bundle::Node node = bundle.nodes[bundle.inner[i]];
            const MaskPatchNode& shown = bundle.shown[i];
            if (shown.may_be_whole)
                make_whole(*shown.patch, corners.part(node.begin, node.end), order + node.begin,
                           *shown.node);
            shown.node->links |= static_cast<std::uint32_t>(first + node.first_child - 1);
        }
        return bundle.patches[0];
    }

    /// The nodes over the bundle's keys, and the triangles in the order of the leaves. Returns how
    /// many nodes are not triangles.
    std::size_t split_bundle(Bundle& bundle, std::size_t count, std::uint32_t* order) const
    {
        std::size_t node_count = 1;
        std::size_t inner_count = 0;
        bundle.nodes[0] = {0, static_cast<std::uint8_t>(count), 0, 0};
        for (std::size_t k = 0; k < node_count; ++k) {
            Bundle::Node& node = bundle.nodes[k];
            const std::size_t size = node.end - node.begin;
            MaskKey* const keys = bundle.keys[node.side].data() + node.begin;
            if (size == 1) {
                bundle.leaf[node.begin] = static_cast<std::uint8_t>(k);
                order[node.begin] = keys->tile;
                continue;
            }
            std::uint8_t side = node.side;
            std::size_t below = 1;
            MaskCuts* const cuts = &bundle.cuts[node_count];
            cuts[0] = cuts[1] = bundle.cuts[k];
            if (size > 2) {
                side = 1 - side;
                const MaskPlane plane =
                    split_plane({keys, size}, tiles_, geometry_.positions, cuts[0]);
                cuts[1] = cuts[0];
                MaskKey* const out = bundle.keys[side].data() + node.begin;
                below = part<MaskKey>({keys, size}, plane, out, 0, size);
                if (below != 0 && below != size)
                    cut(plane, cuts[0], cuts[1]);
                else
                    below = size / 2;
            }
            const auto middle = static_cast<std::uint8_t>(node.begin + below);
            node.first_child = static_cast<std::uint8_t>(node_count);
            bundle.inner[inner_count++] = static_cast<std::uint8_t>(k);
            bundle.nodes[node_count++] = {node.begin, middle, 0, side};
            bundle.nodes[node_count++] = {middle, node.end, 0, side};
        }
        return inner_count;
    }

    /// The nodes over the bundle's tiles as in the plan. Returns how many are not tiles.
    template <class Place>
    std::size_t follow_bundle(Bundle& bundle, std::size_t count, const Place& place) const
    {
        std::size_t node_count = 1;
        std::size_t inner_count = 0;
        bundle.nodes[0] = {0, static_cast<std::uint8_t>(count), 0, 0};
        for (std::size_t k = 0; k < node_count; ++k) {
            Bundle::Node& node = bundle.nodes[k];
            if (node.end - node.begin == 1) {
                bundle.leaf[node.begin] = static_cast<std::uint8_t>(k);
                continue;
            }
            const auto middle =
                static_cast<std::uint8_t>(node.begin + followed_->nodes[place(k)].below);
            node.first_child = static_cast<std::uint8_t>(node_count);
            bundle.inner[inner_count++] = static_cast<std::uint8_t>(k);
            bundle.nodes[node_count++] = {node.begin, middle, 0, 0};
            bundle.nodes[node_count++] = {middle, node.end, 0, 0};
        }
        return inner_count;
    }

    const Geometry& geometry_;
    MaskPairs pairs_ = MaskPairs::found;
    RawVector<MaskTile> tiles_;
    MaskPlan* made_ = nullptr;                ///< of this tree
    const MaskPlan* followed_ = nullptr;      ///< of an earlier one
    std::vector<std::uint8_t> solid_;         ///< one per triangle
    RawVector<glm::vec3> positions_;          ///< in the mask frame
    std::array<RawVector<MaskKey>, 2> keys_;  ///< to and fro from level to level
    RawVector<std::uint32_t> order_;  ///< the triangles below each finished node in one range
    RawVector<MaskNode> nodes_;
};

}  // namespace

void check_mask_tiles(std::uint64_t tiles, std::uint64_t triangles)
{
    // for the GPU the last link is the number of nodes
    static_assert(2 * kMostMaskTiles - 1 <= kMaskFirstChild);
    if (tiles > kMostMaskTiles)
        throw InputError("too many triangles for masks: " + std::to_string(triangles) +
                         ", at most " + std::to_string(kMostMaskTiles) +
                         ", a flat pair counting as one");
}

std::shared_ptr<const MaskTree> build_mask_tree(const Geometry& geometry)
{
    // before anything counts them in 32 bits: all may be in pairs
    const std::size_t triangles = geometry.triangles.size();
    check_mask_tiles((triangles + 1) / 2, triangles);
    auto tree = std::make_shared<MaskTree>();
    if (is_winding_mixed(geometry)) {
        Geometry alike = geometry;
        wind_alike(alike);
        tree->nodes = build_mask_nodes(alike);
    } else {
        tree->nodes = build_mask_nodes(geometry);
    }
    return tree;
}

namespace {

/// In blocks: the same sum for any number of threads.
double sum_of_radii(std::span<const MaskNode> nodes)
{
    std::vector<double> sums(nodes.size() / kPartBlock + 1, 0.0);
    for_blocks(nodes, [&](std::span<const MaskNode> block, std::size_t i) {
        for (const MaskNode& node : block)
            sums[i] += node.radius;
    });
    return std::accumulate(sums.begin(), sums.end(), 0.0);
}

}  // namespace

RawVector<MaskNode> build_mask_nodes(const Geometry& geometry)
{
    return Builder(geometry, MaskPairs::found, nullptr).build();
}

RawVector<MaskNode> build_mask_nodes(const Geometry& geometry, MaskPairs pairs, MaskPlan& plan)
{
    RawVector<MaskNode> nodes = Builder(geometry, pairs, &plan).build();
    plan.radii = sum_of_radii(nodes);
    return nodes;
}

std::optional<RawVector<MaskNode>> refit_mask_nodes(const MaskPlan& plan, const Geometry& form)
{
    for (const MaskTile& tile : plan.tiles) {
        if (!is_flat(tile, form.positions))
            return std::nullopt;
    }
    RawVector<MaskNode> nodes = Builder(form, plan).build();
    if (sum_of_radii(nodes) > kMaskRefitGrowth * plan.radii)
        return std::nullopt;
    return nodes;
}

}  // namespace surfelao

/// forest.h: bodies that move: a tree for each, built once in the body's own space.
///
/// A body that is turned, scaled or moved takes its nodes along: 64 bytes each are read and
/// written, nothing is built. A walk starts from the roots of all bodies that are there.
///
/// Internal to the mask engine; engines/moving.h is its door.
#pragma once

#include "surfels/bodies.h"
#include "surfels/geometry.h"
#include "surfels/placement.h"
#include "surfels/raw_vector.h"
#include "tree/masks/refit.h"
#include "tree/masks/tree.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

namespace surfelao {

/// In the mask frame. Holds all triangles of a body.
struct MaskBall {
    glm::vec3 center{0.0f};
    float radius = 0.0f;
};

class MaskForest {
public:
    /// bodies: split_bodies(geometry); they stand at rest. A body alone has the tree of
    /// build_mask_tree(). O(n log n). Throws as build_mask_tree, of all bodies together.
    MaskForest(const Geometry& geometry, std::vector<BodyMesh> bodies);

    [[nodiscard]] std::uint32_t body_count() const;

    void place(std::uint32_t body, const Placement& placement);
    void hide(std::uint32_t body);
    /// Over other positions, one per vertex of the geometry. The tree is refitted from that at
    /// rest, whatever came between; where that is too far, it is built anew. O(vertices of the
    /// body), and O(n log n) the first time.
    void deform(std::uint32_t body, std::span<const glm::vec3> positions);

    /// What the receivers of a body see of another one.
    struct View {
        std::uint32_t viewer = 0;
        MaskBall ball;         ///< about all of its receivers' groups, in its own space
        float cluster = 0.0f;  ///< MaskSettings::cluster
        float limit = 0.0f;    ///< nothing beyond counts, in its own space
    };
    /// The bodies as they stand in the viewer's own space, each at its place in `nodes`, which is
    /// made as large as all of them. What the viewer never opens is left out. Both are not hidden.
    void place_before(const View& view, std::span<const std::uint32_t> bodies,
                      RawVector<MaskNode>& nodes) const;
    /// Where a body's ball is in a viewer's own space.
    [[nodiscard]] MaskBall ball_before(std::uint32_t viewer, std::uint32_t body) const;

    /// Of all bodies where they stand; their links count from here. What has changed is brought to
    /// its place by the first who asks.
    [[nodiscard]] const MaskNode* nodes() const;
    /// Empty where a body is hidden or has no triangle.
    [[nodiscard]] std::optional<std::uint32_t> root(std::uint32_t body) const;
    /// Of the bodies that have one, in their order.
    [[nodiscard]] std::vector<std::uint32_t> roots() const;
    [[nodiscard]] bool is_deformed(std::uint32_t body) const;
    /// Another one after each change.
    [[nodiscard]] std::uint64_t version(std::uint32_t body) const;
    /// Empty where it is hidden.
    [[nodiscard]] const std::optional<Placement>& placement(std::uint32_t body) const;

private:
    struct Body {
        Geometry at_rest;                     ///< compact
        std::vector<std::uint32_t> vertices;  ///< of the whole geometry, one per vertex of at_rest
        RawVector<MaskNode> rest_nodes;       ///< links count from 0
        MaskBall rest_ball;
        /// How its tree was built, once it has been deformed: with flat pairs of triangles as one
        /// tile, and, once one of them has bent, without.
        std::optional<MaskPlan> plan, plan_without_pairs;
        RawVector<MaskNode> form_nodes;  ///< as it is deformed; empty: at rest
        MaskBall form_ball;
        std::optional<Placement> placement = Placement{};
        std::uint64_t version = 0;
        mutable bool settled = false;  ///< in nodes_
        std::uint32_t base = 0;        ///< its first node in nodes_
        std::uint32_t capacity = 0;    ///< nodes there

        [[nodiscard]] const MaskBall& ball() const
        {
            return form_nodes.empty() ? rest_ball : form_ball;
        }
    };

    static RawVector<MaskNode> bent(Body& body, const Geometry& form);
    static void change(Body& body);
    void lay_out();
    void settle(const Body& body) const;
    /// As it is built or bent, links from 0. Body 0 stands in nodes_ alone.
    [[nodiscard]] std::span<const MaskNode> nodes_of(const Body& body) const;

    std::vector<Body> bodies_;
    mutable RawVector<MaskNode> nodes_;
    mutable std::mutex settling_;
};

}  // namespace surfelao

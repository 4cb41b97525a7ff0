/// forest.h: bodies that move: a tree for each, built once in the body's own space.
///
/// A body that is turned, scaled or moved takes its nodes along: 64 bytes each are read and
/// written, nothing is built. A walk starts from the roots of all bodies that are there.
///
/// Internal to the mask engine; engines/moving.h is its door.
#pragma once

#include "surfels/geometry.h"
#include "surfels/placement.h"
#include "tree/masks/refit.h"
#include "tree/masks/tree.h"
#include "tree/raw_vector.h"

#include <glm/vec3.hpp>

#include <cstdint>
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
    /// body_of_triangle: one per triangle, below `bodies`. All bodies stand as they are there. A
    /// body alone has the tree of build_mask_tree(). O(n log n). Throws as build_mask_tree, of all
    /// bodies together.
    MaskForest(const Geometry& geometry, std::span<const std::uint32_t> body_of_triangle,
               std::uint32_t bodies);

    [[nodiscard]] std::uint32_t body_count() const;

    /// All of these take effect at the next settle().
    void place(std::uint32_t body, const Placement& placement);
    void hide(std::uint32_t body);
    /// Over other positions, one per vertex of the geometry. The tree is refitted from that at
    /// rest, whatever came between; where that is too far, it is built anew. O(vertices of the
    /// body), and O(n log n) the first time.
    void deform(std::uint32_t body, std::span<const glm::vec3> positions);

    /// Brings the nodes of what has changed to their places, on all cores.
    void settle();

    /// Of all bodies; their links count from here.
    [[nodiscard]] const MaskNode* nodes() const { return nodes_.data(); }
    /// Empty where a body is hidden or has no triangle.
    [[nodiscard]] std::optional<std::uint32_t> root(std::uint32_t body) const;
    /// Of the bodies that have one, in their order.
    [[nodiscard]] std::vector<std::uint32_t> roots() const;
    [[nodiscard]] const MaskBall& ball(std::uint32_t body) const;
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
        bool settled = false;
        std::uint32_t base = 0;      ///< its first node in nodes_
        std::uint32_t capacity = 0;  ///< nodes there
        MaskBall ball;               ///< where it stands
    };

    static RawVector<MaskNode> nodes_of(Body& body, const Geometry& form);
    static void change(Body& body);
    void lay_out();
    void settle(Body& body);

    std::vector<Body> bodies_;
    RawVector<MaskNode> nodes_;
};

/// A body's nodes, links from 0, as they are where it is placed; their links then count from
/// `base`.
void place_nodes(std::span<const MaskNode> at_rest, const Placement& placement, std::uint32_t base,
                 MaskNode* nodes);

}  // namespace surfelao

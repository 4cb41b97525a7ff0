/// disk_forest.h: octrees of bodies that move, side by side in one that is walked as any other.
///
/// Every body has an octree of its own, built in its own space. A similarity turns centres and
/// normals and scales radii and areas; which disks stand together stays as it is, so nothing
/// flickers, and a frame costs the nodes that have moved.
#pragma once

#include "surfels/placement.h"
#include "tree/disks/gather.h"
#include "tree/disks/octree.h"

#include <array>
#include <cstdint>
#include <vector>

namespace surfelao {

/// One thread at a time may move it.
class DiskForest {
public:
    struct Body {
        Octree at_rest;
        Placement placement = {};
        bool shown = true;
        std::uint64_t shape = 0;  ///< another one, another octree
        /// In octree(): what is one-sided, and what is two-sided. Empty where it is hidden.
        std::array<NodeRange, 2> nodes = {}, surfels = {};
    };

    /// One per body, in the unit frame, where they are at rest.
    explicit DiskForest(std::vector<Octree> bodies);

    void place(std::uint32_t body, const Placement& placement);
    void hide(std::uint32_t body);
    /// Another body in its place, at rest.
    void replace(std::uint32_t body, Octree at_rest);

    /// Brings octree() to where the bodies stand. O(n) of what has moved, all cores.
    void update();

    /// All bodies that are shown. `source` is empty.
    [[nodiscard]] const Octree& octree() const { return octree_; }
    [[nodiscard]] const std::vector<Body>& bodies() const { return bodies_; }

private:
    void lay_out();
    void move(const Body& body);

    std::vector<Body> bodies_;
    std::vector<char> moved_;  ///< per body
    bool other_layout_ = true;
    Octree octree_;
};

}  // namespace surfelao

#include "tree/disks/disk_forest.h"

#include "surfels/for_all.h"

#include <algorithm>
#include <utility>

namespace surfelao {
namespace {

constexpr std::size_t kPiece = 4096;  ///< nodes or surfels of one task: some tens of microseconds

std::uint32_t size_of(const NodeRange& range)
{
    return range.end - range.begin;
}

/// Where the two kinds of a body's nodes or surfels begin in its own octree.
std::array<NodeRange, 2> kinds_of(std::uint32_t two_sided_from, std::size_t count)
{
    return {{{0, two_sided_from}, {two_sided_from, static_cast<std::uint32_t>(count)}}};
}

glm::vec3 moved_normal(const Placement& placement, const glm::vec3& n)
{
    return glm::vec3(placement.rotation * glm::dvec3(n));
}

}  // namespace

DiskForest::DiskForest(std::vector<Octree> bodies) : moved_(bodies.size(), 1)
{
    for (Octree& octree : bodies)
        bodies_.push_back({.at_rest = std::move(octree)});
    update();
}

void DiskForest::place(std::uint32_t body, const Placement& placement)
{
    Body& placed = bodies_.at(body);
    placed.placement = placement;
    moved_[body] = 1;
    if (!std::exchange(placed.shown, true))
        other_layout_ = true;
}

void DiskForest::hide(std::uint32_t body)
{
    if (std::exchange(bodies_.at(body).shown, false))
        other_layout_ = true;
}

void DiskForest::replace(std::uint32_t body, Octree at_rest)
{
    Body& replaced = bodies_.at(body);
    replaced.at_rest = std::move(at_rest);
    ++replaced.shape;
    other_layout_ = true;
    place(body, {});
}

void DiskForest::update()
{
    if (std::exchange(other_layout_, false))
        lay_out();
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
        if (std::exchange(moved_[b], 0) != 0 && bodies_[b].shown)
            move(bodies_[b]);
    }
}

void DiskForest::lay_out()
{
    std::uint32_t node = 0, surfel = 0;
    for (int kind = 0; kind < 2; ++kind) {
        for (Body& body : bodies_) {
            const Octree& own = body.at_rest;
            const auto nodes = kinds_of(own.two_sided_nodes, own.nodes.size());
            const auto surfels = kinds_of(own.two_sided_surfels, own.surfels.size());
            body.nodes[kind].begin = node;
            body.surfels[kind].begin = surfel;
            if (body.shown) {
                node += size_of(nodes[kind]);
                surfel += size_of(surfels[kind]);
            }
            body.nodes[kind].end = node;
            body.surfels[kind].end = surfel;
        }
        if (kind == 0) {
            octree_.two_sided_nodes = node;
            octree_.two_sided_surfels = surfel;
        }
    }
    octree_.nodes.resize(node);
    octree_.surfels.resize(surfel);
    std::ranges::fill(moved_, 1);
}

void DiskForest::move(const Body& body)
{
    const Octree& own = body.at_rest;
    const auto nodes = kinds_of(own.two_sided_nodes, own.nodes.size());
    const auto surfels = kinds_of(own.two_sided_surfels, own.surfels.size());
    const auto scale = static_cast<float>(body.placement.scale);
    for (int kind = 0; kind < 2; ++kind) {
        const std::uint32_t node_shift = body.nodes[kind].begin - nodes[kind].begin;
        const std::uint32_t surfel_shift = body.surfels[kind].begin - surfels[kind].begin;
        for_ranges(nodes[kind].begin, nodes[kind].end, kPiece,
                   [&](std::size_t begin, std::size_t end) {
                       for (std::size_t i = begin; i < end; ++i) {
                           OctreeNode node = own.nodes[i];
                           node.center = glm::vec3(placed_point(node.center, body.placement));
                           node.normal = moved_normal(body.placement, node.normal);
                           node.radius *= scale;
                           node.area *= scale * scale;
                           node.next += node_shift;
                           node.first_surfel += surfel_shift;
                           octree_.nodes[static_cast<std::uint32_t>(i) + node_shift] = node;
                       }
                   });
        for_ranges(surfels[kind].begin, surfels[kind].end, kPiece,
                   [&](std::size_t begin, std::size_t end) {
                       for (std::size_t i = begin; i < end; ++i) {
                           Surfel surfel = own.surfels[i];
                           surfel.position =
                               glm::vec3(placed_point(surfel.position, body.placement));
                           surfel.normal = moved_normal(body.placement, surfel.normal);
                           surfel.area *= scale * scale;
                           surfel.reach *= scale;
                           for (glm::vec3& corner : surfel.corners)
                               corner = scale * moved_normal(body.placement, corner);
                           octree_.surfels[static_cast<std::uint32_t>(i) + surfel_shift] = surfel;
                       }
                   });
    }
}

}  // namespace surfelao

#include "surfels/nearest.h"

#include "surfels/errors.h"

#include <nanoflann.hpp>

#include <utility>

namespace surfelao {
namespace {

/// Of so many points the tree makes a leaf: few nodes, and a search of 16 neighbours is a twentieth
/// faster than with 10.
constexpr std::size_t kLeafPoints = 16;

struct PointList {
    std::vector<glm::vec3> points;

    // what nanoflann asks
    std::size_t kdtree_get_point_count() const { return points.size(); }
    float kdtree_get_pt(std::size_t index, std::size_t axis) const
    {
        return points[index][static_cast<int>(axis)];
    }
    template <class Box>
    bool kdtree_get_bbox(Box&) const
    {
        return false;
    }
};

using KdTree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, PointList>,
                                                   PointList, 3, std::uint32_t>;

}  // namespace

struct NearestPoints::Tree {
    explicit Tree(std::vector<glm::vec3> points)
        : list{std::move(points)},
          tree(3, list, nanoflann::KDTreeSingleIndexAdaptorParams(kLeafPoints))
    {
    }

    PointList list;
    KdTree tree;
};

NearestPoints::NearestPoints(std::vector<glm::vec3> points)
{
    SURFELAO_CHECK(!points.empty());
    tree_ = std::make_unique<Tree>(std::move(points));
}

NearestPoints::~NearestPoints() = default;

std::size_t NearestPoints::find(glm::vec3 place, std::span<std::uint32_t> indices,
                                std::span<float> distances2) const
{
    return tree_->tree.knnSearch(&place.x, indices.size(), indices.data(), distances2.data());
}

}  // namespace surfelao

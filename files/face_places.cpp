#include "files/face_places.h"

#include "files/triangulate.h"

#include <algorithm>
#include <numeric>

namespace surfelao {

FacePlaces::FacePlaces(const Scene& scene, const UvSet& uvs, FaceShape shape)
    : scene_(scene), uvs_(uvs), shape_(shape), polygons_(source_polygons(scene))
{
}

std::span<const PlacedFace> FacePlaces::next()
{
    const std::size_t size = polygons_ ? polygons_->sizes[face_] : 3;
    cut_.assign(size == 3 ? 1 : 0, glm::uvec3(0, 1, 2));
    if (size > 3)
        triangulate(scene_.positions, {&polygons_->corners[corner_], size}, cut_);
    const glm::uvec3* const of_triangles =
        (uvs_.corners.empty() ? scene_.triangles : uvs_.corners).data() + triangle_;
    whole_.assign(size, UvSet::kNone);
    bool is_whole = size == 3 || shape_ == FaceShape::polygons;
    for (std::size_t t = 0; t < cut_.size(); ++t) {
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t place = of_triangles[t][k];
            std::uint32_t& known = whole_[cut_[t][k]];
            if (known == UvSet::kNone)
                known = place;
            else if (place != UvSet::kNone && uvs_.values[place] != uvs_.values[known])
                is_whole = false;
        }
    }
    faces_.clear();
    corners_.clear();
    places_.clear();
    // spans into them must stay good
    corners_.reserve(std::max(size, 3 * cut_.size()));
    places_.reserve(corners_.capacity());
    if (is_whole) {
        corners_.resize(size);
        std::iota(corners_.begin(), corners_.end(), 0u);
        add(corners_, whole_);
    } else {
        for (std::size_t t = 0; t < cut_.size(); ++t) {
            corners_.insert(corners_.end(), {cut_[t].x, cut_[t].y, cut_[t].z});
            add(std::span(corners_).last(3), {&of_triangles[t].x, 3});
        }
    }
    ++face_;
    corner_ += size;
    triangle_ += cut_.size();
    return faces_;
}

void FacePlaces::add(std::span<const std::uint32_t> corners, std::span<const std::uint32_t> places)
{
    const auto any =
        std::ranges::find_if(places, [](std::uint32_t place) { return place != UvSet::kNone; });
    if (any == places.end()) {
        faces_.push_back({corners, {}});
        return;
    }
    for (const std::uint32_t place : places)
        places_.push_back(place == UvSet::kNone ? *any : place);
    faces_.push_back({corners, std::span(places_).last(places.size())});
}

}  // namespace surfelao

/// gltf_cuts.h: the vertices of a glTF's meshes cut where corners have different places in a map.
/// Internal to the glTF reader and writer.
///
/// A primitive that is cut has accessors of its own: those that it had with copies of some vertices
/// behind the others, all attributes and morph targets bit by bit, and indices of triangles. What
/// it had before stays in the file, and stands in its extras, so that a later bake finds the way
/// back:
///
///     "extras": {"surfelao": {"digest": 12345, "original": {"attributes": {...}, "indices": 7}}}
///
/// The digest is one of all that the original's accessors hold: another program may have moved
/// accessors about.
#pragma once

#include "files/gltf_added.h"
#include "files/gltf_asset.h"
#include "files/gltf_resolve.h"

#include <glm/vec3.hpp>

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace surfelao {

/// Sets of coordinates that vertices may be cut along at once: the pages of a blended map.
inline constexpr std::size_t kMostCutSets = 3;

struct GltfCut {
    /// Of each set u and v of each vertex, the copies behind the others.
    std::vector<std::vector<float>> places;
    std::vector<std::uint32_t> copied;  ///< the part's vertex that each copy is one of
    std::vector<glm::uvec3> triangles;  ///< the part's, as its mesh winds them
};

/// A vertex has the first places that a triangle gives it (0, 0 where none does), and a copy for
/// each other ones; places are equal when they are as floats. A corner that has a place in some of
/// the sets is at 0, 0 in the others. O(corners log copies).
[[nodiscard]] GltfCut cut_part(const Scene& scene, const Part& part, const GltfPart& in_file,
                               std::span<const UvSet> sets);

/// Reads accessors as bytes.
class GltfElements {
public:
    /// The asset must outlive it.
    explicit GltfElements(const GltfAsset& asset);

    struct Bytes {
        NamedAccessor named;
        std::string bytes;  ///< as read_elements()
    };
    /// Throws InputError, also where a small file has far more read than there is in it.
    [[nodiscard]] Bytes read(const nlohmann::json& index, const std::string& user);

    /// A digest of all accessors of a primitive. Throws InputError. Each is read once.
    [[nodiscard]] std::uint32_t digest(const nlohmann::json& primitive);

    /// Throws InputError where an accessor has not one element for each vertex.
    void check_count(const NamedAccessor& named, std::size_t vertices) const
    {
        resolver_.check_count(named, vertices);
    }

private:
    std::uint32_t digest_of_accessor(const nlohmann::json& index, const std::string& user);

    const GltfAsset& asset_;
    AccessorResolver resolver_;
    std::uint64_t left_;  ///< bytes that may yet be read
    std::map<std::size_t, std::uint32_t> digests_;
};

/// Cuts primitives. Accessors and cuts that are equal are written once.
class GltfCutter {
public:
    /// A document made of the asset's; all must outlive it.
    GltfCutter(nlohmann::json& document, const GltfAsset& asset, AddedData& added);

    /// Gives a primitive the vertices of the cut and these of its triangles. Throws InputError
    /// where an attribute has no accessor with one element for each vertex; the element is what
    /// it calls the primitive.
    void cut(nlohmann::json& primitive, const std::string& element, const GltfCut& cut,
             std::span<const glm::uvec3> triangles);

private:
    std::size_t extended(const nlohmann::json& index, const std::string& user, std::size_t cut,
                         std::span<const std::uint32_t> copied, std::size_t vertices);

    nlohmann::json& document_;
    AddedData& added_;
    GltfElements elements_;
    std::map<std::vector<std::uint32_t>, std::size_t> cuts_;  ///< by the vertices that are copied
    std::map<std::pair<std::size_t, std::size_t>, std::size_t> extended_;  ///< by cut and accessor
};

/// A primitive that was cut becomes what it was. Where another program has changed it since, it
/// stays, and is the file's own now. The document has passed geometry_text(), what is restored must
/// do so again.
void undo_cut(nlohmann::json& document, nlohmann::json& primitive, GltfElements& elements);

}  // namespace surfelao

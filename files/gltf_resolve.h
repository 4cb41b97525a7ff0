/// gltf_resolve.h: from an accessor's index to its bytes. Internal to the glTF reader and writer.
#pragma once

#include "files/gltf_accessor.h"
#include "files/gltf_asset.h"

#include <cstdint>
#include <string>

namespace surfelao {

/// An accessor and what messages call it.
struct NamedAccessor {
    std::string element;  ///< "mesh 0 primitive 1 POSITION accessor 2"
    GltfAccessor accessor;
};

/// "node 3"
[[nodiscard]] std::string numbered(const char* what, std::size_t index);

/// Finds where elements lie; reads none of them.
class AccessorResolver {
public:
    /// The asset must outlive the resolver, its document have passed geometry_text().
    explicit AccessorResolver(const GltfAsset& asset) : asset_(asset) {}

    /// All that can be wrong with the place of the elements is found here; the name is
    /// `user` + " accessor " + index. Throws InputError. The index must be in range.
    [[nodiscard]] NamedAccessor resolve(int index, const std::string& user) const;

    [[noreturn]] void fail(const std::string& element, const std::string& fault) const
    {
        fail_gltf(asset_.path, element, fault);
    }

    [[nodiscard]] std::size_t byte_count() const { return asset_.byte_count; }

    /// Fails where there is not one element for each of `what`.
    void check_count(const NamedAccessor& accessor, std::size_t count,
                     const char* what = "vertices") const;

private:
    void resolve_sparse(const nlohmann::json& sparse, NamedAccessor& named) const;
    [[nodiscard]] std::size_t stride_of(std::size_t view, const GltfAccessor& accessor,
                                        const std::string& element) const;
    [[nodiscard]] std::string_view slice(std::size_t view, std::size_t offset,
                                         const GltfAccessor& layout,
                                         const std::string& element) const;

    const GltfAsset& asset_;
};

}  // namespace surfelao

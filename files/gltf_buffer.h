/// gltf_buffer.h: bytes of a new glTF's only buffer.
#pragma once

#include <cstddef>
#include <span>

namespace tinygltf {
class Model;
}

namespace surfelao {

/// Appends them at a multiple of four; the number of their buffer view. target: of glTF, 0 for
/// none.
int add_view(tinygltf::Model& model, std::span<const std::byte> bytes, int target);

/// An accessor over a new view. component_type and type are glTF's.
int add_accessor(tinygltf::Model& model, std::span<const std::byte> bytes, int component_type,
                 int type, std::size_t count, int target);

}  // namespace surfelao

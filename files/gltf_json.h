/// gltf_json.h: looking into a document without trusting it. Internal to the glTF reader and
/// writer.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <cstddef>

namespace surfelao {

/// Member of an object; null where there is none.
[[nodiscard]] const nlohmann::json& member(const nlohmann::json& object, const char* key);

/// Entry of one of the document's top-level arrays; null where there is none.
[[nodiscard]] const nlohmann::json& entry(const nlohmann::json& document, const char* list,
                                          const nlohmann::json& index);

/// Whether a number in [first, ...) stands under this key anywhere in the value.
[[nodiscard]] bool uses(const nlohmann::json& value, const char* key, std::size_t first);

}  // namespace surfelao

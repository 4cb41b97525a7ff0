/// gltf_schema.h: the part of a glTF document that geometry comes from, checked.
/// Internal to the glTF reader.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <string>

namespace surfelao {

/// Whether a document's animations count: else nothing in them is looked at.
enum class Animations { left_out, kept };

/// As JSON text, a document with the scenes, nodes (their visibility and instances too), skins,
/// meshes (positions, normals, COLOR_0 and _OWN_COLOR, joints and weights, morph targets, indices),
/// accessors and buffer views of `document`, its animations where they are kept, and of those only
/// the fields that geometry needs. What stands in it is of the type that the specification asks
/// for, nothing required is missing, whole numbers are not written as fractions, every index lies
/// inside the section it points into, and no number is too large for what tinygltf stores it in.
/// Entries keep their indices.
///
/// Throws InputError naming the element at fault (`path` is for the message), and like
/// check_required_extensions().
[[nodiscard]] std::string geometry_text(const nlohmann::json& document,
                                        const std::filesystem::path& path,
                                        Animations animations = Animations::left_out);

}  // namespace surfelao

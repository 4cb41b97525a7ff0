/// gltf_strings.h: the strings of a glTF's JSON, without making a document of it. Internal to the
/// folder.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>

namespace surfelao {

/// Told the keys that lead to a string ("asset", "extras", ...; "" for a place in a list) and the
/// string; false ends the reading.
using VisitString = std::function<bool(std::span<const std::string> keys, const std::string& text)>;

/// Visits the strings of a .gltf or of the JSON chunk of a .glb in the file's order. Only as much
/// of the file is read as is visited; it ends without a word at whatever is no JSON.
void visit_gltf_strings(const std::filesystem::path& path, const VisitString& visit);

/// The same for a file in memory.
void visit_gltf_strings_in(const std::string& contents, const VisitString& visit);

}  // namespace surfelao

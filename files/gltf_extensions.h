/// gltf_extensions.h: the extensions that a glTF file may require. Internal to the glTF reader.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <filesystem>

namespace surfelao {

/// Throws InputError naming the first entry of `extensionsRequired` that makes geometry which this
/// reader does not know (compression, splats, voxels, other index lists), or that it has never
/// heard of. Those that leave the triangles of the default pose where they are, move all of them
/// alike, or are read here are fine.
void check_required_extensions(const nlohmann::json& document, const std::filesystem::path& path);

}  // namespace surfelao

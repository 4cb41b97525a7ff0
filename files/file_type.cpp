#include "files/file_type.h"

#include "surfels/extension.h"

#include <string>
#include <utility>

namespace surfelao {

FileType type_of(const std::filesystem::path& path)
{
    const std::string extension = lower_extension(path);
    constexpr std::pair<const char*, FileType> kTypes[] = {
        {".obj", FileType::obj},     {".ply", FileType::ply},     {".off", FileType::off},
        {".stl", FileType::stl},     {".gltf", FileType::gltf},   {".glb", FileType::glb},
        {".pcd", FileType::pcd},     {".xyz", FileType::xyz},     {".pts", FileType::xyz},
        {".txt", FileType::xyz},     {".asc", FileType::xyz},     {".fbx", FileType::foreign},
        {".dae", FileType::foreign}, {".zae", FileType::foreign}, {".3ds", FileType::foreign},
        {".3mf", FileType::foreign}, {".x3d", FileType::foreign}};
    for (const auto& [name, type] : kTypes) {
        if (extension == name)
            return type;
    }
    return FileType::unknown;
}

bool is_gltf(FileType type)
{
    return type == FileType::gltf || type == FileType::glb;
}

}  // namespace surfelao

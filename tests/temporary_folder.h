/// temporary_folder.h: a folder of its own for each test, gone afterwards; files in and out of it.
#pragma once

#include "surfels/scene.h"

#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

namespace surfelao {

class TemporaryFolder {
public:
    TemporaryFolder()
    {
        std::string pattern = (std::filesystem::temp_directory_path() / "surfelao_XXXXXX").string();
        if (mkdtemp(pattern.data()) == nullptr)
            throw std::runtime_error("no temporary folder");
        path_ = pattern;
    }
    ~TemporaryFolder()
    {
        std::error_code error;
        std::filesystem::remove_all(path_, error);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
    const std::filesystem::path& path() const { return path_; }

    /// A file with these bytes.
    std::filesystem::path file(const std::string& name, const std::string& contents) const
    {
        std::ofstream(path_ / name, std::ios::binary) << contents;
        return path_ / name;
    }

    std::ptrdiff_t file_count() const
    {
        return std::distance(std::filesystem::directory_iterator(path_),
                             std::filesystem::directory_iterator());
    }

private:
    std::filesystem::path path_;
};

inline std::string contents_of(const std::filesystem::path& path)
{
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// The scene as an OBJ file.
inline void write_obj(const std::filesystem::path& path, const Scene& scene)
{
    std::ofstream file(path);
    file.precision(17);
    for (const glm::dvec3 p : scene.positions)
        file << "v " << p.x << ' ' << p.y << ' ' << p.z << '\n';
    for (const glm::uvec3 t : scene.triangles)
        file << "f " << t.x + 1 << ' ' << t.y + 1 << ' ' << t.z + 1 << '\n';
}

}  // namespace surfelao

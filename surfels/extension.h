/// extension.h: the end of a file's name, by which formats are told apart.
#pragma once

#include <filesystem>
#include <string>

namespace surfelao {

/// ".ply" of "Model.PLY": ASCII letters become small, whatever the locale; empty without one.
[[nodiscard]] inline std::string lower_extension(const std::filesystem::path& path)
{
    std::string extension = path.extension().string();
    for (char& c : extension) {
        if (c >= 'A' && c <= 'Z')
            c = static_cast<char>(c - 'A' + 'a');
    }
    return extension;
}

}  // namespace surfelao

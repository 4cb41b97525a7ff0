/// source_file.h: the file that is read.
#pragma once

#include <filesystem>
#include <string>

namespace surfelao {

struct SourceFile {
    std::filesystem::path path;
    std::string format;  ///< "FBX", "3MF": its extension
};

}  // namespace surfelao

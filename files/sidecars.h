/// sidecars.h: the other files that a mesh file is made of.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace surfelao {

/// What the file refers to and what is there: buffers and images of .gltf and .glb, material files
/// of .obj and their textures, textures that a .ply names in a comment (`TextureFile`), textures of
/// what assimp reads (by import_file() of foreign_io.h). For telling whether a file belongs to a
/// model: any words of a texture's line may be its name. Empty for other formats and for what
/// cannot be read; never throws for a fault in the file. O(bytes of the file).
[[nodiscard]] std::vector<std::filesystem::path> sidecars_of(const std::filesystem::path& mesh);

/// A comment of a PLY's header names textures behind this word.
inline constexpr std::string_view kTextureKeyword = "TextureFile";

/// Whether a line of an OBJ's material file that begins with this word names a texture.
[[nodiscard]] bool names_texture(std::string_view keyword);

struct NamedFile {
    std::string_view name;       ///< into the names
    std::filesystem::path file;  ///< empty where there is none
};

/// Splits names that stand behind one another, with blanks between and in them, by what lies in
/// `folder`: the longest run of words that is a file, else a single word. Backslashes may stand for
/// slashes.
[[nodiscard]] std::vector<NamedFile> files_named(const std::filesystem::path& folder,
                                                 std::string_view names);

/// The path by which a file in `folder` reaches `file`, with slashes. Folders that are links are
/// followed, `file` is not.
[[nodiscard]] std::string path_from(const std::filesystem::path& folder,
                                    const std::filesystem::path& file);

/// The names of files in `from` as they must be written in a file in `to`. Absolute ones and what
/// is not found stay as they are, and all where both are one folder; what is not found in another
/// is added to `missing`.
[[nodiscard]] std::string names_from(const std::filesystem::path& to,
                                     const std::filesystem::path& from, std::string_view names,
                                     std::vector<std::string>& missing);

/// Adds one sentence that lists them, if there are any.
void note_missing(const std::vector<std::string>& missing, std::vector<std::string>& notes);

}  // namespace surfelao

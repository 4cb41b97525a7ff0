/// maker_mark.h: the line by which a result says which command made it, and how.
///
///     surfelao 0.1.0 bake: engine=masks quality=1 device=cpu ...
///
/// By it a command knows its own earlier results, which it may replace unasked, from files of its
/// user, and `bake --resume` knows whether a result was made with the same settings. Where it
/// stands:
///
///   .ply          a comment behind the line `format`
///   .obj          a comment, the first line
///   .off          a comment, the last line: not every reader takes one in front of the counts
///   .pcd          a comment in front of the line `FIELDS`
///   .xyz .pts .txt .asc   likewise
///   .gltf .glb    the string `surfelao` in `asset.extras` (none where extras are no object)
///   pictures      the description (image/image_file.h: read_description)
///   .html         the content of <meta name="generator">, in the first line
///
/// No reader of these formats minds it. A writer that is given a mark drops an older one.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace surfelao {

/// `settings` without line ends. The version is that of the program.
[[nodiscard]] std::string make_mark(std::string_view command, std::string_view settings);

/// The command of a mark ("bake"); empty for any other text.
[[nodiscard]] std::string_view command_of_mark(std::string_view text);

/// The mark that a file carries; empty without one, also for what cannot be read or is none of
/// these formats. Only a few kilobytes of a file are read, of glTF its JSON as far as the asset.
[[nodiscard]] std::string read_mark(const std::filesystem::path& path);

/// The key of the mark in a glTF's asset.extras.
inline constexpr const char* kMarkKey = "surfelao";

/// The line of an OBJ or OFF that is its mark, with its end, and the mark in it; empty without one.
/// An OBJ's text begins behind a byte order mark.
struct MarkLine {
    std::string_view line, mark;
};
[[nodiscard]] MarkLine obj_mark(std::string_view text);
[[nodiscard]] MarkLine off_mark(std::string_view text);

}  // namespace surfelao

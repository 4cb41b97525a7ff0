/// shader_source.h: GLSL text as the compiler gets it, and the compiler's words as a person gets
/// them.
///
/// Shaders are files in shaders/, embedded at build by cmake/embed_shaders.cmake. A line
/// `#include "name.glsl"` is replaced by that file, once per shader; #line keeps the places, so
/// that a driver's "1:12(5): error" can be told as "octree.glsl:12(5): error".
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace surfelao {

struct ShaderFile {
    std::string_view name;  ///< file name without folder
    std::string_view text;
};

/// All files of shaders/.
[[nodiscard]] std::span<const ShaderFile> shader_files();

struct ShaderSource {
    std::string text;                ///< complete GLSL, #version first
    std::vector<std::string> files;  ///< by the source number that #line gives them
};

/// Pastes the includes of `name` and puts `definitions` ("KEY VALUE" each, as #define) behind its
/// #version line. Throws std::runtime_error naming file and line when a file is unknown or the
/// first line is no #version.
[[nodiscard]] ShaderSource assemble_shader(std::span<const ShaderFile> files, std::string_view name,
                                           std::span<const std::string> definitions = {});

/// The driver's log with our file names in place of source numbers. Understands the forms of Mesa
/// ("0:12(5): ..."), NVIDIA ("0(12) : ...") and AMD ("ERROR: 0:12: ..."); leaves all else as it is.
[[nodiscard]] std::string name_files_in_log(std::string_view log,
                                            std::span<const std::string> files);

}  // namespace surfelao

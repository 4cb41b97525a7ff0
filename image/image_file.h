/// image_file.h: pictures from and to files.
///
/// OpenImageIO does the work, in a module of its own (image_module.cpp) that is opened at the first
/// call: linking it into the program would cost every start 0.25 s and 134 MB. The module lies at
/// ../<library folder>/surfelao beside the program's folder, in the build tree and after install
/// alike; else the system's search path for libraries is tried.
#pragma once

#include "image/image.h"
#include "image/map.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace surfelao {

/// Begins to open the module, on a thread of its own where several are allowed: for who is going to
/// write a picture and has work to do before. The program's end waits for it.
void open_images_early();

/// Reads .png, .jpg, .hdr, .exr and whatever else OpenImageIO knows. 8- and 16-bit files are taken
/// as sRGB, float files as linear; grey becomes RGB, missing alpha becomes 1. Throws InputError
/// with one sentence for a file that is missing, not a picture, cut short, larger than 2^28 pixels
/// or holds values that are not finite.
[[nodiscard]] Image read_image(const std::filesystem::path& path);

/// The same from the contents of a .png or .jpg; `name` is for messages.
[[nodiscard]] Image read_image(const std::string& name, std::string_view bytes);

/// Throws InputError when `path` could not be written at all: an extension other than .png, .jpg,
/// .jpeg or .exr, a folder that is missing, a path that is a folder. For use before any work.
void check_image_output(const std::filesystem::path& path);

/// Writes .png (8 bit sRGB), .jpg (8 bit sRGB, quality 95, alpha left out) or .exr (linear 32-bit
/// float). Alpha is written where any pixel is not opaque. The file appears when it is complete
/// (atomic_file.h). Throws InputError as check_image_output does and for an image without pixels,
/// std::runtime_error when the machine refuses.
void write_image(const std::filesystem::path& path, const Image& image);

/// Throws InputError as check_image_output(), for an extension other than .png, .tif, .tiff or
/// .exr, and for a depth that the format does not have (.png: byte, half; .exr: half, whole).
void check_map_output(const std::filesystem::path& path, MapDepth depth);

/// Writes the numbers of a map as they are: tagged linear, without a gamma, those of 0 to 1 rounded
/// to the nearest step of the depth. One channel is grey, three are RGB, four have an alpha that is
/// a number as the others. mark: who made the file,
/// and how (files/maker_mark.h), as its description. As write_image() else.
void write_map(const std::filesystem::path& path, const Map& map, MapDepth depth,
               const std::string& mark = {});

/// The numbers of a picture as they are: as many channels as the file has, whole numbers as shares
/// of their largest, nothing decoded, alpha not multiplied in. As read_image() else.
[[nodiscard]] Map read_map(const std::filesystem::path& path);

/// The description of a picture: the mark of one of ours. Empty where there is none, or no picture.
[[nodiscard]] std::string read_description(const std::filesystem::path& path);

/// The bytes that write_map() gives a .png: for files that hold pictures. Throws SettingsError for
/// a map without texels and for MapDepth::whole, std::runtime_error when the module refuses.
[[nodiscard]] std::string map_bytes(const Map& map, MapDepth depth);

}  // namespace surfelao

/// grid_file.h: AO grids as files: a picture of tiles, and a text beside it that says what they
/// are.
///
///     NAME.aogrid.exr or NAME.aogrid.png      the cells
///     NAME.aogrid.json                        box, cells, warp, coding
///
/// A tile is a slice of the grid: cells.x texels wide, cells.y high, row 0 (the top) of y = 0. Tile
/// z stands in column z % columns, row z / columns, as engines cut up pictures for textures of
/// three dimensions. Texels hold four numbers x in [-1, 1]:
///
///     cone    m / pi and alpha                    one sheet of tiles
///     sh      c / (4 pi Y_00): c_00 is alpha      three sheets, one below the other, with
///                                                 coefficients 0-3, 4-7, and 8 and zeros
///
/// stored as zero + (1 - zero) x: .exr half floats, zero = 0; .png whole numbers, zero = 32768 /
/// 65535 or 128 / 255, so that nothing is exactly nothing. The numbers are data: linear, alpha is
/// not multiplied in.
///
/// The JSON: format "aogrid 1", picture, cells, columns, rows, sheets, box {low, high}, warp
/// {inner, share}, store, depth, zero, border {kind, fade, value}, and whatever its maker adds.
#pragma once

#include "grid/ao_grid.h"
#include "image/map.h"

#include <cstdint>
#include <filesystem>
#include <string>

namespace surfelao {

/// What is known of a grid's making; nothing of it is needed to read the grid.
struct GridNotes {
    std::string maker;         ///< the mark of the command (files/maker_mark.h)
    std::string about = "{}";  ///< a JSON object: what stands in the file as "made"
    bool operator==(const GridNotes&) const = default;
};

/// Whether the name is one of a grid's picture: it ends in .aogrid.exr or .aogrid.png.
[[nodiscard]] bool is_grid_name(const std::filesystem::path& path);

/// "NAME.aogrid.json" of a picture's name.
[[nodiscard]] std::filesystem::path grid_text_path(const std::filesystem::path& picture);

/// Throws InputError where no grid could be written there: another name, a depth that the format
/// does not have (.exr: half; .png: byte, half), a folder that is missing.
void check_grid_output(const std::filesystem::path& picture, MapDepth depth);

/// Both files, or none. Throws as check_grid_output(), and std::runtime_error when the machine
/// refuses. maker: also the picture's description.
void write_grid(const std::filesystem::path& picture, const AoGrid& grid, MapDepth depth,
                const GridNotes& notes = {});

/// path: the picture or the text. Throws InputError with one sentence for a file that is missing,
/// damaged, or does not fit the other one, and for values that no grid has.
[[nodiscard]] AoGrid read_grid(const std::filesystem::path& path, GridNotes* notes = nullptr);

/// The maker that a text beside a grid names; empty for any other file.
[[nodiscard]] std::string grid_maker(const std::filesystem::path& text);

/// The texels of a grid as they stand in the file, before they are rounded.
[[nodiscard]] Map sheet_of(const AoGrid& grid, float zero);

/// Of the numbers in the file, before any compression.
[[nodiscard]] std::uint64_t bytes_of(const AoGrid& grid, MapDepth depth);

/// Columns of tiles: as many as make the sheet about square.
[[nodiscard]] int tile_columns(int slices);

}  // namespace surfelao

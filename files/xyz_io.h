/// xyz_io.h: point clouds as text, one point a line: .xyz .pts .txt .asc.
///
/// Read: columns of numbers between blanks, tabs, commas or semicolons, as many on every line;
/// blank lines and comments (`#`, `//`) anywhere; in front of the points a line with nothing but
/// their count (.pts), and a line that names the columns, which may be a comment (CloudCompare's
/// `//X Y Z R G B`). What the columns are is said, the first of these that there is, by
/// ReadOptions::columns, by the comment `# columns ...` of an earlier result, by the line of names
/// (a comment only where it names as many as there are), or by what stands in them:
///
///   x y z        the first three
///   nx ny nz     of six columns and more the first three behind z, in a row, whose length as a
///                vector is .9 to 1.1 at 99 % of the points
///   r g b        the first three in a row that are whole numbers of 0 to 255 everywhere; in a .pts
///                the last three (x y z intensity r g b)
///   intensity    a single column that is left; of several none has a name
///
/// Names are taken in any case: `x y z`, `nx ny nz` or `normal_x ...`, `r g b` or `red green blue`
/// or CloudCompare's `Rf Gf Bf`; any others are kept and not used. x, y and z are finite and up to
/// 1e100 everywhere: nobody writes a point into a list that is not there. Normals are numbers (any:
/// zero and nan are none); other columns may hold any words. Colours are whole numbers up to 255,
/// or up to 65535 where one is larger, or else as own_colors.h takes numbers.
#pragma once

#include "files/scene_io.h"

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace surfelao {

/// file_name is what faults are reported of, and tells a .pts; contents is the file. Faults name
/// the line. Throws SettingsError where `columns` does not name x, y and z once each.
[[nodiscard]] Scene read_xyz(const std::string& file_name, std::string contents,
                             const std::string& columns = {});

/// The cloud as text with the columns `occlusion`, `bent_nx bent_ny bent_nz` and colours `red green
/// blue` (vertex_colors.h) behind the others; `automatic` keeps those of the file, all of them
/// white: shades. Colours that others are shown in place of stand last, `own_red own_green
/// own_blue`.
///
/// A cloud that came from text gives its own file with nothing else changed: numbers as they are
/// written there, separators, comments, count; the line that names the columns names the new ones
/// too. Where there is none, or columns were told, a comment behind the points does, `# columns x y
/// z ...`: no reader stumbles over it there. Any other cloud, and one that becomes or was a .pts
/// with the count that this needs, gives new text with blanks between numbers: its coordinates,
/// normals, colours and other columns; points without a finite place are left out.
/// options.mark: a comment as the last line (maker_mark.h).
[[nodiscard]] WrittenFile xyz_contents(const std::filesystem::path& path, const Scene& scene,
                                       std::span<const Occlusion> occlusion,
                                       const WriteOptions& options = {});

}  // namespace surfelao

/// cloud_cases.h: files of points, and what they show.
#pragma once

#include "surfels/scene.h"
#include "surfels/srgb.h"

#include "malformed_case.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

namespace surfelao::test {

using Places = std::vector<glm::dvec3>;
using Normals = std::vector<glm::vec3>;
using Bytes = std::vector<glm::ivec3>;

inline constexpr double kUtm = 5432109.125;

/// A file and what it shows.
struct CloudCase {
    std::string name;  ///< of the file
    std::string contents;
    std::string columns = {};  ///< told
    Places positions = {{1, 2, 3}, {4, 5, 6}};
    Normals normals = {};
    Bytes colors = {};
    std::optional<glm::dvec3> viewpoint = {};

    friend std::ostream& operator<<(std::ostream& out, const CloudCase& c) { return out << c.name; }
};

inline std::string ply_cloud(const std::string& header, const std::string& rows)
{
    return "ply\nformat ascii 1.0\n" + header + "end_header\n" + rows;
}

inline std::string pcd_header(const std::string& fields, int points, const std::string& kind)
{
    const std::string count = std::to_string(points);
    return "# .PCD v.7 - Point Cloud Data file format\nVERSION .7\n" + fields + "WIDTH " + count +
           "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + count + "\nDATA " + kind + "\n";
}

inline constexpr const char* kXyzFields = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n";
inline constexpr const char* kAllFields =
    "FIELDS x y z rgb normal_x normal_y normal_z curve id\nSIZE 4 4 4 4 4 4 4 2 8\n"
    "TYPE F F F F F F F U I\nCOUNT 1 1 1 1 1 1 1 2 1\n";

/// Points of kAllFields; `by_field` as compressed data have them.
inline std::string pcd_points(bool by_field)
{
    using malformed::bytes;
    const std::vector<std::string> fields[] = {
        {bytes(1.f), bytes(2.f), bytes(3.f), bytes(0xffff0000u), bytes(0.f), bytes(0.f), bytes(1.f),
         bytes(std::uint16_t{7}, std::uint16_t{8}), bytes(std::int64_t{-1})},
        {bytes(4.f), bytes(5.f), bytes(6.f), bytes(0x00008007u), bytes(0.f), bytes(1.f), bytes(0.f),
         bytes(std::uint16_t{9}, std::uint16_t{9}), bytes(std::int64_t{1} << 60)}};
    std::string data;
    for (std::size_t f = 0; f < fields[0].size() && by_field; ++f)
        data += fields[0][f] + fields[1][f];
    for (std::size_t f = 0; f < 2 * fields[0].size() && !by_field; ++f)
        data += fields[f / fields[0].size()][f % fields[0].size()];
    return data;
}

/// LZF that compresses nothing but runs of zeros, which it finds.
inline std::string lzf(const std::string& data)
{
    std::string packed;
    for (std::size_t at = 0; at < data.size();) {
        std::size_t zeros = data.substr(at, 9).find_first_not_of('\0');
        zeros = std::min(zeros, data.size() - at);
        if (at > 0 && data[at - 1] == '\0' && zeros >= 3 && zeros < 9) {
            packed += static_cast<char>((zeros - 2) << 5);  // as many as the byte before
            packed += '\0';
            at += zeros;
        } else {
            packed += std::string(1, '\0') + data[at++];
        }
    }
    return packed;
}

inline std::string compressed(const std::string& data, const std::string& packed)
{
    return malformed::bytes(static_cast<std::uint32_t>(packed.size()),
                            static_cast<std::uint32_t>(data.size())) +
           packed;
}

// long: a table
inline std::vector<CloudCase> clouds()
{
    const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
    const std::string normal = "property float nx\nproperty float ny\nproperty float nz\n";
    const std::string red = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
    const std::string two = "element vertex 2\n" + xyz;
    const std::string rows = "1 2 3\n4 5 6\n";
    const Places places = {{1, 2, 3}, {4, 5, 6}};
    const Normals up = {{0, 0, 1}, {0, 1, 0}};
    const Bytes colors = {{255, 0, 0}, {0, 128, 7}};
    return {
        {"plain.ply", ply_cloud(two, rows)},
        {"no_faces.ply",
         ply_cloud(two + "element face 0\nproperty list uchar int vertex_indices\n", rows)},
        {"all.ply",
         ply_cloud(two + "property float intensity\n" + normal + red,
                   "1 2 3 .5 0 0 1 255 0 0\n"
                   "4 5 6 .7 0 1 0 0 128 7\n"),
         "", places, up, colors},
        {"splat.ply",
         ply_cloud(two + normal + "property float scale_0\n", "1 2 3 0 0 0 -5\n4 5 6 0 0 0 -4\n")},
        {"one_normal.ply",
         ply_cloud(two + normal, "1 2 3 0 0 1\n4 5 6 nan 0 1\n"),
         "",
         places,
         {{0, 0, 1}, {0, 0, 0}}},
        {"comment.ply",
         ply_cloud("comment viewpoint 7 8 9.5\n" + two, rows),
         "",
         places,
         {},
         {},
         {{7, 8, 9.5}}},
        {"camera.ply",
         ply_cloud(two + "element camera 1\nproperty float view_px\nproperty float view_py\n"
                         "property float view_pz\nproperty float x_axisx\n",
                   rows + "7 8 9 1\n"),
         "",
         places,
         {},
         {},
         {{7, 8, 9}}},
        {"no_camera.ply",
         ply_cloud(two + "element camera 1\nproperty float view_px\nproperty float view_py\n"
                         "property float view_pz\n",
                   rows + "0 0 0\n")},
        {"points.obj",
         "v 1 2 3 1 0 0\nv 4 5 6 0 .50196078 .02745098\np 1 2\n",
         "",
         places,
         {},
         colors},
        {"normals.obj", "vn 0 0 1\nv 1 2 3\nvn 0 1 0\nv 4 5 6\n", "", places, up},
        {"points.off", "NOFF\n2 0 0\n1 2 3 0 0 1\n4 5 6 0 1 0\n", "", places, up},

        {"plain.xyz", rows},
        {"blanks.XYZ", "\xEF\xBB\xBF  1\t2   3 \r\n\r\n4 5 6"},
        {"commas.txt", "1,2,3\n4, 5, 6\n"},
        {"semicolons.asc", "# a scan\n1;2;3;\n// more\n4;5;6;\n# the end\n"},
        {"count.pts", "2\n1 2 3\n4 5 6\n"},
        {"leica.pts", "2\n1 2 3 -7 255 0 0\n4 5 6 12 0 128 7\n", "", places, {}, colors},
        {"bytes.pts", "2\n1 2 3 7 255 0 0\n4 5 6 12 0 128 7\n", "", places, {}, colors},
        {"colors.xyz", "1 2 3 255 0 0\n4 5 6 0 128 7\n", "", places, {}, colors},
        {"normals.xyz", "1 2 3 0 0 1\n4 5 6 0 1 0\n", "", places, up},
        {"all.txt", "1 2 3 .5 255 0 0 0 0 1\n4 5 6 .7 0 128 7 0 1 0\n", "", places, up, colors},
        {"utm.xyz", "5432109.125 1 2\n", "", {{kUtm, 1, 2}}},
        {"header.csv.txt",
         "X,Y,Z,Red,Green,Blue,GPS Time\n1,2,3,255,0,0,1e9\n4,5,6,0,128,7,2e9\n",
         "",
         places,
         {},
         colors},
        {"cloudcompare.asc",
         "//Intensity X Y Z Rf Gf Bf Nx Ny Nz\n.5 1 2 3 1 0 0 0 0 1\n"
         ".7 4 5 6 0 .50196078 .02745098 0 1 0\n",
         "", places, up, colors},
        {"deep.txt",
         "# x y z red green blue\n1 2 3 65535 0 0\n4 5 6 0 32896 1799\n",
         "",
         places,
         {},
         colors},
        {"told.xyz",
         "9 a 3 2 1 0 0 5\n9 b 6 5 4 0 5 0\n",
         "- word z Y x nx ny nz",
         places,
         {{0, 0, 5}, {0, 5, 0}}},
        {"told_over_names.txt", "East North Up\n1 2 3\n4 5 6\n", "x,y,z"},
        {"plain.pcd", pcd_header(kXyzFields, 2, "ascii") + rows},
        {"short.pcd", "FIELDS y x z\nSIZE 8 8 4\nTYPE F F I\nPOINTS 2\nDATA ascii\n2 1 3\n5 4 6"},
        {"organised.pcd",
         "VERSION 0.7\nFIELDS _ x y z\nSIZE 1 4 4 4\nTYPE U F F F\nCOUNT 2 1 1 1\nWIDTH 1\n"
         "HEIGHT 2\nVIEWPOINT 7 8 9 1 0 0 0\nDATA ascii\n0 0 1 2 3\n0 0 4 5 6\n",
         "",
         places,
         {},
         {},
         {{7, 8, 9}}},
        {"rgb.pcd",
         pcd_header("FIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\n", 2, "ascii") +
             "1 2 3 2.3418052e-38\n4 5 6 4.5927557e-41\n",
         "",
         places,
         {},
         colors},
        {"rgba.pcd",
         pcd_header("FIELDS x y z rgba\nSIZE 4 4 4 4\nTYPE F F F U\nCOUNT 1 1 1 1\n", 2, "ascii") +
             "1 2 3 4294901760\n4 5 6 32775\n",
         "",
         places,
         {},
         colors},
        {"binary.pcd", pcd_header(kAllFields, 2, "binary") + pcd_points(false) + "behind", "",
         places, up, colors},
        {"packed.pcd",
         pcd_header(kAllFields, 2, "binary_compressed") +
             compressed(pcd_points(true), lzf(pcd_points(true))),
         "", places, up, colors},
        {"prose.xyz", "# x y z of a scan\n1 2 3\n4 5 6\n"},
        {"named_after_result.xyz", "1 3 2\n4 6 5\n# columns x z y\n"},
        {"channels.pcd",
         pcd_header("FIELDS x y z r g b\nSIZE 4 4 4 1 1 1\nTYPE F F F U U U\n", 2, "ascii") +
             "1 2 3 255 0 0\n4 5 6 0 128 7\n",
         "",
         places,
         {},
         colors},
        {"no_unit.xyz", "1 2 3 0 0 1.2\n4 5 6 0 1.2 0\n"},
    };
}

/// Those of own_colors() as bytes of sRGB.
inline Bytes color_bytes(const Scene& scene)
{
    Bytes bytes;
    for (const glm::vec4& color : scene.asset->own_colors()) {
        const auto byte = [](float linear) {
            return static_cast<int>(std::lround(255.0f * srgb_encode(linear)));
        };
        bytes.emplace_back(byte(color.x), byte(color.y), byte(color.z));
    }
    return bytes;
}

/// For the name of a test.
inline std::string word_of(std::string name)
{
    std::ranges::replace(name, '.', '_');
    return name;
}

}  // namespace surfelao::test

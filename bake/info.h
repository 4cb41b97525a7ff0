/// info.h: what a mesh file holds, and what is odd about it.
#pragma once

#include "bake/vertex_target.h"
#include "files/scene_io.h"
#include "surfels/half_edges.h"
#include "surfels/progress.h"
#include "surfels/scene.h"
#include "surfels/texels.h"
#include "surfels/topology.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace surfelao {

/// A set of texture coordinates as a map of kUvMap would be baked over it. Triangles without area
/// in space do not count.
struct UvReport {
    std::uint32_t set = 0;
    std::uint64_t triangles = 0;  ///< with coordinates at all corners
    std::uint64_t flat = 0;       ///< of these: show no texel (MapRaster::flat_triangles)
    std::uint64_t outside = 0;    ///< of these: reach out of [0, 1]
    double sheets = 0.0;          ///< area of those that show texels, 1 = that of the map
    /// Of the texels that show the surface, the share that shows several sheets of it. Not looked
    /// for where there are more than kMostSheets: the surface repeats the map.
    std::optional<double> overlap;
};

inline constexpr MapSize kUvMap{1024, 1024};

struct Info {
    std::filesystem::path input;
    std::vector<Part> parts;
    std::vector<Label> labels;  ///< names by which --exclude and its like know triangles
    std::uint64_t vertices = 0;
    std::uint64_t triangles = 0;
    std::uint64_t positions = 0;                ///< different places: vertices without seams
    std::uint64_t dropped_triangles = 0;        ///< without area
    std::uint64_t unused_vertices = 0;          ///< in no triangle
    std::uint64_t vertices_without_normal = 0;  ///< they get occlusion 0
    bool normals_in_file = false;
    std::uint64_t corners_from_file = 0;  ///< corners of triangles that a bake shades so
    std::uint64_t replaced_corners = 0;   ///< the file's were not usable there
    std::vector<UvReport> uvs;            ///< sets that some triangle has
    std::uint64_t receivers = 0;          ///< places where a bake asks for occlusion
    std::uint64_t ill_defined = 0;        ///< of `examined`: reference/well_defined.h
    std::uint64_t examined = 0;           ///< receivers that were looked at
    Topology topology;
    HalfEdgeReport half_edges;
    glm::dvec3 low{0.0}, high{0.0};  ///< box of the triangles' corners, the file's units
    double diagonal = 0.0;
    double area = 0.0;            ///< the file's units squared
    double mean_occlusion = 0.0;  ///< this and the next two: of a default bake
    std::optional<Misfit> misfit;
    std::vector<std::string> notes;  ///< bake/notes.h
};

/// Reads, bakes with default settings, keeping only what is to be said of it, and looks, with rays
/// at up to kExaminedReceivers places. Throws InputError; Cancelled when progress, told of both,
/// returns false.
[[nodiscard]] Info inspect(const std::filesystem::path& input, const Progress& progress = {},
                           const ReadOptions& reading = {});

inline constexpr std::uint64_t kExaminedReceivers = 20'000;

/// The facts, then a list of what is odd in sentences.
[[nodiscard]] std::string text_of(const Info& info);
/// The same as one JSON object.
[[nodiscard]] std::string json_of(const Info& info);

}  // namespace surfelao

/// info.h: what a mesh file holds, and what is odd about it.
#pragma once

#include "surfels/half_edges.h"
#include "surfels/progress.h"
#include "surfels/scene.h"
#include "surfels/topology.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace surfelao {

struct Info {
    std::filesystem::path input;
    std::vector<Part> parts;
    std::uint64_t vertices = 0;
    std::uint64_t triangles = 0;
    std::uint64_t positions = 0;                ///< different places: vertices without seams
    std::uint64_t dropped_triangles = 0;        ///< without area
    std::uint64_t unused_vertices = 0;          ///< in no triangle
    std::uint64_t vertices_without_normal = 0;  ///< they get occlusion 0
    std::uint64_t ill_defined = 0;              ///< of `examined`: reference/well_defined.h
    std::uint64_t examined = 0;                 ///< vertices with a normal that were looked at
    Topology topology;
    HalfEdgeReport half_edges;
    glm::dvec3 low{0.0}, high{0.0};  ///< box of the triangles' corners, the file's units
    double diagonal = 0.0;
    double area = 0.0;  ///< the file's units squared
};

/// Reads and looks, with rays at up to kExaminedVertices vertices. Throws InputError; Cancelled
/// when progress, told of the rays, returns false.
[[nodiscard]] Info inspect(const std::filesystem::path& input, const Progress& progress = {});

inline constexpr std::uint64_t kExaminedVertices = 20'000;

/// The facts, then a list of what is odd in sentences.
[[nodiscard]] std::string text_of(const Info& info);
/// The same as one JSON object.
[[nodiscard]] std::string json_of(const Info& info);

}  // namespace surfelao

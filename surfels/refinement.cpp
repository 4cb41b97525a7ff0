#include "surfels/refinement.h"

#include <glm/geometric.hpp>

#include <utility>

namespace surfelao {

glm::dvec3 middle_direction(const glm::dvec3& a, const glm::dvec3& b)
{
    const glm::dvec3 sum = a + b;
    const double length = glm::length(sum);
    return length > 0.0 ? sum * (0.5 * (glm::length(a) + glm::length(b)) / length) : a;
}

Scene plain_refined(const Scene& scene, const Refinement& refinement)
{
    // the part of each vertex, and its number in the refined scene
    const std::size_t count = refinement.old_vertices + refinement.parents.size();
    std::vector<std::uint32_t> part_of(count), number_of(count);
    Scene refined;
    refined.name = scene.name;
    refined.notes = scene.notes;
    refined.parts = scene.parts;
    for (std::uint32_t p = 0; p < scene.parts.size(); ++p) {
        const Part& part = scene.parts[p];
        std::fill_n(part_of.begin() + part.first_vertex, part.vertex_count, p);
    }
    for (std::size_t i = 0; i < refinement.parents.size(); ++i) {
        const std::uint32_t part = part_of[refinement.parents[i].x];
        part_of[refinement.old_vertices + i] = part;
        ++refined.parts[part].vertex_count;
    }
    std::vector<std::uint32_t> next;
    std::uint32_t vertex = 0;
    for (Part& part : refined.parts) {
        next.push_back(part.first_vertex = vertex);
        vertex += part.vertex_count;
        const std::uint32_t end = part.first_triangle + part.triangle_count;
        part.first_triangle = refinement.first[part.first_triangle];
        part.triangle_count = refinement.first[end] - part.first_triangle;
    }

    refined.positions.resize(count);
    for (std::uint32_t v = 0; v < count; ++v) {
        const std::uint32_t number = number_of[v] = next[part_of[v]]++;
        if (v < refinement.old_vertices) {
            refined.positions[number] = scene.positions[v];
            continue;
        }
        const glm::uvec2 of = refinement.parents[v - refinement.old_vertices];
        refined.positions[number] =
            0.5 * refined.positions[number_of[of.x]] + 0.5 * refined.positions[number_of[of.y]];
    }
    refined.triangles.reserve(refinement.pieces.size());
    for (const glm::uvec3& piece : refinement.pieces)
        refined.triangles.emplace_back(number_of[piece.x], number_of[piece.y], number_of[piece.z]);
    refined.labels = scene.labels;
    for (Label& label : refined.labels) {
        for (Label::Range& range : label.ranges) {
            const std::uint32_t end = refinement.first[range.first + range.count];
            range.first = refinement.first[range.first];
            range.count = end - range.first;
        }
    }
    return refined;
}

}  // namespace surfelao

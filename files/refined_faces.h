/// refined_faces.h: what becomes of the faces of a file whose triangles are cut. Internal to
/// refined_scene.cpp and those who write the formats for it.
#pragma once

#include "files/mesh_source.h"
#include "files/text_cursor.h"
#include "surfels/refinement.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace surfelao {

/// Goes through the faces of a scene: the source's polygons, else its triangles (for_each_face).
class RefinedFaces {
public:
    /// Both must outlive it.
    RefinedFaces(const Scene& scene, const Refinement& refinement);

    struct Triangle {
        std::uint32_t number;  ///< in the scene
        glm::uvec3 corners;    ///< by their numbers in the file's face
    };
    /// What becomes of a face; both empty: it stays as it is.
    struct Face {
        std::span<const Triangle> triangles;      ///< it is cut: into the pieces of these
        std::span<const std::uint32_t> vertices;  ///< it is not: but these are its corners now
    };
    /// Of the next face. Good until the next call.
    [[nodiscard]] Face next();

private:
    const Scene& scene_;
    const Refinement& refinement_;
    const Polygons* polygons_;
    std::size_t face_ = 0;
    std::size_t corner_ = 0;      ///< of all polygons
    std::uint32_t triangle_ = 0;  ///< of the scene
    std::vector<glm::uvec3> cut_;
    std::vector<Triangle> triangles_;
    std::vector<std::uint32_t> vertices_;
};

/// Rows of words in a text file: vertices, normals and the like.
class TextRows {
public:
    explicit TextRows(TextRules rules) : rules_(rules) {}

    [[nodiscard]] std::size_t size() const { return rows_.size(); }
    /// One of the file, which must outlive it.
    void add(std::string_view row) { rows_.push_back(row); }
    /// A new one.
    std::string_view add_own(std::string row)
    {
        return rows_.emplace_back(own_.emplace_back(std::move(row)));
    }
    [[nodiscard]] std::vector<std::string_view> words(std::size_t row) const;

private:
    TextRules rules_;
    std::vector<std::string_view> rows_;
    std::deque<std::string> own_;  ///< which never move
};

/// The numbers of two words; nan for what is none.
[[nodiscard]] glm::dvec2 numbers_of_words(std::string_view a, std::string_view b);

/// The mean of two words that are numbers; the first word where one is none.
enum class Rounding { none, whole };
void append_middle(std::string& text, std::string_view a, std::string_view b,
                   Rounding rounding = Rounding::none);

/// That of three words each, as coordinates or as directions.
enum class Triple { place, direction };
void append_middle(std::string& text, std::span<const std::string_view> a,
                   std::span<const std::string_view> b, Triple triple);

/// Each returns the text of the file with the triangles cut. The scene is that of the file without
/// anything that a bake has added: original_obj() and so on. normals: as in refined_scene().
[[nodiscard]] std::string refined_obj(const Scene& scene, const Refinement& refinement,
                                      std::span<const glm::vec3> normals = {});
[[nodiscard]] std::string refined_off(const Scene& scene, const Refinement& refinement,
                                      std::span<const glm::vec3> normals = {});
[[nodiscard]] std::string refined_ply(const Scene& scene, const Refinement& refinement,
                                      std::span<const glm::vec3> normals = {});

}  // namespace surfelao

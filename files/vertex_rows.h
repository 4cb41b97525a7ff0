/// vertex_rows.h: a result at the rows of vertices: in and behind those of its file, or as new
/// ones. Internal to the writers of PLY, PCD and text clouds.
///
/// What a bake adds stands in this order behind the file's own: occlusion, the bent normal, and
/// either colours made of nothing or the file's own that are not shown (ColorPlaces). A result's
/// columns of these names go before new ones come.
#pragma once

#include "files/table_rows.h"

#include <bit>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace surfelao::table {

/// How numbers stand in the rows of a file.
struct Notation {
    bool ascii = false;
    std::endian endian = std::endian::little;
    char separator = ' ';  ///< ascii: before each number
};
[[nodiscard]] Notation notation_of(const RowForm& form);

/// A number of this type; integers are rounded.
void append_channel(std::string& text, Type type, double value, Notation notation);

/// The same, in ascii with a separator before it.
void append_number(std::string& text, Type type, double value, Notation notation);

/// Where the vertices of a scene stand in its file, one after the other: nan for Scene::placeless.
class FilePlaces {
public:
    explicit FilePlaces(const Scene& scene) : scene_(scene) {}

    glm::dvec3 next()
    {
        const std::size_t vertex = vertex_++;
        if (lost_ == scene_.placeless.size() || scene_.placeless[lost_] != vertex)
            return scene_.positions[vertex];
        ++lost_;
        return glm::dvec3(std::numeric_limits<double>::quiet_NaN());
    }

private:
    const Scene& scene_;
    std::size_t vertex_ = 0, lost_ = 0;
};

/// Whether rounding to float would move some vertex by more than kFloatSlack of the box's diagonal
/// (ply_io.h).
[[nodiscard]] bool needs_double(const std::vector<glm::dvec3>& positions);

struct Column {
    Type type = Type::float32;
    std::string name;  ///< a word
};

/// A name as every format can hold it: `_` for blanks, commas and semicolons.
[[nodiscard]] std::string as_word(std::string_view name);

enum class ColorForm { apart, packed };

/// What becomes of a file's vertices.
struct VertexChanges {
    ColorPlaces places;
    ColorPlan plan;
    double largest = 0.0;       ///< of the numbers of the file's colours
    std::vector<Column> added;  ///< behind the others

    /// An earlier result's, or in the way of one of ours.
    [[nodiscard]] bool drops(std::string_view property) const;
};

/// is_measured: the result has occlusion at its vertices.
[[nodiscard]] VertexChanges changes_of(const RowSource& source, const WriteOptions& options,
                                       bool is_measured, std::vector<std::string>& notes);

/// Appends the source's rows with what changes. occlusion: one for each row, or empty. rest: bytes
/// that will come behind them, so that the text need not move for these.
void append_changed_rows(std::string& text, const RowSource& source,
                         std::span<const Occlusion> occlusion, const VertexChanges& changes,
                         std::size_t rest = 0);

/// Rows for a scene whose file is of another format: behind x y z its normals, where each vertex
/// has one, its colours, in a cloud other columns too, and the result.
class NewRows {
public:
    /// occlusion: one for each vertex; must outlive this, as the scene must.
    NewRows(const Scene& scene, std::span<const Occlusion> occlusion, const WriteOptions& options,
            ColorForm form, std::vector<std::string>& notes);

    /// Behind x y z.
    [[nodiscard]] const std::vector<Column>& columns() const { return columns_; }

    /// Appends them for one vertex.
    void append(std::string& text, std::size_t vertex, Notation notation) const;

private:
    const Scene& scene_;
    std::span<const Occlusion> occlusion_;
    ColorForm form_;
    ColorPlan plan_;
    std::vector<Column> columns_;
    std::vector<Column> others_;  ///< of the file, kept
    std::vector<double> kept_;    ///< their numbers, row by row
};

}  // namespace surfelao::table

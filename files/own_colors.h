/// own_colors.h: the colours that a file gives its vertices itself, and what its result shows in
/// their place. Internal to the readers and writers of OBJ, PLY and OFF.
#pragma once

#include "files/scene_io.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace surfelao {

/// Numbers of colours are 0 to 1 where no colour of the file is above this, else 0 to 255.
inline constexpr double kLargestOfUnit = 2.0;

/// 1 or 255: what white is in a file whose largest number is this.
[[nodiscard]] double white_of(double largest);

/// The number that makes up all of a word, nan and infinite ones too; none where it is no number.
[[nodiscard]] std::optional<double> number_in(std::string_view word);

/// Linear light of a number of sRGB, white being 1: at least 0, at most 1; 1 for what is no number.
[[nodiscard]] float linear_of(double number);

/// SourceAsset::own_colors() of the scene's source.
[[nodiscard]] std::vector<glm::vec4> own_colors_of(const Scene& scene);

/// The numbers of sRGB for a colour in linear light.
[[nodiscard]] glm::vec3 numbers_of(const glm::vec3& linear);

/// What the colours of a result show, decided for its format and for the colours of its source.
struct ColorPlan {
    VertexColors what = VertexColors::grey;  ///< never `automatic`
    Encoding encoding = Encoding::srgb;      ///< nor here
    std::vector<glm::vec4> own;              ///< SourceAsset::own_colors()

    [[nodiscard]] bool has_own() const { return !own.empty(); }
    /// The file's own colours stand in it a second time.
    [[nodiscard]] bool replaces() const { return has_own() && what != VertexColors::keep; }
    /// The result has colours.
    [[nodiscard]] bool writes() const { return has_own() || what != VertexColors::keep; }
    /// As they are written, 0 to 1. Not for `keep`.
    [[nodiscard]] glm::vec3 numbers(std::size_t vertex, const Occlusion& occlusion) const;
};

/// Whether a format has a place for occlusion beside the colours.
enum class OcclusionPlace { beside, none };

/// Adds to the notes what became of the file's own colours where that may surprise.
[[nodiscard]] ColorPlan plan_colors(const WriteOptions& options, std::vector<glm::vec4> own,
                                    OcclusionPlace place, std::vector<std::string>& notes);

/// A number of 0 to 1 as 8 bits.
[[nodiscard]] std::uint8_t byte_of(float number);

/// The colours of a text file's vertices, as their words stand in it, with single blanks.
///
/// A result that shows others keeps them in comments, one for each vertex, behind everything else
/// (an OFF's mark excepted; between vertices not every reader takes a comment):
///
///     # own 0.8 0.2 0.1
///
/// A vertex without a colour has the comment `# own`.
class ColorWords {
public:
    /// The next vertex' colour: three or four words, none: it has none.
    void add(std::span<const std::string_view> words);
    /// In OBJ six decimals, in OFF bytes, with alpha.
    enum class Form { decimals, bytes };
    void add(const glm::vec4& linear, Form form);

    [[nodiscard]] std::size_t size() const { return ends_.size(); }
    [[nodiscard]] std::string_view operator[](std::size_t vertex) const;

    /// As SourceAsset::own_colors(): empty where no vertex has a colour.
    [[nodiscard]] std::vector<glm::vec4> linear() const;

    /// Appends the comments. The text ends with the end of a line afterwards if it did before.
    void append_comments(std::string& text) const;

    /// If `text` ends with such comments for so many vertices, adds their colours and returns the
    /// text before them, which append_comments() makes the same again; else all of it.
    std::string_view take_comments(std::string_view text, std::size_t vertices);

    /// For a text without colours: if it ends with such comments all the same, adds that no vertex
    /// has any, so that those who read a result do not take them for its own.
    void deny_comments(std::string_view text, std::size_t vertices);

private:
    std::string words_;
    std::vector<std::size_t> ends_;
};

/// The end of the first line of a text; "\n" where it has none.
[[nodiscard]] std::string_view line_end_of(std::string_view text);

/// Whether the colours of a file with this mark are those of a bake (maker_mark.h), as far as they
/// do not stand in it a second time. A bake of a map (`at=texels`) leaves them alone.
[[nodiscard]] bool colors_are_baked(std::string_view mark);

}  // namespace surfelao

#include "files/stl_io.h"

#include "files/mesh_source.h"
#include "files/text_cursor.h"
#include "surfels/errors.h"
#include "surfels/labels.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace surfelao {
namespace {

constexpr std::size_t kHeaderBytes = 80;
constexpr std::size_t kFacetBytes = 50;  ///< normal and corners of 12 bytes each, 2 more

/// Gives equal corners one number.
class Corners {
public:
    std::uint32_t index_of(glm::dvec3 corner)
    {
        corner += 0.0;  // -0 and 0 are one place
        if (positions.size() * 2 >= slots_.size())
            grow();
        const std::size_t slot = find(corner);
        if (slots_[slot] == kFree) {
            slots_[slot] = static_cast<std::uint32_t>(positions.size());
            positions.push_back(corner);
        }
        return slots_[slot];
    }

    std::vector<glm::dvec3> positions;

private:
    static constexpr std::uint32_t kFree = std::numeric_limits<std::uint32_t>::max();

    /// The slot of this corner, or the free one where it belongs.
    [[nodiscard]] std::size_t find(const glm::dvec3& corner) const
    {
        std::uint64_t hash = 0;
        for (int axis = 0; axis < 3; ++axis) {
            hash ^= std::bit_cast<std::uint64_t>(corner[axis]);
            hash *= 0x9E3779B97F4A7C15u;
            hash ^= hash >> 29;
        }
        std::size_t slot = hash & (slots_.size() - 1);
        while (slots_[slot] != kFree && positions[slots_[slot]] != corner)
            slot = (slot + 1) & (slots_.size() - 1);
        return slot;
    }

    void grow()
    {
        slots_.assign(std::max<std::size_t>(1024, slots_.size() * 2), kFree);
        for (std::uint32_t v = 0; v < positions.size(); ++v)
            slots_[find(positions[v])] = v;
    }

    std::vector<std::uint32_t> slots_;  ///< a power of two of them
};

Scene make_stl_scene(const std::string& file_name, Corners corners, Polygons polygons)
{
    Scene scene = make_mesh_scene(file_name, std::move(corners.positions), std::move(polygons),
                                  std::make_shared<MeshSource>());
    scene.free_vertices = true;
    return scene;
}

std::uint32_t read_u32(const std::string& contents, std::size_t offset)
{
    const auto byte = [&](std::size_t i) {
        return static_cast<std::uint32_t>(static_cast<unsigned char>(contents[offset + i]));
    };
    return byte(0) | byte(1) << 8 | byte(2) << 16 | byte(3) << 24;
}

/// Numbers of binary files hold zero bytes, text does not.
bool is_ascii(const std::string& contents)
{
    // wide text is refused as such by the reader of text
    const std::string_view start = std::string_view(contents).substr(0, 4);
    if (start.size() == 4 && ((start.starts_with("\xFF\xFE") && start[2] != 0 && start[3] == 0) ||
                              (start.starts_with("\xFE\xFF") && start[2] == 0 && start[3] != 0)))
        return true;
    if (contents.size() >= kHeaderBytes + 4 &&
        contents.size() == kHeaderBytes + 4 + kFacetBytes * read_u32(contents, kHeaderBytes))
        return false;
    return contents.substr(0, 1024).find('\0') == std::string::npos;
}

/// The number of facets. What else the file holds is passed over, unless it looks like facets.
std::uint64_t facet_count(const std::string& file_name, const std::string& contents)
{
    const auto refuse = [&](const std::string& fault) {
        throw InputError(file_name + ": " + fault);
    };
    if (contents.size() < kHeaderBytes + 4)
        refuse("has " + std::to_string(contents.size()) +
               " bytes and is no text, so it is no STL file");
    const std::uint64_t count = read_u32(contents, kHeaderBytes);
    const std::uint64_t room = (contents.size() - kHeaderBytes - 4) / kFacetBytes;
    if (count > room)
        refuse("is no text, and as a binary file says " + std::to_string(count) +
               " facets, but ends after " + std::to_string(room));
    const std::size_t end = kHeaderBytes + 4 + count * kFacetBytes;
    if (count < room && (contents.size() - end) % kFacetBytes == 0 &&
        contents.find_first_not_of('\0', end) != std::string::npos)
        refuse("says " + std::to_string(count) + " facets, but its size is that of " +
               std::to_string(room));
    return count;
}

Scene read_binary(const std::string& file_name, const std::string& contents)
{
    const std::uint64_t count = facet_count(file_name, contents);
    Corners corners;
    Polygons polygons;
    polygons.corners.reserve(count * 3);
    for (std::size_t facet = 0; facet < count; ++facet) {
        const std::size_t first = kHeaderBytes + 4 + facet * kFacetBytes + 12;
        for (std::size_t corner = 0; corner < 3; ++corner) {
            glm::dvec3 position;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const float value =
                    std::bit_cast<float>(read_u32(contents, first + corner * 12 + axis * 4));
                if (!std::isfinite(value)) {
                    throw InputError(file_name + ": facet " + std::to_string(facet) +
                                     " has the coordinate " + (std::isnan(value) ? "nan" : "inf") +
                                     ", which is not finite");
                }
                position[static_cast<int>(axis)] = value;
            }
            polygons.corners.push_back(corners.index_of(position));
        }
    }
    Scene scene = make_stl_scene(file_name, std::move(corners), std::move(polygons));
    add_note(scene.notes, contents.size() - kHeaderBytes - 4 - count * kFacetBytes, "byte",
             "behind the last facet passed over");
    return scene;
}

std::string lower(std::string_view word)
{
    std::string text(word);
    std::ranges::transform(text, text.begin(), [](char c) {
        return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
    });
    return text;
}

class AsciiReader {
public:
    AsciiReader(const std::string& file_name, const std::string& contents)
        : file_name_(file_name), cursor_(file_name, contents, {})
    {
    }

    Scene read()
    {
        std::uint64_t solid_count = 0;
        std::uint64_t other_lines = 0;
        bool in_solid = false;
        for (std::string keyword = next(); !keyword.empty(); keyword = next()) {
            if (keyword == (in_solid ? "endsolid" : "solid")) {
                in_solid = !in_solid;
                solid_count += in_solid;
                name_solid(in_solid ? cursor_.rest_of_line() : std::string_view());
                skip_line();
            } else if (keyword == "facet" && in_solid) {
                read_facet();
            } else if (keyword.starts_with('#') || (!in_solid && !is_of_solid(keyword))) {
                ++other_lines;
                skip_line();
            } else {
                refuse(keyword, in_solid ? "\"facet\" or \"endsolid\"" : "\"solid\"");
            }
        }
        if (solid_count == 0)
            throw InputError(file_name_ +
                             ": is text, but no line begins with \"solid\", so it is no STL file");
        if (in_solid)
            refuse({}, "\"endsolid\"");
        Scene scene = make_stl_scene(file_name_, std::move(corners_), std::move(polygons_));
        scene.labels = labels_.finish();
        add_note(scene.notes, other_lines, "line", "of comment or outside of solids passed over");
        add_note(scene.notes, split_count_, "keyword", "in two words, as \"end loop\"");
        return scene;
    }

private:
    /// The next keyword, on this line or a later one, in lower case; "end loop" is "endloop" and so
    /// on. Empty at the end of the file.
    std::string next()
    {
        if (cursor_.at_line_end() && !cursor_.next_line())
            return {};
        std::string keyword = lower(cursor_.word());
        if (keyword == "end") {
            keyword += lower(cursor_.word());
            ++split_count_;
        }
        return keyword;
    }

    static bool is_of_solid(std::string_view keyword)
    {
        constexpr std::string_view kWords[] = {"facet",   "outer",    "vertex",
                                               "endloop", "endfacet", "endsolid"};
        return std::ranges::find(kWords, keyword) != std::end(kWords);
    }

    void skip_line()
    {
        while (!cursor_.at_line_end())
            cursor_.word();
    }

    [[noreturn]] void refuse(const std::string& found, const std::string& wanted) const
    {
        if (found.empty())
            cursor_.fail("the file ends, but " + wanted + " is missing");
        cursor_.fail(surfelao::quoted(found) + " stands where " + wanted + " must");
    }

    void expect(std::string_view wanted)
    {
        const std::string found = next();
        if (found != wanted)
            refuse(found, quoted(wanted));
    }

    glm::dvec3 read_corner()
    {
        glm::dvec3 position;
        for (int axis = 0; axis < 3; ++axis)
            position[axis] = cursor_.number("a coordinate of the vertex");
        if (!cursor_.at_line_end())
            cursor_.fail("the vertex has more than 3 numbers");
        return position;
    }

    /// What stands behind the keyword `facet`.
    void read_facet()
    {
        skip_line();  // the normal
        expect("outer");
        expect("loop");
        glm::dvec3 positions[3];
        std::size_t size = 0;
        std::string keyword = next();
        for (; keyword == "vertex" && size < 3; keyword = next())
            positions[size++] = read_corner();
        if (keyword != "endloop")
            refuse(keyword, size < 3 ? "\"vertex\"" : "\"endloop\"");
        expect("endfacet");
        if (size < 3) {
            ++polygons_.small_count;
            return;
        }
        for (const glm::dvec3& position : positions)
            polygons_.corners.push_back(corners_.index_of(position));
    }

    /// At the begin of a solid, and without a name at its end.
    void name_solid(std::string_view name)
    {
        const auto triangles = static_cast<std::uint32_t>(polygons_.corners.size() / 3);
        labels_.add(LabelKind::object, solid_, solid_begin_, triangles - solid_begin_);
        solid_ = name;
        solid_begin_ = triangles;
    }

    const std::string& file_name_;
    TextCursor cursor_;
    Corners corners_;
    Polygons polygons_;
    LabelMaker labels_;
    std::string_view solid_;
    std::uint32_t solid_begin_ = 0;
    std::uint64_t split_count_ = 0;
};

}  // namespace

Scene read_stl(const std::string& file_name, const std::string& contents)
{
    return is_ascii(contents) ? AsciiReader(file_name, contents).read()
                              : read_binary(file_name, contents);
}

}  // namespace surfelao

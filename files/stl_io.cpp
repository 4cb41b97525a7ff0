#include "files/stl_io.h"

#include "files/mesh_source.h"
#include "files/text_cursor.h"
#include "surfels/errors.h"

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

bool is_ascii(const std::string& contents)
{
    // wide text is refused as such by the reader of text
    for (const std::string_view wide :
         {std::string_view("\xFF\xFEs"), std::string_view("\xFE\xFF\0s", 4)}) {
        if (contents.starts_with(wide))
            return true;
    }
    const std::size_t word = contents.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
    if (word == std::string::npos || contents.compare(word, 5, "solid") != 0)
        return false;
    if (contents.size() >= kHeaderBytes + 4 &&
        contents.size() == kHeaderBytes + 4 + kFacetBytes * read_u32(contents, kHeaderBytes))
        return false;
    const std::string_view start = std::string_view(contents).substr(0, 1024);
    return std::ranges::none_of(start, [](unsigned char c) {
        return c < ' ' &&
               std::string_view("\t\n\v\f\r").find(static_cast<char>(c)) == std::string_view::npos;
    });
}

Scene read_binary(const std::string& file_name, const std::string& contents)
{
    if (contents.size() < kHeaderBytes + 4) {
        throw InputError(file_name + ": has " + std::to_string(contents.size()) +
                         " bytes and does not begin with \"solid\", so it is no STL file");
    }
    const std::uint64_t count = read_u32(contents, kHeaderBytes);
    const std::size_t room = (contents.size() - kHeaderBytes - 4) / kFacetBytes;
    if (count > room) {
        throw InputError(file_name + ": says " + std::to_string(count) +
                         " facets, but ends after " + std::to_string(room));
    }
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
    return make_stl_scene(file_name, std::move(corners), std::move(polygons));
}

std::string lower(std::string_view word)
{
    std::string text(word);
    std::ranges::transform(text, text.begin(), [](char c) {
        return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
    });
    return text;
}

/// The keywords that must come next, on this line or the next.
void expect(TextCursor& cursor, std::string_view wanted)
{
    if (cursor.at_line_end() && !cursor.next_line())
        cursor.fail("the file ends, but " + quoted(wanted) + " is missing");
    const std::string_view found = cursor.word();
    if (lower(found) != wanted)
        cursor.fail(quoted(found) + " stands where " + quoted(wanted) + " must");
}

Scene read_ascii(const std::string& file_name, const std::string& contents)
{
    Corners corners;
    Polygons polygons;
    TextCursor cursor(file_name, contents, {});
    bool in_solid = false;
    while (!cursor.at_line_end() || cursor.next_line()) {
        const std::string_view word = cursor.word();
        const std::string keyword = lower(word);
        if (keyword == (in_solid ? "endsolid" : "solid")) {
            in_solid = !in_solid;
            while (!cursor.at_line_end())  // the name of the solid
                cursor.word();
            continue;
        }
        if (keyword != "facet" || !in_solid) {
            cursor.fail(quoted(word) + " stands where " +
                        (in_solid ? "\"facet\" or \"endsolid\"" : "\"solid\"") + " must");
        }
        while (!cursor.at_line_end())  // the normal
            cursor.word();
        expect(cursor, "outer");
        expect(cursor, "loop");
        for (int corner = 0; corner < 3; ++corner) {
            expect(cursor, "vertex");
            glm::dvec3 position;
            for (int axis = 0; axis < 3; ++axis)
                position[axis] = cursor.number("a coordinate of the vertex");
            if (!cursor.at_line_end())
                cursor.fail("the vertex has more than 3 numbers");
            polygons.corners.push_back(corners.index_of(position));
        }
        expect(cursor, "endloop");
        expect(cursor, "endfacet");
    }
    if (in_solid)
        cursor.fail("the file ends, but \"endsolid\" is missing");
    return make_stl_scene(file_name, std::move(corners), std::move(polygons));
}

}  // namespace

Scene read_stl(const std::string& file_name, const std::string& contents)
{
    return is_ascii(contents) ? read_ascii(file_name, contents) : read_binary(file_name, contents);
}

}  // namespace surfelao

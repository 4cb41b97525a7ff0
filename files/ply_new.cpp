#include "files/face_places.h"
#include "files/mesh_source.h"
#include "files/ply_io.h"
#include "files/ply_text.h"
#include "surfels/number_text.h"

#include <algorithm>
#include <limits>
#include <optional>

namespace surfelao {
namespace {

using namespace ply;

/// The rows of the faces, and how many there are.
struct NewFaces {
    std::string bytes;
    std::size_t count = 0;
};

NewFaces new_faces(const Scene& scene, Type length_type, const PlyTexture* texture)
{
    NewFaces faces;
    std::optional<FacePlaces> places;
    if (texture)
        places.emplace(scene, texture->uvs, FaceShape::triangles);
    for_each_face(scene, [&](std::span<const std::uint32_t> vertices) {
        const auto append_vertices = [&](std::span<const std::uint32_t> corners) {
            ++faces.count;
            append_number(faces.bytes, length_type, static_cast<double>(corners.size()), {});
            for (const std::uint32_t corner : corners)
                append_bytes(faces.bytes, corner);
        };
        if (!places)
            return append_vertices(vertices);
        std::vector<std::uint32_t> of_face;
        for (const PlacedFace& face : places->next()) {
            of_face.clear();
            for (const std::uint32_t corner : face.corners)
                of_face.push_back(vertices[corner]);
            append_vertices(of_face);
            append_places(faces.bytes, texture->uvs, face.places, {});
        }
    });
    return faces;
}

/// As it is read again (ply_io.h).
void append_viewpoint_line(std::string& text, const Scene& scene)
{
    if (!scene.viewpoint)
        return;
    text += "comment viewpoint";
    for (int axis = 0; axis < 3; ++axis)
        append_shortest(text += ' ', (*scene.viewpoint)[axis]);
    text += '\n';
}

}  // namespace

std::string new_ply(const Scene& scene, const PlyValues& values, std::string_view mark,
                    PlyCoordinates coordinates, const PlyTexture* texture)
{
    const bool wide = coordinates == PlyCoordinates::exact || needs_double(scene.positions);
    const bool many = scene.positions.size() > std::numeric_limits<std::int32_t>::max();
    // small lengths have a byte: not every reader knows others
    const Type length_type = longest_face(scene) > 255 ? Type::uint32 : Type::uint8;
    const NewFaces faces = new_faces(scene, length_type, texture);
    std::string text = "ply\nformat binary_little_endian 1.0\n";
    append_mark_line(text, mark, "\n");
    if (texture)
        append_texture_line(text, texture->name, "\n");
    append_viewpoint_line(text, scene);
    text += "element vertex ";
    append_integer(text, static_cast<std::int64_t>(scene.positions.size()));
    text += '\n';
    for (const char* axis : {"x\n", "y\n", "z\n"})
        text.append(wide ? "property double " : "property float ").append(axis);
    append_property_lines(text, values.properties, "\n");
    if (!scene.triangles.empty()) {
        text += "element face ";
        append_integer(text, static_cast<std::int64_t>(faces.count));
        text.append("\nproperty list ")
            .append(name_of(length_type))
            .append(many ? " uint" : " int")
            .append(" vertex_indices\n");
    }
    if (texture)
        text.append("property ").append(kPlacesProperty).append("\n");
    text += "end_header\n";

    // of the values 19 bytes: what a bake has at a vertex
    text.reserve(text.size() + scene.positions.size() * (wide ? 43 : 31) + faces.bytes.size());
    FilePlaces places(scene);
    for (std::size_t v = 0; v < scene.positions.size(); ++v) {
        const glm::dvec3 place = places.next();
        for (int axis = 0; axis < 3; ++axis)
            append_channel(text, wide ? Type::float64 : Type::float32, place[axis], {});
        values.append(text, v);
    }
    return text += faces.bytes;
}

}  // namespace surfelao

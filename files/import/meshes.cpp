#include "files/import/meshes.h"

#include "files/gltf_buffer.h"

#include <assimp/mesh.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace surfelao {
namespace {

template <class Value>
int add_floats(tinygltf::Model& model, std::span<const Value> values, int type)
{
    return add_accessor(model, std::as_bytes(values), TINYGLTF_COMPONENT_TYPE_FLOAT, type,
                        values.size(), TINYGLTF_TARGET_ARRAY_BUFFER);
}

int add_vectors(tinygltf::Model& model, const aiVector3D* first, unsigned int count)
{
    return add_floats(model, std::span(first, count), TINYGLTF_TYPE_VEC3);
}

int add_uvs(tinygltf::Model& model, std::span<const aiVector3D> places)
{
    std::vector<std::array<float, 2>> uvs;
    uvs.reserve(places.size());
    for (const aiVector3D& place : places)
        uvs.push_back({place.x, 1.0f - place.y});
    return add_floats(model, std::span<const std::array<float, 2>>(uvs), TINYGLTF_TYPE_VEC2);
}

/// glTF asks for the box of positions.
void set_box(std::span<const aiVector3D> positions, tinygltf::Accessor& accessor)
{
    aiVector3D low = positions.front(), high = positions.front();
    for (const aiVector3D& position : positions) {
        low = {std::min(low.x, position.x), std::min(low.y, position.y),
               std::min(low.z, position.z)};
        high = {std::max(high.x, position.x), std::max(high.y, position.y),
                std::max(high.z, position.z)};
    }
    accessor.minValues = {low.x, low.y, low.z};
    accessor.maxValues = {high.x, high.y, high.z};
}

int mode_of(unsigned int corner_count)
{
    switch (corner_count) {
        case 1:
            return TINYGLTF_MODE_POINTS;
        case 2:
            return TINYGLTF_MODE_LINE;
        default:
            return TINYGLTF_MODE_TRIANGLES;
    }
}

int add_indices(tinygltf::Model& model, std::span<const aiFace> faces)
{
    std::vector<std::uint32_t> indices;
    indices.reserve(3 * faces.size());
    for (const aiFace& face : faces) {
        if (face.mNumIndices == faces.front().mNumIndices)
            indices.insert(indices.end(), face.mIndices, face.mIndices + face.mNumIndices);
    }
    return add_accessor(model, std::as_bytes(std::span(indices)),
                        TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TYPE_SCALAR, indices.size(),
                        TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
}

}  // namespace

tinygltf::Primitive add_primitive(const aiMesh& mesh, tinygltf::Model& model)
{
    tinygltf::Primitive primitive;
    const unsigned int count = mesh.mNumVertices;
    primitive.mode = mode_of(mesh.mFaces[0].mNumIndices);
    if (mesh.mMaterialIndex < model.materials.size())
        primitive.material = static_cast<int>(mesh.mMaterialIndex);
    primitive.indices = add_indices(model, std::span(mesh.mFaces, mesh.mNumFaces));
    const int positions = add_vectors(model, mesh.mVertices, count);
    set_box(std::span(mesh.mVertices, count), model.accessors.back());
    primitive.attributes["POSITION"] = positions;
    if (mesh.HasNormals())
        primitive.attributes["NORMAL"] = add_vectors(model, mesh.mNormals, count);
    for (unsigned int set = 0; mesh.HasTextureCoords(set); ++set)
        primitive.attributes["TEXCOORD_" + std::to_string(set)] =
            add_uvs(model, std::span(mesh.mTextureCoords[set], count));
    if (mesh.HasVertexColors(0))
        primitive.attributes["COLOR_0"] = add_floats(
            model, std::span<const aiColor4D>(mesh.mColors[0], count), TINYGLTF_TYPE_VEC4);
    return primitive;
}

void add_joints(const aiMesh& mesh, tinygltf::Primitive& primitive, tinygltf::Model& model)
{
    if (mesh.mNumBones > 65536)
        throw std::runtime_error("it has a mesh of " + std::to_string(mesh.mNumBones) +
                                 " bones, of which glTF numbers 65536");
    std::vector<std::array<std::uint16_t, 4>> joints(mesh.mNumVertices);
    std::vector<std::array<float, 4>> weights(mesh.mNumVertices);
    for (unsigned int bone = 0; bone < mesh.mNumBones; ++bone) {
        const std::span<const aiVertexWeight> of_bone(mesh.mBones[bone]->mWeights,
                                                      mesh.mBones[bone]->mNumWeights);
        for (const aiVertexWeight& one : of_bone) {
            if (one.mVertexId >= mesh.mNumVertices)
                continue;
            std::array<float, 4>& heaviest = weights[one.mVertexId];
            const auto lightest = std::ranges::min_element(heaviest);
            if (one.mWeight <= *lightest)
                continue;
            *lightest = one.mWeight;
            joints[one.mVertexId][static_cast<std::size_t>(lightest - heaviest.begin())] =
                static_cast<std::uint16_t>(bone);
        }
    }
    for (std::array<float, 4>& of_vertex : weights) {
        const float sum = of_vertex[0] + of_vertex[1] + of_vertex[2] + of_vertex[3];
        for (float& weight : of_vertex)
            weight = sum > 0.0f ? weight / sum : 0.0f;
    }
    primitive.attributes["JOINTS_0"] = add_accessor(
        model, std::as_bytes(std::span(joints)), TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT,
        TINYGLTF_TYPE_VEC4, joints.size(), TINYGLTF_TARGET_ARRAY_BUFFER);
    primitive.attributes["WEIGHTS_0"] =
        add_floats(model, std::span<const std::array<float, 4>>(weights), TINYGLTF_TYPE_VEC4);
}

}  // namespace surfelao

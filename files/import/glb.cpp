#include "files/import/glb.h"

#include "files/gltf_buffer.h"
#include "files/import/materials.h"
#include "files/import/meshes.h"
#include "files/import/names.h"
#include "files/import/unit.h"

#include <assimp/scene.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <map>
#include <sstream>
#include <stdexcept>
#include <unordered_map>

namespace surfelao {
namespace {

/// Matrices of glTF stand column by column.
std::array<ai_real, 16> columns_of(const aiMatrix4x4& m)
{
    return {m.a1, m.b1, m.c1, m.d1, m.a2, m.b2, m.c2, m.d2,
            m.a3, m.b3, m.c3, m.d3, m.a4, m.b4, m.c4, m.d4};
}

/// A quarter turn about x: z becomes y.
const aiMatrix4x4 kUpright(1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1);

/// From the world of the file to glTF's, where assimp leaves that to us. Of FBX it tells the axes
/// and the unit, of 3MF, in which z is up, neither; COLLADA, 3DS and X3D stand upright already.
aiMatrix4x4 to_gltf_world(const aiScene& scene, const SourceFile& file)
{
    aiMatrix4x4 to_world, scaling;
    if (file.format == "3MF") {
        aiMatrix4x4::Scaling(aiVector3D(metres_of_3mf(file.path)), scaling);
        return kUpright * scaling;
    }
    if (!scene.mMetaData)
        return to_world;
    int up = 1, sign = 1;
    scene.mMetaData->Get("UpAxis", up);
    scene.mMetaData->Get("UpAxisSign", sign);
    if (up == 2 && sign == 1)
        to_world = kUpright;
    float centimetres = 100.0f;
    scene.mMetaData->Get("UnitScaleFactor", centimetres);
    aiMatrix4x4::Scaling(aiVector3D(centimetres / 100.0f), scaling);
    return to_world * scaling;
}

/// Makes the nodes and what hangs on them.
class Nodes {
public:
    Nodes(const aiScene& scene, tinygltf::Model& model) : scene_(scene), model_(model) {}

    void add_all(const aiMatrix4x4& to_world)
    {
        number(*scene_.mRootNode);
        for (const aiNode* node : nodes_)
            fill(*node);
        model_.scenes.emplace_back();
        model_.scenes.front().nodes = {0};
        model_.defaultScene = 0;
        set_matrix(to_world * scene_.mRootNode->mTransformation, model_.nodes[0]);
    }

private:
    /// In the order of a walk downwards, in which joints are found by name too.
    void number(const aiNode& node)
    {
        const int index = static_cast<int>(nodes_.size());
        nodes_.push_back(&node);
        numbers_.emplace(&node, index);
        by_name_.emplace(node.mName.C_Str(), index);
        model_.nodes.emplace_back();
        for (unsigned int i = 0; i < node.mNumChildren; ++i)
            number(*node.mChildren[i]);
    }

    static void set_matrix(const aiMatrix4x4& matrix, tinygltf::Node& node)
    {
        const std::array<ai_real, 16> columns = columns_of(matrix);
        if (matrix.IsIdentity())
            node.matrix.clear();
        else
            node.matrix.assign(columns.begin(), columns.end());
    }

    void fill(const aiNode& node)
    {
        const auto index = static_cast<std::size_t>(numbers_.at(&node));
        model_.nodes[index].name = to_utf8(node.mName.C_Str());
        set_matrix(node.mTransformation, model_.nodes[index]);
        for (unsigned int i = 0; i < node.mNumChildren; ++i)
            model_.nodes[index].children.push_back(numbers_.at(node.mChildren[i]));
        std::vector<unsigned int> rigid;
        for (unsigned int i = 0; i < node.mNumMeshes; ++i) {
            const aiMesh& mesh = *scene_.mMeshes[node.mMeshes[i]];
            if (mesh.mNumFaces == 0 || mesh.mNumVertices == 0)
                continue;
            if (mesh.HasBones())
                place(index, mesh_of({node.mMeshes[i]}), skin_of(node.mMeshes[i]));
            else
                rigid.push_back(node.mMeshes[i]);
        }
        if (!rigid.empty())
            place(index, mesh_of(rigid), -1);
    }

    /// A glTF node has one mesh: a second one gets a node of its own below it.
    void place(std::size_t index, int mesh, int skin)
    {
        if (model_.nodes[index].mesh >= 0) {
            const int below = static_cast<int>(model_.nodes.size());
            model_.nodes[index].children.push_back(below);
            model_.nodes.emplace_back();
            model_.nodes.back().name = model_.nodes[index].name;
            index = static_cast<std::size_t>(below);
        }
        model_.nodes[index].mesh = mesh;
        model_.nodes[index].skin = skin;
    }

    /// Meshes that assimp has split by material are one again.
    int mesh_of(const std::vector<unsigned int>& numbers)
    {
        const auto [known, is_new] =
            meshes_.emplace(numbers, static_cast<int>(model_.meshes.size()));
        if (!is_new)
            return known->second;
        tinygltf::Mesh mesh;
        mesh.name = to_utf8(scene_.mMeshes[numbers.front()]->mName.C_Str());
        for (const unsigned int one : numbers) {
            mesh.primitives.push_back(add_primitive(*scene_.mMeshes[one], model_));
            if (scene_.mMeshes[one]->HasBones())
                add_joints(*scene_.mMeshes[one], mesh.primitives.back(), model_);
        }
        model_.meshes.push_back(std::move(mesh));
        return known->second;
    }

    int skin_of(unsigned int number)
    {
        const auto [known, is_new] = skins_.emplace(number, static_cast<int>(model_.skins.size()));
        if (!is_new)
            return known->second;
        const aiMesh& mesh = *scene_.mMeshes[number];
        tinygltf::Skin skin;
        std::vector<std::array<ai_real, 16>> to_bones;
        for (unsigned int i = 0; i < mesh.mNumBones; ++i) {
            const auto joint = by_name_.find(mesh.mBones[i]->mName.C_Str());
            if (joint == by_name_.end())
                throw std::runtime_error("there is no node for the bone \"" +
                                         std::string(mesh.mBones[i]->mName.C_Str()) + "\"");
            skin.joints.push_back(joint->second);
            to_bones.push_back(columns_of(mesh.mBones[i]->mOffsetMatrix));
        }
        skin.inverseBindMatrices =
            add_accessor(model_, std::as_bytes(std::span(to_bones)), TINYGLTF_COMPONENT_TYPE_FLOAT,
                         TINYGLTF_TYPE_MAT4, to_bones.size(), 0);
        model_.skins.push_back(std::move(skin));
        return known->second;
    }

    const aiScene& scene_;
    tinygltf::Model& model_;
    std::vector<const aiNode*> nodes_;
    std::unordered_map<const aiNode*, int> numbers_;
    std::unordered_map<std::string, int> by_name_;
    std::map<std::vector<unsigned int>, int> meshes_;
    std::map<unsigned int, int> skins_;
};

}  // namespace

std::string glb_of(const aiScene& scene, const SourceFile& file, std::vector<std::string>& notes)
{
    tinygltf::Model model;
    model.asset.version = "2.0";
    model.asset.generator = "surfelao-import";
    add_materials(scene, file, model, notes);
    Nodes(scene, model).add_all(to_gltf_world(scene, file));
    std::ostringstream glb;
    tinygltf::TinyGLTF writer;
    writer.SetImageWriter(nullptr, nullptr);  // else names of files are lost
    if (!writer.WriteGltfSceneToStream(&model, glb, false, true))
        throw std::runtime_error("its scene could not be written as glTF");
    return std::move(glb).str();
}

}  // namespace surfelao

#include "files/gltf_new.h"

#include "files/gltf_asset.h"
#include "files/gltf_buffer.h"
#include "files/gltf_io.h"
#include "files/gltf_uri.h"
#include "surfels/errors.h"
#include "surfels/extension.h"

#include <tiny_gltf.h>
#include <glm/common.hpp>

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace surfelao {
namespace {

/// Of the labels of one kind, per triangle: one more than its number, 0 where none is.
struct Named {
    std::vector<std::uint32_t> of_triangle;  ///< empty: no labels of the kind
    std::vector<std::string> names;
};

Named names_by(const Scene& scene, LabelKind kind)
{
    Named named;
    for (const Label& label : scene.labels) {
        if (label.kind != kind)
            continue;
        named.of_triangle.resize(scene.triangles.size());
        named.names.push_back(label.name);
        for (const Label::Range& range : label.ranges)
            std::fill_n(named.of_triangle.begin() + range.first, range.count,
                        static_cast<std::uint32_t>(named.names.size()));
    }
    return named;
}

/// What glTF knows of pictures; empty for others.
std::string media_type_of_file(const PictureSource& picture)
{
    const std::string extension = lower_extension(picture.name);
    if (extension == ".png")
        return "image/png";
    return extension == ".jpg" || extension == ".jpeg" ? "image/jpeg" : "";
}

class NewGltf {
public:
    NewGltf(const std::filesystem::path& path, const Mesh& mesh)
        : path_(path), mesh_(mesh), scene_(mesh.scene)
    {
        model_.asset.version = "2.0";
        model_.scenes.emplace_back();
        model_.defaultScene = 0;
        if (scene_.asset)
            colors_ = scene_.asset->own_colors();
        corners_ = wedges();
        middle_ = far_middle();
    }

    void add_all()
    {
        add_materials();
        Named objects = names_by(scene_, LabelKind::object);
        if (objects.names.empty())
            objects = names_by(scene_, LabelKind::group);
        std::vector<std::vector<std::uint32_t>> triangles(objects.names.size() + 1);
        for (std::uint32_t t = 0; t < scene_.triangles.size(); ++t)
            triangles[objects.of_triangle.empty() ? 0 : objects.of_triangle[t]].push_back(t);
        for (std::size_t object = 0; object < triangles.size(); ++object) {
            if (!triangles[object].empty())
                add_object(object == 0 ? path_.stem().string() : objects.names[object - 1],
                           triangles[object]);
        }
    }

    [[nodiscard]] std::string glb()
    {
        std::ostringstream bytes;
        tinygltf::TinyGLTF writer;
        writer.SetImageWriter(nullptr, nullptr);  // else names of files are lost
        if (model_.buffers.front().data.size() >= kMostBytes ||
            !writer.WriteGltfSceneToStream(&model_, bytes, false, true))
            throw InputError(path_.string() + ": is more than the 4 GiB that a .glb holds");
        return std::move(bytes).str();
    }

    [[nodiscard]] std::size_t lost_pictures() const { return lost_pictures_; }

    /// The mesh's objects and groups, of the triangles as they stand in the glTF.
    [[nodiscard]] std::vector<Label> labels() const
    {
        std::vector<std::uint32_t> place(order_.size());
        for (std::uint32_t i = 0; i < order_.size(); ++i)
            place[order_[i]] = i;
        std::vector<Label> labels;
        for (const Label& label : scene_.labels) {
            if (label.kind != LabelKind::object && label.kind != LabelKind::group)
                continue;
            std::vector<std::uint32_t> places;
            for (const Label::Range& range : label.ranges)
                places.insert(places.end(), place.begin() + range.first,
                              place.begin() + range.first + range.count);
            std::sort(places.begin(), places.end());
            Label moved{label.kind, label.name, {}};
            for (const std::uint32_t at : places) {
                if (moved.ranges.empty() ||
                    moved.ranges.back().first + moved.ranges.back().count != at)
                    moved.ranges.push_back({at, 0});
                ++moved.ranges.back().count;
            }
            labels.push_back(std::move(moved));
        }
        return labels;
    }

private:
    static constexpr std::size_t kMostBytes = 0xf0000000;  // and the JSON beside them

    /// Per scene triangle; of those without an area the vertices' own.
    [[nodiscard]] std::vector<glm::uvec3> wedges() const
    {
        const std::vector<glm::uvec3>& shaded = mesh_.surface.corners(mesh_.geometry);
        std::vector<glm::uvec3> corners = scene_.triangles;
        for (std::size_t t = 0; t < shaded.size(); ++t)
            corners[mesh_.geometry.scene_triangle(t)] = shaded[t];
        return corners;
    }

    /// Zero where coordinates are as good from the origin.
    [[nodiscard]] glm::dvec3 far_middle() const
    {
        glm::dvec3 low = scene_.positions[scene_.triangles.front().x], high = low;
        for (const glm::uvec3& triangle : scene_.triangles) {
            for (int corner = 0; corner < 3; ++corner) {
                low = min(low, scene_.positions[triangle[corner]]);
                high = max(high, scene_.positions[triangle[corner]]);
            }
        }
        const glm::dvec3 middle = low / 2.0 + high / 2.0, size = high - low;
        const double farthest =
            std::max({std::abs(middle.x), std::abs(middle.y), std::abs(middle.z)});
        const bool is_far = farthest > kFarInSizes * std::max({size.x, size.y, size.z});
        return is_far ? middle : glm::dvec3(0.0);
    }

    void add_materials()
    {
        if (scene_.asset)
            base_ = scene_.asset->base_colors();
        if (base_.materials.size() <= 1) {  // without an MTL: names alone
            const Named named = names_by(scene_, LabelKind::material);
            base_.triangles = named.of_triangle;
            base_.materials.assign(1, BaseColor{});  // of triangles without one
            for (const std::string& name : named.names)
                base_.materials.emplace_back().name = name;
        }
        for (std::size_t i = 1; i < base_.materials.size(); ++i)
            model_.materials.push_back(material_of(base_.materials[i]));
    }

    tinygltf::Material material_of(const BaseColor& color)
    {
        tinygltf::Material material;
        material.name = color.name;
        tinygltf::PbrMetallicRoughness& pbr = material.pbrMetallicRoughness;
        const glm::vec3 factor = glm::clamp(color.factor, 0.0f, 1.0f);
        pbr.baseColorFactor = {factor.x, factor.y, factor.z, color.alpha};
        pbr.metallicFactor = 0.0;
        if (color.picture)
            pbr.baseColorTexture.index = texture_of(base_.pictures[*color.picture]);
        pbr.baseColorTexture.texCoord = 0;
        if (color.opacity == Opacity::clear)
            material.alphaMode = "BLEND";
        // glTF takes the alpha of the picture of colour, and of no other
        if (color.opacity == Opacity::cut && !color.alpha_picture) {
            material.alphaMode = "MASK";
            material.alphaCutoff = color.cutoff;
        }
        return material;
    }

    /// -1 where glTF has no place for it.
    int texture_of(const PictureSource& picture)
    {
        tinygltf::Image image;
        const std::string media_type = media_type_of_file(picture);
        if (media_type.empty()) {
            ++lost_pictures_;
            return -1;
        }
        if (picture.file.empty()) {
            image.mimeType = media_type;
            image.bufferView = add_view(model_, std::as_bytes(std::span(picture.bytes)), 0);
        } else {
            const std::filesystem::path folder = std::filesystem::absolute(path_).parent_path();
            image.uri = encode_uri(std::filesystem::absolute(picture.file)
                                       .lexically_normal()
                                       .lexically_relative(folder.lexically_normal())
                                       .generic_string());
        }
        const auto known = std::ranges::find_if(model_.images, [&](const tinygltf::Image& other) {
            return !image.uri.empty() && other.uri == image.uri;
        });
        tinygltf::Texture texture;
        texture.source = static_cast<int>(known - model_.images.begin());
        if (known == model_.images.end())
            model_.images.push_back(std::move(image));
        model_.textures.push_back(std::move(texture));
        return static_cast<int>(model_.textures.size()) - 1;
    }

    /// A vertex of glTF: a wedge, and its place in the map; rising they keep the file's order.
    using Key = std::pair<std::uint32_t, std::uint32_t>;

    [[nodiscard]] Key key_of(std::uint32_t triangle, int corner) const
    {
        std::uint32_t uv = UvSet::kNone;
        if (has_uvs()) {
            const UvSet& uvs = scene_.uvs.front();
            uv = (uvs.corners.empty() ? scene_.triangles : uvs.corners)[triangle][corner];
        }
        return {corners_[triangle][corner], uv};
    }

    [[nodiscard]] bool has_uvs() const
    {
        return !scene_.uvs.empty() && !scene_.uvs.front().empty();
    }

    void add_object(const std::string& name, std::span<const std::uint32_t> triangles)
    {
        std::vector<Key> vertices;
        vertices.reserve(3 * triangles.size());
        for (const std::uint32_t triangle : triangles) {
            for (int corner = 0; corner < 3; ++corner)
                vertices.push_back(key_of(triangle, corner));
        }
        std::ranges::sort(vertices);
        vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());

        tinygltf::Mesh mesh;
        mesh.name = name;
        tinygltf::Primitive primitive = primitive_of(vertices);
        for (const auto& [material, own] : by_material(triangles)) {
            const std::vector<std::uint32_t> indices = indices_of(own, vertices);
            order_.insert(order_.end(), own.begin(), own.end());
            primitive.material = material;
            primitive.indices = add_accessor(
                model_, std::as_bytes(std::span(indices)), TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT,
                TINYGLTF_TYPE_SCALAR, indices.size(), TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
            mesh.primitives.push_back(primitive);
        }
        tinygltf::Node node;
        node.name = name;
        node.mesh = static_cast<int>(model_.meshes.size());
        if (middle_ != glm::dvec3(0.0))
            node.translation = {middle_.x, middle_.y, middle_.z};
        model_.meshes.push_back(std::move(mesh));
        model_.scenes.front().nodes.push_back(static_cast<int>(model_.nodes.size()));
        model_.nodes.push_back(std::move(node));
    }

    /// -1: of no material.
    std::map<int, std::vector<std::uint32_t>> by_material(
        std::span<const std::uint32_t> triangles) const
    {
        std::map<int, std::vector<std::uint32_t>> own;
        for (const std::uint32_t triangle : triangles)
            own[base_.triangles.empty() ? -1 : static_cast<int>(base_.triangles[triangle]) - 1]
                .push_back(triangle);
        return own;
    }

    std::vector<std::uint32_t> indices_of(std::span<const std::uint32_t> triangles,
                                          std::span<const Key> vertices) const
    {
        std::vector<std::uint32_t> indices;
        indices.reserve(3 * triangles.size());
        for (const std::uint32_t triangle : triangles) {
            for (int corner = 0; corner < 3; ++corner) {
                const auto found = std::ranges::lower_bound(vertices, key_of(triangle, corner));
                indices.push_back(static_cast<std::uint32_t>(found - vertices.begin()));
            }
        }
        return indices;
    }

    /// Its attributes: those of all primitives of an object.
    tinygltf::Primitive primitive_of(std::span<const Key> vertices)
    {
        std::vector<glm::vec3> positions, normals;
        std::vector<glm::vec2> uvs;
        std::vector<glm::vec4> colors;
        for (const auto& [wedge, uv] : vertices) {
            const std::uint32_t vertex = mesh_.surface.vertex_of(wedge);
            positions.emplace_back(scene_.positions[vertex] - middle_);
            const glm::vec3 normal = mesh_.surface.normals[wedge];
            normals.push_back(normal == glm::vec3(0.0f) ? glm::vec3(0.0f, 0.0f, 1.0f) : normal);
            if (has_uvs())
                uvs.emplace_back(uv == UvSet::kNone ? glm::dvec2(0.0)
                                                    : scene_.uvs.front().values[uv]);
            if (!colors_.empty())
                colors.push_back(colors_[vertex]);
        }
        tinygltf::Primitive primitive;
        primitive.mode = TINYGLTF_MODE_TRIANGLES;
        const auto add = [&](const char* name, auto& values, int type) {
            if (values.empty())
                return;
            primitive.attributes[name] = add_accessor(model_, std::as_bytes(std::span(values)),
                                                      TINYGLTF_COMPONENT_TYPE_FLOAT, type,
                                                      values.size(), TINYGLTF_TARGET_ARRAY_BUFFER);
        };
        add("POSITION", positions, TINYGLTF_TYPE_VEC3);
        glm::vec3 low = positions.front(), high = low;
        for (const glm::vec3& position : positions) {
            low = min(low, position);
            high = max(high, position);
        }
        model_.accessors.back().minValues = {low.x, low.y, low.z};
        model_.accessors.back().maxValues = {high.x, high.y, high.z};
        add("NORMAL", normals, TINYGLTF_TYPE_VEC3);
        add("TEXCOORD_0", uvs, TINYGLTF_TYPE_VEC2);
        add("COLOR_0", colors, TINYGLTF_TYPE_VEC4);
        return primitive;
    }

    const std::filesystem::path& path_;
    const Mesh& mesh_;
    const Scene& scene_;
    std::vector<glm::vec4> colors_;
    std::vector<glm::uvec3> corners_;
    glm::dvec3 middle_{0.0};
    BaseColors base_;
    std::vector<std::uint32_t> order_;  ///< the scene's triangles as the glTF has them
    std::size_t lost_pictures_ = 0;
    tinygltf::Model model_;
};

}  // namespace

Scene as_gltf(const std::filesystem::path& path, Scene scene, const NormalSettings& normals)
{
    if (dynamic_cast<const GltfAsset*>(scene.asset.get()) != nullptr)
        return scene;
    if (scene.triangles.empty())
        throw InputError(path.string() +
                         ": has points only, which are not written as glTF, use .ply");
    std::string glb;
    std::vector<std::string> notes;
    std::vector<Label> labels;
    {
        const Mesh mesh = make_mesh(std::move(scene), normals);
        NewGltf made(path, mesh);
        made.add_all();
        glb = made.glb();
        notes = mesh.scene.notes;
        labels = made.labels();
        if (made.lost_pictures() > 0)
            notes.push_back("textures that are neither PNG nor JPEG are left out of the glTF: " +
                            std::to_string(made.lost_pictures()));
    }
    Scene result = read_gltf(path, std::move(glb));
    result.name = path.filename().string();
    result.notes.insert(result.notes.begin(), notes.begin(), notes.end());
    result.labels.insert(result.labels.end(), labels.begin(), labels.end());
    return result;
}

}  // namespace surfelao

#include "files/refined_scene.h"

#include "files/gltf_asset.h"
#include "files/gltf_io.h"
#include "files/gltf_refined.h"
#include "files/obj_file.h"
#include "files/obj_io.h"
#include "files/off_file.h"
#include "files/off_io.h"
#include "files/ply_file.h"
#include "files/ply_io.h"
#include "files/refined_faces.h"
#include "surfels/errors.h"

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

namespace surfelao {
namespace {

/// What is left of a file that cannot be written with more faces.
struct ColorSource : SourceAsset {
    std::vector<glm::vec4> colors;
    [[nodiscard]] std::vector<glm::vec4> own_colors() const override { return colors; }
};

/// Of a scene of one part.
Scene with_colors(const Scene& scene, const Refinement& refinement)
{
    const auto source = std::make_shared<ColorSource>();
    source->colors = scene.asset->own_colors();
    for (std::size_t i = 0; i < refinement.parents.size() && !source->colors.empty(); ++i) {
        const glm::uvec2 of = refinement.parents[i];
        source->colors.push_back(0.5f * (source->colors[of.x] + source->colors[of.y]));
    }
    Scene refined = plain_refined(scene, refinement);
    refined.asset = source;
    return refined;
}

bool has_strips(const ply::PlySource& source)
{
    const ply::Element* strips = ply::find_element(source.header, "tristrips");
    return strips && strips->count > 0;
}

Scene read_refined(const Scene& scene, const Refinement& refinement,
                   std::span<const glm::vec3> normals)
{
    const SourceAsset* asset = scene.asset.get();
    if (const auto* ply = dynamic_cast<const ply::PlySource*>(asset)) {
        if (has_strips(*ply)) {
            Scene refined = with_colors(scene, refinement);
            refined.notes.push_back(
                "strips become faces, and only coordinates and colours are kept");
            return refined;
        }
        const std::string name = (ply->folder / scene.name).string();
        return read_ply(name,
                        refined_ply(read_ply(name, original_ply(scene)), refinement, normals));
    }
    if (const auto* obj = dynamic_cast<const ObjSource*>(asset)) {
        const std::string name = (obj->folder / scene.name).string();
        return read_obj(name,
                        refined_obj(read_obj(name, original_obj(scene)), refinement, normals));
    }
    if (dynamic_cast<const OffSource*>(asset) != nullptr)
        return read_off(scene.name, refined_off(read_off(scene.name, original_off(scene)),
                                                refinement, normals));
    if (const auto* gltf = dynamic_cast<const GltfAsset*>(asset))
        return read_gltf(gltf->path, refined_gltf(scene, refinement, normals), gltf->moment);
    if (dynamic_cast<const ColorSource*>(asset) != nullptr)
        return with_colors(scene, refinement);
    return plain_refined(scene, refinement);
}

}  // namespace

void check_refinable(const Scene& scene)
{
    const auto* gltf = dynamic_cast<const GltfAsset*>(scene.asset.get());
    if (gltf == nullptr)
        return;
    for (std::size_t p = 0; p < gltf->parts.size(); ++p) {
        if (!gltf->parts[p].vertices_to_world.empty())
            throw InputError(scene.name + ": mesh " + std::to_string(scene.parts[p].mesh) +
                             " has a skin, whose weights at new vertices are not known: it is not "
                             "subdivided");
    }
}

Scene refined_scene(const Scene& scene, const Refinement& refinement,
                    std::span<const glm::vec3> normals)
{
    SURFELAO_CHECK(normals.empty() ||
                   normals.size() == scene.positions.size() + refinement.parents.size());
    check_refinable(scene);
    Scene refined = read_refined(scene, refinement, normals);
    refined.name = scene.name;
    for (const std::string& note : scene.notes) {
        if (std::ranges::find(refined.notes, note) == refined.notes.end())
            refined.notes.push_back(note);
    }
    return refined;
}

}  // namespace surfelao

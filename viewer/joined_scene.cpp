#include "viewer/joined_scene.h"

#include "surfels/errors.h"
#include "surfels/labels.h"
#include "viewer/part_list.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <memory>
#include <utility>

namespace surfelao {
namespace {

/// Of all files, in their order.
class JoinedAsset : public SourceAsset {
public:
    explicit JoinedAsset(std::span<const Scene> scenes)
    {
        for (const Scene& scene : scenes)
            files_.push_back({scene.asset, scene.triangles.size()});
    }

    BaseColors base_colors() const override
    {
        BaseColors all;
        for (const File& file : files_) {
            BaseColors own = file.asset ? file.asset->base_colors() : BaseColors();
            if (own.triangles.size() != file.triangles)  // nothing is said of it
                own = {.materials = {{}}, .triangles = std::vector<std::uint32_t>(file.triangles)};
            const auto pictures = static_cast<std::uint32_t>(all.pictures.size());
            const auto materials = static_cast<std::uint32_t>(all.materials.size());
            for (BaseColor& material : own.materials) {
                for (std::optional<std::uint32_t>* picture :
                     {&material.picture, &material.alpha_picture}) {
                    if (*picture)
                        **picture += pictures;
                }
                all.materials.push_back(std::move(material));
            }
            std::ranges::move(own.pictures, std::back_inserter(all.pictures));
            for (const std::uint32_t material : own.triangles)
                all.triangles.push_back(material + materials);
        }
        return all;
    }

    bool has_openings() const override
    {
        return std::ranges::any_of(
            files_, [](const File& file) { return file.asset && file.asset->has_openings(); });
    }

private:
    struct File {
        std::shared_ptr<const SourceAsset> asset;
        std::size_t triangles = 0;
    };
    std::vector<File> files_;
};

/// Set `number` of all files; those that have none have no places.
UvSet joined_uvs(std::span<const Scene> scenes, std::size_t number)
{
    UvSet all;
    for (const Scene& scene : scenes) {
        const bool has_some = number < scene.uvs.size() && !scene.uvs[number].empty();
        const UvSet none;
        const UvSet& own = has_some ? scene.uvs[number] : none;
        const auto first = static_cast<std::uint32_t>(all.values.size());
        all.values.insert(all.values.end(), own.values.begin(), own.values.end());
        for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
            glm::uvec3 corners(UvSet::kNone);
            if (has_some)
                corners = own.corners.empty() ? scene.triangles[t] : own.corners[t];
            for (int k = 0; k < 3; ++k)
                if (corners[k] != UvSet::kNone)
                    corners[k] += first;
            all.corners.push_back(corners);
        }
    }
    return all;
}

std::vector<Label> joined_labels(std::span<const Scene> scenes)
{
    LabelMaker labels;
    std::uint32_t first = 0;
    for (const Scene& scene : scenes) {
        const auto count = static_cast<std::uint32_t>(scene.triangles.size());
        labels.add(LabelKind::node, scene.name, first, count);
        const auto add = [&](LabelKind kind, const Label& label) {
            for (const Label::Range& range : label.ranges)
                labels.add(kind, label.name, first + range.first, range.count);
        };
        for (const Label& label : scene.labels)
            add(label.kind, label);
        for (const Label* label : parting_labels(scene))
            add(LabelKind::node, *label);
        first += count;
    }
    return labels.finish();
}

}  // namespace

Scene joined_scene(std::span<const Scene> scenes)
{
    std::size_t uv_sets = 0;
    for (const Scene& scene : scenes) {
        if (scene.triangles.empty())
            throw InputError(scene.name + ": points do not stand in one world with other files");
        uv_sets = std::max(uv_sets, scene.uvs.size());
    }
    Scene all = join(scenes);
    for (Part& part : all.parts)
        part.node = part.mesh = part.primitive = -1;  // numbers within one file
    for (std::size_t number = 0; number < uv_sets; ++number)
        all.uvs.push_back(joined_uvs(scenes, number));
    all.labels = joined_labels(scenes);
    all.free_vertices = std::ranges::all_of(scenes, &Scene::free_vertices);
    all.asset = std::make_shared<const JoinedAsset>(scenes);
    return all;
}

}  // namespace surfelao

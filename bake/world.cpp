#include "bake/world.h"

#include "bake/roles.h"
#include "files/scene_io.h"
#include "surfels/errors.h"

#include <algorithm>
#include <utility>

namespace surfelao {
namespace {

/// Puts triangles together that are to occlude.
class OccluderScene {
public:
    void add(const Scene& scene, const Roles& roles)
    {
        const auto first = static_cast<std::uint32_t>(scene_.positions.size());
        require(scene_.positions.size() + scene.positions.size() <= kMostElements &&
                    scene_.triangles.size() + scene.triangles.size() <= kMostElements,
                "the files have more than " + std::to_string(kMostElements) +
                    " vertices or triangles together");
        scene_.positions.insert(scene_.positions.end(), scene.positions.begin(),
                                scene.positions.end());
        const std::vector<bool>& cut = roles.cut.replaced;
        for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
            if (roles.occludes(t) && (cut.empty() || !cut[t]))
                scene_.triangles.push_back(scene.triangles[t] + first);
        }
        for (const CutOut::Piece& piece : roles.cut.pieces)
            add(scene, piece);
    }

    [[nodiscard]] std::shared_ptr<const Geometry> geometry(const Frame& frame) const
    {
        return std::make_shared<const Geometry>(make_geometry(scene_, {.frame = frame}));
    }

private:
    void add(const Scene& scene, const CutOut::Piece& piece)
    {
        const glm::uvec3 t = scene.triangles[piece.triangle];
        const auto first = static_cast<std::uint32_t>(scene_.positions.size());
        for (const glm::dvec2 at : piece.corners)
            scene_.positions.push_back((1.0 - at.x - at.y) * scene.positions[t.x] +
                                       at.x * scene.positions[t.y] + at.y * scene.positions[t.z]);
        scene_.triangles.emplace_back(first, first + 1, first + 2);
    }

    Scene scene_;
};

/// Of what the inputs bake or what occludes in them.
Frame common_frame(std::span<const Scene> inputs, std::span<const std::vector<bool>> left_out)
{
    Box all;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const Box box = box_of(inputs[i], left_out[i]);
        if (box.low.x > box.high.x)
            continue;
        all.include(box.low);
        all.include(box.high);
    }
    return frame_of(all);
}

/// Those that the scene, which may have been in another world before, does not have.
void add_notes(const std::vector<std::string>& notes, Scene& scene)
{
    for (const std::string& note : notes) {
        if (std::ranges::find(scene.notes, note) == scene.notes.end())
            scene.notes.push_back(note);
    }
}

bool has(const std::vector<bool>& list, bool value)
{
    return std::ranges::find(list, value) != list.end();
}

}  // namespace

std::string name_of(ClearSurfaces clear)
{
    constexpr const char* kNames[] = {"solid", "open", "cut"};
    return kNames[static_cast<int>(clear)];
}

std::string text_of(const PartChoice& choice)
{
    std::string text;
    const auto add = [&](const char* key, const std::string& value) {
        text += std::string(" ") + key + "=" + value;
    };
    for (const std::string& pattern : choice.exclude)
        add("exclude", pattern);
    for (const std::string& pattern : choice.receivers)
        add("receivers", pattern);
    for (const std::filesystem::path& file : choice.occluders)
        add("occluders", file.filename().string());
    if (choice.clear != ClearSurfaces::solid)
        add("transparent", name_of(choice.clear));
    return text;
}

BakeWorld make_world(std::vector<Scene> inputs, std::span<const Scene> others,
                     const NormalSettings& normals, const PartChoice& choice,
                     const std::optional<Frame>& wanted)
{
    std::vector<Roles> roles = roles_of(inputs, others, choice);
    std::vector<std::vector<bool>> left_out(inputs.size());
    bool is_joined = inputs.size() > 1 || !others.empty();
    std::vector<std::string> notes_of_others;
    for (std::size_t i = 0; i < roles.size(); ++i) {
        const bool is_input = i < inputs.size();
        std::vector<std::string> notes;
        const Scene& scene = is_input ? inputs[i] : others[i - inputs.size()];
        open_materials(scene, choice.clear, roles[i], notes);
        is_joined = is_joined || !roles[i].cut.triangles.empty();
        if (is_input)
            add_notes(notes, inputs[i]);
        for (const std::string& note : notes)
            if (!is_input)
                notes_of_others.push_back(scene.name + ": " + note);
    }
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const Roles& own = roles[i];
        if (own.occlude.empty() && own.baked.empty())
            continue;
        const std::size_t count = inputs[i].triangles.size();
        left_out[i] = left_out_of(own, count);
        for (std::size_t t = 0; t < count; ++t)
            is_joined = is_joined || (own.is_baked(t) && !own.occludes(t));
        check_baked(inputs[i], own, inputs.size());
    }
    const Frame frame = wanted ? *wanted : common_frame(inputs, left_out);

    BakeWorld world;
    OccluderScene occluders;
    world.meshes.reserve(inputs.size());
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const Roles& own = roles[i];
        if (is_joined)
            occluders.add(inputs[i], own);
        const bool has_left_out = has(left_out[i], true);
        Mesh& mesh = world.meshes.emplace_back(
            make_mesh(std::move(inputs[i]), normals,
                      {.frame = frame,
                       .left_out = has_left_out ? std::move(left_out[i]) : std::vector<bool>()}));
        if (!has(own.baked, false))
            continue;
        if (!is_joined && !choice.receivers.empty())
            mesh.occluders = std::make_shared<const Geometry>(mesh.geometry);
        keep_triangles(mesh, [&](std::size_t triangle) { return own.is_baked(triangle); });
    }
    for (std::size_t i = 0; i < others.size(); ++i) {
        check_occluder(others[i]);
        occluders.add(others[i], roles[world.meshes.size() + i]);
    }
    const std::shared_ptr<const Geometry> joined = is_joined ? occluders.geometry(frame) : nullptr;
    for (Mesh& mesh : world.meshes) {
        if (joined)
            mesh.occluders = joined;
        add_notes(notes_of_others, mesh.scene);
    }
    return world;
}

namespace {

std::vector<Scene> read_all(std::span<const std::filesystem::path> paths,
                            const ReadOptions& reading)
{
    std::vector<Scene> scenes;
    for (const std::filesystem::path& path : paths)
        scenes.push_back(read_scene(path, reading));
    return scenes;
}

}  // namespace

std::vector<Scene> read_others(const PartChoice& choice, ReadOptions reading)
{
    reading.moment.reset();
    return read_all(choice.occluders, reading);
}

BakeWorld read_world(std::span<const std::filesystem::path> inputs, const NormalSettings& normals,
                     const PartChoice& choice, const ReadOptions& reading)
{
    return make_world(read_all(inputs, reading), read_others(choice, reading), normals, choice);
}

Mesh mesh_of(Scene scene, std::span<const Scene> others, const NormalSettings& normals,
             const PartChoice& choice, const std::optional<Frame>& frame)
{
    std::vector<Scene> input;
    input.push_back(std::move(scene));
    return std::move(make_world(std::move(input), others, normals, choice, frame).meshes.front());
}

Mesh read_mesh(const std::filesystem::path& input, const NormalSettings& normals,
               const PartChoice& choice, const ReadOptions& reading)
{
    return std::move(read_world({&input, 1}, normals, choice, reading).meshes.front());
}

}  // namespace surfelao

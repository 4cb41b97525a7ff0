#include "bake/played_scene.h"

#include "bake/moving_poses.h"
#include "bake/roles.h"

namespace surfelao {

PlayedScene::PlayedScene(const std::filesystem::path& input, const ReadOptions& reading)
    : rest_(read_rest(input, reading)),
      scene_(rest_),
      motion_(rest_, reading.moment.value_or(Moment{}).animation)
{
}

std::vector<PartPose> PlayedScene::move_to(double seconds)
{
    std::vector<PartPose> poses = motion_.at(seconds);
    move_scene(rest_, motion_, poses, scene_);
    return poses;
}

const Scene& PlayedScene::at(double seconds)
{
    move_to(seconds);
    scene_.notes = rest_.notes;
    scene_.notes.push_back("the pose is that of " + motion_.text_at(seconds));
    return scene_;
}

Box PlayedScene::box_at(std::span<const double> seconds, const PartChoice& choice,
                        std::span<const Scene> others)
{
    Roles roles = roles_of({&rest_, 1}, others, choice).front();
    std::vector<std::string> notes;
    open_materials(rest_, choice.clear, roles, notes);
    const std::vector<bool> left_out = left_out_of(roles, rest_.triangles.size());
    Box box;
    for (const double moment : seconds)
        include(scene_, move_to(moment), left_out, box);
    return box;
}

}  // namespace surfelao

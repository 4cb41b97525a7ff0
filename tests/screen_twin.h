/// screen_twin.h: the screen-space methods of gpu/screen_space.h once more, as plain loops in
/// double precision with angles in place of cosines: what their shaders are held against.
#pragma once

#include "gpu/screen_space.h"

#include <glm/vec4.hpp>

#include <vector>

namespace surfelao {

/// A picture as GBuffer::read_surface() reads it back.
struct ReadPicture {
    std::vector<glm::vec4> surface;
    int width = 0, height = 0;
    View view;
};

/// Occlusion of every pixel, row by row from the bottom. definition: with a max_distance.
[[nodiscard]] std::vector<float> screen_twin(const ReadPicture& picture,
                                             const ScreenSettings& settings,
                                             const Definition& definition);

/// The radius that a rule chooses, over R.
[[nodiscard]] std::vector<float> radius_twin(const ReadPicture& picture,
                                             const ScreenSettings& settings,
                                             const Definition& definition);

}  // namespace surfelao

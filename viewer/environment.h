/// environment.h: light that comes from all around, far away.
///
/// A panorama is an Image in equirectangular form: the top row looks to the sky, the middle column
/// along +x of the file's ground, columns run clockwise as seen from above (the usual orientation
/// of HDR maps); radiance in linear light.
#pragma once

#include "image/image.h"

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <span>
#include <vector>

namespace surfelao {

/// Where in a panorama the unit direction (y up) lies, as uv of sample_panorama.
[[nodiscard]] glm::vec2 panorama_uv(glm::vec3 direction);

/// The inverse: the unit direction (y up) that uv looks to.
[[nodiscard]] glm::vec3 panorama_direction(glm::vec2 uv);

/// A clear late afternoon, for those who bring no map: blue above, bright at the horizon, a warm
/// low sun with a wide glow, a pale ground. 256 x 128.
[[nodiscard]] Image builtin_sky();

/// What a white, unoccluded surface that faces a direction sends back: the mean of the radiance
/// around it, weighted by the cosine, as a panorama of 64 x 32. A uniform sky of L gives L. The
/// input is first averaged down to 128 x 64, so a small bright sun keeps its energy. O(pixels +
/// 2^24).
[[nodiscard]] Image irradiance_map(const Image& panorama);

/// The panorama averaged over boxes to at most that width, for backgrounds; height to match.
[[nodiscard]] Image shrink_panorama(const Image& panorama, int max_width);

/// A panorama and its halves, each the mean of four texels of the one before, down to one row.
[[nodiscard]] std::vector<Image> halved_panoramas(const Image& panorama);

/// Mean light of a patch about a direction that has the share alpha of all directions, from the
/// halves of a panorama of W x H: between the two about level .5 log2(alpha W H), at least 0.
[[nodiscard]] glm::vec3 patch_light(std::span<const Image> halves, glm::vec3 direction,
                                    float alpha);

/// Exposure by itself: one over what a surface that faces the sky receives, in the middle; 1 for a
/// map that is black.
[[nodiscard]] float automatic_exposure(const Image& irradiance);

/// Model to panorama directions.
[[nodiscard]] glm::mat3 sky_frame(glm::vec3 up);

/// Rolls bright light off towards 1: twin of shaders/panorama.glsl.
[[nodiscard]] glm::vec3 soften(glm::vec3 light);

}  // namespace surfelao

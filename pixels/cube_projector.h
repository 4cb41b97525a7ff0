/// cube_projector.h: cube maps on the device, and what they tell of a camera's pixels.
///
/// A pixel's point p with normal n reads the four texels of a map round its direction. A texel with
/// the point q and normal m counts where it lies on the same piece of surface:
///
///     |(q - p).n| <= f      |q - p| <= 3 f / cos      m.n >= .8
///
/// f = 2 |p - c| / size is a texel's footprint, cos = n.(c - p) / |c - p|. The answer is bilinear
/// over those that count, if they have at least .02 of the weight. With looser tests pixels read
/// what lies behind or beside them: the thin wall leaks.
///
/// Several maps are blended by their quality Q^4,
///
///     Q = cos * (largest |d_i| / |d|) * (1 / |d|),   d = p - c
///
/// facing, nearness to the face's middle, nearness to the centre. The thesis takes the best map
/// alone, whose change shows. Maps that fade, w_1 >= w_2 >= ... their weights, w = 0 behind the
/// last, enter linearly however good they are:
///
///     shown = sum over k of (w_k - w_k+1) * blend of the maps 1 to k
///
/// over those that answer there. Where the first of them weighs less than half the pixel's own
/// answer has the rest: a map that comes alone comes twice as fast as its weight, however sure it
/// seems of itself. Four times as fast showed where maps are wrong, beside edges and in closed
/// contacts (room, three maps: 8 jumps of 2.3 million, .0235 the largest; now .0076); as fast as
/// its weight, most pixels of a body from outside need their own answers (bunny: 84 % for 15 %).
#pragma once

#include "pixels/cube_map.h"

#include <optional>
#include <span>
#include <vector>

namespace surfelao {

/// A pixel reads so many maps at most, the nearest to the eye. A map fades away before another one
/// takes its place.
inline constexpr int kNearestMaps = 8;

/// A map as a drawing uses it.
struct ProjectedMap {
    std::uint32_t index = 0;
    float weight = 1.0f;  ///< in (0, 1]
};

/// Of these maps the `most` nearest to the eye, rising by distance, equal ones by index. One that
/// is nearly as far as the first that is left out weighs less, down to nothing: what is seen
/// changes continuously with the eye. weights: one per map, 0 to 1; those of 0 do not count.
[[nodiscard]] std::vector<ProjectedMap> nearest_maps(std::span<const glm::vec3> centres,
                                                     std::span<const float> weights, glm::vec3 eye,
                                                     int most = kNearestMaps);

/// Uses the context in every call.
class CubeProjector {
public:
    explicit CubeProjector(const GlContext& context);

    /// All maps have one size, that of the first. weight: 0 to 1, for a map that comes slowly.
    void add(CubeMap map, float weight = 1.0f);
    void set_weight(std::size_t map, float weight);
    void clear();

    const std::vector<CubeMap>& maps() const { return maps_; }
    /// Of all maps, seven a texel; on the device it is eight.
    [[nodiscard]] std::size_t bytes() const;

    /// As large as the picture: RG32F.
    [[nodiscard]] Framebuffer make_target(int width, int height) const;

    /// Occlusion of every pixel in red; in green its share in what should be shown: 1 where a map
    /// answers, less where only fading maps do, 0 where none does and on the background. seen must
    /// be drawn and as large as the target.
    void project(const GBuffer& seen, const Framebuffer& target, int most = kNearestMaps);

private:
    void upload(std::size_t first);

    const GlContext& context_;
    VertexArray nothing_;
    std::vector<CubeMap> maps_;
    std::vector<float> weights_;
    std::optional<TextureBuffer> distances_, values_;
    std::size_t capacity_ = 0;  ///< of the buffers, in maps
};

}  // namespace surfelao

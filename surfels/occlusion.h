/// occlusion.h: the one definition of what surfelao measures. Every engine, file attribute and test
/// refers to this page.
///
///     occlusion(p, n) = 1/pi * integral over the hemisphere around n of  H(w) (n.w) dw
///
/// H(w) = 1 where the ray from p along w hits any triangle, from either side, within max_distance;
/// with a falloff, H(w) = falloff weight of the distance of the nearest hit. 0 = open, 1 = closed.
/// visibility = 1 - occlusion is what is drawn and what is written to colours.
///
/// p is the receiver: the surface point moved off the *geometric* surface, to n's side, by an
/// offset in proportion to its triangle (surface.h). On sheets closer together than that the result
/// depends on it: of two that coincide each lies open beside the other, and one that lies nearer
/// behind the other than its offset is seen through it. Both sides of a comparison use the same
/// receivers.
///
/// bent normal = normalised integral of (1 - H(w)) w (n.w) dw; n itself where nothing is open.
///
/// A ground is one more occluder: an infinite plane, without triangles, that counts from both sides
/// as they do. A receiver at the height h over it sees it along every w with w.up < 0, at the
/// distance h / -w.up: with a max_distance R only inside of the cone -w.up > h / R. A receiver
/// below it sees it along w.up > 0 alike, one in the plane counts as above. Of triangle and ground
/// the nearer is the hit.
///
///           o---> n           on a convex body: occlusion = (1 - n.up) / 2
///          /|
///      R  / | h               on a wall (n.up = 0) with R, x = h / R:
///     ___/__|____ ground      occlusion = 1/2 - (asin x + x sqrt(1 - x^2)) / pi
///
/// All lengths are in diagonals of the scene's bounding box (geometry.h).
#pragma once

#include <glm/vec3.hpp>

#include <limits>
#include <optional>

namespace surfelao {

/// The answer for one receiver.
struct Occlusion {
    float occlusion = 0.0f;       ///< in [0, 1]: 0 = open, 1 = closed
    glm::vec3 bent_normal{0.0f};  ///< unit length; zero only where the receiver has no normal
};

/// How directions are weighted.
enum class Kernel {
    cosine,   ///< the definition above
    bunnell,  ///< min(1, 4 n.w) / (2 pi) in place of (n.w) / pi: the weight of Bunnell's "Dynamic
              ///< Ambient Occlusion" (GPU Gems 2, 2005) and of Engleson's report (2011). Another
              ///< quantity: a full enclosure gives 7/8. Known to the disk engine and to rays.
};

/// What a hit at a distance below max_distance counts.
enum class Falloff {
    none,    ///< every hit within max_distance counts 1
    smooth,  ///< (1 - (t / max_distance)^2)^2: near hits count more, and nothing jumps at the
             ///< limit. A choice of taste.
};

/// An infinite plane that occludes: all p with p.up = height.
struct Ground {
    glm::vec3 up{0.0f, 1.0f, 0.0f};  ///< unit length
    float height = 0.0f;             ///< finite, in diagonals from the centre of the box
    bool operator==(const Ground&) const = default;
};

/// Everything that changes what is measured, and nothing that changes how.
struct Definition {
    float max_distance = std::numeric_limits<float>::infinity();  ///< > 0, in diagonals
    Falloff falloff = Falloff::none;  ///< must be `none` where max_distance is infinite
    Kernel kernel = Kernel::cosine;
    std::optional<Ground> ground = {};  ///< with the cosine kernel only
    bool operator==(const Definition&) const = default;
};

/// Throws SettingsError where a member is out of its range, or the falloff has no limit to fall to.
void check_definition(const Definition& definition);

/// The weight in [0, 1] of a hit at distance t >= 0; 0 at and beyond max_distance.
[[nodiscard]] float hit_weight(const Definition& definition, float t);

/// The bent normal from an estimate of the integral of (1 - H(w)) w (n.w), of any scale. The
/// integral never points below the horizon; an estimate may, where next to nothing is open: that
/// part is taken off, and what was (nearly) all below is n. normal zero and open zero: zero.
[[nodiscard]] glm::vec3 bent_normal_of(glm::vec3 open, glm::vec3 normal);

}  // namespace surfelao

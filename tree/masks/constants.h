/// constants.h: the numbers of the mask engine; constants.inc is the table, with unit, neutral
/// value, reason and measured effect of each.
///
/// Plain data, for the kernels too. The shaders have the same rows as mask_constants.glsl
/// (cmake/embed_shaders.cmake).
#pragma once

#include <cstddef>
#include <cstdint>

namespace surfelao {

#define SURFELAO_MASK_CONSTANT(type, name, value) constexpr type name = value;
#define SURFELAO_MASK_FLAG(name, value) constexpr std::uint32_t name = value;
#define SURFELAO_MASK_QUALITY(quality, cluster, share_leaf, share_inner, graze)
#define SURFELAO_MASK_LIMIT(distance, weight)
#include "tree/masks/constants.inc"
#undef SURFELAO_MASK_CONSTANT
#undef SURFELAO_MASK_FLAG
#undef SURFELAO_MASK_QUALITY
#undef SURFELAO_MASK_LIMIT

/// The parameter family at one whole quality.
struct MaskFamilyPoint {
    int quality;
    float cluster, share_leaf, share_inner, graze;
};

/// By quality, from MaskOptions::kCoarsest to kFinest.
constexpr MaskFamilyPoint kMaskFamily[] = {
#define SURFELAO_MASK_CONSTANT(type, name, value)
#define SURFELAO_MASK_FLAG(name, value)
#define SURFELAO_MASK_QUALITY(quality, cluster, share_leaf, share_inner, graze) \
    {quality, cluster, share_leaf, share_inner, graze},
#define SURFELAO_MASK_LIMIT(distance, weight)
#include "tree/masks/constants.inc"
#undef SURFELAO_MASK_CONSTANT
#undef SURFELAO_MASK_FLAG
#undef SURFELAO_MASK_QUALITY
#undef SURFELAO_MASK_LIMIT
};

/// One of the limits that stand for the smooth falloff, near to far.
struct MaskFalloffStep {
    float distance, weight;
};
constexpr MaskFalloffStep kMaskFalloffSteps[] = {
#define SURFELAO_MASK_CONSTANT(type, name, value)
#define SURFELAO_MASK_FLAG(name, value)
#define SURFELAO_MASK_QUALITY(quality, cluster, share_leaf, share_inner, graze)
#define SURFELAO_MASK_LIMIT(distance, weight) {distance, weight},
#include "tree/masks/constants.inc"
#undef SURFELAO_MASK_CONSTANT
#undef SURFELAO_MASK_FLAG
#undef SURFELAO_MASK_QUALITY
#undef SURFELAO_MASK_LIMIT
};
static_assert(sizeof kMaskFalloffSteps == kMaskMostLimits * sizeof(MaskFalloffStep));

}  // namespace surfelao

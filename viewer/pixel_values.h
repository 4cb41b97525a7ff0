/// pixel_values.h: what lies on the pixels of a picture, in place of values of the model's own.
#pragma once

#include "gpu/program.h"

namespace surfelao {

/// What a texture of pixels' values tells.
enum class PixelForm {
    bent_and_occlusion,  ///< RGBA32F
    occlusion,           ///< R32F
    covered,             ///< RG32F: occlusion, and 0 to 1 how far it counts beside the model's own
    visibility,          ///< R32F: 1 - occlusion
};

/// Textures as large as the picture; they must live until it is drawn.
struct PixelValues {
    const Texture2D* own = nullptr;                  ///< null: there are none
    PixelForm form = PixelForm::bent_and_occlusion;  ///< of own
    int guard = 0;                                   ///< own is so many pixels larger on each side
    const Texture2D* rays = nullptr;     ///< bent normal, occlusion; null: own stands in
    const Texture2D* surface = nullptr;  ///< GBuffer::surface()
};

/// Sets the uniforms of shaders/pixel_values.glsl. unused: where there is no texture.
void set_pixel_values(Program& program, const PixelValues& values, const Texture2D& unused);

}  // namespace surfelao

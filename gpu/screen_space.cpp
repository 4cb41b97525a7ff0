#include "gpu/screen_space.h"

namespace surfelao {

ScreenSpace::ScreenSpace(const GlContext& context) : context_(context), nothing_(context)
{
}

Framebuffer ScreenSpace::make_target(const GBuffer& seen) const
{
    return {context_,
            {.width = seen.width(), .height = seen.height(), .colors = {TexelFormat::r32f}}};
}

void ScreenSpace::draw(const GBuffer&, const ScreenSettings&, const Definition&,
                       const Framebuffer& target)
{
    target.clear_color(glm::vec4(0.0f));
}

}  // namespace surfelao

#include "viewer/pixel_values.h"

namespace surfelao {

void set_pixel_values(Program& program, const PixelValues& values, const Texture2D& unused)
{
    const auto set = [&](const char* sampler, const Texture2D* texture) {
        program.set(sampler, texture ? *texture : unused);
    };
    program.set("u_has_pixels", values.own ? 1 + static_cast<int>(values.form) : 0);
    program.set("u_pixel_guard", values.guard);
    program.set("u_has_pixel_rays", values.rays ? 1 : 0);
    set("u_own_pixels", values.own);
    set("u_pixel_rays", values.rays);
    set("u_pixel_surface", values.surface);
}

}  // namespace surfelao

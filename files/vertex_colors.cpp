#include "files/vertex_colors.h"

#include <cmath>

namespace surfelao {

std::string name_of(VertexColors colors)
{
    switch (colors) {
        case VertexColors::grey:
            return "grey";
        case VertexColors::shaded:
            return "shaded";
        case VertexColors::keep:
            return "keep";
        case VertexColors::bent:
            return "bent";
        default:
            return "auto";
    }
}

std::string name_of(Encoding encoding)
{
    switch (encoding) {
        case Encoding::linear:
            return "linear";
        case Encoding::srgb:
            return "srgb";
        default:
            return "auto";
    }
}

glm::vec3 color_of(VertexColors what, const Occlusion& occlusion, glm::vec3 own)
{
    const float visibility = 1.0f - occlusion.occlusion;
    switch (what) {
        case VertexColors::shaded:
            return visibility * own;
        case VertexColors::keep:
            return own;
        case VertexColors::bent:
            return occlusion.bent_normal == glm::vec3(0.0f) ? glm::vec3(0.0f)
                                                            : 0.5f + 0.5f * occlusion.bent_normal;
        default:
            return glm::vec3(visibility);
    }
}

float to_srgb(float linear)
{
    // in double, so that white stays white
    return linear <= 0.0031308f
               ? 12.92f * linear
               : static_cast<float>(1.055 * std::pow(double{linear}, 1.0 / 2.4) - 0.055);
}

float from_srgb(float encoded)
{
    return encoded <= 0.04045f
               ? encoded / 12.92f
               : static_cast<float>(std::pow((double{encoded} + 0.055) / 1.055, 2.4));
}

}  // namespace surfelao

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

}  // namespace surfelao

#include "gpu/answers.h"

#include "gpu/rows.h"

#include <glm/vec4.hpp>

#include <span>

namespace surfelao {

TextureBuffer answers_of_rows(const GlContext& context, const Framebuffer& rows, std::size_t count)
{
    TextureBuffer answers(context, TexelFormat::rgba32f, count);
    const int whole_rows = static_cast<int>(count / kRowTexels);
    const int rest = static_cast<int>(count % kRowTexels);
    rows.copy_color({0, 0, kRowTexels, whole_rows}, answers.buffer(), 0);
    rows.copy_color({0, whole_rows, rest, rest > 0 ? 1 : 0}, answers.buffer(),
                    static_cast<std::size_t>(whole_rows) * kRowTexels * sizeof(glm::vec4));
    return answers;
}

std::vector<Occlusion> read_answers(const TextureBuffer& answers, std::size_t count)
{
    std::vector<glm::vec4> texels(count);
    answers.buffer().read(std::span(texels));
    std::vector<Occlusion> result(count);
    for (std::size_t i = 0; i < count; ++i)
        result[i] = {texels[i].w, glm::vec3(texels[i])};
    return result;
}

}  // namespace surfelao

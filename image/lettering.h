/// lettering.h: short labels in pictures, in one small built-in bitmap font.
#pragma once

#include "image/image.h"

#include <glm/vec2.hpp>

#include <string_view>

namespace surfelao {

/// Cell of one character, gap to the next included, in font pixels.
inline constexpr int kGlyphWidth = 6;
inline constexpr int kGlyphHeight = 8;

/// Draws text with its top left corner at `corner`, each font pixel `scale` >= 1 pixels wide.
/// Letters are drawn as capitals; known besides are digits, space and . , : - + % / ( ) =. Any
/// other character is drawn as a filled box. What lies outside the image is left out.
void draw_text(Image& image, glm::ivec2 corner, std::string_view text, glm::vec4 color, int scale);

/// The width of a line of text at scale 1, in pixels.
[[nodiscard]] int text_width(std::string_view text);

}  // namespace surfelao

// rows.glsl: a long array as a texture of rows of 4,096 texels, which can be drawn into.
//
// Host side  gpu/rows.h
const int kRowBits = 12;

int index_of_texel(ivec2 texel) { return (texel.y << kRowBits) + texel.x; }

ivec2 texel_of_index(int index) { return ivec2(index & ((1 << kRowBits) - 1), index >> kRowBits); }

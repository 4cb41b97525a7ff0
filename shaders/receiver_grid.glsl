// receiver_grid.glsl: which receiver a pixel stands for, and where a receiver's pixel is.
//
// A slot is a receiver's place in the list of groups: 16 * group + lane (tree/receiver_groups.h). Slots
// fill blocks of 32 x 32 pixels, block after block along rows of blocks, and a Z-order curve inside a
// block. So a group, whose receivers make the same decisions, is a square of 4 x 4 pixels, and what a
// GPU runs in lockstep stands close together in space.
//
// Host side  gpu/receiver_grid.h
const int kBlockSide  = 32;
const int kBlockSlots = kBlockSide * kBlockSide;

// The bits of a five-bit x at the even places.
int spread_bits(int x)
{
    x = (x | (x << 4)) & 0x10F;
    x = (x | (x << 2)) & 0x133;
    return (x | (x << 1)) & 0x155;
}

// The inverse of spread_bits; odd places are ignored.
int gather_bits(int x)
{
    x &= 0x155;
    x = (x | (x >> 1)) & 0x133;
    x = (x | (x >> 2)) & 0x10F;
    return (x | (x >> 4)) & 0x1F;
}

int slot_at_pixel(ivec2 pixel, int blocks_per_row)
{
    ivec2 block  = pixel / kBlockSide;
    ivec2 inside = pixel % kBlockSide;
    return (block.y * blocks_per_row + block.x) * kBlockSlots +
           (spread_bits(inside.x) | (spread_bits(inside.y) << 1));
}

ivec2 pixel_of_slot(int slot, int blocks_per_row)
{
    int block  = slot / kBlockSlots;
    int inside = slot % kBlockSlots;
    return ivec2(block % blocks_per_row, block / blocks_per_row) * kBlockSide +
           ivec2(gather_bits(inside), gather_bits(inside >> 1));
}

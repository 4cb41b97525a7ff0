/// receiver_grid.h: receivers as the pixels of a picture, computed one piece at a time.
///
/// A fragment shader that computes one value per receiver finds it by slot_at_pixel() of
/// shaders/receiver_grid.glsl: slot = 16 * group + lane. Work is cut twice, so that no draw is long
/// enough for a driver's watchdog (often two seconds), and progress and cancelling stay prompt:
/// into pieces of the picture, sized by the clock, and within a piece into draws of so many steps
/// along the list of things that each receiver looks at. The cuts change nothing in the results.
#pragma once

#include "gpu/draw.h"
#include "gpu/objects.h"
#include "gpu/program.h"
#include "surfels/progress.h"
#include "tree/receiver_groups.h"

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace surfelao {

/// Slot of a receiver that stands in no group: it has no normal.
inline constexpr std::uint32_t kNoSlot = 0xFFFFFFFF;

/// slots[i] is the place of receiver i in the groups, or kNoSlot.
[[nodiscard]] std::vector<std::uint32_t> slots_of_receivers(const ReceiverGroups& groups,
                                                            std::size_t receiver_count);

/// RGBA32F, 3 texels a leaf: center.xyz radius | axis.xyz cone_cos | cone_sin rise_of_cone 0 0.
/// leaves: of the groups, side by side.
[[nodiscard]] TextureBuffer upload_groups(const GlContext& context, const ReceiverGroups& groups,
                                          std::span<const std::uint32_t> leaves);

/// One value that a computation finds: an output of its fragment shader, in the order of locations,
/// and the sampler through which the next draw goes on with it.
struct GridValue {
    std::string sampler;
    TexelFormat format;
};

class ReceiverGrid {
public:
    /// Throws std::runtime_error when the device cannot hold so many.
    ReceiverGrid(const GlContext& context, const ReceiverGroups& groups,
                 std::span<const std::uint32_t> leaves, std::vector<GridValue> values);

    /// Runs the program over all slots and counts finished groups into `meter`. Each receiver goes
    /// along a list that ends at `end`; its place is the last output, R32UI, and comes back in
    /// u_at. Sets the program's u_receivers, u_slot_count, u_blocks_per_row and, for going on where
    /// the last draw stopped, the values' samplers, u_at, u_continued. `then` is called with each
    /// part of the targets that is done. Throws Cancelled.
    void compute(Program& program, std::uint32_t end, ProgressMeter& meter,
                 const std::function<void(const Rect& piece)>& then = {});

    /// What compute() found, at pixel_of_slot().
    const Texture2D& value(std::size_t index = 0) const { return targets_[0].color(index); }
    Rect rect() const { return targets_[0].rect(); }
    int blocks_per_row() const { return blocks_per_row_; }

    /// RGBA32F, 2 texels a slot: position.xyz 0 | normal.xyz 0
    const TextureBuffer& receivers() const { return receivers_; }
    int slot_count() const { return slot_count_; }

private:
    void compute_piece(Program& program, std::uint32_t end, const Rect& piece);
    static constexpr int kBlockSide = 32;
    static constexpr std::uint64_t kBlockGroups = kBlockSide * kBlockSide / kGroupSize;
    const GlContext* context_;
    std::uint64_t group_count_;
    int slot_count_;
    int blocks_per_row_;
    TextureBuffer receivers_;
    std::vector<GridValue> values_;
    VertexArray empty_;
    std::array<Framebuffer, 2> targets_;  ///< values and place in the list; by turns
    double wanted_ = 1.0;                 ///< blocks in the next piece
};

}  // namespace surfelao

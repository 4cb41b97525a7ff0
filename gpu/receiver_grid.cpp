#include "gpu/receiver_grid.h"
#include "surfels/stopwatch.h"

#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace surfelao {
namespace {

/// One draw is to take about this long, and grows by no more than that factor over the last.
constexpr double kPieceSeconds = 0.05;
constexpr double kMaxGrowth = 4.0;

std::vector<glm::vec4> receiver_texels(const ReceiverGroups& groups,
                                       std::span<const std::uint32_t> leaves)
{
    std::vector<glm::vec4> texels;
    texels.reserve(leaves.size() * kGroupSize * 2);
    for (const std::uint32_t leaf : leaves) {
        for (std::size_t i = groups.groups[leaf].begin; i < groups.groups[leaf].end; ++i) {
            for (const auto* columns : {&groups.position, &groups.normal})
                texels.emplace_back((*columns)[0][i], (*columns)[1][i], (*columns)[2][i], 0.0f);
        }
    }
    return texels;
}

/// Blocks in one row of a picture that is about square.
int square_side(std::uint64_t blocks)
{
    return std::max(1, static_cast<int>(std::ceil(std::sqrt(static_cast<double>(blocks)))));
}

Framebuffer make_target(const GlContext& context, int side, std::span<const GridValue> values)
{
    FramebufferOptions options = {.width = side, .height = side, .colors = {}};
    for (const GridValue& value : values)
        options.colors.push_back(value.format);
    options.colors.push_back(TexelFormat::r32ui);
    return Framebuffer(context, options);
}

std::uint64_t divide_up(std::uint64_t a, std::uint64_t b)
{
    return (a + b - 1) / b;
}

}  // namespace

std::vector<std::uint32_t> slots_of_receivers(const ReceiverGroups& groups,
                                              std::size_t receiver_count)
{
    std::vector<std::uint32_t> slots(receiver_count, kNoSlot);
    for (std::uint32_t slot = 0; slot < groups.order.size(); ++slot)
        slots[groups.order[slot]] = slot;
    return slots;
}

TextureBuffer upload_groups(const GlContext& context, const ReceiverGroups& groups,
                            std::span<const std::uint32_t> leaves)
{
    std::vector<glm::vec4> texels;
    texels.reserve(leaves.size() * 3);
    for (const std::uint32_t leaf : leaves) {
        const ReceiverGroup& group = groups.groups[leaf];
        texels.emplace_back(group.center[0], group.center[1], group.center[2], group.radius);
        texels.emplace_back(group.axis[0], group.axis[1], group.axis[2], group.cone_cos);
        texels.emplace_back(group.cone_sin, rise_of_cone(group), 0.0f, 0.0f);
    }
    return TextureBuffer(context, TexelFormat::rgba32f, std::span<const glm::vec4>(texels));
}

ReceiverGrid::ReceiverGrid(const GlContext& context, const ReceiverGroups& groups,
                           std::span<const std::uint32_t> leaves, std::vector<GridValue> values)
    : context_(&context),
      group_count_(leaves.size()),
      slot_count_(leaves.empty() ? 0
                                 : static_cast<int>(groups.groups[leaves.back()].end -
                                                    groups.groups[leaves.front()].begin)),
      blocks_per_row_(square_side(divide_up(leaves.size(), kBlockGroups))),
      receivers_(context, TexelFormat::rgba32f,
                 std::span<const glm::vec4>(receiver_texels(groups, leaves))),
      values_(std::move(values)),
      empty_(context),
      targets_{make_target(context, blocks_per_row_ * kBlockSide, values_),
               make_target(context, blocks_per_row_ * kBlockSide, values_)}
{
}

void ReceiverGrid::compute_piece(Program& program, std::uint32_t end, const Rect& piece)
{
    Program& unfinished = context_->program("fullscreen.vert", "unfinished.frag");
    unfinished.set("u_end", end);
    const DrawState state = {.scissor = piece};
    std::size_t latest = 1;
    bool more = true;
    for (int continued = 0; more; continued = 1) {
        for (std::size_t i = 0; i < values_.size(); ++i)
            program.set(values_[i].sampler, targets_[latest].color(i));
        program.set("u_at", targets_[latest].color(values_.size()));
        program.set("u_continued", continued);
        latest = 1 - latest;
        draw_fullscreen(targets_[latest], program, empty_, state);
        unfinished.set("u_at", targets_[latest].color(values_.size()));
        // what is done is only copied by a further draw: one more brings the end to the first
        // target
        more = any_fragment(targets_[1 - latest], unfinished, empty_, state) || latest != 0;
    }
}

void ReceiverGrid::compute(Program& program, std::uint32_t end, ProgressMeter& meter,
                           const std::function<void(const Rect& piece)>& then)
{
    program.set("u_receivers", receivers_);
    program.set("u_slot_count", slot_count());
    program.set("u_blocks_per_row", blocks_per_row_);

    const std::uint64_t row = static_cast<std::uint64_t>(blocks_per_row_);
    const std::uint64_t block_count = divide_up(group_count_, kBlockGroups);
    for (std::uint64_t first = 0; first < block_count;) {
        // whole rows where a piece begins with a row and is at least that long, else part of a row
        const std::uint64_t column = first % row;
        const std::uint64_t blocks = static_cast<std::uint64_t>(wanted_);
        const std::uint64_t rows_left = divide_up(block_count - first, row);
        const std::uint64_t rows =
            column == 0 ? std::clamp<std::uint64_t>(blocks / row, 1, rows_left) : 1;
        const std::uint64_t columns = rows > 1 ? row : std::min(blocks, row - column);
        const Rect piece = {
            static_cast<int>(column) * kBlockSide, static_cast<int>(first / row) * kBlockSide,
            static_cast<int>(columns) * kBlockSide, static_cast<int>(rows) * kBlockSide};
        Stopwatch watch;
        compute_piece(program, end, piece);
        if (then)
            then(piece);
        context_->finish("computing occlusion");
        const double seconds = watch.lap();

        const std::uint64_t next = std::min(first + rows * columns, block_count);
        meter.add(std::min(next * kBlockGroups, group_count_) - first * kBlockGroups);
        first = next;
        const double growth = kPieceSeconds / std::max(seconds, 1e-6);
        wanted_ = std::clamp(wanted_ * std::min(growth, kMaxGrowth), 1.0, 1e9);
    }
}

}  // namespace surfelao

#include "gpu/gpu_disks.h"

#include "gpu/answers.h"
#include "gpu/draw.h"
#include "gpu/receiver_grid.h"
#include "gpu/rows.h"
#include "tree/disks/correction.h"
#include "tree/disks/gather.h"
#include "tree/ground.h"
#include "tree/receiver_groups.h"

#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace surfelao {
namespace {

/// Records of one chunk of disks_average_chunks.frag.
constexpr std::uint32_t kChunkRecords = 1024;

/// As shaders/disk_record.glsl says.
struct Record {
    glm::vec3 center{0.0f};
    float radius = 0.0f;
    glm::vec3 normal{0.0f};
    float flat_area = 0.0f;
    std::uint32_t next = 0;
    float area = 0.0f;
    std::uint32_t first_chunk = 0;  ///< of a surfel: 1 + its triangle, or 0
    std::uint32_t chunk_count = 0;
};
static_assert(sizeof(Record) == 48);

/// Records that a receiver looks at in one draw: far below what any driver ends loops at, and more
/// than nearly all receivers need.
constexpr int kStepLimit = 16384;

/// Neighbours that row_sums.frag adds up.
constexpr int kRowSumTerms = 64;

/// FarVisibility before the first pass.
constexpr glm::vec4 kAllVisible(0.0f, 0.0f, 0.0f, 1.0f);

/// The octree as the device walks it.
struct Records {
    std::vector<Record> records;
    std::vector<glm::uvec4> chunks;        ///< node, first and end record, 0
    std::vector<glm::vec4> corners;        ///< two per triangle, as u_corners
    std::vector<std::uint32_t> of_surfel;  ///< record of each surfel
    std::uint32_t two_sided_from = 0;      ///< first record that occludes from both sides
};

Records make_records(const Octree& octree)
{
    const auto node_count = static_cast<std::uint32_t>(octree.nodes.size());
    const auto total = static_cast<std::uint32_t>(octree.nodes.size() + octree.surfels.size());
    // all surfels of earlier leaves stand before a node, and those are the ones before its first
    const auto record_of_node = [&](std::uint32_t node) {
        return node < node_count ? node + octree.nodes[node].first_surfel : total;
    };
    Records result;
    result.records.resize(total);
    result.of_surfel.resize(octree.surfels.size());
    result.two_sided_from = record_of_node(octree.two_sided_nodes);
    for (std::uint32_t i = 0; i < node_count; ++i) {
        const OctreeNode& node = octree.nodes[i];
        const std::uint32_t self = record_of_node(i);
        const std::uint32_t next = record_of_node(node.next);
        const auto first_chunk = static_cast<std::uint32_t>(result.chunks.size());
        for (std::uint32_t at = self + 1; at < next; at += kChunkRecords)
            result.chunks.emplace_back(self, at, std::min(at + kChunkRecords, next), 0);
        result.records[self] = {
            node.center, opening_size(node),
            node.normal, node.flatness * node.area,
            next,        node.area,
            first_chunk, static_cast<std::uint32_t>(result.chunks.size()) - first_chunk};
        if (node.next != i + 1)
            continue;
        for (std::uint32_t k = 0; k < node.surfel_count; ++k) {
            const Surfel& surfel = octree.surfels[node.first_surfel + k];
            const std::uint32_t record = self + 1 + k;
            result.of_surfel[node.first_surfel + k] = record;
            result.records[record] = {surfel.position, -1.0f - surfel.reach, surfel.normal,
                                      surfel.area,     record + 1,           surfel.area};
            if (surfel.reach > 0.0f) {
                for (const glm::vec3& corner : surfel.corners)
                    result.corners.emplace_back(corner, 0.0f);
                result.records[record].first_chunk =
                    static_cast<std::uint32_t>(result.corners.size() / 2);
            }
        }
    }
    return result;
}

/// Receivers where disks are summed.
struct GatherGrid {
    ReceiverGrid grid;
    TextureBuffer groups;

    GatherGrid(const GlContext& context, const ReceiverGroups& receivers)
        : grid(context, receivers, receivers.leaves, {{"u_sums", TexelFormat::rgba32f}}),
          groups(upload_groups(context, receivers, receivers.leaves))
    {
    }
    /// Sums of disks_gather.frag, at pixel_of_slot().
    const Texture2D& sums() const { return grid.value(); }
};

TextureBuffer upload_slots(const GlContext& context, std::vector<std::uint32_t> slots)
{
    slots.resize(padded_to_rows(slots.size()), kNoSlot);
    return TextureBuffer(context, TexelFormat::r32ui, std::span<const std::uint32_t>(slots));
}

/// One side of all surfels: where they are asked, and what they find.
struct FarSide {
    float sign;  ///< +1: the side of the casting normal
    ReceiverGroups groups;
    GatherGrid gathered;
    TextureBuffer slots;  ///< of each record in the grid
    Framebuffer found;    ///< disks_fit.frag: visibility and its change
    Framebuffer before;   ///< the same of the pass before

    FarSide(const GlContext& context, const Octree& octree, const Records& records, float side)
        : sign(side),
          groups(group_receivers(far_sides(octree, side))),
          gathered(context, groups),
          slots(upload_slots(context, slots_of_records(records))),
          found(make_rows(context, records.records.size(), kFormats)),
          before(make_rows(context, records.records.size(), kFormats))
    {
        found.clear_color(kAllVisible);
    }

private:
    inline static const std::vector<TexelFormat> kFormats = {TexelFormat::rgba32f,
                                                             TexelFormat::r32f};
    std::vector<std::uint32_t> slots_of_records(const Records& records) const
    {
        const std::vector<std::uint32_t> of_surfel =
            slots_of_receivers(groups, records.of_surfel.size());
        std::vector<std::uint32_t> slots_of(records.records.size(), kNoSlot);
        for (std::size_t s = 0; s < of_surfel.size(); ++s)
            slots_of[records.of_surfel[s]] = of_surfel[s];
        return slots_of;
    }
};

/// What the correcting passes have come to. It depends on the octree and on these options, not on
/// who is asked, so it is where every later solve starts from: one pass is left.
struct Corrected {
    DiskOptions of;
    std::vector<Framebuffer> visibility;  ///< per side: FarVisibility of each record
    std::vector<double> residuals;

    bool serves(const DiskOptions& options) const
    {
        Definition asked = options.definition, had = of.definition;
        asked.ground.reset();  // nothing that still counts has the ground beyond it
        had.ground.reset();
        return asked == had && options.opening == of.opening && options.passes == of.passes;
    }
};

}  // namespace

struct GpuDisks::Impl {
    const GlContext& context;
    const Octree& octree;
    Records records;
    TextureBuffer records_texture;
    TextureBuffer corners;
    TextureBuffer chunks;
    VertexArray empty;
    mutable std::optional<Corrected> corrected;  ///< by the last solve

    Impl(const GlContext& in, const Octree& of)
        : context(in),
          octree(of),
          records(make_records(of)),
          records_texture(in, TexelFormat::rgba32ui, std::span<const Record>(records.records)),
          corners(in, TexelFormat::rgba32f, std::span<const glm::vec4>(records.corners)),
          chunks(in, TexelFormat::rgba32ui, std::span<const glm::uvec4>(records.chunks)),
          empty(in)
    {
    }
};

namespace {

/// What the ground covers, as disks_gather.frag begins with it: one texel per slot.
TextureBuffer upload_ground(const GlContext& context, const Definition& definition,
                            const ReceiverGroups& groups, std::span<const Receiver> receivers)
{
    std::vector<glm::vec4> texels;
    for (const std::uint32_t receiver : groups.order)
        texels.emplace_back(ground_direction(definition, receivers[receiver]),
                            ground_share(definition, receivers[receiver]));
    return TextureBuffer(context, TexelFormat::rgba32f, std::span<const glm::vec4>(texels));
}

/// What the passes of one solve share.
class Solver {
public:
    Solver(const GpuDisks::Impl& scene, const DiskOptions& options)
        : scene_(scene),
          options_(options),
          limited_(std::isfinite(options.definition.max_distance)),
          two_sided_(limited_ || scene.octree.two_sided_surfels < scene.octree.surfels.size())
    {
    }

    GpuDiskResult solve(std::span<const Receiver> receivers, const Progress& progress)
    {
        if (scene_.corrected && !scene_.corrected->serves(options_))
            scene_.corrected.reset();
        std::vector<FarSide> sides;
        for (int side = 0; !scene_.corrected && side < side_count() && options_.passes > 1; ++side)
            sides.emplace_back(scene_.context, scene_.octree, scene_.records,
                               side == 0 ? 1.0f : -1.0f);
        const ReceiverGroups groups = group_receivers(receivers);
        std::uint64_t work = groups.leaves.size();
        for (const FarSide& side : sides)
            work += side.groups.leaves.size() * static_cast<std::uint64_t>(options_.passes - 1);
        ProgressMeter meter(progress, work);

        if (scene_.corrected)
            visibility_ = &scene_.corrected->visibility;
        else
            correct(sides, meter);
        return {answer(groups, receivers, meter), scene_.corrected->residuals};
    }

private:
    int side_count() const { return two_sided_ ? 2 : 1; }
    std::size_t record_count() const { return scene_.records.records.size(); }

    void correct(std::vector<FarSide>& sides, ProgressMeter& meter)
    {
        Corrected corrected{options_, {}, {}};
        for (int side = 0; side < side_count(); ++side) {
            corrected.visibility.push_back(
                make_rows(scene_.context, record_count(), {TexelFormat::rgba32f}));
            corrected.visibility.back().clear_color(kAllVisible);
        }
        visibility_ = &corrected.visibility;
        for (int pass = 1; pass < options_.passes; ++pass) {
            double change = 0.0;
            for (FarSide& side : sides) {
                gather(side.gathered, beyond_settings(options_), nullptr, meter);
                change += fit(side, pass);
            }
            average(sides);
            const auto count = static_cast<double>(sides.size() * scene_.octree.surfels.size());
            corrected.residuals.push_back(count > 0.0 ? std::sqrt(change / count) : 0.0);
            if (corrected.residuals.back() <= kSettled)
                break;
        }
        scene_.corrected = std::move(corrected);
        visibility_ = &scene_.corrected->visibility;
    }

    std::string two_sided_definition() const
    {
        return std::string("TWO_SIDED ") + (two_sided_ ? "1" : "0");
    }

    /// ground: what it covers of each slot (upload_ground), where it counts; else null.
    void gather(GatherGrid& gathered, const GatherSettings& settings, const TextureBuffer* ground,
                ProgressMeter& meter)
    {
        const bool bunnell = options_.definition.kernel == Kernel::bunnell;
        Program& program = scene_.context.program(
            "fullscreen.vert", "disks_gather.frag",
            {two_sided_definition(), std::string("LIMITED ") + (limited_ ? "1" : "0"),
             std::string("BUNNELL ") + (bunnell ? "1" : "0"),
             std::string("GROUND ") + (ground ? "1" : "0")});
        if (ground) {
            program.set("u_ground", *ground);
            program.set("u_up", options_.definition.ground->up);
            program.set("u_ground_height", options_.definition.ground->height);
        }
        program.set("u_records", scene_.records_texture);
        program.set("u_record_count", static_cast<int>(record_count()));
        program.set("u_corners", scene_.corners);
        program.set("u_triangles", bunnell || settings.only_disks ? 0 : 1);
        program.set("u_opening", settings.opening);
        program.set("u_far_front", (*visibility_)[0].color());
        if (two_sided_) {
            const std::uint32_t from = limited_ ? 0 : scene_.records.two_sided_from;
            program.set("u_two_sided_from", static_cast<int>(from));
            program.set("u_far_back", (*visibility_)[1].color());
        }
        if (limited_) {
            program.set("u_max_distance", settings.definition.max_distance);
            program.set("u_smooth", options_.definition.falloff == Falloff::smooth ? 1 : 0);
        }
        program.set("u_step_limit", kStepLimit);
        program.set("u_groups", gathered.groups);
        gathered.grid.compute(program, static_cast<std::uint32_t>(record_count()), meter);
    }

    /// From the sums in the side's grid. Returns the sum of the squared changes.
    double fit(FarSide& side, int pass)
    {
        std::swap(side.found, side.before);
        Program& program = scene_.context.program("fullscreen.vert", "disks_fit.frag");
        program.set("u_sums", side.gathered.sums());
        program.set("u_blocks_per_row", side.gathered.grid.blocks_per_row());
        program.set("u_records", scene_.records_texture);
        program.set("u_slots", side.slots);
        program.set("u_side", side.sign);
        program.set("u_first", pass == 1 ? 1 : 0);
        program.set("u_weight", correction_weight(pass));
        program.set("u_before", side.before.color());
        draw_fullscreen(side.found, program, scene_.empty);

        const Framebuffer sums(scene_.context, {.width = kRowTexels / kRowSumTerms,
                                                .height = side.found.height(),
                                                .colors = {TexelFormat::r32f}});
        Program& summing = scene_.context.program("fullscreen.vert", "row_sums.frag");
        summing.set("u_values", side.found.color(1));
        draw_fullscreen(sums, summing, scene_.empty);
        const std::vector<float> parts = sums.read_red(sums.rect());
        return std::accumulate(parts.begin(), parts.end(), 0.0);
    }

    /// From what the surfels found to the visibility of all records.
    void average(const std::vector<FarSide>& sides)
    {
        const Framebuffer sums =
            make_rows(scene_.context, scene_.records.chunks.size(),
                      std::vector<TexelFormat>(sides.size(), TexelFormat::rgba32f));
        Program& chunked = scene_.context.program("fullscreen.vert", "disks_average_chunks.frag",
                                                  {two_sided_definition()});
        chunked.set("u_chunks", scene_.chunks);
        chunked.set("u_chunk_count", static_cast<int>(scene_.records.chunks.size()));
        chunked.set("u_records", scene_.records_texture);
        chunked.set("u_far_front", sides[0].found.color());
        if (two_sided_)
            chunked.set("u_far_back", sides[1].found.color());
        draw_fullscreen(sums, chunked, scene_.empty);

        Program& whole = scene_.context.program("fullscreen.vert", "disks_average.frag");
        whole.set("u_records", scene_.records_texture);
        whole.set("u_record_count", static_cast<int>(record_count()));
        for (std::size_t side = 0; side < sides.size(); ++side) {
            whole.set("u_far", sides[side].found.color());
            whole.set("u_chunks", sums.color(side));
            draw_fullscreen((*visibility_)[side], whole, scene_.empty);
        }
        scene_.context.finish("averaging visibility");
    }

    TextureBuffer answer(const ReceiverGroups& groups, std::span<const Receiver> receivers,
                         ProgressMeter& meter)
    {
        const std::size_t count = receivers.size();
        GatherGrid gathered(scene_.context, groups);
        std::optional<TextureBuffer> ground;
        if (options_.definition.ground)
            ground = upload_ground(scene_.context, options_.definition, groups, receivers);
        gather(gathered, gather_settings(options_), ground ? &*ground : nullptr, meter);
        const TextureBuffer slots = upload_slots(scene_.context, slots_of_receivers(groups, count));
        const Framebuffer rows = make_rows(scene_.context, count, {TexelFormat::rgba32f});
        Program& program = scene_.context.program("fullscreen.vert", "disks_result.frag");
        program.set("u_sums", gathered.sums());
        program.set("u_blocks_per_row", gathered.grid.blocks_per_row());
        program.set("u_receivers", gathered.grid.receivers());
        program.set("u_slots", slots);
        program.set("u_strength", options_.strength);
        draw_fullscreen(rows, program, scene_.empty);

        TextureBuffer answers = answers_of_rows(scene_.context, rows, count);
        scene_.context.finish("computing occlusion");
        return answers;
    }

    const GpuDisks::Impl& scene_;
    DiskOptions options_;
    bool limited_;
    bool two_sided_;
    const std::vector<Framebuffer>* visibility_ = nullptr;  ///< of Corrected, or what becomes one
};

}  // namespace

GpuDisks::GpuDisks(const GlContext& context, const Octree& octree)
    : impl_(std::make_unique<Impl>(context, octree))
{
}
GpuDisks::~GpuDisks() = default;
GpuDisks::GpuDisks(GpuDisks&&) noexcept = default;
GpuDisks& GpuDisks::operator=(GpuDisks&&) noexcept = default;

GpuDiskResult GpuDisks::solve(std::span<const Receiver> receivers, const DiskOptions& options,
                              const Progress& progress) const
{
    check_disk_options(options);
    return Solver(*impl_, options).solve(receivers, progress);
}

}  // namespace surfelao

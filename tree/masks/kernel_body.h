/// kernel_body.h: the text of the mask kernels, compiled once per instruction set.
///
/// Its parts, in the order in which they are read: kernel_raster.h (bits of one polygon),
/// kernel_stream.h (lists of polygons), kernel_walk.h (which nodes), kernel_sums.h (what a mask is
/// worth), kernel_cracks.h (what is no opening), kernel_solve.h (one group).
///
/// Before it SURFELAO_MASK_ISA names the namespace, SURFELAO_MASK_ISA_NAME the set.
#pragma once

#include "tree/masks/kernel.h"
#include "tree/masks/kernel_solve.h"
#include "tree/masks/kernel_walk.h"

namespace surfelao::SURFELAO_MASK_ISA {
namespace {

void descend(const MaskWorld& world, const ReceiverGroup& group, const std::uint32_t* in,
             std::size_t in_count, MaskBuffer<std::uint32_t>& out, MaskShared& shared,
             MaskScratch& scratch)
{
    out.count = 0;
    start_frontier(scratch, in, in_count);
    walk<false>(world, group, &out, shared, scratch);
}
}  // namespace

constexpr MaskKernel kKernel = {SURFELAO_MASK_ISA_NAME, descend, solve, keep, solve_kept};

}  // namespace surfelao::SURFELAO_MASK_ISA

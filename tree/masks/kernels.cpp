#include "tree/masks/constants.h"
#include "tree/masks/kernel.h"
#include "tree/masks/masks.h"
#include "tree/masks/solver.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <new>

namespace surfelao {

namespace {

/// 64-byte aligned zeros: lanes beyond the end are loaded, though never used.
template <typename T>
T* allocate_zeros(std::size_t count)
{
    const std::size_t bytes = (count * sizeof(T) + 63) / 64 * 64;
    void* data = std::aligned_alloc(64, bytes);
    if (data == nullptr)
        throw std::bad_alloc();
    return static_cast<T*>(std::memset(data, 0, bytes));
}

}  // namespace

void reserve(MaskBuffer<std::uint32_t>& buffer, std::size_t count)
{
    if (count <= buffer.capacity)
        return;
    const std::size_t capacity = std::max<std::size_t>(2 * buffer.capacity, count + kMaskListSlack);
    auto* data = allocate_zeros<std::uint32_t>(capacity);
    std::copy_n(buffer.data, buffer.count, data);
    const std::size_t kept = buffer.count;
    release(buffer);
    buffer = {data, kept, capacity};
}
void release(MaskBuffer<std::uint32_t>& buffer)
{
    std::free(buffer.data);
    buffer = {};
}

const MaskKernel* kernel_of(MaskKernelSet set)
{
    switch (set) {
        case MaskKernelSet::best:
            return kernel_of(available_mask_kernels().front());
#if defined(__x86_64__)
        case MaskKernelSet::avx512:
            return &kMaskKernelAvx512;
        case MaskKernelSet::avx2:
            return &kMaskKernelAvx2;
#endif
        default:
            return &kMaskKernelPortable;
    }
}

std::vector<MaskKernelSet> available_mask_kernels()
{
    std::vector<MaskKernelSet> sets;
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
        __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl") &&
        __builtin_cpu_supports("avx512vnni"))
        sets.push_back(MaskKernelSet::avx512);
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
        sets.push_back(MaskKernelSet::avx2);
#endif
    sets.push_back(MaskKernelSet::portable);
    return sets;
}

std::string_view name_of(MaskKernelSet kernel)
{
    return kernel_of(kernel)->name;
}

}  // namespace surfelao

#include "mesh_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    return surfelao::fuzz_mesh(surfelao::From::pcd, surfelao::read_pcd, data, size);
}

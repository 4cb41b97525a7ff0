#include "mesh_fuzz.h"

#include "files/stl_io.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    return surfelao::fuzz_mesh(surfelao::From::other, surfelao::read_stl, data, size);
}

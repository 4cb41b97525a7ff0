#include "mesh_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    const auto read = [](const std::string& name, const std::string& text) {
        return surfelao::read_xyz(name, text);
    };
    return surfelao::fuzz_mesh(surfelao::From::xyz, read, data, size);
}

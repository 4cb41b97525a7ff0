#include "files/gltf_model.h"

#include <tiny_gltf.h>

#include <limits>

namespace surfelao {

tinygltf::Model parse_model(const GltfAsset& asset, const std::string& text)
{
    if (text.size() > std::numeric_limits<unsigned int>::max())
        fail_gltf(asset.path, "JSON", "is larger than 4 GiB");
    tinygltf::TinyGLTF parser;
    tinygltf::Model model;
    std::string error;
    std::string warning;
    if (!parser.LoadASCIIFromString(&model, &error, &warning, text.data(),
                                    static_cast<unsigned int>(text.size()), ""))
        fail_gltf(asset.path, "", error.substr(0, error.find('\n')));
    return model;
}

}  // namespace surfelao

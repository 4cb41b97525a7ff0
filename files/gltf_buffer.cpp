#include "files/gltf_buffer.h"

#include <tiny_gltf.h>

namespace surfelao {

int add_view(tinygltf::Model& model, std::span<const std::byte> bytes, int target)
{
    if (model.buffers.empty())
        model.buffers.emplace_back();
    std::vector<unsigned char>& data = model.buffers.front().data;
    data.resize((data.size() + 3) / 4 * 4);
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = data.size();
    view.byteLength = bytes.size();
    view.target = target;
    const auto* const first = reinterpret_cast<const unsigned char*>(bytes.data());
    data.insert(data.end(), first, first + bytes.size());
    model.bufferViews.push_back(std::move(view));
    return static_cast<int>(model.bufferViews.size()) - 1;
}

int add_accessor(tinygltf::Model& model, std::span<const std::byte> bytes, int component_type,
                 int type, std::size_t count, int target)
{
    tinygltf::Accessor accessor;
    accessor.bufferView = add_view(model, bytes, target);
    accessor.componentType = component_type;
    accessor.type = type;
    accessor.count = count;
    model.accessors.push_back(std::move(accessor));
    return static_cast<int>(model.accessors.size()) - 1;
}

}  // namespace surfelao

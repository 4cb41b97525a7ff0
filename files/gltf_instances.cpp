#include "files/gltf_instances.h"

#include <tiny_gltf.h>

#include <string>

namespace surfelao {
namespace {

constexpr const char* kExtension = "EXT_mesh_gpu_instancing";

/// The extension's attributes; null where the node has none.
const tinygltf::Value* attributes_of(const tinygltf::Model& model, std::size_t node)
{
    const tinygltf::ExtensionMap& extensions = model.nodes[node].extensions;
    const auto extension = extensions.find(kExtension);
    return extension == extensions.end() ? nullptr : &extension->second.Get("attributes");
}

std::string element_of(const MeshNode& use)
{
    return numbered("node", use.node) + ' ' + kExtension;
}

/// One attribute as numbers, `dimension` per instance; empty where the node does not have it.
std::vector<double> read_attribute(const tinygltf::Model& model, const MeshNode& use,
                                   const char* name, int dimension,
                                   const AccessorResolver& resolver)
{
    const tinygltf::Value& attributes = *attributes_of(model, use.node);
    if (!attributes.Has(name))
        return {};
    const NamedAccessor named =
        resolver.resolve(attributes.Get(name).GetNumberAsInt(), element_of(use) + ' ' + name);
    if (named.accessor.dimension != dimension)
        resolver.fail(named.element, "is not of type VEC" + std::to_string(dimension));
    if (named.accessor.component == GltfComponent::uint32)
        resolver.fail(named.element,
                      "has componentType 5125 (unsigned int), which no instance may have");
    try {
        return read_numbers(named.accessor);
    } catch (const AccessorError& error) {
        resolver.fail(named.element + ":", error.what());
    }
}

}  // namespace

std::optional<std::size_t> instance_count(const tinygltf::Model& model, const MeshNode& use,
                                          const AccessorResolver& resolver)
{
    const tinygltf::Value* attributes = attributes_of(model, use.node);
    if (attributes == nullptr)
        return std::nullopt;
    if (use.skin)
        resolver.fail(element_of(use), "stands beside a skin, which is not supported");
    std::optional<std::size_t> count;
    std::string first;
    for (const std::string& name : attributes->Keys()) {
        const auto accessor = static_cast<std::size_t>(attributes->Get(name).GetNumberAsInt());
        const std::size_t of_this = model.accessors[accessor].count;
        if (count && of_this != *count)
            resolver.fail(element_of(use), "has " + std::to_string(*count) + " values of " +
                                               shortened(first) + " and " +
                                               std::to_string(of_this) + " of " + shortened(name));
        count = of_this;
        first = name;
    }
    if (!count)
        resolver.fail(element_of(use), "has no attributes");
    return count;
}

std::vector<GltfPlacement> read_instances(const tinygltf::Model& model, const MeshNode& use,
                                          const AccessorResolver& resolver)
{
    std::vector<GltfPlacement> instances(*instance_count(model, use, resolver));
    const std::vector<double> translations = read_attribute(model, use, "TRANSLATION", 3, resolver);
    const std::vector<double> rotations = read_attribute(model, use, "ROTATION", 4, resolver);
    const std::vector<double> scales = read_attribute(model, use, "SCALE", 3, resolver);
    for (std::size_t i = 0; i < instances.size(); ++i) {
        GltfPlacement& instance = instances[i];
        if (!translations.empty())
            instance.translation = {translations[3 * i], translations[3 * i + 1],
                                    translations[3 * i + 2]};
        if (!rotations.empty()) {
            const double* r = &rotations[4 * i];
            const std::optional<glm::dvec4> rotation = unit_rotation({r[0], r[1], r[2], r[3]});
            if (!rotation)
                resolver.fail(element_of(use) + " ROTATION " + std::to_string(i),
                              "has a length of zero or infinity");
            instance.rotation = *rotation;
        }
        if (!scales.empty())
            instance.scale = {scales[3 * i], scales[3 * i + 1], scales[3 * i + 2]};
    }
    return instances;
}

}  // namespace surfelao

#include "files/gltf_json.h"

#include <nlohmann/json.hpp>

namespace surfelao {

using nlohmann::json;

const json& member(const json& object, const char* key)
{
    static const json none;
    if (!object.is_object())
        return none;
    const auto found = object.find(key);
    return found == object.end() ? none : *found;
}

const json& entry(const json& document, const char* list, const json& index)
{
    static const json none;
    const json& entries = member(document, list);
    if (!entries.is_array() || !index.is_number_unsigned() ||
        index.get<std::size_t>() >= entries.size())
        return none;
    return entries[index.get<std::size_t>()];
}

bool uses(const json& value, const char* key, std::size_t first)
{
    for (const auto& [name, inner] : value.items()) {
        if (name == key && inner.is_number_unsigned() && inner.get<std::size_t>() >= first)
            return true;
        if (inner.is_structured() && uses(inner, key, first))
            return true;
    }
    return false;
}

}  // namespace surfelao

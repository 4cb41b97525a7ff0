#include "files/gltf_cuts.h"

#include "files/gltf_io.h"
#include "files/gltf_json.h"
#include "files/maker_mark.h"
#include "surfels/errors.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <optional>

namespace surfelao {
namespace {

using nlohmann::json;

/// What a cut changes in a primitive.
constexpr const char* kChanged[] = {"attributes", "targets", "indices", "mode", "extras"};

/// Bytes that a vertex may have: more than the attributes of any format of today.
constexpr std::uint64_t kMostVertexBytes = 64;

/// What the attributes and morph targets of a primitive are, by their places in it.
json attributes_of(const json& primitive)
{
    json attributes = json::object();
    for (const char* key : {"attributes", "targets"}) {
        if (primitive.contains(key) && !primitive[key].empty())
            attributes[key] = primitive[key];
    }
    return attributes.empty() ? attributes : attributes.flatten();
}

/// Fowler, Noll, Vo: 1a, 32 bits.
struct Digest {
    std::uint32_t value = 2166136261u;

    void add(std::string_view bytes)
    {
        for (const char byte : bytes)
            value = (value ^ static_cast<unsigned char>(byte)) * 16777619u;
    }
    void add(std::uint64_t number)
    {
        for (int shift = 0; shift < 64; shift += 8)
            value = (value ^ (number >> shift & 0xFF)) * 16777619u;
    }
};

/// u and v in each set.
using CornerPlaces = std::array<float, 2 * kMostCutSets>;

/// Nothing where the corner has no place in any set.
std::optional<CornerPlaces> places_of_corner(const Scene& scene, std::span<const UvSet> sets,
                                             std::size_t triangle, int k)
{
    std::optional<CornerPlaces> places;
    for (std::size_t s = 0; s < sets.size(); ++s) {
        const std::uint32_t place =
            (sets[s].corners.empty() ? scene.triangles : sets[s].corners)[triangle][k];
        if (place == UvSet::kNone)
            continue;
        if (!places)
            places.emplace();  // zeros
        (*places)[2 * s] = static_cast<float>(sets[s].values[place].x);
        (*places)[2 * s + 1] = static_cast<float>(sets[s].values[place].y);
    }
    return places;
}

/// Hands out the vertices of a part.
class PlacedVertices {
public:
    explicit PlacedVertices(std::size_t count)
        : places_(count, CornerPlaces{}), has_place_(count, false)
    {
    }

    /// The one of this vertex and its copies that lies there.
    std::uint32_t at(std::uint32_t vertex, const CornerPlaces& place)
    {
        if (!has_place_[vertex]) {
            has_place_[vertex] = true;
            places_[vertex] = place;
            return vertex;
        }
        if (places_[vertex] == place)
            return vertex;
        const auto [copy, is_new] =
            copies_.try_emplace({vertex, place}, static_cast<std::uint32_t>(places_.size()));
        if (is_new) {
            places_.push_back(place);
            copied.push_back(vertex);
        }
        return copy->second;
    }

    [[nodiscard]] std::vector<float> places(std::size_t set) const
    {
        std::vector<float> numbers;
        numbers.reserve(2 * places_.size());
        for (const CornerPlaces& place : places_)
            numbers.insert(numbers.end(), {place[2 * set], place[2 * set + 1]});
        return numbers;
    }

    std::vector<std::uint32_t> copied;

private:
    std::vector<CornerPlaces> places_;
    std::vector<bool> has_place_;
    std::map<std::pair<std::uint32_t, CornerPlaces>, std::uint32_t> copies_;
};

}  // namespace

GltfCut cut_part(const Scene& scene, const Part& part, const GltfPart& in_file,
                 std::span<const UvSet> sets)
{
    PlacedVertices vertices(part.vertex_count);
    GltfCut cut;
    cut.triangles.reserve(part.triangle_count);
    for (std::uint32_t t = 0; t < part.triangle_count; ++t) {
        glm::uvec3 triangle = scene.triangles[part.first_triangle + t] - part.first_vertex;
        for (int k = 0; k < 3; ++k) {
            if (const auto places = places_of_corner(scene, sets, part.first_triangle + t, k))
                triangle[k] = vertices.at(triangle[k], *places);
        }
        if (in_file.turned[t])
            std::swap(triangle.y, triangle.z);
        cut.triangles.push_back(triangle);
    }
    for (std::size_t s = 0; s < sets.size(); ++s)
        cut.places.push_back(vertices.places(s));
    cut.copied = std::move(vertices.copied);
    return cut;
}

GltfElements::GltfElements(const GltfAsset& asset)
    : asset_(asset),
      resolver_(asset),
      left_(kMostVertexBytes * (kInstancingBase + kInstancingPerByte * asset.byte_count))
{
}

GltfElements::Bytes GltfElements::read(const json& index, const std::string& user)
{
    if (entry(*asset_.document, "accessors", index).is_null())
        resolver_.fail(user, "is no accessor");
    Bytes read{resolver_.resolve(index.get<int>(), user), {}};
    const GltfAccessor& accessor = read.named.accessor;
    if (accessor.count > left_ / accessor.element_bytes)
        resolver_.fail(read.named.element,
                       "brings what is cut to more bytes than a file of this size may stand for");
    left_ -= accessor.count * accessor.element_bytes;
    try {
        read.bytes = read_elements(accessor);
    } catch (const AccessorError& error) {
        resolver_.fail(read.named.element + ":", error.what());
    }
    return read;
}

std::uint32_t GltfElements::digest_of_accessor(const json& index, const std::string& user)
{
    const auto known =
        index.is_number_unsigned() ? digests_.find(index.get<std::size_t>()) : digests_.end();
    if (known != digests_.end())
        return known->second;
    const Bytes read = this->read(index, user);
    const GltfAccessor& accessor = read.named.accessor;
    Digest digest;
    for (const std::uint64_t number :
         {static_cast<std::uint64_t>(accessor.component),
          static_cast<std::uint64_t>(accessor.dimension),
          static_cast<std::uint64_t>(accessor.normalized), std::uint64_t{accessor.count}})
        digest.add(number);
    digest.add(read.bytes);
    return digests_[index.get<std::size_t>()] = digest.value;
}

std::uint32_t GltfElements::digest(const json& primitive)
{
    Digest digest;
    json accessors = attributes_of(primitive);
    if (primitive.contains("indices"))
        accessors["indices"] = primitive["indices"];
    for (const auto& [place, index] : accessors.items()) {
        digest.add(place);
        if (!index.is_structured() && !index.is_null())  // a target may have no attributes
            digest.add(std::uint64_t{digest_of_accessor(index, place)});
    }
    return digest.value;
}

GltfCutter::GltfCutter(json& document, const GltfAsset& asset, AddedData& added)
    : document_(document), added_(added), elements_(asset)
{
}

void GltfCutter::cut(json& primitive, const std::string& element, const GltfCut& cut,
                     std::span<const glm::uvec3> triangles)
{
    json original = json::object();
    for (const char* key : kChanged) {
        if (primitive.contains(key))
            original[key] = primitive[key];
    }
    const std::size_t vertices = cut.places[0].size() / 2;
    const std::size_t number = cuts_.try_emplace(cut.copied, cuts_.size()).first->second;
    const json attributes = attributes_of(primitive);
    for (const auto& [place, index] : attributes.items()) {
        if (!index.is_null())
            primitive[json::json_pointer(place)] =
                extended(index, element + ' ' + place.substr(1), number, cut.copied,
                         vertices - cut.copied.size());
    }
    const std::size_t indices =
        added_.add_indices({&triangles.front().x, 3 * triangles.size()}, vertices);
    mark_replacement(document_["accessors"][indices]);
    primitive["indices"] = indices;
    primitive.erase("mode");  // triangles
    if (!member(primitive, "extras").is_object())
        primitive["extras"] = json::object();
    const std::uint32_t digest = elements_.digest(original);
    primitive["extras"][kMarkKey] = {{"original", std::move(original)}, {"digest", digest}};
}

std::size_t GltfCutter::extended(const json& index, const std::string& user, std::size_t cut,
                                 std::span<const std::uint32_t> copied, std::size_t vertices)
{
    if (index.is_number_unsigned()) {
        const auto known = extended_.find({cut, index.get<std::size_t>()});
        if (known != extended_.end())
            return known->second;
    }
    GltfElements::Bytes read = elements_.read(index, user);
    elements_.check_count(read.named, vertices);
    const std::size_t size = read.named.accessor.element_bytes;
    read.bytes.reserve(read.bytes.size() + copied.size() * size);
    for (const std::uint32_t vertex : copied)
        read.bytes.append(read.bytes, vertex * size, size);
    json accessor = document_["accessors"][index.get<std::size_t>()];
    for (const char* key : {"bufferView", "byteOffset", "sparse"})
        accessor.erase(key);
    mark_replacement(accessor);
    const std::size_t added = added_.add_elements(std::move(accessor), read.bytes, size);
    return extended_[{cut, index.get<std::size_t>()}] = added;
}

namespace {

/// Whether a primitive is what a cut has made of the original.
bool is_cut_of(const json& document, const json& primitive, const json& original,
               const json& digest, GltfElements& elements)
{
    if (!original.is_object() || !digest.is_number_unsigned())
        return false;
    const json now = attributes_of(primitive), before = attributes_of(original);
    if (now.size() != before.size())
        return false;
    for (const auto& [place, index] : now.items()) {
        if (!before.contains(place) ||
            (!index.is_null() && !is_replacement(entry(document, "accessors", index))))
            return false;
    }
    try {
        return elements.digest(original) == digest;
    } catch (const InputError&) {
        return false;
    }
}

/// Takes the marks off a primitive and its accessors.
void make_own(json& document, json& primitive)
{
    primitive["extras"].erase(kMarkKey);
    if (primitive["extras"].empty())
        primitive.erase("extras");
    json accessors = attributes_of(primitive);
    accessors["indices"] = member(primitive, "indices");
    for (const json& index : accessors) {
        if (is_replacement(entry(document, "accessors", index)))
            document["accessors"][index.get<std::size_t>()]["extras"].erase(kMarkKey);
    }
}

}  // namespace

void undo_cut(json& document, json& primitive, GltfElements& elements)
{
    const json mark = member(member(primitive, "extras"), kMarkKey);
    if (!mark.is_object())
        return;
    const json& original = member(mark, "original");
    if (!is_cut_of(document, primitive, original, member(mark, "digest"), elements))
        return make_own(document, primitive);
    for (const char* key : kChanged) {
        primitive.erase(key);
        if (original.contains(key))
            primitive[key] = original[key];
    }
}

}  // namespace surfelao

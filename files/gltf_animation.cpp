#include "files/gltf_animation.h"

#include "files/gltf_io.h"
#include "surfels/number_text.h"

#include <glm/geometric.hpp>

#include <tiny_gltf.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>

namespace surfelao {
namespace {

/// Below this angle, in radians, an arc is as good as its chord.
constexpr double kShortArc = 1e-6;

glm::dvec4 quaternion(std::span<const double> values)
{
    return {values[0], values[1], values[2], values[3]};
}

std::vector<double> along_arc(glm::dvec4 from, glm::dvec4 to, double share)
{
    if (glm::dot(from, to) < 0.0)
        to = -to;
    const double cosine = glm::dot(from, to) / (glm::length(from) * glm::length(to));
    const double angle = std::acos(std::clamp(cosine, -1.0, 1.0));
    const glm::dvec4 at =
        !(angle > kShortArc)
            ? from + share * (to - from)
            : (std::sin((1.0 - share) * angle) * from + std::sin(share * angle) * to) /
                  std::sin(angle);
    return {at.x, at.y, at.z, at.w};
}

/// The animation that a user names: by its number, else by its name.
std::size_t find_animation(const tinygltf::Model& model, const AccessorResolver& resolver,
                           const std::string& name)
{
    const std::size_t count = model.animations.size();
    if (count == 0)
        resolver.fail("", "has no animation");
    if (name.empty())
        return 0;
    for (std::size_t i = 0; i < count; ++i) {
        if (model.animations[i].name == name)
            return i;
    }
    std::size_t number = 0;
    const auto end = name.data() + name.size();
    const auto [rest, error] = std::from_chars(name.data(), end, number);
    if (error == std::errc() && rest == end && number < count)
        return number;
    std::string known;
    for (std::size_t i = 0; i < std::min<std::size_t>(count, 8); ++i)
        known += " \"" + shortened(model.animations[i].name) + '"';
    resolver.fail("", "has no animation \"" + shortened(name) + "\", but" + known +
                          (count > 8 ? " and others" : ""));
}

std::vector<double> numbers_of(const NamedAccessor& named, const AccessorResolver& resolver)
{
    try {
        return read_numbers(named.accessor);
    } catch (const AccessorError& error) {
        resolver.fail(named.element + ":", error.what());
    }
}

KeyBlend blend_of(const std::string& text, const AccessorResolver& resolver,
                  const std::string& element)
{
    if (text == "STEP")
        return KeyBlend::step;
    if (text == "CUBICSPLINE")
        return KeyBlend::cubic;
    if (text != "LINEAR")
        resolver.fail(element, "has the unknown interpolation \"" + shortened(text) + '"');
    return KeyBlend::linear;
}

/// width 0: as many a key as there are (weights).
KeyFrames keys_of(const tinygltf::AnimationSampler& sampler, const std::string& element,
                  std::size_t width, const AccessorResolver& resolver)
{
    KeyFrames keys;
    const NamedAccessor input = resolver.resolve(sampler.input, element + " input");
    const NamedAccessor output = resolver.resolve(sampler.output, element + " output");
    keys.blend = blend_of(sampler.interpolation, resolver, element);
    keys.seconds = numbers_of(input, resolver);
    keys.values = numbers_of(output, resolver);
    if (input.accessor.dimension != 1)
        resolver.fail(input.element, "does not hold times");
    if (keys.seconds.empty())
        resolver.fail(input.element, "holds no time");
    for (std::size_t k = 1; k < keys.seconds.size(); ++k) {
        if (!(keys.seconds[k] > keys.seconds[k - 1]))
            resolver.fail(input.element + ":",
                          "time " + std::to_string(k) + " is not later than the one before");
    }
    const std::size_t slots = keys.seconds.size() * (keys.blend == KeyBlend::cubic ? 3 : 1);
    keys.width = width == 0 ? keys.values.size() / slots : width;
    if (keys.width == 0 || keys.values.size() != slots * keys.width ||
        (width != 0 && output.accessor.dimension != static_cast<int>(width)))
        resolver.fail(
            output.element,
            "does not fit the " + count_text(keys.seconds.size(), "time") + " of its sampler");
    return keys;
}

std::optional<NodeValue> value_of(const std::string& path)
{
    if (path == "translation")
        return NodeValue::translation;
    if (path == "rotation")
        return NodeValue::rotation;
    if (path == "scale")
        return NodeValue::scale;
    if (path == "weights")
        return NodeValue::weights;
    return std::nullopt;
}

/// 0: as many a key as there are.
std::size_t width_of(NodeValue value)
{
    return value == NodeValue::weights ? 0 : (value == NodeValue::rotation ? 4 : 3);
}

/// Numbers that a sampler's keys take.
std::uint64_t key_count(const tinygltf::AnimationSampler& sampler, const std::string& element,
                        const AccessorResolver& resolver)
{
    const GltfAccessor times = resolver.resolve(sampler.input, element + " input").accessor;
    const GltfAccessor values = resolver.resolve(sampler.output, element + " output").accessor;
    return times.count + values.count * static_cast<std::uint64_t>(values.dimension);
}

}  // namespace

std::vector<double> sample(const KeyFrames& keys, double seconds)
{
    const bool is_cubic = keys.blend == KeyBlend::cubic;
    const std::size_t stride = keys.width * (is_cubic ? 3 : 1);
    // slot: of a cubic key 0 = in-tangent, 1 = value, 2 = out-tangent
    const auto at = [&](std::size_t key, std::size_t slot) {
        return std::span(keys.values).subspan(key * stride + slot * keys.width, keys.width);
    };
    const std::size_t value = is_cubic ? 1 : 0;
    const auto next = std::ranges::upper_bound(keys.seconds, seconds);
    const auto after = static_cast<std::size_t>(next - keys.seconds.begin());
    const std::size_t before = after == 0 ? 0 : after - 1;
    const std::span<const double> from = at(before, value);
    if (after == 0 || after == keys.seconds.size() || keys.blend == KeyBlend::step)
        return {from.begin(), from.end()};

    const std::span<const double> to = at(after, value);
    const double length = keys.seconds[after] - keys.seconds[before];
    const double t = (seconds - keys.seconds[before]) / length;
    if (keys.is_rotation && !is_cubic)
        return along_arc(quaternion(from), quaternion(to), t);
    std::vector<double> result(keys.width);
    for (std::size_t i = 0; i < keys.width; ++i)
        result[i] = from[i] + t * (to[i] - from[i]);
    if (!is_cubic)
        return result;
    const std::span<const double> out = at(before, 2), in = at(after, 0);
    for (std::size_t i = 0; i < keys.width; ++i)
        result[i] = (2 * t * t * t - 3 * t * t + 1) * from[i] +
                    length * (t * t * t - 2 * t * t + t) * out[i] +
                    (3 * t * t - 2 * t * t * t) * to[i] + length * (t * t * t - t * t) * in[i];
    return result;
}

GltfAnimation read_animation(const tinygltf::Model& model, const AccessorResolver& resolver,
                             const std::string& name)
{
    GltfAnimation read;
    read.number = find_animation(model, resolver, name);
    const tinygltf::Animation& animation = model.animations[read.number];
    read.name = animation.name;
    const std::string element = numbered("animation", read.number);
    const std::uint64_t limit = kInstancingBase + kInstancingPerByte * resolver.byte_count();
    std::uint64_t amount = 0;
    std::map<std::pair<int, NodeValue>, std::size_t> known;  // channels that share a sampler
    for (const tinygltf::AnimationChannel& channel : animation.channels) {
        const auto node = static_cast<std::size_t>(channel.target_node);
        const std::optional<NodeValue> value = value_of(channel.target_path);
        if (!value)
            continue;
        if (*value != NodeValue::weights && !model.nodes[node].matrix.empty())
            resolver.fail(numbered("node", node), "has a matrix, but " + element + " moves it");
        const auto [entry, is_new] = known.try_emplace({channel.sampler, *value}, read.keys.size());
        if (is_new) {
            const auto sampler = static_cast<std::size_t>(channel.sampler);
            const std::string place = element + ' ' + numbered("sampler", sampler);
            const std::uint64_t keys = key_count(animation.samplers[sampler], place, resolver);
            // each is below 2^53: it is a number of JSON
            if (keys > limit || (amount += keys) > limit)
                resolver.fail(place, "brings the animation to more than " + std::to_string(limit) +
                                         " numbers, far more than a file of this size may stand "
                                         "for");
            read.keys.push_back(
                keys_of(animation.samplers[sampler], place, width_of(*value), resolver));
            read.keys.back().is_rotation = *value == NodeValue::rotation;
        }
        read.channels.push_back({node, *value, entry->second});
    }
    return read;
}

void pose_nodes(std::vector<tinygltf::Node>& nodes, const GltfAnimation& animation, double seconds)
{
    for (const GltfAnimation::Channel& channel : animation.channels) {
        tinygltf::Node& node = nodes[channel.node];
        std::vector<double>& moved = channel.value == NodeValue::translation ? node.translation
                                     : channel.value == NodeValue::rotation  ? node.rotation
                                     : channel.value == NodeValue::scale     ? node.scale
                                                                             : node.weights;
        moved = sample(animation.keys[channel.keys], seconds);
    }
}

std::string pose_text(const GltfAnimation& animation, double seconds)
{
    const std::string name =
        animation.name.empty() ? std::string() : " \"" + shortened(animation.name) + '"';
    return numbered("animation", animation.number) + name + " at " + exact(seconds) + " s";
}

std::string pose_model(tinygltf::Model& model, const AccessorResolver& resolver,
                       const Moment& moment)
{
    const GltfAnimation animation = read_animation(model, resolver, moment.animation);
    pose_nodes(model.nodes, animation, moment.seconds);
    return pose_text(animation, moment.seconds);
}

}  // namespace surfelao

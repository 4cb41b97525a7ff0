/// gltf_animation.h: a glTF at a moment of one of its animations. Internal to the glTF reader.
#pragma once

#include "files/gltf_resolve.h"
#include "files/scene_io.h"

#include <glm/vec4.hpp>

#include <span>
#include <string>
#include <vector>

namespace tinygltf {
class Model;
class Node;
}  // namespace tinygltf

namespace surfelao {

/// How values between keys come about. Rotations are quaternions x y z w.
enum class KeyBlend {
    step,    ///< the last key's
    linear,  ///< in between; of rotations along the shorter arc, at a steady speed
    cubic,   ///< a Hermite spline through the keys, whose tangents are per second; rotations are
             ///< brought to unit length afterwards (whoever places them does that)
};

/// Keys over time. values: `width` numbers a key; cubic: three times as many: in-tangent, value,
/// out-tangent.
struct KeyFrames {
    std::vector<double> seconds;  ///< rising, not empty
    std::vector<double> values;
    std::size_t width = 0;
    KeyBlend blend = KeyBlend::linear;
    bool is_rotation = false;  ///< width 4
};

/// The values at a time, the first or last key's before and behind all of them. O(log keys).
/// glTF 2.0, appendix C (the formulas).
[[nodiscard]] std::vector<double> sample(const KeyFrames& keys, double seconds);

/// What of a node an animation moves.
enum class NodeValue { translation, rotation, scale, weights };

/// An animation, checked, with its keys read.
struct GltfAnimation {
    struct Channel {
        std::size_t node = 0;
        NodeValue value = NodeValue::translation;
        std::size_t keys = 0;  ///< into `keys`
    };
    std::size_t number = 0;  ///< in its file
    std::string name;        ///< as in the file
    std::vector<KeyFrames> keys;
    std::vector<Channel> channels;
};

/// The animation that a user names: by its name, else by its number; empty: the first. Channels of
/// other paths are left out. Throws InputError where the file has no such animation, or it is
/// malformed: keys that are not finite or not rising, too few values, a node that has a matrix,
/// more keys by repetition than a file of its size may stand for (kInstancingBase). O(keys).
[[nodiscard]] GltfAnimation read_animation(const tinygltf::Model& model,
                                           const AccessorResolver& resolver,
                                           const std::string& name);

/// Gives nodes the translations, rotations, scales and weights that the animation has then; nodes
/// that it does not move stay as they are. O(channels * log keys).
void pose_nodes(std::vector<tinygltf::Node>& nodes, const GltfAnimation& animation, double seconds);

/// "animation 0 "Walk" at 1.5 s"
[[nodiscard]] std::string pose_text(const GltfAnimation& animation, double seconds);

/// Both. Returns what was played, for notes.
std::string pose_model(tinygltf::Model& model, const AccessorResolver& resolver,
                       const Moment& moment);

}  // namespace surfelao

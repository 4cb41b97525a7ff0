/// part_file.h: what one machine of several has solved: a share of a bake's receivers.
///
/// CBOR (RFC 8949), one map: format, version, mark (files/maker_mark.h, of the whole bake), input,
/// output, arguments, share and shares, question (hash), receivers (of all shares), surfels,
/// residual, and as byte strings the solved receivers' indices and answers, little-endian, with a
/// checksum. Says of a single bake all that `merge` needs but the mesh itself.
#pragma once

#include "surfels/geometry.h"
#include "surfels/occlusion.h"
#include "surfels/receiver.h"
#include "surfels/share.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace surfelao {

inline constexpr std::uint32_t kMostShares = 1'000'000;

/// Which question is answered: 128 bits over what occludes and what is asked.
using QuestionHash = std::array<std::uint64_t, 2>;
[[nodiscard]] QuestionHash question_of(const Geometry& occluding,
                                       std::span<const Receiver> receivers);

struct PartFile {
    std::string mark;                    ///< of the bake
    std::filesystem::path input;         ///< absolute
    std::filesystem::path output;        ///< absolute: of the whole bake
    std::vector<std::string> arguments;  ///< of its command line, without these
    Share share;
    QuestionHash question = {};
    std::uint64_t receivers = 0;  ///< of all shares
    std::uint64_t surfels = 0;
    std::optional<double> residual;
    std::vector<std::uint32_t> solved;  ///< ascending, below `receivers`
    std::vector<Occlusion> answers;     ///< one per solved
};

/// Where a share's answers go: "baked.glb.3-of-7.part" for "baked.glb".
[[nodiscard]] std::filesystem::path part_path(const std::filesystem::path& output,
                                              const Share& share);

/// Atomically. Throws as write_atomically().
void write_part(const std::filesystem::path& path, const PartFile& part);

/// Throws InputError, one sentence, for what is no part, cut, damaged or contradicts itself.
[[nodiscard]] PartFile read_part(const std::filesystem::path& path);

/// The answers of a whole bake.
struct MergedAnswers {
    QuestionHash question = {};
    std::vector<Occlusion> answers;  ///< one per receiver: kUnsolved where there is no normal
    std::uint64_t surfels = 0;
    std::optional<double> residual;
};

/// Joins all shares of one bake, in any order. paths: of the parts, for messages. Throws InputError
/// for parts of different bakes, a share that is there twice or missing, and a receiver that two
/// shares answer.
[[nodiscard]] MergedAnswers merge_parts(std::span<const std::filesystem::path> paths,
                                        std::span<const PartFile> parts);

}  // namespace surfelao

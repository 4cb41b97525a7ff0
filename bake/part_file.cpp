#include "bake/part_file.h"

#include "surfels/atomic_file.h"
#include "surfels/content_hash.h"
#include "surfels/errors.h"

#include <nlohmann/json.hpp>

#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>

namespace surfelao {
namespace {

namespace fs = std::filesystem;
using Cbor = nlohmann::json;

constexpr int kVersion = 1;
constexpr const char* kName = "surfelao part";

static_assert(std::endian::native == std::endian::little);
static_assert(sizeof(Occlusion) == 16);

template <class T>
Cbor bytes_of(const std::vector<T>& values)
{
    const auto* first = reinterpret_cast<const std::uint8_t*>(values.data());
    return Cbor::binary(std::vector<std::uint8_t>(first, first + values.size() * sizeof(T)));
}

template <class T>
std::vector<T> values_of(const Cbor& bytes)
{
    const Cbor::binary_t& binary = bytes.get_binary();
    std::vector<T> values(binary.size() / sizeof(T));
    std::memcpy(values.data(), binary.data(), values.size() * sizeof(T));
    return values;
}

std::uint64_t checksum_of(const PartFile& part)
{
    ContentHash hash;
    hash.add(std::span<const std::uint32_t>(part.solved));
    hash.add(std::span<const Occlusion>(part.answers));
    return hash.high();
}

/// What nlohmann's parser refuses, and what no bake writes.
PartFile part_of(const Cbor& cbor)
{
    const auto check = [](bool holds) {
        if (!holds)
            throw std::invalid_argument("contradicts itself");
    };
    check(cbor.at("format").get<std::string>() == kName && cbor.at("version") == kVersion);
    PartFile part;
    part.mark = cbor.at("mark").get<std::string>();
    part.input = cbor.at("input").get<std::string>();
    part.output = cbor.at("output").get<std::string>();
    part.arguments = cbor.at("arguments").get<std::vector<std::string>>();
    part.share = {cbor.at("share").get<std::uint32_t>(), cbor.at("shares").get<std::uint32_t>()};
    part.question = cbor.at("question").get<QuestionHash>();
    part.receivers = cbor.at("receivers").get<std::uint64_t>();
    part.surfels = cbor.at("surfels").get<std::uint64_t>();
    if (!cbor.at("residual").is_null())
        part.residual = cbor.at("residual").get<double>();
    part.solved = values_of<std::uint32_t>(cbor.at("solved"));
    part.answers = values_of<Occlusion>(cbor.at("answers"));
    check(part.share.count >= 1 && part.share.count <= kMostShares);
    check(part.share.index < part.share.count);
    check(part.solved.size() == part.answers.size() && part.solved.size() <= part.receivers);
    for (std::size_t i = 0; i < part.solved.size(); ++i)
        check(part.solved[i] < part.receivers && (i == 0 || part.solved[i - 1] < part.solved[i]));
    check(cbor.at("checksum").get<std::uint64_t>() == checksum_of(part));
    return part;
}

}  // namespace

QuestionHash question_of(const Geometry& occluding, std::span<const Receiver> receivers)
{
    ContentHash hash;
    hash.add(std::span<const glm::vec3>(occluding.positions));
    hash.add(std::span<const glm::uvec3>(occluding.triangles));
    hash.add(receivers);
    return {hash.high(), hash.low()};
}

fs::path part_path(const fs::path& output, const Share& share)
{
    fs::path path = output;
    path += "." + std::to_string(share.index + 1) + "-of-" + std::to_string(share.count) + ".part";
    return path;
}

void write_part(const fs::path& path, const PartFile& part)
{
    Cbor cbor;
    cbor["format"] = kName;
    cbor["version"] = kVersion;
    cbor["mark"] = part.mark;
    cbor["input"] = part.input.string();
    cbor["output"] = part.output.string();
    cbor["arguments"] = part.arguments;
    cbor["share"] = part.share.index;
    cbor["shares"] = part.share.count;
    cbor["question"] = part.question;
    cbor["receivers"] = part.receivers;
    cbor["surfels"] = part.surfels;
    cbor["residual"] = part.residual ? Cbor(*part.residual) : Cbor();
    cbor["solved"] = bytes_of(part.solved);
    cbor["answers"] = bytes_of(part.answers);
    cbor["checksum"] = checksum_of(part);
    std::string bytes;
    Cbor::to_cbor(cbor, bytes);
    write_atomically(path, bytes);
}

PartFile read_part(const fs::path& path)
{
    std::ifstream file(path, std::ios::binary);
    if (!file)
        throw InputError(path.string() + ": no such file");
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    try {
        return part_of(Cbor::from_cbor(bytes));
    } catch (const Cbor::exception&) {
    } catch (const std::invalid_argument&) {
    }
    throw InputError(path.string() + ": is no part of a bake, or is damaged");
}

MergedAnswers merge_parts(std::span<const fs::path> paths, std::span<const PartFile> parts)
{
    const PartFile& first = parts.front();
    std::vector<std::size_t> at(first.share.count, parts.size());  // the part of each share
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const PartFile& part = parts[i];
        if (part.mark != first.mark || part.question != first.question ||
            part.arguments != first.arguments || part.share.count != first.share.count ||
            part.receivers != first.receivers)
            throw InputError(paths[i].string() + ": belongs to another bake than " +
                             paths[0].string());
        if (std::size_t& there = at[part.share.index]; there == parts.size())
            there = i;
        else
            throw InputError(paths[i].string() + ": is share " +
                             std::to_string(part.share.index + 1) + " as " + paths[there].string() +
                             " is");
    }
    for (std::size_t share = 0; share < at.size(); ++share)
        if (at[share] == parts.size())
            throw InputError("share " + std::to_string(share + 1) + " of " +
                             std::to_string(at.size()) +
                             " is missing: " + std::to_string(parts.size()) + " parts were given");
    MergedAnswers merged{first.question, std::vector<Occlusion>(first.receivers, kUnsolved),
                         first.surfels, first.residual};
    std::vector<bool> is_solved(first.receivers, false);
    for (std::size_t i = 0; i < parts.size(); ++i) {
        for (std::size_t k = 0; k < parts[i].solved.size(); ++k) {
            const std::uint32_t receiver = parts[i].solved[k];
            if (is_solved[receiver])
                throw InputError(paths[i].string() + ": answers what another share answers too");
            is_solved[receiver] = true;
            merged.answers[receiver] = parts[i].answers[k];
        }
    }
    return merged;
}

}  // namespace surfelao

#include "reference/reference_cache.h"

#include "reference/rays.h"
#include "reference/well_defined.h"
#include "surfels/atomic_file.h"
#include "surfels/errors.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <optional>
#include <string>
#include <type_traits>

namespace surfelao {
namespace {

namespace fs = std::filesystem;

/// Counts up whenever rays, layout or rule change: old files are then nobody's answer.
constexpr std::uint64_t kVersion = 4;

/// Seeds of the two halves. Neither is the opponents' seed 0, so that no error of theirs is hidden
/// by being ours too.
constexpr std::uint32_t kFirstSeed = 0x51A7E001, kSecondSeed = 0x51A7E002;

/// What placement_change costs, in rays a receiver; for an even progress only.
constexpr double kPlacementRays = 1280.0;

/// 128 bits over words of 64: two multiplicative hashes with different odd constants.
class ContentHash {
public:
    template <class T>
    void add(std::span<const T> values)
    {
        static_assert(std::is_trivially_copyable_v<T>);
        add_word(values.size_bytes());
        const char* bytes = reinterpret_cast<const char*>(values.data());
        for (std::size_t at = 0; at < values.size_bytes(); at += 8) {
            std::uint64_t word = 0;
            std::memcpy(&word, bytes + at, std::min<std::size_t>(8, values.size_bytes() - at));
            add_word(word);
        }
    }
    void add_word(std::uint64_t word)
    {
        high_ = std::rotl((high_ ^ word) * 0x9E3779B97F4A7C15u, 31);
        low_ = std::rotl((low_ ^ word) * 0xD6E8FEB86659FD93u, 29);
    }
    std::uint64_t high() const { return high_ ^ high_ >> 32; }
    std::uint64_t low() const { return low_ ^ low_ >> 32; }

private:
    std::uint64_t high_ = 0x243F6A8885A308D3u, low_ = 0x13198A2E03707344u;  // digits of pi
};

ContentHash key_of(const Geometry& geometry, std::span<const Receiver> receivers,
                   const ReferenceOptions& options)
{
    ContentHash hash;
    hash.add_word(kVersion);
    hash.add(std::span(geometry.positions));
    hash.add(std::span(geometry.triangles));
    hash.add(receivers);
    hash.add_word(std::bit_cast<std::uint32_t>(options.definition.max_distance));
    hash.add_word(static_cast<std::uint64_t>(options.definition.falloff));
    hash.add_word(static_cast<std::uint64_t>(options.definition.kernel));
    if (const auto& ground = options.definition.ground) {
        for (const float value : {ground->up.x, ground->up.y, ground->up.z, ground->height})
            hash.add_word(std::bit_cast<std::uint32_t>(value));
    }
    hash.add_word(options.rays);
    hash.add_word(options.find_ill_defined);
    return hash;
}

/// A cache file: header, occlusion, half_difference, change. Machine's byte order: a cache does not
/// travel.
struct Header {
    char magic[8] = {'S', 'U', 'R', 'F', 'R', 'E', 'F', '\n'};
    std::uint64_t version = kVersion;
    std::uint64_t key_high = 0, key_low = 0;
    std::uint64_t count = 0;
    double noise = 0.0;
    std::uint64_t check_high = 0, check_low = 0;  ///< of noise and all behind the header
};

std::uint64_t file_size_of(std::uint64_t count, bool with_change)
{
    return sizeof(Header) + count * (sizeof(Occlusion) + (with_change ? 2 : 1) * sizeof(float));
}

ContentHash check_of(const Reference& reference)
{
    ContentHash hash;
    hash.add(std::span<const Occlusion>(reference.occlusion));
    hash.add(std::span<const float>(reference.half_difference));
    hash.add(std::span<const float>(reference.change));
    hash.add_word(std::bit_cast<std::uint64_t>(reference.noise));
    return hash;
}

template <class T>
void read_list(std::istream& file, std::vector<T>& list, std::size_t count)
{
    list.resize(count);
    file.read(reinterpret_cast<char*>(list.data()),
              static_cast<std::streamsize>(count * sizeof(T)));
}

template <class T>
void write_list(std::ostream& file, const std::vector<T>& list)
{
    file.write(reinterpret_cast<const char*>(list.data()),
               static_cast<std::streamsize>(list.size() * sizeof(T)));
}

std::optional<Reference> load(const fs::path& path, const ContentHash& key, std::size_t count,
                              bool with_change)
{
    std::error_code error;
    if (fs::file_size(path, error) != file_size_of(count, with_change) || error)
        return std::nullopt;
    std::ifstream file(path, std::ios::binary);
    Header header;
    const Header wanted;
    file.read(reinterpret_cast<char*>(&header), sizeof header);
    if (!file || std::memcmp(header.magic, wanted.magic, sizeof header.magic) != 0 ||
        header.version != kVersion || header.key_high != key.high() ||
        header.key_low != key.low() || header.count != count)
        return std::nullopt;

    Reference reference;
    read_list(file, reference.occlusion, count);
    read_list(file, reference.half_difference, count);
    read_list(file, reference.change, with_change ? count : 0);
    reference.noise = header.noise;
    reference.from_cache = true;
    const ContentHash check = check_of(reference);
    if (!file || check.high() != header.check_high || check.low() != header.check_low)
        return std::nullopt;
    return reference;
}

/// Removes the oldest files until `coming` more bytes fit.
void make_room(const fs::path& folder, std::uint64_t coming)
{
    struct File {
        fs::file_time_type time;
        std::uint64_t size;
        fs::path path;
    };
    std::vector<File> files;
    std::uint64_t total = coming;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
        if (entry.path().extension() == ".reference") {
            files.push_back({entry.last_write_time(), entry.file_size(), entry.path()});
            total += files.back().size;
        }
    }
    std::sort(files.begin(), files.end(),
              [](const File& a, const File& b) { return a.time < b.time; });
    for (std::size_t i = 0; i < files.size() && total > kCacheBytes; ++i) {
        fs::remove(files[i].path);
        total -= files[i].size;
    }
}

/// The cache is a convenience: whatever goes wrong with it, the reference is at hand.
void store(const fs::path& path, const ContentHash& key, const Reference& reference)
try {
    const std::uint64_t size = file_size_of(reference.occlusion.size(), !reference.change.empty());
    if (size > kCacheBytes)
        return;
    fs::create_directories(path.parent_path());
    make_room(path.parent_path(), size);
    const ContentHash check = check_of(reference);
    Header header;
    header.key_high = key.high();
    header.key_low = key.low();
    header.count = reference.occlusion.size();
    header.noise = reference.noise;
    header.check_high = check.high();
    header.check_low = check.low();
    write_atomically(path, [&](const fs::path& temporary) {
        std::ofstream file(temporary, std::ios::binary);
        file.write(reinterpret_cast<const char*>(&header), sizeof header);
        write_list(file, reference.occlusion);
        write_list(file, reference.half_difference);
        write_list(file, reference.change);
        file.close();
        if (!file)
            throw std::runtime_error("cannot write " + temporary.string());
    });
} catch (const std::exception&) {
}

/// The share of the whole job that each part is, for one steady progress.
Progress part_of(const Progress& progress, double from, double to)
{
    if (!progress)
        return {};
    return [=](double done) { return progress(from + (to - from) * done); };
}

Reference trace(const Geometry& geometry, std::span<const Receiver> receivers,
                const ReferenceOptions& options, const Progress& progress)
{
    const RayScene scene(geometry, RayScene::Build::robust);
    const double placement = options.find_ill_defined ? kPlacementRays : 0.0;
    const double half = 0.5 * options.rays / (options.rays + placement);

    // two independent halves; their mean is the reference, their difference tells its noise
    RayOptions rays{options.definition, options.rays / 2, kFirstSeed};
    const std::vector<Occlusion> first =
        trace_occlusion(scene, receivers, rays, part_of(progress, 0.0, half));
    rays.seed = kSecondSeed;
    const std::vector<Occlusion> second =
        trace_occlusion(scene, receivers, rays, part_of(progress, half, 2.0 * half));
    Reference reference;
    reference.occlusion.resize(receivers.size());
    reference.half_difference.resize(receivers.size());
    double squares = 0.0;
    for (std::size_t i = 0; i < receivers.size(); ++i) {
        const float difference = 0.5f * (first[i].occlusion - second[i].occlusion);
        reference.half_difference[i] = difference;
        squares += static_cast<double>(difference) * difference;
        const glm::vec3 bent = first[i].bent_normal + second[i].bent_normal;
        const float length = glm::length(bent);
        reference.occlusion[i] = {0.5f * (first[i].occlusion + second[i].occlusion),
                                  length > 0.0f ? bent / length : receivers[i].normal};
    }
    reference.noise =
        receivers.empty() ? 0.0 : std::sqrt(squares / static_cast<double>(receivers.size()));

    if (options.find_ill_defined) {
        reference.change = placement_change(scene, receivers, options.definition,
                                            part_of(progress, 2.0 * half, 1.0));
    }
    return reference;
}

}  // namespace

fs::path cache_folder()
{
    // the XDG base directory specification ignores relative paths
    if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache != nullptr && cache[0] == '/')
        return fs::path(cache) / "surfelao";
    if (const char* home = std::getenv("HOME"); home != nullptr && home[0] == '/')
        return fs::path(home) / ".cache" / "surfelao";
    return {};
}

Reference trace_reference(const Geometry& geometry, std::span<const Receiver> receivers,
                          const ReferenceOptions& options, const Progress& progress)
{
    check_definition(options.definition);
    require(
        options.rays >= 2 && options.rays <= kMostRays && options.rays % 2 == 0,
        "rays of the reference must be an even number between 2 and " + std::to_string(kMostRays));
    const fs::path folder = options.use_cache ? cache_folder() : fs::path();
    if (folder.empty())
        return trace(geometry, receivers, options, progress);

    const ContentHash key = key_of(geometry, receivers, options);
    char name[48];
    std::snprintf(name, sizeof name, "%016llx%016llx.reference",
                  static_cast<unsigned long long>(key.high()),
                  static_cast<unsigned long long>(key.low()));
    if (std::optional<Reference> cached =
            load(folder / name, key, receivers.size(), options.find_ill_defined))
        return *std::move(cached);
    Reference reference = trace(geometry, receivers, options, progress);
    store(folder / name, key, reference);
    return reference;
}

}  // namespace surfelao

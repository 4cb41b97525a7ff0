#include "cli/frame_options.h"

#include "cli/commands.h"
#include "cli/value_checks.h"
#include "files/file_type.h"

#include <CLI/CLI.hpp>

#include <charconv>
#include <cstdint>

namespace surfelao {
namespace {

/// Numbers of frames, and so many of them at once.
constexpr std::uint32_t kLastFrame = 1'000'000, kMostFrames = 100'000;
constexpr std::size_t kMostDigits = 9;

/// A file name around the number of a frame.
struct NamePattern {
    std::string before, after;
    std::size_t digits = 1;  ///< at least; shorter numbers have zeros in front
};

NamePattern pattern_of(const std::string& text)
{
    for (std::size_t at = text.find('%'); at != std::string::npos; at = text.find('%', at + 1)) {
        std::size_t digits = 0;
        const char* const end = text.data() + text.size();
        const auto [rest, error] = std::from_chars(text.data() + at + 1, end, digits);
        const bool has_digits = error == std::errc();
        const char* const letter = has_digits ? rest : text.data() + at + 1;
        if (letter != end && *letter == 'd' && digits <= kMostDigits)
            return {text.substr(0, at), std::string(letter + 1, end), has_digits ? digits : 1};
    }
    throw UsageError("-o: frames go to as many files: name them as in \"f.%04d.png\".");
}

std::string name_of_frame(const NamePattern& pattern, std::uint32_t frame)
{
    std::string number = std::to_string(frame);
    if (number.size() < pattern.digits)
        number.insert(0, pattern.digits - number.size(), '0');
    return pattern.before + number + pattern.after;
}

struct FrameRange {
    std::uint32_t first = 0, last = 0;
};

FrameRange range_of(const FrameOptions& options, std::span<const std::string> inputs)
{
    const FileType type = type_of(inputs.front());
    if (inputs.size() != 1 || (type != FileType::gltf && type != FileType::glb))
        throw UsageError("--frames is for a single .gltf or .glb.");
    const char* const end = options.frames->data() + options.frames->size();
    FrameRange range;
    const auto one = std::from_chars(options.frames->data(), end, range.first);
    const bool has_second = one.ec == std::errc() && one.ptr != end && *one.ptr == ':';
    const auto two = has_second ? std::from_chars(one.ptr + 1, end, range.last) : one;
    if (!has_second || two.ec != std::errc() || two.ptr != end || range.first > range.last ||
        range.last > kLastFrame || range.last - range.first >= kMostFrames)
        throw UsageError("--frames: \"" + *options.frames +
                         "\" is not A:B with whole numbers A up to B.");
    return range;
}

}  // namespace

void add_frame_options(CLI::App& command, FrameOptions& options, const std::string& help)
{
    CLI::Option* const frames = command.add_option("--frames", options.frames, help)
                                    ->type_name("A:B")
                                    ->excludes(command.get_option("--time"));
    command.add_option("--fps", options.fps, "Frames a second")
        ->check(number_from(1e-3, 1e4))
        ->needs(frames)
        ->type_name("F")
        ->capture_default_str();
}

std::vector<double> seconds_of(const FrameOptions& options, std::span<const std::string> inputs)
{
    std::vector<double> seconds;
    if (!options.frames)
        return seconds;
    const FrameRange range = range_of(options, inputs);
    for (std::uint32_t frame = range.first; frame <= range.last; ++frame)
        seconds.push_back(static_cast<double>(frame) / options.fps);
    return seconds;
}

std::vector<FrameFile> frames_of(const FrameOptions& options, std::span<const std::string> inputs,
                                 const std::string& pattern, const ReadOptions& reading)
{
    if (!options.frames)
        return {};
    const FrameRange range = range_of(options, inputs);
    const std::string animation = reading.moment.value_or(Moment{}).animation;
    const NamePattern name = pattern_of(pattern);
    std::vector<FrameFile> files;
    for (std::uint32_t frame = range.first; frame <= range.last; ++frame)
        files.push_back(
            {{static_cast<double>(frame) / options.fps, animation}, name_of_frame(name, frame)});
    return files;
}

}  // namespace surfelao

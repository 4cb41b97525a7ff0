#include "image/image_module.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cstdint>
#include <exception>
#include <memory>
#include <vector>

namespace surfelao {
namespace {

constexpr std::int64_t kMaxPixels = std::int64_t{1} << 28;  // 4 GiB as floats: 23,000 x 11,500
constexpr int kJpegQuality = 95;

/// Why a picture of such a size is not read; empty where it is.
std::string fault_of_size(const OIIO::ImageSpec& spec)
{
    if (spec.width < 1 || spec.height < 1 || spec.nchannels < 1)
        return "it holds no pixels";
    if (std::int64_t{spec.width} * spec.height > kMaxPixels)
        return "it has " + std::to_string(spec.width) + " x " + std::to_string(spec.height) +
               " pixels, more than 2^28";
    return {};
}

/// From the file, or from `memory`: then in that format of OpenImageIO's, where it is told.
std::string read(const std::string& path, Image& image, OIIO::Filesystem::IOProxy* memory = nullptr,
                 const std::string& format = {})
{
    OIIO::ImageSpec wishes;
    wishes.attribute("oiio:UnassociatedAlpha", 1);
    // ImageInput::open() says of some pictures in memory that it cannot open the file
    const std::unique_ptr<OIIO::ImageInput> input =
        format.empty() ? OIIO::ImageInput::open(path, &wishes, memory)
                       : OIIO::ImageInput::create(format);
    if (!input)
        return OIIO::geterror();
    OIIO::ImageSpec spec = input->spec();
    if (!format.empty() && (!input->set_ioproxy(memory) || !input->open(path, spec, wishes)))
        return input->has_error() ? input->geterror() : "is no " + format;
    if (std::string fault = fault_of_size(spec); !fault.empty())
        return fault;

    const int channels = std::min(spec.nchannels, 4);
    Image result(spec.width, spec.height, glm::vec4(0.0f, 0.0f, 0.0f, 1.0f));
    std::vector<float> values(result.pixels.size() * static_cast<std::size_t>(channels));
    if (!input->read_image(0, 0, 0, channels, OIIO::TypeDesc::FLOAT, values.data()))
        return input->geterror();

    const bool is_grey = channels < 3;
    const bool has_alpha = channels == 2 || channels == 4;
    const bool is_srgb = !spec.format.is_floating_point();
    const bool is_straight = spec.get_int_attribute("oiio:UnassociatedAlpha") != 0;
    for (std::size_t i = 0; i < result.pixels.size(); ++i) {
        const float* value = &values[i * static_cast<std::size_t>(channels)];
        glm::vec4& pixel = result.pixels[i];
        for (int c = 0; c < 3; ++c) {
            const float stored = value[is_grey ? 0 : c];
            pixel[c] = is_srgb ? srgb_decode(stored) : stored;
        }
        if (has_alpha)
            pixel.a = value[channels - 1];
        if (has_alpha && !is_straight && pixel.a > 0.0f)
            pixel = glm::vec4(glm::vec3(pixel) / pixel.a, pixel.a);
    }
    image = std::move(result);
    return {};
}

std::string read_bytes(std::string_view bytes, Image& image)
{
    OIIO::Filesystem::IOMemReader memory(bytes.data(), bytes.size());
    if (bytes.starts_with("\xff\xd8"))
        return read("memory.jpg", image, &memory, "jpeg");
    return read("memory.png", image, &memory, bytes.starts_with("\x89PNG") ? "png" : "");
}

std::string write(const std::string& path, const Image& image, bool alpha)
{
    const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(path);
    if (!output)
        return OIIO::geterror();
    const bool is_float = std::string(output->format_name()) == "openexr";
    const int channels = alpha && output->supports("alpha") ? 4 : 3;

    std::vector<float> values;
    values.reserve(image.pixels.size() * static_cast<std::size_t>(channels));
    for (const glm::vec4& pixel : image.pixels) {
        for (int c = 0; c < 3; ++c)
            values.push_back(is_float ? pixel[c] * pixel.a : srgb_encode(pixel[c]));
        if (channels == 4)
            values.push_back(pixel.a);
    }

    OIIO::ImageSpec spec(image.width, image.height, channels,
                         is_float ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:ColorSpace", is_float ? "Linear" : "sRGB");
    spec.attribute("oiio:UnassociatedAlpha", is_float ? 0 : 1);  // OpenEXR demands premultiplied
    spec.attribute("CompressionQuality", kJpegQuality);
    if (!output->open(path, spec) || !output->write_image(OIIO::TypeDesc::FLOAT, values.data()) ||
        !output->close())
        return output->geterror();
    return {};
}

/// To the file, or to `memory` in the format that `path` has.
std::string write_map(const std::string& path, const Map& map, MapDepth depth,
                      const std::string& description, OIIO::Filesystem::IOProxy* memory = nullptr)
{
    const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(path);
    if (!output)
        return OIIO::geterror();
    const bool is_exr = std::string(output->format_name()) == "openexr";
    const OIIO::TypeDesc type = depth == MapDepth::byte ? OIIO::TypeDesc::UINT8
                                : depth == MapDepth::half
                                    ? is_exr ? OIIO::TypeDesc::HALF : OIIO::TypeDesc::UINT16
                                    : OIIO::TypeDesc::FLOAT;
    OIIO::ImageSpec spec(static_cast<int>(map.width), static_cast<int>(map.height),
                         static_cast<int>(map.channels), type);
    spec.attribute("oiio:ColorSpace", "Linear");
    spec.attribute("oiio:UnassociatedAlpha", 1);  // a fourth number is multiplied into none
    if (!description.empty())
        spec.attribute("ImageDescription", description);
    if (memory)
        spec.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &memory);
    if (!output->open(path, spec) ||
        !output->write_image(OIIO::TypeDesc::FLOAT, map.values.data()) || !output->close())
        return output->geterror();
    return {};
}

std::string read_map(const std::string& path, Map& map)
{
    OIIO::ImageSpec wishes;
    wishes.attribute("oiio:UnassociatedAlpha", 1);
    const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(path, &wishes);
    if (!input)
        return OIIO::geterror();
    const OIIO::ImageSpec spec = input->spec();
    if (std::string fault = fault_of_size(spec); !fault.empty())
        return fault;
    if (spec.nchannels > 4)
        return "it has " + std::to_string(spec.nchannels) + " channels, more than 4";
    Map read(static_cast<std::uint32_t>(spec.width), static_cast<std::uint32_t>(spec.height),
             static_cast<std::uint32_t>(spec.nchannels));
    if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, read.values.data()))
        return input->geterror();
    map = std::move(read);
    return {};
}

std::string map_bytes(const Map& map, MapDepth depth, std::string& bytes)
{
    OIIO::Filesystem::IOVecOutput memory;
    std::string error = write_map("map.png", map, depth, "", &memory);
    bytes.assign(memory.buffer().begin(), memory.buffer().end());
    return error;
}

std::string read_description(const std::string& path, std::string& description)
{
    const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(path);
    if (!input)
        return OIIO::geterror();
    description = input->spec().get_string_attribute("ImageDescription");
    return {};
}

/// An empty error text would read as success.
template <class Work>
std::string guarded(Work work)
{
    try {
        return work();
    } catch (const std::exception& error) {
        return error.what();
    }
}

}  // namespace
}  // namespace surfelao

extern "C" __attribute__((visibility("default"))) const surfelao::ImageModule*
surfelao_image_module()
{
    static const surfelao::ImageModule module = {
        [](const std::string& path, surfelao::Image& image) {
            return surfelao::guarded([&] { return surfelao::read(path, image); });
        },
        [](std::string_view bytes, surfelao::Image& image) {
            return surfelao::guarded([&] { return surfelao::read_bytes(bytes, image); });
        },
        [](const std::string& path, const surfelao::Image& image, bool alpha) {
            return surfelao::guarded([&] { return surfelao::write(path, image, alpha); });
        },
        [](const std::string& path, const surfelao::Map& map, surfelao::MapDepth depth,
           const std::string& description) {
            return surfelao::guarded(
                [&] { return surfelao::write_map(path, map, depth, description); });
        },
        [](const std::string& path, surfelao::Map& map) {
            return surfelao::guarded([&] { return surfelao::read_map(path, map); });
        },
        [](const std::string& path, std::string& description) {
            return surfelao::guarded([&] { return surfelao::read_description(path, description); });
        },
        [](const surfelao::Map& map, surfelao::MapDepth depth, std::string& bytes) {
            return surfelao::guarded([&] { return surfelao::map_bytes(map, depth, bytes); });
        },
    };
    return &module;
}

#include "image/image_file.h"

#include "image/image_module.h"
#include "surfels/atomic_file.h"
#include "surfels/errors.h"
#include "surfels/extension.h"
#include "surfels/for_all.h"

#include <dlfcn.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <stdexcept>
#include <string>
#include <thread>

namespace surfelao {
namespace {

const ImageModule& open_module()
{
    std::error_code ignored;  // no /proc: the search path is left
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", ignored);
    const std::filesystem::path beside =
        program.parent_path() / SURFELAO_IMAGE_MODULE_FROM_PROGRAM / SURFELAO_IMAGE_MODULE_NAME;
    void* library = dlopen(beside.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!library && !std::filesystem::exists(beside, ignored))
        library = dlopen(SURFELAO_IMAGE_MODULE_NAME, RTLD_NOW | RTLD_LOCAL);
    if (!library)
        throw std::runtime_error(std::string("cannot read or write pictures: ") + dlerror());
    const auto entry = reinterpret_cast<ImageModuleEntry>(dlsym(library, kImageModuleEntry));
    if (!entry)
        throw std::runtime_error(std::string("cannot read or write pictures: ") + dlerror());
    return *entry();  // the library stays open for the life of the process
}

const ImageModule& module()
{
    static const ImageModule& opened = open_module();
    return opened;
}

}  // namespace

void open_images_early()
{
    if (loop_threads() < 2)
        return;
    static const std::jthread opening([] {
        try {
            static_cast<void>(module());
        } catch (const std::exception&) {
            // whoever reads or writes a picture is told
        }
    });
}

namespace {

/// One line without a full stop, whatever a library wrote.
std::string one_line(std::string text)
{
    text.erase(std::min(text.find('\n'), text.size()));
    while (!text.empty() && (text.back() == '.' || text.back() == ' '))
        text.pop_back();
    return text.empty() ? "it is damaged" : text;
}

/// read(image) returns what went wrong.
template <class Read>
Image checked_image(const std::string& name, const Read& read)
{
    Image image;
    const std::string error = read(image);
    if (!error.empty())
        throw InputError(name + ": cannot be read as a picture: " + one_line(error));
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const glm::vec4& p = image.at(x, y);
            if (!std::isfinite(p.r) || !std::isfinite(p.g) || !std::isfinite(p.b) ||
                !std::isfinite(p.a))
                throw InputError(name + ": pixel " + std::to_string(x) + ", " + std::to_string(y) +
                                 " is not finite");
        }
    }
    return image;
}

}  // namespace

namespace {

void check_readable(const std::filesystem::path& path)
{
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored))
        throw InputError(path.string() + ": no such file");
    if (std::filesystem::is_directory(path, ignored))
        throw InputError(path.string() + ": is a folder, a picture was wanted");
}

}  // namespace

Map read_map(const std::filesystem::path& path)
{
    check_readable(path);
    Map map;
    const std::string error = module().read_map(path.string(), map);
    if (!error.empty())
        throw InputError(path.string() + ": cannot be read as a picture: " + one_line(error));
    const auto wrong =
        std::ranges::find_if(map.values, [](float value) { return !std::isfinite(value); });
    if (wrong != map.values.end()) {
        const std::size_t texel =
            static_cast<std::size_t>(wrong - map.values.begin()) / map.channels;
        throw InputError(path.string() + ": pixel " + std::to_string(texel % map.width) + ", " +
                         std::to_string(texel / map.width) + " is not finite");
    }
    return map;
}

Image read_image(const std::filesystem::path& path)
{
    check_readable(path);
    return checked_image(path.string(),
                         [&](Image& image) { return module().read(path.string(), image); });
}

Image read_image(const std::string& name, std::string_view bytes)
{
    return checked_image(name, [&](Image& image) { return module().read_bytes(bytes, image); });
}

namespace {

/// What is not a matter of the format.
void check_place(const std::filesystem::path& path)
{
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored))
        throw InputError(path.string() + ": is a folder, a file name was wanted");
    const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
    if (!std::filesystem::is_directory(folder, ignored))
        throw InputError(path.string() + ": there is no folder " + folder.string());
}

/// write(temporary) returns what went wrong.
template <class Write>
void write_picture(const std::filesystem::path& path, const Write& write)
{
    write_atomically(path, [&](const std::filesystem::path& temporary) {
        const std::string error = write(temporary.string());
        if (!error.empty())
            throw std::runtime_error(path.string() + ": cannot be written: " + one_line(error));
    });
}

}  // namespace

void check_image_output(const std::filesystem::path& path)
{
    const std::string extension = lower_extension(path);
    if (extension != ".png" && extension != ".jpg" && extension != ".jpeg" && extension != ".exr")
        throw InputError(path.string() + ": pictures are written as .png, .jpg or .exr");
    check_place(path);
}

void check_map_output(const std::filesystem::path& path, MapDepth depth)
{
    const std::string extension = lower_extension(path);
    const bool is_png = extension == ".png", is_exr = extension == ".exr";
    if (!is_png && !is_exr && extension != ".tif" && extension != ".tiff")
        throw InputError(path.string() + ": maps are written as .png, .tif or .exr");
    if (is_png && depth == MapDepth::whole)
        throw InputError(path.string() + ": .png has 8 or 16 bits, use .tif or .exr for 32");
    if (is_exr && depth == MapDepth::byte)
        throw InputError(path.string() + ": .exr has 16 or 32 bits, use .png or .tif for 8");
    check_place(path);
}

void write_image(const std::filesystem::path& path, const Image& image)
{
    check_image_output(path);
    if (image.pixels.empty())
        throw InputError(path.string() + ": the picture has no pixels");
    const bool alpha = std::any_of(image.pixels.begin(), image.pixels.end(),
                                   [](const glm::vec4& pixel) { return pixel.a < 1.0f; });
    write_picture(path, [&](const std::string& temporary) {
        return module().write(temporary, image, alpha);
    });
}

void write_map(const std::filesystem::path& path, const Map& map, MapDepth depth,
               const std::string& mark)
{
    check_map_output(path, depth);
    if (map.values.empty())
        throw InputError(path.string() + ": the map has no texels");
    write_picture(path, [&](const std::string& temporary) {
        return module().write_map(temporary, map, depth, mark);
    });
}

std::string read_description(const std::filesystem::path& path)
{
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored))
        return {};
    std::string description;
    return module().read_description(path.string(), description).empty() ? description : "";
}

std::string map_bytes(const Map& map, MapDepth depth)
{
    require(!map.values.empty(), "a picture has one texel at least");
    require(depth != MapDepth::whole, "a .png has 8 or 16 bits");
    std::string bytes;
    const std::string error = module().map_bytes(map, depth, bytes);
    if (!error.empty())
        throw std::runtime_error("a map cannot be made a picture: " + one_line(error));
    return bytes;
}

}  // namespace surfelao

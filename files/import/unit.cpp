#include "files/import/unit.h"

#include <minizip/unzip.h>

#include <algorithm>
#include <array>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

namespace surfelao {
namespace {

/// Of the model, which says its unit in its first element.
constexpr std::size_t kHead = 1 << 16;

constexpr std::array<std::pair<std::string_view, float>, 6> kUnits = {{{"micron", 1e-6f},
                                                                       {"millimeter", 1e-3f},
                                                                       {"centimeter", 1e-2f},
                                                                       {"inch", 0.0254f},
                                                                       {"foot", 0.3048f},
                                                                       {"meter", 1.0f}}};

std::string head_of_model(const std::filesystem::path& file)
{
    const std::unique_ptr<void, int (*)(void*)> archive(unzOpen64(file.c_str()), &unzClose);
    constexpr int kAnyCase = 2;
    if (!archive || unzLocateFile(archive.get(), "3D/3dmodel.model", kAnyCase) != UNZ_OK ||
        unzOpenCurrentFile(archive.get()) != UNZ_OK)
        throw std::runtime_error("its archive holds no 3D/3dmodel.model");
    std::string head(kHead, '\0');
    std::size_t filled = 0;
    int count = 0;
    while (filled < head.size() &&
           (count = unzReadCurrentFile(archive.get(), head.data() + filled,
                                       static_cast<unsigned>(head.size() - filled))) > 0)
        filled += static_cast<std::size_t>(count);
    unzCloseCurrentFile(archive.get());
    head.resize(filled);
    return head;
}

/// The value of an attribute of the first element of this name; empty where it has none.
std::string_view attribute_of(std::string_view text, std::string_view element,
                              std::string_view attribute)
{
    text.remove_prefix(std::min(text.find(element), text.size()));
    text = text.substr(0, text.find('>'));
    text.remove_prefix(std::min(text.find(attribute), text.size()));
    const std::size_t begin = text.find_first_of("\"'");
    if (begin == text.npos)
        return {};
    const char quote = text[begin];
    text.remove_prefix(begin + 1);
    return text.substr(0, text.find(quote));
}

}  // namespace

float metres_of_3mf(const std::filesystem::path& file)
{
    const std::string head = head_of_model(file);
    const std::string_view name = attribute_of(head, "<model", " unit=");
    if (name.empty())
        return 1e-3f;
    const auto known = std::ranges::find(kUnits, name, &std::pair<std::string_view, float>::first);
    if (known == kUnits.end())
        throw std::runtime_error("its unit \"" + std::string(name) + "\" is none of 3MF");
    return known->second;
}

}  // namespace surfelao

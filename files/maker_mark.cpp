#include "files/maker_mark.h"

#include "files/file_type.h"
#include "files/gltf_strings.h"
#include "files/text_cursor.h"
#include "surfels/extension.h"

#include <algorithm>
#include <fstream>

namespace surfelao {
namespace {

namespace fs = std::filesystem;

/// More than any mark needs, and than the comments that stand in front of it in a header.
constexpr std::uintmax_t kLookedAt = 1u << 14;

constexpr std::string_view kMaker = "surfelao ";
constexpr std::string_view kLineEnds = "\r\n";

/// The first kLookedAt bytes, or the last ones.
std::string part_of(const fs::path& path, bool last)
{
    std::error_code error;
    if (!fs::is_regular_file(path, error))
        return {};
    const std::uintmax_t size = fs::file_size(path, error);
    if (error)
        return {};
    std::ifstream file(path, std::ios::binary);
    if (last && size > kLookedAt)
        file.seekg(static_cast<std::streamoff>(size - kLookedAt));
    std::string text(std::min(size, kLookedAt), '\0');
    file.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(std::max<std::streamsize>(0, file.gcount())));
    return text;
}

std::string_view first_line(std::string_view text)
{
    return text.substr(0, text.find_first_of(kLineEnds));
}

/// The rest of the line behind `prefix` where the line is a mark; else empty.
std::string_view mark_behind(std::string_view prefix, std::string_view line)
{
    if (!line.starts_with(prefix))
        return {};
    line.remove_prefix(prefix.size());
    return command_of_mark(line).empty() ? std::string_view() : line;
}

/// Of a header of lines that ends with one that begins with `last`.
std::string mark_of_header(std::string_view text, std::string_view comment, std::string_view last)
{
    while (!text.empty()) {
        const std::string_view line = first_line(text);
        if (line.starts_with(last))
            break;
        if (const std::string_view mark = mark_behind(comment, line); !mark.empty())
            return std::string(mark);
        text.remove_prefix(std::min(text.size(), line.size() + 1));
    }
    return {};
}

std::string mark_of_obj(std::string_view text)
{
    if (text.starts_with(kByteOrderMark))
        text.remove_prefix(kByteOrderMark.size());
    return std::string(obj_mark(text).mark);
}

std::string mark_of_html(std::string_view text)
{
    constexpr std::string_view kBefore = "<meta name=\"generator\" content=\"";
    const std::size_t at = text.find(kBefore);
    if (at == text.npos)
        return {};
    text.remove_prefix(at + kBefore.size());
    return std::string(mark_behind("", text.substr(0, text.find('"'))));
}

std::string mark_of_gltf(const fs::path& path)
{
    std::string mark;
    visit_gltf_strings(path, [&](std::span<const std::string> keys, const std::string& text) {
        const bool found =
            keys.size() == 3 && keys[0] == "asset" && keys[1] == "extras" && keys[2] == kMarkKey;
        if (found)
            mark = mark_behind("", text);
        return !found;
    });
    return mark;
}

}  // namespace

std::string make_mark(std::string_view command, std::string_view settings)
{
    std::string mark(kMaker);
    mark.append(SURFELAO_VERSION " ").append(command).append(": ").append(settings);
    return mark;
}

std::string_view command_of_mark(std::string_view text)
{
    if (!text.starts_with(kMaker) || text.find_first_of(kLineEnds) != text.npos)
        return {};
    const std::size_t version_end = text.find(' ', kMaker.size());
    const std::size_t command_end = text.find(": ", version_end);
    if (version_end == text.npos || command_end == text.npos)
        return {};
    const std::string_view command = text.substr(version_end + 1, command_end - version_end - 1);
    return command.find(' ') == command.npos ? command : std::string_view();
}

MarkLine obj_mark(std::string_view text)
{
    const std::string_view line = first_line(text);
    const std::string_view mark = mark_behind("# ", line);
    if (mark.empty())
        return {};
    const bool two = text.substr(line.size()).starts_with(kLineEnds);
    return {text.substr(0, line.size() + (two ? 2 : 1)), mark};
}

MarkLine off_mark(std::string_view text)
{
    const std::size_t end = text.find_last_not_of(kLineEnds) + 1;  // npos + 1 is 0
    const std::size_t begin = text.substr(0, end).find_last_of(kLineEnds) + 1;
    const std::string_view mark = mark_behind("# ", text.substr(begin, end - begin));
    return mark.empty() ? MarkLine() : MarkLine{text.substr(begin), mark};
}

std::string read_mark(const fs::path& path)
{
    switch (type_of(path)) {
        case FileType::ply:
            return mark_of_header(part_of(path, false), "comment ", "end_header");
        case FileType::pcd:
            return mark_of_header(part_of(path, false), "# ", "DATA ");
        case FileType::obj:
            return mark_of_obj(part_of(path, false));
        case FileType::off:
        case FileType::xyz:
            return std::string(off_mark(part_of(path, true)).mark);
        case FileType::gltf:
        case FileType::glb:
            return mark_of_gltf(path);
        default:
            return lower_extension(path) == ".html" ? mark_of_html(part_of(path, false)) : "";
    }
}

}  // namespace surfelao

#include "gpu/shader_source.h"

#include <algorithm>
#include <regex>
#include <stdexcept>

namespace surfelao {
namespace {

std::string_view text_of(std::span<const ShaderFile> files, std::string_view name,
                         const std::string& asked_from)
{
    const auto found = std::ranges::find(files, name, &ShaderFile::name);
    if (found == files.end())
        throw std::runtime_error(asked_from + "there is no shader file '" + std::string(name) +
                                 "'");
    return found->text;
}

/// Splits off the first line, without its end.
std::string_view take_line(std::string_view& rest)
{
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const std::string_view line = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    return line;
}

void mark_line(std::string& text, std::size_t line, std::size_t file)
{
    text += "#line " + std::to_string(line) + ' ' + std::to_string(file) + '\n';
}

void paste(std::span<const ShaderFile> files, std::string_view text, std::size_t first_line,
           std::size_t file, ShaderSource& out)
{
    constexpr std::string_view kInclude = "#include \"";
    std::size_t line_number = first_line;
    mark_line(out.text, line_number, file);
    for (std::string_view rest = text; !rest.empty(); ++line_number) {
        const std::string_view line = take_line(rest);
        if (!line.starts_with(kInclude)) {
            out.text.append(line) += '\n';
            continue;
        }
        const std::string_view quoted = line.substr(kInclude.size());
        const std::string name(quoted.substr(0, quoted.find('"')));
        if (std::ranges::find(out.files, name) == out.files.end()) {
            const std::string place = out.files[file] + ':' + std::to_string(line_number) + ": ";
            const std::string_view included = text_of(files, name, place);
            out.files.push_back(name);
            paste(files, included, 1, out.files.size() - 1, out);
        }
        mark_line(out.text, line_number + 1, file);
    }
}

}  // namespace

ShaderSource assemble_shader(std::span<const ShaderFile> files, std::string_view name,
                             std::span<const std::string> definitions)
{
    std::string_view text = text_of(files, name, "");
    const std::string_view version = take_line(text);
    if (!version.starts_with("#version "))
        throw std::runtime_error(std::string(name) + ":1: a shader begins with #version");

    ShaderSource out;
    out.files.emplace_back(name);
    out.text.append(version) += '\n';
    for (const std::string& definition : definitions)
        out.text += "#define " + definition + '\n';
    paste(files, text, 2, 0, out);
    return out;
}

std::string name_files_in_log(std::string_view log, std::span<const std::string> files)
{
    static const std::regex place(R"(^((?:ERROR: |WARNING: )?)(\d+)([:(])(\d+)(.*)$)");
    std::string result;
    while (!log.empty()) {
        const std::string line(take_line(log));
        std::smatch match;
        const bool matched = std::regex_match(line, match, place) && match[2].length() < 6;
        const std::size_t file = matched ? std::stoul(match[2]) : files.size();
        if (file < files.size())
            result +=
                match[1].str() + files[file] + match[3].str() + match[4].str() + match[5].str();
        else
            result += line;
        result += '\n';
    }
    return result;
}

}  // namespace surfelao

#include "files/own_colors.h"

#include "files/maker_mark.h"
#include "files/text_cursor.h"
#include "surfels/number_text.h"
#include "surfels/srgb.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace surfelao {
namespace {

constexpr std::string_view kOwn = "# own";
constexpr std::string_view kLineEnd = "\r\n";

std::string_view without_line_end(std::string_view text)
{
    if (text.ends_with(kLineEnd))
        text.remove_suffix(2);
    else if (!text.empty() && kLineEnd.find(text.back()) != kLineEnd.npos)
        text.remove_suffix(1);
    return text;
}

/// Calls visit(word) for the words of a line.
template <class Visit>
void for_each_word(std::string_view line, const Visit& visit)
{
    while (true) {
        line.remove_prefix(std::min(line.find_first_not_of(' '), line.size()));
        if (line.empty())
            return;
        const std::string_view word = line.substr(0, line.find(' '));
        visit(word);
        line.remove_prefix(word.size());
    }
}

/// A vertex' comment: no number, or those of a colour.
bool is_own_comment(std::string_view line)
{
    if (line == kOwn)
        return true;
    int numbers = 0;
    bool are_numbers = line.starts_with(kOwn) && line[kOwn.size()] == ' ';
    for_each_word(line.substr(std::min(kOwn.size(), line.size())), [&](std::string_view word) {
        are_numbers = are_numbers && number_in(word);
        ++numbers;
    });
    return are_numbers && (numbers == 3 || numbers == 4);
}

bool is_white(const glm::vec4& color)
{
    return color.x == 1.0f && color.y == 1.0f && color.z == 1.0f;
}

}  // namespace

double white_of(double largest)
{
    return largest > kLargestOfUnit ? 255.0 : 1.0;
}

std::optional<double> number_in(std::string_view word)
{
    if (word.size() > 1 && word[0] == '+' && word[1] != '-')
        word.remove_prefix(1);
    double number = 0.0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error == std::errc::invalid_argument || end != word.data() + word.size())
        return is_nan_of_windows(word) ? std::optional(std::numeric_limits<double>::quiet_NaN())
                                       : std::nullopt;
    return number;
}

float linear_of(double number)
{
    if (std::isnan(number))
        return 1.0f;
    return srgb_decode(static_cast<float>(std::clamp(number, 0.0, 1.0)));
}

glm::vec3 numbers_of(const glm::vec3& linear)
{
    if (linear.x == linear.y && linear.y == linear.z)
        return glm::vec3(srgb_encode(linear.x));
    return {srgb_encode(linear.x), srgb_encode(linear.y), srgb_encode(linear.z)};
}

std::vector<glm::vec4> own_colors_of(const Scene& scene)
{
    return scene.asset ? scene.asset->own_colors() : std::vector<glm::vec4>();
}

std::uint8_t byte_of(float number)
{
    return static_cast<std::uint8_t>(std::lround(255.0f * number));
}

glm::vec3 ColorPlan::numbers(std::size_t vertex, const Occlusion& occlusion) const
{
    const glm::vec3 color = color_of(what, occlusion, own.empty() ? glm::vec3(1.0f) : own[vertex]);
    if (encoding == Encoding::linear)
        return color;
    return numbers_of(color);
}

ColorPlan plan_colors(const WriteOptions& options, std::vector<glm::vec4> own, OcclusionPlace place,
                      std::vector<std::string>& notes)
{
    ColorPlan plan;
    plan.what = options.colors;
    plan.encoding = options.encoding == Encoding::automatic ? Encoding::srgb : options.encoding;
    const bool is_plain = std::ranges::all_of(own, is_white);
    if (options.colors == VertexColors::automatic) {
        plan.what =
            place == OcclusionPlace::none || is_plain ? VertexColors::shaded : VertexColors::keep;
        if (plan.what == VertexColors::keep)
            notes.push_back(
                "colours of the file kept; --colors shaded shows the occlusion on them");
        else if (!is_plain)
            notes.push_back(
                "colours of the file shaded by the occlusion, which has no other place in this "
                "format; --colors keep leaves them as they are");
    } else if (options.colors == VertexColors::keep && place == OcclusionPlace::none) {
        notes.push_back("--colors keep leaves the occlusion no place in this format: it is lost");
    }
    plan.own = std::move(own);
    return plan;
}

void ColorWords::add(std::span<const std::string_view> words)
{
    for (const std::string_view& word : words) {
        if (&word != words.data())
            words_ += ' ';
        words_.append(word);
    }
    ends_.push_back(words_.size());
}

void ColorWords::add(const glm::vec4& linear, Form form)
{
    for (int channel = 0; channel < 3; ++channel) {
        if (channel > 0)
            words_ += ' ';
        if (form == Form::decimals)
            append_fixed(words_, srgb_encode(linear[channel]), 6);
        else
            append_integer(words_, byte_of(srgb_encode(linear[channel])));
    }
    if (form == Form::bytes)
        append_integer(words_ += ' ', byte_of(linear.w));
    ends_.push_back(words_.size());
}

std::string_view ColorWords::operator[](std::size_t vertex) const
{
    const std::size_t begin = vertex > 0 ? ends_[vertex - 1] : 0;
    return std::string_view(words_).substr(begin, ends_[vertex] - begin);
}

std::vector<glm::vec4> ColorWords::linear() const
{
    if (words_.empty())
        return {};
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    std::vector<glm::dvec4> numbers(size(), glm::dvec4(kNone));
    double largest = 0.0;
    for (std::size_t vertex = 0; vertex < size(); ++vertex) {
        int channel = 0;
        for_each_word((*this)[vertex], [&](std::string_view word) {
            const double number = number_in(word).value_or(kNone);
            numbers[vertex][channel++] = number;
            if (std::isfinite(number))
                largest = std::max(largest, number);
        });
    }
    const double white = white_of(largest);
    std::vector<glm::vec4> colors;
    colors.reserve(size());
    for (const glm::dvec4& number : numbers) {
        const double alpha = std::isnan(number.w) ? 1.0 : std::clamp(number.w / white, 0.0, 1.0);
        colors.emplace_back(linear_of(number.x / white), linear_of(number.y / white),
                            linear_of(number.z / white), static_cast<float>(alpha));
    }
    return colors;
}

void ColorWords::append_comments(std::string& text) const
{
    const std::string end(line_end_of(text));
    const bool is_closed = without_line_end(text).size() < text.size();
    for (std::size_t vertex = 0; vertex < size(); ++vertex) {
        const std::string_view words = (*this)[vertex];
        text.append(is_closed ? "" : end).append(kOwn).append(words.empty() ? "" : " ");
        text.append(words).append(is_closed ? end : "");
    }
}

std::string_view ColorWords::take_comments(std::string_view text, std::size_t vertices)
{
    std::vector<std::string_view> lines;  // from the last to the first
    std::string_view before = text;
    while (lines.size() < vertices) {
        const std::string_view rest = without_line_end(before);
        const std::size_t begin = rest.find_last_of(kLineEnd) + 1;  // npos + 1 is 0
        const std::string_view line = rest.substr(begin);
        if (!is_own_comment(line))
            return text;
        lines.push_back(line.substr(kOwn.size()));
        before = rest.substr(0, begin);
    }
    std::ranges::reverse(lines);
    std::vector<std::string_view> words;
    for (const std::string_view line : lines) {
        words.clear();
        for_each_word(line, [&](std::string_view word) { words.push_back(word); });
        add(words);
    }
    const bool is_closed = without_line_end(text).size() < text.size();
    return is_closed ? before : without_line_end(before);
}

void ColorWords::deny_comments(std::string_view text, std::size_t vertices)
{
    if (ColorWords().take_comments(text, vertices).size() < text.size())
        ends_.resize(vertices, words_.size());
}

std::string_view line_end_of(std::string_view text)
{
    const std::size_t at = text.find_first_of(kLineEnd);
    if (at == text.npos)
        return "\n";
    return text.substr(at, text.substr(at).starts_with(kLineEnd) ? 2 : 1);
}

bool colors_are_baked(std::string_view mark)
{
    return command_of_mark(mark) == "bake" && mark.find(" at=texels") == mark.npos &&
           mark.find(" colors=" + name_of(VertexColors::keep)) == mark.npos;
}

}  // namespace surfelao

#include "files/text_cursor.h"

#include "surfels/errors.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

namespace surfelao {
namespace {

constexpr std::size_t kLongestQuote = 40;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool is_newline(char c)
{
    return c == '\n' || c == '\r';
}

/// Whether a decimal number that no double can hold is too small (and so 0) and not too large.
bool is_underflow(std::string_view word)
{
    const std::size_t exponent = word.find_first_of("eE");
    if (exponent != std::string_view::npos)
        return exponent + 1 < word.size() && word[exponent + 1] == '-';
    return word.substr(0, word.find('.')).find_first_of("123456789") == std::string_view::npos;
}

}  // namespace

bool is_nan_of_windows(std::string_view word)
{
    const std::size_t digit = word.starts_with('-') ? 1 : 0;
    return word.substr(std::min(digit, word.size())).starts_with("1.#");
}

std::string quoted(std::string_view word)
{
    std::string text = "\"";
    for (const char c : word.substr(0, kLongestQuote))
        text += (c >= ' ' && c <= '~') ? c : '?';
    return text + (word.size() > kLongestQuote ? "...\"" : "\"");
}

TextCursor::TextCursor(std::string_view file_name, std::string_view text, TextRules rules,
                       std::uint64_t first_line)
    : file_name_(file_name),
      begin_(text.data()),
      at_(text.data()),
      end_(text.data() + text.size()),
      rules_(rules),
      line_(first_line)
{
    if (first_line != 1)
        return;
    const std::string_view start = text.substr(0, 4);
    if (start.starts_with("\xFF\xFE") || start.starts_with("\xFE\xFF") ||
        start == std::string_view("\0\0\xFE\xFF", 4)) {
        throw InputError(std::string(file_name) +
                         ": is UTF-16 or UTF-32 text, but must be plain or UTF-8 text");
    }
    if (start.starts_with(kByteOrderMark))
        at_ += 3;
}

bool TextCursor::is_blank(char c) const
{
    return c == ' ' || c == '\t' || c == '\v' || c == '\f' || c == rules_.separator;
}

bool TextCursor::begins_comment(const char* at) const
{
    return (*at == rules_.comment && rules_.comment != '\0') ||
           (rules_.slashes && *at == '/' && at + 1 != end_ && at[1] == '/');
}

void TextCursor::skip_newline()
{
    if (at_ == end_)
        return;
    at_ += (*at_ == '\r' && at_ + 1 != end_ && at_[1] == '\n') ? 2 : 1;
    ++line_;
}

bool TextCursor::at_line_end()
{
    while (at_ != end_) {
        if (is_blank(*at_)) {
            ++at_;
        } else if (*at_ == '\\' && rules_.continuation && at_ + 1 != end_ && is_newline(at_[1])) {
            ++at_;
            skip_newline();
        } else {
            return is_newline(*at_) || begins_comment(at_);
        }
    }
    return true;
}

bool TextCursor::next_line()
{
    while (true) {
        if (started_) {
            // a continued line goes on, unless what goes on is a comment
            while (!at_line_end())
                word();
            while (at_ != end_ && !is_newline(*at_))
                ++at_;
            skip_newline();
        }
        started_ = true;
        if (!at_line_end())
            return true;
        if (at_ == end_)
            return false;
    }
}

bool TextCursor::ends_word(const char* at) const
{
    return at == end_ || is_blank(*at) || is_newline(*at) ||
           (*at == '\\' && rules_.continuation && at + 1 != end_ && is_newline(at[1]));
}

std::string_view TextCursor::word()
{
    if (at_line_end())
        return {};
    const char* first = at_;
    while (!ends_word(at_))
        ++at_;
    return {first, static_cast<std::size_t>(at_ - first)};
}

std::string_view TextCursor::rest_of_line()
{
    if (at_line_end())
        return {};
    std::string_view rest(at_, remaining());
    rest = rest.substr(0, rest.find_first_of("\r\n"));
    return rest.substr(0, rest.find_last_not_of(" \t") + 1);
}

template <bool kFinite>
double TextCursor::parse(std::string_view what)
{
    if (at_line_end())
        fail(std::string(what) + " is missing");
    const char* first = (*at_ == '+' && at_ + 1 != end_ && at_[1] != '-') ? at_ + 1 : at_;
    double value = 0.0;
    const std::from_chars_result result = std::from_chars(first, end_, value);
    if (result.ec == std::errc::invalid_argument || !ends_word(result.ptr)) {
        const std::string_view all = word();
        if (kFinite || !is_nan_of_windows(all))
            fail(quoted(all) + " is not a number");
        return std::numeric_limits<double>::quiet_NaN();
    }
    if (result.ec == std::errc::result_out_of_range) {
        const std::string_view all = word();
        if (is_underflow(all))
            return 0.0;
        if (kFinite)
            fail(quoted(all) + " is too large for a number");
        return *first == '-' ? -kInfinity : kInfinity;
    }
    if (kFinite && !std::isfinite(value))
        fail(quoted(word()) + " is not a finite number");
    at_ = result.ptr;
    return value;
}

double TextCursor::number(std::string_view what)
{
    return parse<true>(what);
}

double TextCursor::any_number(std::string_view what)
{
    return parse<false>(what);
}

std::int64_t TextCursor::integer_of(std::string_view word) const
{
    const char* first = word.data();
    const char* last = first + word.size();
    if (word.size() > 1 && *first == '+' && first[1] != '-')
        ++first;
    std::int64_t value = 0;
    const std::from_chars_result result = std::from_chars(first, last, value);
    if (result.ec == std::errc::result_out_of_range && result.ptr == last)
        fail(quoted(word) + " is too large for a whole number");
    if (result.ec != std::errc() || result.ptr != last)
        fail(quoted(word) + " is not a whole number");
    return value;
}

std::int64_t TextCursor::integer(std::string_view what)
{
    if (at_line_end())
        fail(std::string(what) + " is missing");
    return integer_of(word());
}

void TextCursor::fail(const std::string& fault) const
{
    throw InputError(std::string(file_name_) + ": line " + std::to_string(line_) + ": " + fault);
}

}  // namespace surfelao

#include "files/text_cursor.h"

#include "surfels/errors.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>

namespace surfelao {
namespace {

constexpr std::size_t kLongestQuote = 40;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Up to here a double holds every whole number.
constexpr std::uint64_t kExactEnd = std::uint64_t{1} << 53;
/// Below it there is room for one digit more.
constexpr std::uint64_t kDigitsEnd = 1'000'000'000'000'000'000;

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

/// Digits from `at` on behind those of `number`, as long as they are fewer than 19 in all.
const char* read_digits(const char* at, const char* end, std::uint64_t& number)
{
    for (; at != end && static_cast<unsigned char>(*at - '0') < 10 && number < kDigitsEnd; ++at)
        number = 10 * number + static_cast<unsigned char>(*at - '0');
    return at;
}

/// A decimal number without exponent whose digits make up a whole number that a double holds, as do
/// the powers of ten up to the 22nd: their quotient is rounded once, and so is right to the last
/// bit (Clinger. How to Read Floating Point Numbers Accurately. 1990). Returns where it ends; null
/// for all other numbers and words.
const char* read_short_number(const char* at, const char* end, double& value)
{
    constexpr double kPowers[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                  1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                  1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
    const bool is_negative = at != end && *at == '-';
    const char* const first = is_negative ? at + 1 : at;
    std::uint64_t digits = 0;
    const char* last = read_digits(first, end, digits);
    std::size_t count = static_cast<std::size_t>(last - first), decimals = 0;
    if (last != end && *last == '.') {
        const char* const point = last;
        last = read_digits(point + 1, end, digits);
        decimals = static_cast<std::size_t>(last - point) - 1;
        count += decimals;
    }
    if (count == 0 || decimals >= std::size(kPowers) || digits > kExactEnd)
        return nullptr;
    const double size = static_cast<double>(digits) / kPowers[decimals];
    value = is_negative ? -size : size;
    return last;
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
    const auto set = [&](char c, Sign sign) { signs_[static_cast<unsigned char>(c)] = sign; };
    if (rules.comment != '\0')
        set(rules.comment, Sign::special);
    if (rules.continuation)
        set('\\', Sign::special);
    if (rules.slashes)
        set('/', Sign::special);
    for (const char c : {'\n', '\r'})
        set(c, Sign::newline);
    for (const char c : {' ', '\t', '\v', '\f', rules.separator})
        set(c, Sign::blank);
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

bool TextCursor::joins_lines(const char* at) const
{
    return *at == '\\' && rules_.continuation && at + 1 != end_ && is_newline(at[1]);
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

bool TextCursor::next_line()
{
    while (true) {
        if (started_) {
            // a continued line goes on, unless what goes on is a comment
            while (rules_.continuation && !at_line_end())
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

std::size_t TextCursor::line_begin(std::size_t offset) const
{
    for (const char* at = begin_ + offset; at != end_; ++at) {
        if (!is_newline(*at) || (rules_.continuation && at != begin_ && at[-1] == '\\'))
            continue;
        const bool is_two = *at == '\r' && at + 1 != end_ && at[1] == '\n';
        return static_cast<std::size_t>(at - begin_) + (is_two ? 2 : 1);
    }
    return static_cast<std::size_t>(end_ - begin_);
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
    double short_value = 0.0;
    if (const char* const last = read_short_number(at_, end_, short_value);
        last != nullptr && ends_word(last)) {
        at_ = last;
        return short_value;
    }
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
    const char* const first = *at_ == '-' ? at_ + 1 : at_;
    std::uint64_t digits = 0;
    const char* const last = read_digits(first, end_, digits);
    if (last == first || !ends_word(last))
        return integer_of(word());
    const bool is_negative = first != at_;
    at_ = last;
    return is_negative ? -static_cast<std::int64_t>(digits) : static_cast<std::int64_t>(digits);
}

void TextCursor::fail(const std::string& fault) const
{
    throw InputError(std::string(file_name_) + ": line " + std::to_string(line_) + ": " + fault);
}

}  // namespace surfelao

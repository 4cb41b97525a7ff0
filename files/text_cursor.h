/// text_cursor.h: the words and numbers of a text file, and the line they stand on.
///
/// Shared by the readers of text formats. Lines end with LF, CRLF or CR. Nothing is copied; memory
/// does not depend on the length of lines. Every fault is an InputError "FILE: line N: FAULT".
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace surfelao {

/// A word of a file as it may stand in a message: in quotes, cut after 40 bytes, unprintable bytes
/// replaced by '?'.
[[nodiscard]] std::string quoted(std::string_view word);

/// As the C library of Windows once printed what is no finite number: 1.#IND, -1.#QNAN0, 1.#INF.
[[nodiscard]] bool is_nan_of_windows(std::string_view word);

/// What a UTF-8 text may begin with.
inline constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/// What a text format knows beside words and lines.
struct TextRules {
    char comment = '\0';        ///< from here to the end of the line is nothing; '\0': no comments
    bool continuation = false;  ///< a backslash at the end of a line joins it with the next
    bool slashes = false;       ///< `//` begins a comment too
    char separator = ' ';       ///< stands between words, as blanks do
};

class TextCursor {
public:
    /// Both views must outlive the cursor. Line 1 may begin with a UTF-8 byte order mark; where it
    /// shows UTF-16 or UTF-32, InputError is thrown.
    TextCursor(std::string_view file_name, std::string_view text, TextRules rules,
               std::uint64_t first_line = 1);

    /// Goes to the first word of the next line that has one (at the start: of the first such line).
    /// False when there is none.
    bool next_line();

    /// True when the line holds no more words.
    bool at_line_end()
    {
        while (at_ != end_) {
            const Sign sign = sign_of(*at_);
            if (sign == Sign::of_word)
                return false;
            if (sign == Sign::newline)
                return true;
            if (sign == Sign::special && !joins_lines(at_))
                return begins_comment(at_);
            ++at_;
            if (sign == Sign::special)
                skip_newline();
        }
        return true;
    }

    /// The next word on this line; empty at its end.
    std::string_view word()
    {
        if (at_line_end())
            return {};
        const char* first = at_;
        while (!ends_word(at_))
            ++at_;
        return {first, static_cast<std::size_t>(at_ - first)};
    }

    /// What stands on this line from the next word on, without blanks at the end; it is not taken.
    [[nodiscard]] std::string_view rest_of_line();

    /// The next word as a finite number. `what` names it in the sentence when it is missing.
    double number(std::string_view what);

    /// The same for a number that may be too large, infinite or nan, in any spelling.
    double any_number(std::string_view what);

    /// The next word as a whole number.
    std::int64_t integer(std::string_view what);

    /// The number that makes up all of `word`, which stands on this line.
    std::int64_t integer_of(std::string_view word) const;

    /// Bytes that lie behind the cursor.
    [[nodiscard]] std::size_t remaining() const { return static_cast<std::size_t>(end_ - at_); }

    /// Before the lines between two byte positions of the text, at the first of which a line
    /// begins, as in line_begin(): next_line() finds its first. Positions remain those in the whole
    /// text.
    [[nodiscard]] TextCursor part(std::size_t begin, std::size_t end, std::uint64_t line) const
    {
        TextCursor cursor = *this;
        cursor.at_ = begin_ + begin;
        cursor.end_ = begin_ + end;
        cursor.line_ = line;
        cursor.started_ = false;
        return cursor;
    }

    /// All of it, also what lies before the cursor.
    [[nodiscard]] std::string_view text() const
    {
        return {begin_, static_cast<std::size_t>(end_ - begin_)};
    }

    /// Byte position of the first line that begins behind `offset` and is not joined with the one
    /// before; the text's end where there is none.
    [[nodiscard]] std::size_t line_begin(std::size_t offset) const;

    /// Byte position in the text: of the next word after next_line() or at_line_end().
    [[nodiscard]] std::size_t offset() const { return static_cast<std::size_t>(at_ - begin_); }

    /// Counts from 1.
    [[nodiscard]] std::uint64_t line() const { return line_; }

    [[noreturn]] void fail(const std::string& fault) const;

private:
    /// What a byte may be where words are looked for.
    enum class Sign : std::uint8_t {
        of_word,
        blank,
        newline,
        special,  ///< a comment or a joint of lines may begin here, or a word
    };

    template <bool kFinite>
    double parse(std::string_view what);
    /// Steps over the line's end; a no-op at the end of the text.
    void skip_newline();
    [[nodiscard]] Sign sign_of(char c) const { return signs_[static_cast<unsigned char>(c)]; }
    [[nodiscard]] bool ends_word(const char* at) const
    {
        return at == end_ || sign_of(*at) == Sign::blank || sign_of(*at) == Sign::newline ||
               (sign_of(*at) == Sign::special && joins_lines(at));
    }
    [[nodiscard]] bool joins_lines(const char* at) const;
    [[nodiscard]] bool begins_comment(const char* at) const;

    std::string_view file_name_;
    const char* begin_;
    const char* at_;
    const char* end_;
    TextRules rules_;
    std::uint64_t line_;
    bool started_ = false;
    std::array<Sign, 256> signs_{};
};

}  // namespace surfelao

/// content_hash.h: 128 bits by which equal data is known again: two multiplicative hashes with
/// different odd constants. Not against forgers. The same on machines of one byte order.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>

namespace surfelao {

class ContentHash {
public:
    template <class T>
    void add(std::span<const T> values)
    {
        static_assert(std::is_trivially_copyable_v<T>);
        add_word(values.size_bytes());
        const char* bytes = reinterpret_cast<const char*>(values.data());
        for (std::size_t at = 0; at < values.size_bytes(); at += 8) {
            std::uint64_t word = 0;
            std::memcpy(&word, bytes + at, std::min<std::size_t>(8, values.size_bytes() - at));
            add_word(word);
        }
    }
    void add_word(std::uint64_t word)
    {
        high_ = std::rotl((high_ ^ word) * 0x9E3779B97F4A7C15u, 31);
        low_ = std::rotl((low_ ^ word) * 0xD6E8FEB86659FD93u, 29);
    }
    std::uint64_t high() const { return high_ ^ high_ >> 32; }
    std::uint64_t low() const { return low_ ^ low_ >> 32; }

private:
    std::uint64_t high_ = 0x243F6A8885A308D3u, low_ = 0x13198A2E03707344u;  // digits of pi
};

}  // namespace surfelao

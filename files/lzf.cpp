#include "files/lzf.h"

namespace surfelao {

std::optional<std::string> unpack_lzf(std::string_view packed, std::size_t size)
{
    if (size / kLargestLzfRatio > packed.size())
        return std::nullopt;
    std::string bytes;
    bytes.reserve(size);
    std::size_t at = 0;
    const auto take = [&] { return static_cast<unsigned char>(packed[at++]); };
    while (at < packed.size()) {
        const unsigned control = take();
        if (control < 32) {  // so many bytes and one as they are
            const std::size_t count = control + 1;
            if (count > packed.size() - at || count > size - bytes.size())
                return std::nullopt;
            bytes.append(packed.substr(at, count));
            at += count;
            continue;
        }
        // length in the upper bits, 7 of them: in the next byte; then how far back
        std::size_t count = control >> 5;
        if (packed.size() - at < (count == 7 ? 2u : 1u))
            return std::nullopt;
        if (count == 7)
            count += take();
        count += 2;
        const std::size_t back = (control & 31u) * 256 + take() + 1;
        if (back > bytes.size() || count > size - bytes.size())
            return std::nullopt;
        for (std::size_t from = bytes.size() - back; count > 0; --count, ++from)
            bytes += bytes[from];  // what is copied may be copied again
    }
    if (bytes.size() != size)
        return std::nullopt;
    return bytes;
}

}  // namespace surfelao

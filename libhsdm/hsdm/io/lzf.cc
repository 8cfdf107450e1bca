#include "hsdm/io/lzf.hh"

#include <algorithm>
#include <cstdint>

namespace hsdm::io {

// A control byte below 32 announces one literal byte more than its value. Another begins a reference to what
// was expanded before:
//
//     LLLDDDDD [LLLLLLLL] DDDDDDDD    length L + 2, where L = 7 adds the second byte; distance D + 1
bool expand_lzf(std::string_view packed, std::span<char> out) {
    std::size_t at = 0, filled = 0;
    const auto next = [&] { return static_cast<std::uint8_t>(packed[at++]); };
    while (at < packed.size()) {
        const std::size_t control = next();
        if (control < 32) {
            const std::size_t length = control + 1;
            if (length > packed.size() - at || length > out.size() - filled) return false;
            std::copy_n(packed.data() + at, length, out.data() + filled);
            at += length;
            filled += length;
            continue;
        }
        std::size_t length = (control >> 5) + 2;
        if (packed.size() - at < (length == 9 ? 2u : 1u)) return false;
        if (length == 9) length += next();
        const std::size_t distance = ((control & 31) << 8 | next()) + 1;
        if (distance > filled || length > out.size() - filled) return false;
        // Byte by byte: the copy may reach into what it writes, which repeats it.
        for (const std::size_t end = filled + length; filled < end; ++filled)
            out[filled] = out[filled - distance];
    }
    return filled == out.size();
}

} // namespace hsdm::io

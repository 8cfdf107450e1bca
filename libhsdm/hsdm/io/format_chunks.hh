#pragma once
// Text and bytes of many alike elements, made in parallel and written in order.

#include "hsdm/io/atomic_file.hh"
#include "hsdm/types.hh"

#include <charconv>
#include <cstddef>
#include <cstring>
#include <functional>
#include <span>
#include <string>
#include <type_traits>

namespace hsdm {

/// Appends the shortest decimal that reads back to the same bits, or an integer's digits.
template <class Number>
void append_number(std::string& out, Number value) {
    char digits[32];
    const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
    out.append(digits, static_cast<std::size_t>(end - digits));
}

/// Appends a number's own bytes, which are little endian on every machine this is built for.
template <class Number>
void append_bytes(std::string& out, Number value) {
    static_assert(std::is_trivially_copyable_v<Number>);
    char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    out.append(bytes, sizeof value);
}

/// A facet's line in OFF and in text PLY.
inline void append_polygon(std::string& out, std::span<const Index> corners) {
    append_number(out, corners.size());
    for (const Index v : corners) append_number(out += ' ', v);
    out += '\n';
}

/// Calls format(out, begin, end) on consecutive pieces of 0 .. count, in parallel, and writes what they
/// appended in the order of the pieces. Holds at most a few megabytes of it at once.
void write_chunks(AtomicFile& file, std::size_t count,
                  const std::function<void(std::string& out, std::size_t begin, std::size_t end)>& format);
/// The same in memory, all at once.
std::string
formatted(std::size_t count,
          const std::function<void(std::string& out, std::size_t begin, std::size_t end)>& format);

} // namespace hsdm

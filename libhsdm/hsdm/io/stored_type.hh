#pragma once
// Numbers as binary files hold them: of several types, in either order of their bytes.

#include <cstddef>
#include <cstdint>

namespace hsdm::io {

/// Floating types are the last ones.
enum class StoredType : std::uint8_t {
    int8,
    uint8,
    int16,
    uint16,
    int32,
    uint32,
    int64,
    uint64,
    float32,
    float64
};

/// Bytes of a number.
std::size_t size_of(StoredType type);

/// Reads `count` numbers that lie `stride` bytes apart, at any address.
using Gather = void (*)(const char* at, std::size_t stride, std::size_t count, double* out);

/// For numbers of the type, the most significant byte first if `big_endian`.
Gather gather_of(StoredType type, bool big_endian);

} // namespace hsdm::io

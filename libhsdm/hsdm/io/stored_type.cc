#include "hsdm/io/stored_type.hh"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace hsdm::io {
namespace {

static_assert(std::endian::native == std::endian::little || std::endian::native == std::endian::big);

/// One number, from the file's byte order.
template <class T, bool swap>
T load(const char* at) {
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), at, sizeof(T));
    if constexpr (swap) std::reverse(bytes.begin(), bytes.end());
    return std::bit_cast<T>(bytes);
}

template <class T, bool swap>
void gather(const char* at, std::size_t stride, std::size_t count, double* out) {
    for (std::size_t i = 0; i < count; ++i) out[i] = static_cast<double>(load<T, swap>(at + i * stride));
}

template <bool swap>
Gather gather_of(StoredType type) {
    switch (type) {
    case StoredType::int8:
        return gather<std::int8_t, swap>;
    case StoredType::uint8:
        return gather<std::uint8_t, swap>;
    case StoredType::int16:
        return gather<std::int16_t, swap>;
    case StoredType::uint16:
        return gather<std::uint16_t, swap>;
    case StoredType::int32:
        return gather<std::int32_t, swap>;
    case StoredType::uint32:
        return gather<std::uint32_t, swap>;
    case StoredType::int64:
        return gather<std::int64_t, swap>;
    case StoredType::uint64:
        return gather<std::uint64_t, swap>;
    case StoredType::float32:
        return gather<float, swap>;
    case StoredType::float64:
        return gather<double, swap>;
    }
    return nullptr;
}

} // namespace

std::size_t size_of(StoredType type) {
    constexpr std::size_t sizes[] = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
    return sizes[static_cast<std::size_t>(type)];
}

Gather gather_of(StoredType type, bool big_endian) {
    const bool swap = big_endian == (std::endian::native == std::endian::little);
    return swap ? gather_of<true>(type) : gather_of<false>(type);
}

} // namespace hsdm::io

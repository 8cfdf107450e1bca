#pragma once
// Vectors as large as a cloud: their memory is touched for the first time by all threads, not page by page by
// one that nobody can stop meanwhile.

#include "hsdm/core/interruption.hh"

#include <algorithm>
#include <cstddef>
#include <type_traits>
#include <vector>

namespace hsdm {

/// Writes a byte of each page of memory that is about to be written for the first time and belongs to nothing
/// yet; in parallel, and asks in between (Interruption). Does nothing for small blocks.
void touch_pages(void* memory, std::size_t bytes);

/// Makes the vector n values long, as resize(n, value) does.
template <class T>
void resize_large(std::vector<T>& values, std::size_t n, const std::type_identity_t<T>& value = T()) {
    constexpr std::size_t step = std::max<std::size_t>(1, (std::size_t{1} << 22) / sizeof(T));
    if (n > values.capacity()) {
        values.reserve(n);
        touch_pages(values.data() + values.size(), (n - values.size()) * sizeof(T));
    }
    for (std::size_t size = values.size() + step; size < n; size += step) {
        Interruption::poll();
        values.resize(size, value);
    }
    values.resize(n, value);
}

/// As assign(n, value) does.
template <class T>
void assign_large(std::vector<T>& values, std::size_t n, const std::type_identity_t<T>& value) {
    values.clear();
    resize_large(values, n, value);
}

/// A vector of n values.
template <class T>
std::vector<T> large_vector(std::size_t n, const std::type_identity_t<T>& value = T()) {
    std::vector<T> values;
    resize_large(values, n, value);
    return values;
}

} // namespace hsdm

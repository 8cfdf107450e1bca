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

/// Values that are written between two questions whether to go on: far less than 50 ms.
template <class T>
inline constexpr std::size_t values_at_once = std::max<std::size_t>(1, (std::size_t{1} << 22) / sizeof(T));

/// Appends the values of another vector.
template <class T>
void append_large(std::vector<T>& values, const std::vector<T>& more) {
    for (std::size_t begin = 0; begin < more.size(); begin += values_at_once<T>) {
        Interruption::poll();
        const std::size_t end = std::min(more.size(), begin + values_at_once<T>);
        values.insert(values.end(), more.begin() + static_cast<std::ptrdiff_t>(begin),
                      more.begin() + static_cast<std::ptrdiff_t>(end));
    }
}

/// Makes room for n values, as reserve(n) does.
template <class T>
void reserve_large(std::vector<T>& values, std::size_t n) {
    if (n <= values.capacity()) return;
    if constexpr (std::is_trivially_copyable_v<T>) {
        std::vector<T> larger;
        larger.reserve(n);
        touch_pages(larger.data(), n * sizeof(T));
        append_large(larger, values);
        values.swap(larger);
    } else {
        values.reserve(n);
    }
}

/// Appends one value, as push_back does, to a vector that becomes large.
template <class T>
void push_large(std::vector<T>& values, const T& value) {
    if (values.size() == values.capacity())
        reserve_large(values, std::max<std::size_t>(16, values.size() + values.size() / 2)); // all touched
    values.push_back(value);
}

/// The same values again.
template <class T>
std::vector<T> copy_of_large(const std::vector<T>& values) {
    std::vector<T> copy;
    reserve_large(copy, values.size());
    append_large(copy, values);
    return copy;
}

/// Makes the vector n values long, as resize(n, value) does, also if `value` is one of its own.
template <class T>
void resize_large(std::vector<T>& values, std::size_t n, std::type_identity_t<T> value = T()) {
    constexpr std::size_t step = values_at_once<T>;
    reserve_large(values, n);
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

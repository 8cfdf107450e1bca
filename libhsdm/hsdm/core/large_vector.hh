#pragma once
// Vectors as large as a cloud: their memory is touched for the first time, and filled, by all threads, not
// page by page by one that nobody can stop meanwhile.

#include "hsdm/core/interruption.hh"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

namespace hsdm {

/// Writes a byte of each page of memory that is about to be written for the first time and belongs to nothing
/// yet; in parallel, and asks in between (Interruption). Does nothing for small blocks.
void touch_pages(void* memory, std::size_t bytes);

/// Values that are written between two questions whether to go on: far less than 50 ms.
template <class T>
inline constexpr std::size_t values_at_once = std::max<std::size_t>(1, (std::size_t{1} << 22) / sizeof(T));

/// Calls fill(context, begin, end) for consecutive ranges of [0, n), in parallel, as touch_pages() does.
void fill_blocks(std::size_t n, std::size_t per_block,
                 void (*fill)(void* context, std::size_t begin, std::size_t end), void* context);

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

/// The same where it is not known how many will come: of the memory only what is filled is touched.
template <class T>
void reserve_ahead(std::vector<T>& values, std::size_t n) {
    if (n <= values.capacity()) return;
    if constexpr (std::is_trivially_copyable_v<T>) {
        std::vector<T> larger;
        larger.reserve(n);
        append_large(larger, values);
        values.swap(larger);
    } else {
        values.reserve(n);
    }
}

/// Appends one value, as push_back does, to a vector that becomes large.
template <class T>
void push_large(std::vector<T>& values, T value) { // not by reference: it may be of the vector itself
    if (values.size() == values.capacity())
        reserve_large(values, std::max<std::size_t>(16, values.size() + values.size() / 2)); // all touched
    values.push_back(std::move(value));
}

/// The same values again.
template <class T>
std::vector<T> copy_of_large(const std::vector<T>& values) {
    std::vector<T> copy;
    reserve_large(copy, values.size());
    append_large(copy, values);
    return copy;
}

/// Empties vectors and frees their memory, which `= {}` does not.
template <class... T>
void release(std::vector<T>&... values) {
    ((values = std::vector<T>()), ...);
}

/// Values that need neither a constructor nor a destructor to be there.
template <class T>
inline constexpr bool may_be_unwritten =
    std::is_trivially_copyable_v<T>&& std::is_trivially_destructible_v<T> && !std::is_same_v<T, bool>;

/// Sets a vector's size within its capacity and writes nothing, which std::vector has no function for: that
/// of libstdc++ lets a class derived from it do so.
template <class T>
struct SizeOfVector : std::vector<T> {
    static constexpr bool can_be_set =
#ifdef __GLIBCXX__
        may_be_unwritten<T>;
    static void set(std::vector<T>& values, std::size_t n) {
        auto& memory = values.*(&SizeOfVector::_M_impl);
        memory._M_finish = memory._M_start + n;
    }
#else
        false;
    static void set(std::vector<T>&, std::size_t) {}
#endif
};

/// Makes a vector n values long, of at least as many as it has. The new ones are whatever their memory held
/// and have to be written before they are read.
template <class T>
void resize_unwritten(std::vector<T>& values, std::size_t n) {
    if constexpr (SizeOfVector<T>::can_be_set) {
        reserve_large(values, n);
#ifndef NDEBUG // what is read before it is written shows
        if (n > values.size())
            std::memset(static_cast<void*>(values.data() + values.size()), 0xa5,
                        (n - values.size()) * sizeof(T));
#endif
        SizeOfVector<T>::set(values, n);
    } else {
        values.resize(n);
    }
}

/// A vector of n values that have to be written before they are read.
template <class T>
std::vector<T> unwritten_vector(std::size_t n) {
    std::vector<T> values;
    resize_unwritten(values, n);
    return values;
}

/// Makes the vector n values long, as resize(n, value) does, also if `value` is one of its own.
template <class T>
void resize_large(std::vector<T>& values, std::size_t n, std::type_identity_t<T> value = T()) {
    constexpr std::size_t step = values_at_once<T>;
    reserve_large(values, n);
    if constexpr (SizeOfVector<T>::can_be_set) {
        constexpr std::size_t worth_it = std::size_t{1} << 20, block = std::size_t{1} << 18; // bytes
        if (n > values.size() && (n - values.size()) * sizeof(T) >= worth_it) {
            struct Rest {
                T* first;
                const T& value;
            } rest{values.data() + values.size(), value};
            fill_blocks(
                n - values.size(), std::max<std::size_t>(1, block / sizeof(T)),
                [](void* context, std::size_t begin, std::size_t end) {
                    const Rest& of = *static_cast<const Rest*>(context);
                    std::uninitialized_fill(of.first + begin, of.first + end, of.value);
                },
                &rest);
            SizeOfVector<T>::set(values, n);
            return;
        }
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

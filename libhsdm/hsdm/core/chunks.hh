#pragma once
// Fixed chunks: the unit of parallel work. Their size never follows the number of threads, so neither do
// results.

#include "hsdm/core/large_vector.hh"
#include "hsdm/types.hh"

#include <algorithm>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

namespace hsdm {

/// Items of a chunk, by what one takes: from a search of its own down to a copy.
namespace chunks {
inline constexpr std::size_t heavy = 256, slow = 1024, usual = 2048, quick = 4096, light = 1 << 14;
} // namespace chunks

inline std::size_t chunk_count(std::size_t n, std::size_t chunk_size) {
    return (n + chunk_size - 1) / chunk_size;
}

/// Calls task(context, i) for each i below n, in parallel. TBB stands behind it alone: its headers take
/// longer to compile than all else that includes this one, and a call by address costs nothing beside a task.
void run_tasks(std::size_t n, void (*task)(void* context, std::size_t i), void* context);

/// Calls f(i) for each i below n, in parallel, each a task of its own: they should be few and large. Throws
/// Cancelled if an Interruption says so.
template <class F>
void for_each_task(std::size_t n, F&& f) {
    using Function = std::remove_reference_t<F>;
    run_tasks(
        n, [](void* function, std::size_t i) { (*static_cast<Function*>(function))(i); },
        const_cast<void*>(static_cast<const void*>(std::addressof(f))));
}

/// Calls act(context) so that this thread, while it waits for a loop in it, takes no task of another one.
void run_isolated(void (*act)(void* context), void* context);

/// The same of f(): for loops in a task of a loop, whose other tasks would pile up on this thread's stack, or
/// under a lock, which another task may want.
template <class F>
void isolated(F&& f) {
    using Function = std::remove_reference_t<F>;
    run_isolated([](void* function) { (*static_cast<Function*>(function))(); },
                 const_cast<void*>(static_cast<const void*>(std::addressof(f))));
}

/// Calls f(begin, end, chunk) for consecutive ranges of [0, n), in parallel.
template <class F>
void for_chunks(std::size_t n, std::size_t chunk_size, F&& f) {
    for_each_task(chunk_count(n, chunk_size), [&](std::size_t chunk) {
        f(chunk * chunk_size, std::min(n, (chunk + 1) * chunk_size), chunk);
    });
}

/// Of few items smaller chunks, so that there is work for all threads: where nothing depends on the chunks.
inline std::size_t chunk_of_few(std::size_t n, std::size_t chunk_size) {
    return std::clamp(n / 16, std::max<std::size_t>(1, chunk_size / 16), chunk_size);
}

/// Calls f(i) for each index i below n, in parallel by chunks of that size, or less where they would be few.
template <class F>
void for_each_index(std::size_t n, std::size_t chunk_size, F&& f) {
    for_chunks(n, chunk_of_few(n, chunk_size), [&](std::size_t begin, std::size_t end, std::size_t) {
        for (auto i = static_cast<Index>(begin); i < end; ++i) f(i);
    });
}

/// Appends what chunks produced.
template <class T>
void append_parts(std::span<const std::vector<T>> parts, std::vector<T>& whole) {
    std::vector<std::size_t> offset(parts.size() + 1, whole.size());
    for (std::size_t i = 0; i < parts.size(); ++i) offset[i + 1] = offset[i] + parts[i].size();
    resize_unwritten(whole, offset.back());
    for_each_task(parts.size(), [&](std::size_t i) {
        std::copy(parts[i].begin(), parts[i].end(), whole.begin() + static_cast<std::ptrdiff_t>(offset[i]));
    });
}

/// Concatenates what the chunks produced.
template <class T>
std::vector<T> joined(const std::vector<std::vector<T>>& parts) {
    std::vector<T> whole;
    append_parts<T>(parts, whole);
    return whole;
}

/// What f(begin, end, part) appends to `part` for consecutive ranges of [0, n), one after the other, then
/// what else is given; in parallel, by chunks of that size, or less where they would be few. So many chunks
/// are joined at a time that all threads have some, and that their parts are little beside the whole.
template <class T, class F, class... Last>
std::vector<T> collected(std::size_t n, std::size_t chunk_size, F&& f, const Last&... last) {
    constexpr std::size_t at_a_time = 256;
    chunk_size = chunk_of_few(n, chunk_size);
    const std::size_t chunks = chunk_count(n, chunk_size);
    std::vector<T> whole;
    std::vector<std::vector<T>> parts(std::min(chunks, at_a_time));
    for (std::size_t done = 0; done < chunks;) {
        parts.resize(std::min(parts.size(), chunks - done));
        for_each_task(parts.size(), [&](std::size_t i) {
            parts[i].clear();
            f((done + i) * chunk_size, std::min(n, (done + i + 1) * chunk_size), parts[i]);
        });
        done += parts.size();
        std::size_t size = whole.size() + sizeof...(last);
        for (const std::vector<T>& part : parts) size += part.size();
        if (done < chunks && size > whole.capacity()) { // as many of each chunk that is left, and some more
            const std::size_t in_all = size / done * chunks;
            reserve_ahead(whole, std::max(in_all + in_all / 32, size + size / 4));
        }
        reserve_large(whole, size);
        append_parts<T>(parts, whole);
    }
    (whole.push_back(last), ...);
    return whole;
}

/// 0, 1, ... n - 1.
inline std::vector<Index> indices_below(std::size_t n) {
    std::vector<Index> indices = unwritten_vector<Index>(n);
    for_each_index(n, chunks::light, [&](Index i) { indices[i] = i; });
    return indices;
}

/// The indices below n that pass a test, ascending; tested in parallel by chunks.
template <class Test>
std::vector<Index> indices_where(std::size_t n, std::size_t chunk_size, Test&& test) {
    return collected<Index>(n, chunk_size, [&](std::size_t begin, std::size_t end, std::vector<Index>& part) {
        for (auto i = static_cast<Index>(begin); i < end; ++i)
            if (test(i)) part.push_back(i);
    });
}

/// Sorts values and leaves each once.
template <class T>
void sort_unique(std::vector<T>& values) {
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
}
inline constexpr std::size_t gathered_ahead = 16; // prefetched: places need not ascend

/// The values at these places, in parallel.
template <class T>
std::vector<T> gathered(const std::vector<T>& values, const std::vector<Index>& places) {
    std::vector<T> result = unwritten_vector<T>(places.size());
    for_each_index(places.size(), chunks::light, [&](Index i) {
        if (i + gathered_ahead < places.size()) __builtin_prefetch(&values[places[i + gathered_ahead]]);
        result[i] = values[places[i]];
    });
    return result;
}

/// Turns counts stored one place to the right, {0, n0, n1, ...}, into first positions {0, n0, n0 + n1, ...}.
inline void counts_to_first(std::vector<Index>& first) {
    Index sum = 0;
    for_each_in_order(first.size(), [&](std::size_t i) { first[i] = sum += first[i]; });
}

} // namespace hsdm

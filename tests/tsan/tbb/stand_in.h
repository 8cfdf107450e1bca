#pragma once
// The part of oneTBB's interface that the project uses, on plain std::thread.
//
// The thread sanitizer sees a hand-over between threads only if both sides of it were built with the
// sanitizer. The installed TBB library was not, so every task would look like a race with whoever started it,
// and a suppression wide enough to silence that silences the project's own races too. In a sanitizer build
// these headers therefore come before TBB's. What they check is what the project promises: that the bodies of
// its parallel loops do not touch each other's data. Loops inside loops run in their thread, one by one.

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <map>
#include <mutex>
#include <thread>
#include <type_traits>
#include <vector>

namespace tbb {
namespace stand_in {

inline constexpr std::size_t default_threads = 4; // more than one even on a single core
inline std::atomic<std::size_t> thread_limit{default_threads};
inline thread_local bool inside_loop = false;

/// body(i) for i in [0, count), on several threads; the first exception is thrown on once all have ended.
template <class Body>
void run(std::size_t count, const Body& body) {
    const std::size_t threads = std::min(thread_limit.load(), count);
    if (threads <= 1 || inside_loop) {
        for (std::size_t i = 0; i < count; ++i) body(i);
        return;
    }
    std::mutex mutex;
    std::exception_ptr failure;
    // Dealt out in turn, so that neighbours are always in different threads, however short the bodies are.
    const auto work = [&](std::size_t first) {
        inside_loop = true;
        for (std::size_t i = first; i < count; i += threads) {
            try {
                body(i);
            } catch (...) {
                const std::lock_guard lock(mutex);
                if (!failure) failure = std::current_exception();
            }
        }
        inside_loop = false;
    };
    std::vector<std::thread> others;
    for (std::size_t t = 1; t < threads; ++t) others.emplace_back(work, t);
    work(0);
    for (std::thread& other : others) other.join();
    if (failure) std::rethrow_exception(failure);
}

} // namespace stand_in

struct simple_partitioner {};
struct auto_partitioner {};
struct static_partitioner {};

template <class Value>
class blocked_range {
public:
    using const_iterator = Value;
    blocked_range(Value begin, Value end, std::size_t grain = 1) : begin_(begin), end_(end), grain_(grain) {}
    Value begin() const { return begin_; }
    Value end() const { return end_; }
    std::size_t size() const { return static_cast<std::size_t>(end_ - begin_); }
    bool empty() const { return !(begin_ < end_); }
    std::size_t grainsize() const { return grain_; }

    /// Pieces no larger than the grain, but at most 64 of them unless `exact`.
    std::size_t pieces(bool exact) const {
        const std::size_t count = (size() + grain_ - 1) / grain_;
        return exact ? count : std::min<std::size_t>(count, 64);
    }
    blocked_range piece(std::size_t i, std::size_t count) const {
        return {at(size() * i / count), at(size() * (i + 1) / count), grain_};
    }

private:
    Value at(std::size_t offset) const {
        if constexpr (std::is_integral_v<Value>)
            return static_cast<Value>(begin_ + static_cast<Value>(offset));
        else
            return begin_ + static_cast<std::ptrdiff_t>(offset);
    }

    Value begin_, end_;
    std::size_t grain_;
};

template <class Value, class Body, class Partitioner = auto_partitioner>
void parallel_for(const blocked_range<Value>& range, const Body& body, const Partitioner& = {}) {
    if (range.empty()) return;
    const std::size_t count = range.pieces(std::is_same_v<Partitioner, simple_partitioner>);
    stand_in::run(count, [&](std::size_t i) { body(range.piece(i, count)); });
}

template <class Int, class Body, class Partitioner = auto_partitioner>
requires std::is_integral_v<Int>
void parallel_for(Int first, Int last, const Body& body, const Partitioner& = {}) {
    if (!(first < last)) return;
    stand_in::run(static_cast<std::size_t>(last - first),
                  [&](std::size_t i) { body(static_cast<Int>(first + static_cast<Int>(i))); });
}

template <class Value, class Result, class Body, class Join, class Partitioner = auto_partitioner>
Result parallel_reduce(const blocked_range<Value>& range, const Result& identity, const Body& body,
                       const Join& join, const Partitioner& = {}) {
    if (range.empty()) return identity;
    const std::size_t count = range.pieces(std::is_same_v<Partitioner, simple_partitioner>);
    std::vector<std::vector<Result>> partial(count); // one each, so that bits of vector<bool> are not shared
    stand_in::run(count, [&](std::size_t i) { partial[i].push_back(body(range.piece(i, count), identity)); });
    Result result = partial.front().front();
    for (std::size_t i = 1; i < count; ++i) result = join(result, partial[i].front());
    return result;
}

template <class Value, class Result, class Body, class Join, class... Partitioner>
Result parallel_deterministic_reduce(const blocked_range<Value>& range, const Result& identity,
                                     const Body& body, const Join& join, const Partitioner&...) {
    return parallel_reduce(range, identity, body, join, simple_partitioner());
}

template <class... Works>
void parallel_invoke(const Works&... works) {
    const auto nth = [&](std::size_t wanted) {
        std::size_t at = 0;
        ((at++ == wanted ? works() : void()), ...);
    };
    stand_in::run(sizeof...(works), nth);
}

template <class Iterator, class... Compare>
void parallel_sort(Iterator begin, Iterator end, const Compare&... compare) {
    std::sort(begin, end, compare...);
}

class global_control {
public:
    enum parameter { max_allowed_parallelism, thread_stack_size };
    global_control(parameter, std::size_t value) : before_(stand_in::thread_limit.exchange(value)) {}
    ~global_control() { stand_in::thread_limit = before_; }
    global_control(const global_control&) = delete;
    global_control& operator=(const global_control&) = delete;
    static std::size_t active_value(parameter) { return stand_in::thread_limit; }

private:
    std::size_t before_;
};

class task_arena {
public:
    static constexpr int automatic = -1;
    explicit task_arena(int threads = automatic) : threads_(threads) {}
    int max_concurrency() const {
        return threads_ > 0 ? threads_ : static_cast<int>(stand_in::thread_limit.load());
    }
    template <class Work>
    auto execute(const Work& work) const {
        const global_control bound(
            global_control::max_allowed_parallelism,
            std::min<std::size_t>(stand_in::thread_limit, static_cast<std::size_t>(max_concurrency())));
        return work();
    }

private:
    int threads_;
};

namespace this_task_arena {
inline int max_concurrency() {
    return static_cast<int>(stand_in::thread_limit.load());
}
template <class Work>
auto isolate(const Work& work) {
    return work();
}
} // namespace this_task_arena

template <class Value>
class enumerable_thread_specific {
public:
    enumerable_thread_specific() = default;
    explicit enumerable_thread_specific(const Value& first) : first_(first) {}
    Value& local() {
        const std::lock_guard lock(mutex_);
        return values_.try_emplace(std::this_thread::get_id(), first_).first->second;
    }

private:
    Value first_{};
    std::mutex mutex_;
    std::map<std::thread::id, Value> values_;
};

} // namespace tbb

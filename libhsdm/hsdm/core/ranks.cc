#include "hsdm/core/ranks.hh"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <new>
#include <numeric>

namespace hsdm {
namespace {

using Clock = std::chrono::steady_clock;

class Stopwatch {
public:
    explicit Stopwatch(double& seconds) : seconds_(seconds) {}
    ~Stopwatch() { seconds_ += std::chrono::duration<double>(Clock::now() - start_).count(); }
    Stopwatch(const Stopwatch&) = delete;
    Stopwatch& operator=(const Stopwatch&) = delete;

private:
    double& seconds_;
    Clock::time_point start_ = Clock::now();
};

} // namespace

void Ranks::together(const std::function<void()>& work) {
    try {
        work();
    } catch (const OtherRankFailed&) { // they know
        throw;
    } catch (const std::bad_alloc&) {
        fail("out of memory");
        throw;
    } catch (const std::exception& error) {
        fail(error.what());
        throw;
    }
    gather(Bytes());
    done_ = true;
}

void Ranks::leave() noexcept {
    if (!done_) fail("a process has ended before the work of all was done");
}

void Ranks::fail(const std::string& why) noexcept {
    if (failed_) return; // all know that one has, and none comes to another gather
    try {
        gather_with(State::failed, Bytes(why.begin(), why.end()));
    } catch (const OtherRankFailed&) { // what is told is why this one has
    } catch (...) {
        abort(why);
    }
}

void Ranks::give_up(const std::string& why) {
    try {
        gather_with(State::gave_up, Bytes(why.begin(), why.end()));
    } catch (const OtherRankGaveUp&) { // all know, this one too
    }
}

/// Every gather tells of failures before what it is for, and of these before what is only given up.
std::vector<Ranks::Bytes> Ranks::gather_with(State state, const Bytes& own) {
    Bytes sent(own.size() + 1, static_cast<char>(state));
    std::ranges::copy(own, sent.begin() + 1);
    bytes_sent_ += own.size() * static_cast<std::size_t>(size() - 1);
    std::vector<Bytes> got;
    {
        const Stopwatch watch(seconds_waited_);
        got = gather_bytes(sent);
    }
    for (const State other : {State::failed, State::gave_up}) {
        const auto is = [&](const Bytes& bytes) { return bytes.front() == static_cast<char>(other); };
        const auto first = std::ranges::find_if(got, is);
        if (first == got.end()) continue;
        std::string why(first->begin() + 1, first->end());
        if (!std::ranges::all_of(got, is))
            why += " (rank " + std::to_string(first - got.begin()) + " of " + std::to_string(size()) + ")";
        if (other == State::gave_up) throw OtherRankGaveUp(why);
        failed_ = true;
        throw OtherRankFailed(why);
    }
    for (Bytes& bytes : got) bytes.erase(bytes.begin());
    return got;
}

std::vector<Ranks::Bytes> Ranks::gather(const Bytes& own) {
    return gather_with(State::well, own);
}

std::vector<std::uint64_t> Ranks::gather(std::uint64_t own) {
    Bytes bytes;
    put(own, bytes);
    std::vector<std::uint64_t> all;
    for (const Bytes& got : gather(bytes)) all.push_back(ByteReader(got).take<std::uint64_t>());
    return all;
}

std::uint64_t Ranks::sum(std::uint64_t own) {
    const std::vector<std::uint64_t> all = gather(own);
    return std::accumulate(all.begin(), all.end(), std::uint64_t{0});
}

std::vector<std::uint8_t> Ranks::any_of_each(const std::vector<std::uint8_t>& own) {
    std::vector<std::uint8_t> any(own.size(), 0);
    for (const Bytes& got : gather(bytes_of(own)))
        std::ranges::transform(any, got, any.begin(),
                               [](std::uint8_t a, char b) { return static_cast<std::uint8_t>(a | b); });
    return any;
}

bool Ranks::of_first(bool own) {
    return gather(std::uint64_t{own}).front() != 0;
}

Ranks::Bytes Ranks::of_first(Bytes&& own) {
    if (size() == 1) return std::move(own);
    constexpr std::size_t at_once = std::size_t{1} << 28; // a gather has a bound
    const std::size_t all = gather(std::uint64_t{own.size()}).front();
    Bytes got;
    got.reserve(is_first() ? 0 : all);
    for (std::size_t begin = 0; begin < all; begin += at_once) {
        Bytes some;
        if (is_first()) append_bytes(own.data() + begin, std::min(at_once, all - begin), some);
        const std::vector<Bytes> part = gather(some);
        if (!is_first()) append_bytes(part.front().data(), part.front().size(), got);
    }
    return is_first() ? std::move(own) : got;
}

std::vector<Ranks::Bytes> Ranks::exchange(std::vector<Bytes>&& out) {
    std::vector<std::uint64_t> own(out.size());
    std::ranges::transform(out, own.begin(), [](const Bytes& bytes) { return bytes.size(); });
    const std::vector<Bytes> gathered = gather(bytes_of(own));
    const auto self = static_cast<std::size_t>(rank());
    bytes_sent_ += std::accumulate(own.begin(), own.end(), std::uint64_t{0}) - own[self];
    const Stopwatch watch(seconds_waited_);
    try {
        std::vector<std::vector<std::uint64_t>> sizes;
        sizes.reserve(gathered.size());
        for (const Bytes& got : gathered) sizes.push_back(ByteReader(got).take_rest<std::uint64_t>());
        return exchange_bytes(std::move(out), sizes);
    } catch (const std::exception& error) { // the others are at it and cannot be told
        abort(std::string("what other ranks send cannot be received: ") + error.what());
        throw; // which abort() does not return to
    }
}

void append_bytes(const void* first, std::size_t count, Ranks::Bytes& bytes) {
    const auto from = static_cast<const char*>(first);
    bytes.insert(bytes.end(), from, from + count);
}

void ByteReader::copy(void* to, std::size_t count) {
    if (count > bytes_.size() - at_) throw Error("another rank sent less than it should have");
    if (count > 0) std::memcpy(to, bytes_.data() + at_, count);
    at_ += count;
}

} // namespace hsdm

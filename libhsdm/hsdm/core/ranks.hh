#pragma once
// Processes that work on one thing together, each at a part of it, and what they tell each other.

#include "hsdm/core/shared_file.hh"
#include "hsdm/errors.hh"

#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace hsdm {

/// Thrown by every rank that has not failed itself once another one has. what(): why that one did.
class OtherRankFailed : public Error {
public:
    using Error::Error;
};

/// The same where that one only gave up what they were at, and all can do something else.
class OtherRankGaveUp : public OtherRankFailed {
public:
    using OtherRankFailed::OtherRankFailed;
};

/// The ranks of one piece of work, this process being one. All call the same functions in the same order;
/// each call waits for all. A rank that throws out of together() takes the others along: their next call
/// throws OtherRankFailed, so that none waits for what does not come.
class Ranks {
public:
    using Bytes = std::vector<char>;

    Ranks() = default;
    virtual ~Ranks() = default;
    Ranks(const Ranks&) = delete;
    Ranks& operator=(const Ranks&) = delete;

    virtual int rank() const = 0; ///< [0, size())
    virtual int size() const = 0;
    bool is_first() const { return rank() == 0; }

    /// Runs work(), which may throw, and waits for all to have done theirs.
    void together(const std::function<void()>& work);
    /// Tells the others, unless all know already that a rank has failed or have been through together(): to
    /// be called by one that ends, whatever it ends for.
    void leave() noexcept;

    /// Tells the others that this rank gives up what all are at; those that did not call it too throw
    /// OtherRankGaveUp from their next call. Whoever has thrown or called it is to go on with the same next
    /// step as all others. Throws OtherRankFailed if one has failed meanwhile.
    void give_up(const std::string& why);

    /// What every rank gives, by rank.
    std::vector<Bytes> gather(const Bytes& own);
    /// Sends `out[r]` to rank r; returns what each rank sent here. `out` has an entry for each.
    std::vector<Bytes> exchange(std::vector<Bytes>&& out);

    std::vector<std::uint64_t> gather(std::uint64_t own); ///< a number of each rank
    std::uint64_t sum(std::uint64_t own);
    bool any(bool own) { return sum(own ? 1 : 0) > 0; }
    /// Entry by entry, does any rank give a 1? All give as many.
    std::vector<std::uint8_t> any_of_each(const std::vector<std::uint8_t>& own);
    /// What the first rank gives.
    bool of_first(bool own);
    Bytes of_first(Bytes&& own);

    /// An existing file, for all ranks at the same time; null on a rank that cannot write it.
    virtual std::unique_ptr<SharedFile> open_shared(const std::string& path) { return open_positioned(path); }

    std::size_t bytes_sent() const { return bytes_sent_; }    ///< to other ranks so far
    double seconds_waited() const { return seconds_waited_; } ///< for others and for what they sent

private:
    /// As gather() and exchange(). `sizes[s][r]`: how many bytes rank s sends to rank r.
    virtual std::vector<Bytes> gather_bytes(const Bytes& own) = 0;
    virtual std::vector<Bytes> exchange_bytes(std::vector<Bytes>&& out,
                                              const std::vector<std::vector<std::uint64_t>>& sizes) = 0;
    /// Ends all ranks at once, where one cannot go on that others wait for.
    [[noreturn]] virtual void abort(const std::string& why) noexcept = 0;

    enum class State : char { well, failed, gave_up };
    std::vector<Bytes> gather_with(State state, const Bytes& own);
    void fail(const std::string& why) noexcept;

    std::size_t bytes_sent_ = 0;
    double seconds_waited_ = 0;
    bool failed_ = false; ///< one of them, as all know
    bool done_ = false;   ///< all have done their work
};

/// One process alone.
class OneRank final : public Ranks {
public:
    int rank() const override { return 0; }
    int size() const override { return 1; }

private:
    std::vector<Bytes> gather_bytes(const Bytes& own) override { return {own}; }
    std::vector<Bytes> exchange_bytes(std::vector<Bytes>&& out,
                                      const std::vector<std::vector<std::uint64_t>>&) override {
        return std::move(out);
    }
    [[noreturn]] void abort(const std::string&) noexcept override { std::terminate(); }
};

void append_bytes(const void* first, std::size_t count, Ranks::Bytes& bytes);

/// Values as bytes, for processes of one machine type.
template <class T>
void append_bytes(std::span<const T> values, Ranks::Bytes& bytes) {
    static_assert(std::is_trivially_copyable_v<T>);
    append_bytes(values.data(), values.size_bytes(), bytes);
}

template <class T>
Ranks::Bytes bytes_of(const std::vector<T>& values) {
    Ranks::Bytes bytes;
    append_bytes(std::span<const T>(values), bytes);
    return bytes;
}

/// Takes back what append_bytes() wrote, in that order.
class ByteReader {
public:
    explicit ByteReader(const Ranks::Bytes& bytes) : bytes_(bytes) {}
    bool at_end() const { return at_ == bytes_.size(); }

    template <class T>
    T take() {
        T value;
        copy(&value, sizeof value);
        return value;
    }
    /// A vector that put_vector() wrote.
    template <class T>
    std::vector<T> take_vector() {
        std::vector<T> values(take<std::uint64_t>());
        copy(values.data(), values.size() * sizeof(T));
        return values;
    }
    /// A text that put_text() wrote.
    std::string take_text() {
        const std::vector<char> text = take_vector<char>();
        return {text.begin(), text.end()};
    }
    /// All that is left.
    template <class T>
    std::vector<T> take_rest() {
        std::vector<T> values((bytes_.size() - at_) / sizeof(T));
        copy(values.data(), values.size() * sizeof(T));
        return values;
    }

private:
    void copy(void* to, std::size_t count);

    const Ranks::Bytes& bytes_;
    std::size_t at_ = 0;
};

/// The values of all ranks, one rank's after the other's; of simple types.
template <class T>
std::vector<T> values_of_all(Ranks& ranks, const std::vector<T>& own) {
    if (ranks.size() == 1) return own;
    std::vector<T> all;
    for (const Ranks::Bytes& got : ranks.gather(bytes_of(own))) {
        const std::vector<T> values = ByteReader(got).take_rest<T>();
        all.insert(all.end(), values.begin(), values.end());
    }
    return all;
}

template <class T>
void put(const T& value, Ranks::Bytes& bytes) {
    append_bytes(std::span<const T>(&value, 1), bytes);
}
template <class T>
void put_vector(const std::vector<T>& values, Ranks::Bytes& bytes) {
    put(std::uint64_t{values.size()}, bytes);
    append_bytes(std::span<const T>(values), bytes);
}
inline void put_text(const std::string& text, Ranks::Bytes& bytes) {
    put(std::uint64_t{text.size()}, bytes);
    append_bytes(text.data(), text.size(), bytes);
}

} // namespace hsdm

#pragma once
// A text too long to be held, made a stretch at a time, as often as it is asked for.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace hsdm {

class LongText {
public:
    /// Appends elements begin .. end - 1. Called from several threads.
    using Format = std::function<void(std::string& out, std::size_t begin, std::size_t end)>;

    void add(std::string text);
    void add(std::size_t count, Format format);

    /// Of all of it, which is made for that once.
    std::uint64_t size() const;
    std::size_t stretches() const;
    /// A few megabytes at most of lines of usual length.
    std::string stretch(std::size_t i) const;

private:
    struct Part {
        std::size_t count;
        Format format;
    };
    std::vector<Part> parts_;
};

} // namespace hsdm

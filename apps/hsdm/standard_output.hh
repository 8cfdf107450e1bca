#pragma once
// Standard output that keeps why it failed, which the library's own streams forget.

#include <array>
#include <streambuf>

namespace hsdm::command {

/// Stands in std::cout's place from its making to its end, so one at a time.
class StandardOutput : public std::streambuf {
public:
    StandardOutput();
    ~StandardOutput() override;
    StandardOutput(const StandardOutput&) = delete;
    StandardOutput& operator=(const StandardOutput&) = delete;

    /// Writes what is left. Throws Error if it, or what was written before, could not be.
    void finish();

protected:
    int_type overflow(int_type character) override;
    int sync() override;

private:
    std::streambuf* before_;
    std::array<char, 1 << 12> buffer_;
    int error_ = 0; // the first; nothing is written behind it
};

} // namespace hsdm::command

#pragma once
// Exceptions of the public functions. Stages throw OptionError for their own options and nothing else: what
// goes wrong with the data is counted in a report.

#include <cstddef>
#include <stdexcept>
#include <string>

namespace hsdm {

/// Bad input or output. what() reads `FILE:LINE: what, and what to do`; `FILE: ...` where no line applies.
class Error : public std::runtime_error {
public:
    /// The message as it is, where no file is to be named.
    explicit Error(const std::string& message) : std::runtime_error(message) {}
    /// `FILE: message`.
    Error(const std::string& file, const std::string& message) : std::runtime_error(file + ": " + message) {}
    /// `FILE:LINE: message`; lines count from 1.
    Error(const std::string& file, std::size_t line, const std::string& message)
        : std::runtime_error(file + ":" + std::to_string(line) + ": " + message) {}
};

/// An option out of its range, e.g. `max_depth 40: must lie in [1, 16]`.
class OptionError : public std::invalid_argument {
public:
    using std::invalid_argument::invalid_argument;
};

/// The caller's progress callback asked to stop.
class Cancelled : public std::runtime_error {
public:
    Cancelled() : std::runtime_error("cancelled") {}
};

} // namespace hsdm

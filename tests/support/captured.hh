#pragma once
// What is printed to standard error in this process: OpenMesh's words.

#include <iostream>
#include <sstream>
#include <string>

namespace hsdm::support {

/// Takes what is written to std::cerr while it lives.
class Captured {
public:
    Captured() : old_(std::cerr.rdbuf(text_.rdbuf())) {}
    ~Captured() { std::cerr.rdbuf(old_); }
    Captured(const Captured&) = delete;
    Captured& operator=(const Captured&) = delete;

    std::string text() const { return text_.str(); }

private:
    std::ostringstream text_;
    std::streambuf* old_;
};

} // namespace hsdm::support

#pragma once
// What all fuzzers share: how one says that a promise was broken.

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace hsdm::fuzz {

/// Ends the process: the fuzzer keeps the input.
[[noreturn]] inline void broken(const std::string& promise) {
    std::fprintf(stderr, "broken promise: %s\n", promise.c_str());
    std::abort();
}

inline void promise(bool kept, const char* what) {
    if (!kept) broken(what);
}

} // namespace hsdm::fuzz

#pragma once
// Code that runs when a module is loaded, and tells.

#include <cstdlib>
#include <fstream>

namespace hsdm::test {

/// Makes the file that HSDM_TEST_LOADED names, if it is set.
struct WhenLoaded {
    WhenLoaded() {
        if (const char* path = std::getenv("HSDM_TEST_LOADED")) std::ofstream(path) << "loaded";
    }
};

} // namespace hsdm::test

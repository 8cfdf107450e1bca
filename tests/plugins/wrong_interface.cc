// A module of an interface to come: only the version may be read of it.

#include <cstdint>

extern "C" const std::uint32_t* hsdm_plugin() {
    static const std::uint32_t abi = 4711;
    return &abi;
}

// A module of an interface to come: only the version may be read of it, nothing else is there.

#include "hsdm/plugin.hh"

#include <cstdint>

extern "C" const hsdm::PluginInfo* hsdm_plugin() {
    alignas(hsdm::PluginInfo) static const std::uint32_t abi = 4711;
    return reinterpret_cast<const hsdm::PluginInfo*>(&abi);
}

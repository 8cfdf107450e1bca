// A module of the right interface, built for another hsdm.

#include "hsdm/plugin.hh"

extern "C" const hsdm::PluginInfo* hsdm_plugin() {
    static const hsdm::PluginInfo info{
        hsdm::plugin_abi, "hsdm 0.0.0, compiler of old, OpenMesh 1", nullptr, nullptr, nullptr, nullptr};
    return &info;
}

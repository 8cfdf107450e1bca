// A module that tells of itself but exports nothing.

#include "hsdm/plugin.hh"

__attribute__((section(".hsdm_plugin"), used)) static constexpr char record[] =
    HSDM_PLUGIN_MARK "\0" HSDM_PLUGIN_BUILD "\0no_function\0\0";

// A module of an interface to come: only the version and the build may be read of it.

__attribute__((section(".hsdm_plugin"), used)) static constexpr char record[] =
    "hsdm module 4711\0of the future";

extern "C" const void* hsdm_plugin() {
    return nullptr;
}

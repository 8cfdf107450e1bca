#pragma once
/// \file
/// What a processing module is: a shared library that exports one function, `hsdm_plugin`, and tells of
/// itself in its section `.hsdm_plugin`, so that what it is and how it was built is read without running it.
/// A module:
///
///     std::string scale(hsdm::PolyMesh& mesh, const hsdm::PluginOptions& options) {
///         const double factor = options.number("factor", 1);
///         for (const auto v : mesh.vertices()) mesh.set_point(v, factor * mesh.point(v));
///         return "scaled by " + options.text("factor", "1");
///     }
///     HSDM_PLUGIN("scale", "multiplies all coordinates", "factor=1 (length): above 0", scale)

#include "hsdm/mesh_types.hh"
#include "hsdm/plugin_build.hh"

#include <cstddef>
#include <cstdint>
#include <string>

namespace hsdm {

/// Version of this interface. The record's first two texts and PluginInfo's first two members stay what they
/// are in every version.
#define HSDM_PLUGIN_ABI 3
/// The same as a number.
inline constexpr std::uint32_t plugin_abi = HSDM_PLUGIN_ABI;

/// How the record begins.
#define HSDM_PLUGIN_MARK "hsdm module " HSDM_STRINGIFY(HSDM_PLUGIN_ABI)

/// One `key=value`, as it was given.
struct PluginOption {
    const char* key;   ///< ends with zero
    const char* value; ///< ends with zero
};

/// What `hsdm_plugin` returns. Everything points to memory that lives as long as the process.
struct PluginInfo {
    std::uint32_t abi; ///< plugin_abi
    const char* build; ///< HSDM_PLUGIN_BUILD
    /// Works on the mesh and writes one line, what it did or what was wrong, of at most `capacity` characters
    /// with the final zero. Returns 0 when done, 2 for a wrong option, 1 for any other failure. Never throws.
    int (*process)(PolyMesh& mesh, const PluginOption* options, std::size_t count, char* message,
                   std::size_t capacity);
};

/// The `key=value` options a module was called with. hsdm has checked them against those that the module
/// declares; for other callers each of the functions checks what it returns.
class PluginOptions {
public:
    /// Keeps the pointer: the options must outlive it.
    PluginOptions(const PluginOption* options, std::size_t count) : options_(options), count_(count) {}

    /// Whether the key is given.
    bool has(const char* key) const { return find(key) != nullptr; }
    /// The value, or the fallback where the key is not given. Throws OptionError for no finite number.
    double number(const char* key, double fallback) const;
    /// The same for whole numbers of 0 or more that an int holds.
    int count(const char* key, int fallback) const;
    /// An angle above 0 and below 180 degrees, which the value is in; it and the fallback in radians.
    double angle(const char* key, double fallback) const;
    /// The value as it was given, or the fallback.
    std::string text(const char* key, const char* fallback) const;

private:
    const char* find(const char* key) const;
    const char* checked(const char* key, const char* kind) const;

    const PluginOption* options_;
    std::size_t count_;
};

/// A module's work: changes the mesh and returns one line on what it did. May throw; OptionError for a wrong
/// option.
using PluginFunction = std::string (*)(PolyMesh&, const PluginOptions&);
/// Carries a module's function over the C interface: exceptions become the message and the result, which are
/// as PluginInfo::process has them.
int run_plugin(PluginFunction function, PolyMesh& mesh, const PluginOption* options, std::size_t count,
               char* message, std::size_t capacity) noexcept;

} // namespace hsdm

/// Defines the record and the exported function. Once per module, at namespace scope. Name, description (one
/// line) and options (as StageOption's declarations, `key=fallback (kind): help` with `; ` between them) are
/// string literals: the record is one text, in which zeros part mark, build, name, description and options.
#define HSDM_PLUGIN(plugin_name, plugin_description, plugin_options, plugin_function)                        \
    __attribute__((section(".hsdm_plugin"), used)) static constexpr char hsdm_plugin_record[] =              \
        HSDM_PLUGIN_MARK "\0" HSDM_PLUGIN_BUILD "\0" plugin_name "\0" plugin_description                     \
                         "\0" plugin_options;                                                                \
    extern "C" __attribute__((visibility("default"))) const hsdm::PluginInfo* hsdm_plugin() {                \
        static constexpr hsdm::PluginInfo info{                                                              \
            hsdm::plugin_abi, hsdm_plugin_record + sizeof HSDM_PLUGIN_MARK,                                  \
            [](hsdm::PolyMesh& mesh, const hsdm::PluginOption* options, std::size_t count, char* message,    \
               std::size_t capacity) {                                                                       \
                return hsdm::run_plugin(plugin_function, mesh, options, count, message, capacity);           \
            }};                                                                                              \
        return &info;                                                                                        \
    }

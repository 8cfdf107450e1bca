#pragma once
// The record in a processing module's file that describes it, read without running any of its code.

#include <cstdint>
#include <optional>
#include <string>

namespace hsdm::io {
class SourceBytes;
}

namespace hsdm {

/// The texts of HSDM_PLUGIN. Of another interface than plugin_abi, `abi` and `build` only.
struct PluginRecord {
    std::uint32_t abi = 0;
    std::string build, name, description, options;
};

/// The record of a shared library of this machine's kind; nothing if the file is none, has none, or is
/// malformed in a way that hides it. Reads headers and record only, O(sections). Throws Error if the file
/// cannot be read.
std::optional<PluginRecord> read_plugin_record(const io::SourceBytes& file);

} // namespace hsdm

#include "hsdm/io/source_bytes.hh"
#include "hsdm/modules/plugin_record.hh"
#include "hsdm/plugin.hh"
#include "support/folder.hh"

#include <catch2/catch.hpp>

#include <cstring>
#include <sstream>
#include <utility>

#include <link.h>

using namespace hsdm;

namespace {

std::optional<PluginRecord> record_of(const std::string& bytes) {
    std::istringstream stream(bytes);
    return read_plugin_record(io::SourceBytes::read(stream, "module"));
}

} // namespace

TEST_CASE("what a module says of itself is read from its bytes") {
    const auto record = record_of(support::read_file(HSDM_EXAMPLE_DIR "/scale.so"));
    REQUIRE(record);
    CHECK(record->abi == plugin_abi);
    CHECK(record->build == HSDM_PLUGIN_BUILD);
    CHECK(record->name == "scale");
    CHECK(record->description == "multiplies all coordinates");
    CHECK(record->options == "factor=1 (length): above 0");
}

TEST_CASE("a damaged module has a record or none, and is never read outside its bytes") {
    const std::string whole = support::read_file(HSDM_ODD_MODULE_DIR "/wrong_interface.so"); // a small one
    REQUIRE(whole.size() > 64);
    REQUIRE(record_of(whole)->abi == 4711);
    for (const std::size_t size : {0u, 3u, 16u, 63u, 64u, 1000u})
        CHECK_FALSE(record_of(whole.substr(0, size)));
    CHECK_FALSE(record_of(whole.substr(0, whole.size() - 1))); // the table of sections is the last thing
    // Every byte of the header, and of the table's first entries, made the least and the greatest.
    for (std::size_t at = 0; at < 64; ++at)
        for (const char value : {'\0', '\x7f', '\xff'}) {
            std::string damaged = whole;
            damaged[at] = value;
            CHECK_NOTHROW(record_of(damaged));
        }
    ElfW(Ehdr) header;
    std::memcpy(&header, whole.data(), sizeof header);
    std::string damaged = whole;
    for (std::size_t at = header.e_shoff; at < whole.size(); ++at) {
        const char before = std::exchange(damaged[at], '\xff');
        const auto record = record_of(damaged);
        if (record && record->build != "of the future") FAIL(record->build);
        damaged[at] = before;
    }
}

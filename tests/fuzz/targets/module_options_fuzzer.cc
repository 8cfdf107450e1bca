// `name:key=value,...` as `hsdm process` takes it, and what a module makes of the options.

#include "fuzz/targets/fuzz.hh"
#include "hsdm/errors.hh"
#include "hsdm/modules/plugin_loader.hh"
#include "hsdm/plugin.hh"

#include <cmath>
#include <cstring>

using namespace hsdm;
using hsdm::fuzz::promise;

namespace {

/// Runs `use`; false if it says that an option is wrong.
template <class Use>
bool accepted(const Use& use) {
    try {
        use();
    } catch (const OptionError&) {
        return false;
    }
    return true;
}

void check(const PluginRequest& request) {
    promise(!request.name.empty(), "a request has a name");
    std::vector<PluginOption> plain;
    for (const auto& [key, value] : request.arguments) {
        promise(!key.empty(), "an option has a key");
        plain.push_back({key.c_str(), value.c_str()});
    }
    const PluginOptions options(plain.data(), plain.size());
    const auto known = parse_stage_options("factor=1 (number): a; rounds=3 (count): b; name= (text): c");
    if (accepted([&] { check_stage_arguments("stage", known, request.arguments); }))
        promise(plain.size() <= 3, "of three known options each stands once at most");
    for (const PluginOption& option : plain) {
        promise(options.has(option.key), "an option that was given is there");
        accepted([&] { promise(!std::isnan(options.number(option.key, 0)), "a number is a number"); });
        accepted([&] { promise(options.count(option.key, 0) >= 0, "a count is none below 0"); });
        options.text(option.key, "");
    }
    promise(options.number("not there", 7) == 7 || options.has("not there"), "a fallback is what was given");

    // The message fits its room, however long the key is.
    char message[16];
    std::memset(message, 'x', sizeof message);
    PolyMesh mesh;
    const auto refuse = [](PolyMesh&, const PluginOptions& given) -> std::string {
        given.count("rounds", 0);
        return "done";
    };
    const int result = run_plugin(refuse, mesh, plain.data(), plain.size(), message, sizeof message);
    promise(std::memchr(message, 0, sizeof message) != nullptr, "a message ends in its room");
    promise(result == 0 || options.has("rounds"), "an option that is not there is not refused");
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    accepted([&] { check(parse_plugin_request({reinterpret_cast<const char*>(bytes), size})); });
    return 0;
}

#include "hsdm/plugin.hh"

#include "hsdm/errors.hh"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <new>
#include <numbers>
#include <string_view>

namespace hsdm {
namespace {

template <class T>
T parse(const char* key, std::string_view text, const char* kind) {
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size())
        throw OptionError(std::string(key) + " " + std::string(text) + ": must be " + kind);
    return value;
}

/// As much of the text as fits, always ended by a zero.
void copy_message(std::string_view text, char* message, std::size_t capacity) {
    if (capacity == 0) return;
    const std::size_t length = std::min(text.size(), capacity - 1);
    std::copy_n(text.data(), length, message);
    message[length] = '\0';
}

} // namespace

const char* PluginOptions::find(const char* key) const {
    for (std::size_t i = 0; i < count_; ++i)
        if (std::strcmp(options_[i].key, key) == 0) return options_[i].value;
    return nullptr;
}

void PluginOptions::allow(std::initializer_list<const char*> known) const {
    for (std::size_t i = 0; i < count_; ++i) {
        const std::string_view key = options_[i].key;
        if (std::find(known.begin(), known.end(), key) == known.end()) {
            std::string names;
            for (const char* name : known) names += (names.empty() ? "" : ", ") + std::string(name);
            throw OptionError(std::string(key) + ": unknown option; "
                              + (names.empty() ? "the module has none" : "known are " + names));
        }
        for (std::size_t j = 0; j < i; ++j)
            if (key == options_[j].key) throw OptionError(std::string(key) + ": given twice");
    }
}

double PluginOptions::number(const char* key, double fallback) const {
    const char* value = find(key);
    if (value == nullptr) return fallback;
    const auto result = parse<double>(key, value, "a number");
    if (!std::isfinite(result)) throw OptionError(std::string(key) + " " + value + ": must be finite");
    return result;
}

int PluginOptions::integer(const char* key, int fallback) const {
    const char* value = find(key);
    return value == nullptr ? fallback : parse<int>(key, value, "a whole number");
}

int PluginOptions::count(const char* key, int fallback) const {
    const int value = integer(key, fallback);
    if (value < 0) throw OptionError(std::string(key) + " " + find(key) + ": must be 0 or more");
    return value;
}

double PluginOptions::angle(const char* key, double fallback) const {
    if (!has(key)) return fallback;
    // What is checked is what is returned: the least angles are none in radians.
    const double radians = number(key, 0) * std::numbers::pi / 180;
    if (!(radians > 0 && radians < std::numbers::pi))
        throw OptionError(std::string(key) + " " + find(key) + ": must lie between 0 and 180 degrees");
    return radians;
}

std::string PluginOptions::text(const char* key, const char* fallback) const {
    const char* value = find(key);
    return value == nullptr ? fallback : value;
}

int run_plugin(PluginFunction function, PolyMesh& mesh, const PluginOption* options, std::size_t count,
               char* message, std::size_t capacity) noexcept {
    try {
        copy_message(function(mesh, PluginOptions(options, count)), message, capacity);
        return 0;
    } catch (const OptionError& error) {
        copy_message(error.what(), message, capacity);
        return 2;
    } catch (const std::bad_alloc&) {
        copy_message("out of memory", message, capacity);
        return 1;
    } catch (const std::exception& error) {
        copy_message(error.what(), message, capacity);
        return 1;
    } catch (...) {
        copy_message("unknown failure", message, capacity);
        return 1;
    }
}

} // namespace hsdm

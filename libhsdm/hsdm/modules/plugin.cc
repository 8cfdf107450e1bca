#include "hsdm/plugin.hh"

#include "hsdm/errors.hh"
#include "hsdm/modules/stage_options.hh"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <new>
#include <numbers>
#include <string_view>

namespace hsdm {
namespace {

/// A value that check_stage_value() has passed.
template <class T>
T parse(std::string_view text) {
    T value{};
    std::from_chars(text.data(), text.data() + text.size(), value);
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

const char* PluginOptions::checked(const char* key, const char* kind) const {
    const char* const value = find(key);
    if (value != nullptr) check_stage_value(key, kind, value);
    return value;
}

double PluginOptions::number(const char* key, double fallback) const {
    const char* const value = checked(key, "number");
    return value == nullptr ? fallback : parse<double>(value);
}

int PluginOptions::count(const char* key, int fallback) const {
    const char* const value = checked(key, "count");
    return value == nullptr ? fallback : parse<int>(value);
}

double PluginOptions::angle(const char* key, double fallback) const {
    const char* const value = checked(key, "angle");
    return value == nullptr ? fallback : parse<double>(value) * std::numbers::pi / 180;
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

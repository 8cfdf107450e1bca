#pragma once
// Writes JSON text key by key.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

namespace hsdm {

/// Collects a document, two blanks a level. No tree is built: the one of nlohmann's library allocates where
/// it is destroyed, which ends the process if there is no memory. Appending throws std::bad_alloc and nothing
/// else; a file name need not be UTF-8, JSON must be: what is not becomes U+FFFD.
class JsonText {
public:
    void begin_object() { open('{'); }
    void begin_array() { open('['); }
    void end(); ///< of the innermost object or array

    void key(std::string_view name);

    void value(std::string_view text);
    void value(const char* text) { value(std::string_view(text)); }
    /// A flag or a number, of which the shortest digits that read back the same.
    template <class Number>
    requires std::is_arithmetic_v<Number>
    void value(Number number);
    /// A range of values.
    template <class Values>
    requires requires(const Values& v) {
        v.begin() != v.end();
    } &&(!std::is_convertible_v<Values, std::string_view>)void value(const Values& values) {
        begin_array();
        for (const auto& one : values) value(one);
        end();
    }
    /// A complete document of this class, as a part.
    void document(std::string_view text);

    /// A key and its value; nothing if that is a number that is not finite, or an array that holds one: JSON
    /// has none, and a `null` in its place breaks whoever reads it.
    template <class Value>
    void member(std::string_view name, const Value& content) {
        if (!is_finite(content)) return;
        key(name);
        value(content);
    }

    /// The finished document with a line feed behind it.
    std::string take() && { return std::move(text_ += '\n'); }

private:
    template <class Value>
    static bool is_finite(const Value& content) {
        if constexpr (std::is_floating_point_v<Value>)
            return std::isfinite(content);
        else if constexpr (requires {
                               requires std::is_floating_point_v<std::decay_t<decltype(*content.begin())>>;
                           })
            return std::all_of(content.begin(), content.end(), [](double x) { return std::isfinite(x); });
        else
            return true;
    }
    void open(char bracket);
    void start_value();
    void break_line();

    std::string text_, open_; ///< open_: the brackets not yet closed
    bool empty_ = true;       ///< is the innermost object or array still empty?
    bool after_key_ = false;
};

} // namespace hsdm

#include "outcome.hh"

#include "page_text.hh"

#include <algorithm>
#include <cstdint>
#include <string_view>

namespace hsdm::command {
namespace {

using OrderedJson = nlohmann::ordered_json;

OrderedJson json_of(const AgainstBaseline& baseline) {
    OrderedJson object{{"seconds", baseline.seconds},     {"peak_memory_bytes", baseline.peak_memory_bytes},
                       {"machine", baseline.machine},     {"ok", baseline.was_ok},
                       {"same_mesh", baseline.same_mesh}, {"slower", baseline.slower},
                       {"more_memory", baseline.more}};
    if (!baseline.not_judged.empty()) object["not_judged"] = baseline.not_judged;
    return object;
}

/// A member, if it is there and of the fallback's kind.
template <class T>
T value_or(const OrderedJson& object, const char* key, const T& fallback) {
    const auto found = object.find(key);
    if (found == object.end() || found->is_number() != OrderedJson(fallback).is_number()
        || found->is_array() != OrderedJson(fallback).is_array()
        || found->is_string() != OrderedJson(fallback).is_string()
        || found->is_boolean() != OrderedJson(fallback).is_boolean())
        return fallback;
    return found->template get<T>();
}

std::vector<std::string> texts_of(const OrderedJson& object, const char* key) {
    std::vector<std::string> texts;
    const auto found = object.find(key);
    if (found == object.end() || !found->is_array()) return texts;
    for (const OrderedJson& one : *found)
        if (one.is_string()) texts.push_back(one.get<std::string>());
    return texts;
}

/// A length in bytes or the like; numbers that are none are 0.
std::size_t size_at(const OrderedJson& object, const char* key) {
    const double value = value_or(object, key, 0.0);
    return value > 0 && value < 9e15 ? static_cast<std::size_t>(value) : 0;
}

} // namespace

OrderedJson json_of(const Outcome& one) {
    OrderedJson object{{"name", one.name},
                       {"ok", is_ok(one)},
                       {"misses", one.misses},
                       {"seconds", one.seconds},
                       {"input", one.input},
                       {"args", one.arguments},
                       {"peak_memory_bytes", one.peak_memory_bytes},
                       {"machine_seconds", one.machine_seconds},
                       {"runs", one.runs},
                       {"status", one.status}};
    if (one.status != 0) object["failure"] = one.failure;
    if (!one.printed.empty()) object["printed"] = one.printed;
    if (one.baseline) object["baseline"] = json_of(*one.baseline);
    if (!one.picture.empty()) object["picture"] = base64(one.picture);
    object["report"] = one.report;
    if (one.interrupted) object["interrupted"] = true;
    return object;
}

Outcome outcome_of(const OrderedJson& object) {
    Outcome one;
    one.name = value_or(object, "name", std::string());
    one.misses = texts_of(object, "misses");
    one.seconds = value_or(object, "seconds", 0.0);
    one.interrupted = value_or(object, "interrupted", false);
    one.input = value_or(object, "input", std::string());
    one.arguments = texts_of(object, "args");
    one.peak_memory_bytes = size_at(object, "peak_memory_bytes");
    one.machine_seconds = value_or(object, "machine_seconds", 0.0);
    one.runs = static_cast<int>(std::min<std::size_t>(size_at(object, "runs"), 1000));
    one.status = static_cast<int>(std::min<std::size_t>(size_at(object, "status"), 255));
    one.failure = value_or(object, "failure", std::string());
    one.printed = value_or(object, "printed", std::string());
    one.picture = from_base64(value_or(object, "picture", std::string()));
    const auto report = object.find("report");
    if (report != object.end() && report->is_object()) one.report = *report;
    return one;
}

std::string to_json(const std::vector<Outcome>& outcomes) {
    OrderedJson results = OrderedJson::array();
    for (const Outcome& one : outcomes) results.push_back(json_of(one));
    return results.dump(2, ' ', false, OrderedJson::error_handler_t::replace) + '\n';
}

} // namespace hsdm::command

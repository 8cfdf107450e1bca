#include "outcome.hh"

#include "messages.hh"

#include <algorithm>
#include <iomanip>
#include <sstream>
#include <utility>

namespace hsdm::command {
namespace {

using OrderedJson = nlohmann::ordered_json;

std::string xml(std::string_view text) {
    // The last two are UTF-8, but no characters of XML.
    constexpr std::pair<std::string_view, std::string_view> written[] = {{"&", "&amp;"},
                                                                         {"<", "&lt;"},
                                                                         {">", "&gt;"},
                                                                         {"\"", "&quot;"},
                                                                         {"\xef\xbf\xbe", "\\ufffe"},
                                                                         {"\xef\xbf\xbf", "\\uffff"}};
    std::string result = printable(text);
    for (const auto& [from, to] : written)
        for (std::size_t at = result.find(from); at != std::string::npos;
             at = result.find(from, at + to.size()))
            result.replace(at, from.size(), to);
    return result;
}

void put_case(std::ostream& out, const std::string& suite, const Outcome& outcome) {
    out << "    <testcase classname=\"" << suite << "\" name=\"" << xml(outcome.name) << "\" time=\""
        << outcome.seconds << '"';
    if (outcome.misses.empty()) {
        out << "/>\n";
        return;
    }
    const char* const kind = outcome.report.is_null() ? "error" : "failure";
    out << ">\n      <" << kind << " message=\"" << xml(outcome.misses.front()) << "\">";
    for (const std::string& reason : outcome.misses) out << xml(reason) << '\n';
    out << "</" << kind << ">\n    </testcase>\n";
}

} // namespace

std::string to_json(const std::vector<Outcome>& outcomes) {
    OrderedJson results = OrderedJson::array();
    for (const Outcome& one : outcomes) {
        results.push_back({{"name", one.name},
                           {"ok", one.misses.empty()},
                           {"misses", one.misses},
                           {"seconds", one.seconds},
                           {"report", one.report}});
        if (one.interrupted) results.back()["interrupted"] = true;
    }
    return results.dump(2, ' ', false, OrderedJson::error_handler_t::replace) + '\n';
}

std::string to_junit(const std::string& suite, const std::vector<Outcome>& outcomes) {
    const auto count = [&outcomes](bool without_report) {
        return std::count_if(outcomes.begin(), outcomes.end(), [without_report](const Outcome& one) {
            return !one.misses.empty() && one.report.is_null() == without_report;
        });
    };
    double seconds = 0;
    for (const Outcome& one : outcomes) seconds += one.seconds;
    const std::string name = xml(suite);
    std::ostringstream out;
    out << std::fixed << std::setprecision(3) << "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n"
        << "  <testsuite name=\"" << name << "\" tests=\"" << outcomes.size() << "\" failures=\""
        << count(false) << "\" errors=\"" << count(true) << "\" time=\"" << seconds << "\">\n";
    for (const Outcome& one : outcomes) put_case(out, name, one);
    out << "  </testsuite>\n</testsuites>\n";
    return out.str();
}

} // namespace hsdm::command

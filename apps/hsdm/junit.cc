#include "junit.hh"

#include "page_text.hh"

#include <algorithm>
#include <ctime>
#include <iomanip>
#include <sstream>

namespace hsdm::command {
namespace {

/// An error is what did not come to a report, though it had to; of a failure there are numbers.
bool is_error(const Outcome& one) {
    return !is_ok(one) && one.report.is_null();
}

void put_case(std::ostream& out, const std::string& suite, const Outcome& one) {
    out << "    <testcase classname=\"" << suite << "\" name=\"" << html_text(one.name) << "\" time=\""
        << one.seconds << '"';
    if (is_ok(one)) {
        out << "/>\n";
        return;
    }
    const char* const kind = is_error(one) ? "error" : "failure";
    const char* const type = one.interrupted ? "interrupted" : is_error(one) ? "failed" : "out of tolerance";
    out << ">\n      <" << kind << " message=\"" << html_text(one.misses.front()) << "\" type=\"" << type
        << "\">";
    for (const std::string& reason : one.misses) out << html_text(reason) << '\n';
    if (!one.printed.empty()) out << "printed:\n" << html_lines(one.printed);
    out << "</" << kind << ">\n    </testcase>\n";
}

/// A line for each case that has a mesh.
std::string counts_of(const std::vector<Outcome>& outcomes) {
    std::ostringstream lines;
    for (const Outcome& one : outcomes) {
        lines << html_text(one.name) << ": " << std::fixed << std::setprecision(3) << one.seconds << " s, "
              << one.peak_memory_bytes / 1000000 << " MB";
        if (one.report.is_object() && one.report.contains("mesh"))
            lines << ", " << one.report["mesh"].value("faces", 0) << " faces, digest "
                  << html_text(one.report["mesh"].value("digest", ""));
        lines << '\n';
    }
    return lines.str();
}

/// Of the time now, in UTC: the schemas have it without a zone.
std::string timestamp() {
    const std::time_t now = std::time(nullptr);
    char text[32] = "1970-01-01T00:00:00";
    if (const std::tm* const parts = std::gmtime(&now))
        std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%S", parts);
    return text;
}

} // namespace

std::string to_junit(const JunitRun& run, const std::vector<Outcome>& outcomes) {
    const auto errors = std::count_if(outcomes.begin(), outcomes.end(), is_error);
    const auto misses =
        std::count_if(outcomes.begin(), outcomes.end(), [](const Outcome& one) { return !is_ok(one); });
    const std::string name = html_text(run.suite);
    std::ostringstream out;
    out << std::fixed << std::setprecision(3) << "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n"
        << "  <testsuite name=\"" << name << "\" package=\"hsdm\" id=\"0\" timestamp=\"" << timestamp()
        << "\" hostname=\"localhost\" tests=\"" << outcomes.size() << "\" failures=\"" << misses - errors
        << "\" errors=\"" << errors << "\" time=\"" << run.seconds << "\">\n    <properties>\n";
    for (const auto& [key, value] : run.properties)
        out << "      <property name=\"" << html_text(key) << "\" value=\"" << html_text(value) << "\"/>\n";
    out << "    </properties>\n";
    for (const Outcome& one : outcomes) put_case(out, name, one);
    out << "    <system-out>" << counts_of(outcomes) << "</system-out>\n    <system-err></system-err>\n"
        << "  </testsuite>\n</testsuites>\n";
    return out.str();
}

} // namespace hsdm::command

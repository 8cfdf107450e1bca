#include "suite_page.hh"

#include "messages.hh"
#include "page_text.hh"

#include "hsdm/version.hh"

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <sstream>
#include <string_view>
#include <utility>

namespace hsdm::command {
namespace {

std::string number_text(double number, const char* format) {
    char text[64];
    std::snprintf(text, sizeof text, format, number);
    return text;
}

const Json* find_in(const Outcome& outcome, const char* key) {
    return outcome.report.is_object() ? find_key(outcome.report, key) : nullptr;
}

/// As a person reads it; empty for what is not there.
std::string value_text(const Json* value) {
    if (!value) return "";
    if (value->is_boolean()) return value->get<bool>() ? "yes" : "no";
    if (value->is_number_float()) return number_text(value->get<double>(), "%.4g");
    if (value->is_string()) return value->get<std::string>();
    if (value->is_array()) return std::to_string(value->size());
    return value->dump();
}

bool is_changed(const Outcome& one) {
    return one.baseline && !one.report.is_null() && !one.baseline->same_mesh;
}

bool is_failure(const Outcome& one) {
    return is_ok(one) && one.status != 0;
}

/// The classes of a row: what the tiles at the top count, and show alone.
struct RowKind {
    const char *name, *label;
    bool (*holds)(const Outcome&);
};

constexpr RowKind row_kinds[] = {
    {"all", "cases", [](const Outcome&) { return true; }},
    {"missed", "missed", [](const Outcome& one) { return !is_ok(one); }},
    {"passed", "passed", [](const Outcome& one) { return is_ok(one); }},
    {"slower", "slower", [](const Outcome& one) { return one.baseline && one.baseline->slower; }},
    {"more", "more memory", [](const Outcome& one) { return one.baseline && one.baseline->more; }},
    {"changed", "another mesh", is_changed},
    {"new", "not in the baseline", [](const Outcome& one) { return !one.baseline; }},
};
constexpr std::size_t row_kinds_without_baseline = 3;

std::size_t row_kinds_of(const SuitePage& page) {
    return page.before ? std::size(row_kinds) : row_kinds_without_baseline;
}

void put_tiles(std::ostream& out, const SuitePage& page) {
    out << "<ul class=\"counts\">\n";
    for (std::size_t k = 0; k < row_kinds_of(page); ++k) {
        const auto count = std::count_if(page.outcomes.begin(), page.outcomes.end(), row_kinds[k].holds);
        const bool is_bad = count > 0 && (k == 1 || k == 3 || k == 4);
        out << "<li><button type=\"button\" data-kind=\"" << row_kinds[k].name
            << "\" aria-pressed=\"false\"><b" << (is_bad ? " class=\"bad\"" : "") << '>' << count << "</b>"
            << row_kinds[k].label << "</button></li>\n";
    }
    out << "</ul>\n";
}

/// A cell that is sorted by a value.
void put_cell(std::ostream& out, const char* label, const std::string& value, const std::string& text,
              const char* kind = "number") {
    out << "<td class=\"" << kind << "\" data-label=\"" << label << "\" data-value=\"" << html_text(value)
        << "\">" << text << "</td>\n";
}

void put_number(std::ostream& out, const char* label, const Outcome& one, const char* key) {
    const Json* const value = find_in(one, key);
    const bool is_number = value && value->is_number();
    put_cell(out, label, is_number ? value->dump() : "",
             is_number ? html_text(value_text(value)) : "\xe2\x80\x93");
}

/// `1.21 s` and, under it, how much that is of the baseline's.
std::string with_ratio(const std::string& text, const Outcome& one, double now, double before,
                       bool is_beyond) {
    if (!one.baseline || !one.baseline->not_judged.empty() || before <= 0) return text;
    const std::string ratio = "\xc3\x97" + number_text(now / before, "%.2f");
    return text + "<br><span class=\"" + (is_beyond ? "bad" : "unit") + "\">"
           + (is_beyond ? "\xe2\x96\xb2 " : "") + ratio + "</span>";
}

void put_costs(std::ostream& out, const Outcome& one) {
    const auto memory = static_cast<double>(one.peak_memory_bytes);
    const AgainstBaseline before = one.baseline.value_or(AgainstBaseline());
    put_cell(out, "seconds", number_text(one.seconds, "%.6f"),
             with_ratio(number_text(one.seconds, "%.2f"), one, one.seconds, before.seconds * before.machine,
                        before.slower));
    put_cell(out, "MB", number_text(memory, "%.0f"),
             with_ratio(number_text(memory / 1e6, "%.0f"), one, memory,
                        static_cast<double>(before.peak_memory_bytes), before.more));
}

void put_picture(std::ostream& out, const std::string& file, const std::string& caption,
                 const std::string& name, bool is_alone = false) {
    if (file.empty()) return;
    out << "<figure><img alt=\"" << html_text(caption + ": " + name) << "\" width=\"240\" height=\"180\" "
        << "src=\"data:image/png;base64," << base64(file) << "\">";
    if (!is_alone) out << "<figcaption>" << html_text(caption) << "</figcaption>";
    out << "</figure>";
}

/// What the report says of the two, where they differ.
constexpr std::pair<const char*, const char*> compared[] = {
    {"mesh.digest", "digest"},
    {"mesh.vertices", "vertices"},
    {"mesh.faces", "faces"},
    {"mesh.quads", "quads"},
    {"mesh.components", "components"},
    {"mesh.boundary_loops", "boundary loops"},
    {"mesh.genus", "genus"},
    {"mesh.closed", "closed"},
    {"features.sharp_edges", "sharp edges"},
    {"error.points_to_mesh_max", "largest error"},
    {"error.points_to_mesh_mean", "mean error"},
    {"error.normalised_max", "largest error over diagonal"},
    {"reference.hausdorff", "distance from reference"},
    {"mesh.intersections", "intersections"},
    {"warnings", "warnings"},
    {"threads", "threads"},
};

void put_change(std::ostream& out, const char* label, const std::string& before, const std::string& now) {
    out << "<tr><th scope=\"row\">" << label << "</th><td class=\"number\">" << html_text(before)
        << "</td><td class=\"number\">" << html_text(now) << "</td></tr>\n";
}

void put_changes(std::ostream& out, const Outcome& before, const Outcome& now) {
    out << "<table><thead><tr><th></th><th class=\"number\">baseline</th><th class=\"number\">now</th></tr>"
           "</thead><tbody>\n";
    for (const auto& [key, label] : compared) {
        const Json *const then = find_in(before, key), *const here = find_in(now, key);
        if ((then == nullptr) == (here == nullptr) && (!then || *then == *here)) continue;
        put_change(out, label, value_text(then), value_text(here));
    }
    put_change(out, "seconds", number_text(before.seconds, "%.3f"), number_text(now.seconds, "%.3f"));
    put_change(out, "MB", number_text(static_cast<double>(before.peak_memory_bytes) / 1e6, "%.1f"),
               number_text(static_cast<double>(now.peak_memory_bytes) / 1e6, "%.1f"));
    out << "</tbody></table>\n";
    if (now.baseline && !now.baseline->not_judged.empty())
        out << "<p>Time and memory were not judged: " << html_text(now.baseline->not_judged) << ".</p>\n";
    else if (now.baseline && now.baseline->machine > 1.005)
        out << "<p>The machine is " << number_text(now.baseline->machine, "%.2f")
            << " times slower than the baseline's was, which is allowed for.</p>\n";
}

void put_details(std::ostream& out, const Outcome* before, const Outcome& one) {
    out << "<p>Input <code>" << html_text(one.input) << "</code>";
    if (!one.arguments.empty()) out << ", options <code>";
    for (const std::string& word : one.arguments)
        out << (&word == &one.arguments.front() ? "" : " ") << html_text(word);
    out << (one.arguments.empty() ? ".</p>\n" : "</code>.</p>\n");
    if (is_failure(one))
        out << "<p>It failed as it must, with status " << one.status << ": " << html_text(one.failure)
            << "</p>\n";
    if (one.runs > 1) out << "<p>The best of " << one.runs << " runs.</p>\n";
    if (const Json* const warnings = find_in(one, "warnings"); warnings && !warnings->empty()) {
        out << "<p>Warnings:</p><ul>";
        for (const Json& warning : *warnings)
            out << "<li>" << html_text(warning.value("what", "")) << ": "
                << html_text(value_text(find_key(warning, "how_much"))) << "</li>";
        out << "</ul>\n";
    }
    if (before) put_changes(out, *before, one);
    if (!one.printed.empty()) out << "<p>It printed:</p><pre>" << html_lines(one.printed) << "</pre>\n";
}

/// What the filter looks at.
std::string searched_text(const Outcome& one) {
    std::string text = one.name + ' ' + one.input;
    for (const std::string& word : one.arguments) text += ' ' + word;
    for (const std::string& reason : one.misses) text += ' ' + reason;
    std::transform(text.begin(), text.end(), text.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    return text;
}

void put_name(std::ostream& out, const Outcome* before, const Outcome& one) {
    out << "<td class=\"name\" data-value=\"" << html_text(one.name) << "\"><details><summary>"
        << html_text(one.name) << "</summary>\n";
    put_details(out, before, one);
    out << "</details>";
    if (!is_ok(one)) {
        out << "<ul class=\"misses\">";
        for (const std::string& reason : one.misses) out << "<li>" << html_text(reason) << "</li>";
        out << "</ul>";
    }
    out << "</td>\n";
}

void put_row(std::ostream& out, const SuitePage& page, std::size_t i) {
    const Outcome& one = page.outcomes[i];
    const Outcome* const before = page.before ? page.before->find(page.cases[i]) : nullptr;
    out << "<tr class=\"case";
    for (std::size_t k = 1; k < row_kinds_of(page); ++k)
        if (row_kinds[k].holds(one)) out << ' ' << row_kinds[k].name;
    out << "\" id=\"case-" << i + 1 << "\" data-index=\"" << i << "\" data-text=\""
        << html_text(searched_text(one)) << "\">\n<td class=\"mark " << (is_ok(one) ? "good" : "bad")
        << "\" data-value=\"" << (is_ok(one) ? "1" : "0") << "\">"
        << (is_ok(one) ? "\xe2\x9c\x93 ok" : "\xe2\x9c\x97 miss") << "</td>\n"
        << "<td class=\"picture\"><div class=\"pictures\">";
    const bool is_alone = !before || !is_changed(one);
    put_picture(out, one.picture, is_alone ? "mesh" : "now", one.name, is_alone);
    if (!is_alone) put_picture(out, before->picture, "baseline", one.name);
    out << "</div></td>\n";
    put_name(out, before, one);
    put_number(out, "faces", one, "mesh.faces");
    put_number(out, "genus", one, "mesh.genus");
    const std::string closed = value_text(find_in(one, "mesh.closed"));
    put_cell(out, "closed", closed, closed.empty() ? "\xe2\x80\x93" : html_text(closed), "other");
    const Json* const error = find_in(one, "error.normalised_max");
    const bool has_error = error && error->is_number();
    put_cell(out, "error %", has_error ? error->dump() : "",
             has_error ? number_text(100 * error->get<double>(), "%.3g") : "\xe2\x80\x93");
    put_costs(out, one);
    if (page.before) put_cell(out, "mesh", mesh_word(one), mesh_word(one), "other");
    out << "</tr>\n";
}

void put_header(std::ostream& out, const char* label, const char* kind) {
    out << "<th scope=\"col\" class=\"" << kind << "\"><button type=\"button\">" << label
        << "</button></th>\n";
}

void put_table(std::ostream& out, const SuitePage& page) {
    out << "<table class=\"cases\">\n<thead><tr>\n";
    put_header(out, "state", "number");
    out << "<th scope=\"col\">mesh</th>\n";
    put_header(out, "case", "other");
    for (const char* label : {"faces", "genus"}) put_header(out, label, "number");
    put_header(out, "closed", "other");
    for (const char* label : {"error %", "seconds", "MB"}) put_header(out, label, "number");
    if (page.before) put_header(out, "bits", "other");
    out << "</tr></thead>\n<tbody>\n";
    for (std::size_t i = 0; i < page.outcomes.size(); ++i) put_row(out, page, i);
    out << "</tbody>\n</table>\n";
}

void put_missed(std::ostream& out, const SuitePage& page) {
    if (std::all_of(page.outcomes.begin(), page.outcomes.end(), is_ok)) return;
    out << "<h2>What missed</h2>\n<ul class=\"misses\">\n";
    for (std::size_t i = 0; i < page.outcomes.size(); ++i)
        if (const Outcome& one = page.outcomes[i]; !is_ok(one))
            out << "<li><a href=\"#case-" << i + 1 << "\">" << html_text(one.name)
                << "</a>: " << html_text(one.misses.front()) << "</li>\n";
    out << "</ul>\n";
}

std::string now_in_words() {
    const std::time_t now = std::time(nullptr);
    char text[64] = "";
    if (const std::tm* const parts = std::gmtime(&now))
        std::strftime(text, sizeof text, "%Y-%m-%d %H:%M UTC", parts);
    return text;
}

void put_summary(std::ostream& out, const SuitePage& page) {
    const auto passed = std::count_if(page.outcomes.begin(), page.outcomes.end(), is_ok);
    const bool all = passed == static_cast<std::ptrdiff_t>(page.cases.size());
    out << "<h1>" << html_text(page.suite) << "</h1>\n<p class=\"verdict " << (all ? "good" : "bad") << "\">"
        << (all ? "\xe2\x9c\x93 " : "\xe2\x9c\x97 ") << passed << " of " << page.cases.size()
        << " as they must be</p>\n<p class=\"faint\">hsdm " << version << ", " << now_in_words();
    if (page.before) out << ", against <code>" << html_text(page.baseline) << "</code>";
    out << "</p>\n";
    put_tiles(out, page);
    if (page.outcomes.size() < page.cases.size())
        out << "<p class=\"bad\">Interrupted: " << page.cases.size() - page.outcomes.size()
            << " cases did not begin.</p>\n";
    if (page.gone.empty()) return;
    out << "<p>In the baseline alone: ";
    for (const std::string& name : page.gone)
        out << (&name == &page.gone.front() ? "" : ", ") << html_text(name);
    out << ".</p>\n";
}

} // namespace

std::string to_html(const SuitePage& page) {
    std::ostringstream out;
    out << "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
           "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
           // Nothing may be loaded, whatever a name in here should try.
           "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; "
           "style-src 'unsafe-inline'; script-src 'unsafe-inline'\">\n<title>"
        << html_text(page.suite) << ", hsdm regress</title>\n<style>\n"
        << whole_text(embedded::suite_css) << "</style>\n</head>\n<body>\n";
    put_summary(out, page);
    put_missed(out, page);
    out << "<div class=\"tools\"><input type=\"search\" id=\"filter\" placeholder=\"filter: words of name, "
           "input, options, misses\" aria-label=\"filter the cases\"><span id=\"shown\" "
           "aria-live=\"polite\"></span></div>\n";
    put_table(out, page);
    out << "<footer class=\"keys\"><p>Keys: <kbd>/</kbd> filter, <kbd>j</kbd> <kbd>k</kbd> next and previous "
           "case, <kbd>Enter</kbd> open it, <kbd>m</kbd> those that missed, <kbd>c</kbd> those with another "
           "mesh, <kbd>a</kbd> all; a click on a head sorts, one on a picture "
           "enlarges.</p></footer>\n<script>\n"
        << whole_text(embedded::suite_js) << "</script>\n</body>\n</html>\n";
    return out.str();
}

} // namespace hsdm::command

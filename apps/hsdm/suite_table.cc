#include "suite_table.hh"

#include "messages.hh"

#include <algorithm>
#include <cstdio>
#include <iomanip>
#include <ostream>
#include <sstream>

namespace hsdm::command {
namespace {

std::string fixed_text(double number, int digits) {
    char text[64];
    std::snprintf(text, sizeof text, "%.*f", digits, number);
    return text;
}

/// Times the baseline's; a machine that is slower now is allowed for.
std::string times_text(double now, double before) {
    if (!(before > 0)) return "-";
    return now < 1000 * before ? fixed_text(now / before, 2) + 'x' : ">999x";
}

std::string cell_text(const Outcome& outcome, const char* key) {
    const Json* const value = outcome.report.is_null() ? nullptr : find_key(outcome.report, key);
    return value == nullptr ? std::string("-") : value->dump();
}

std::string error_text(const Outcome& outcome) {
    const Json* const error =
        outcome.report.is_null() ? nullptr : find_key(outcome.report, "error.normalised_max");
    std::ostringstream percent;
    if (error != nullptr) percent << std::setprecision(3) << 100 * error->get<double>();
    return percent.str();
}

} // namespace

SuiteTable::SuiteTable(std::ostream& out, std::span<const Case> cases, bool against_baseline)
    : out_(out), against_baseline_(against_baseline) {
    for (const Case& one : cases) width_ = std::max(width_, static_cast<int>(printable(one.name).size()));
}

void SuiteTable::print_head() {
    out_ << "      " << std::left << std::setw(width_) << "case" << std::right
         << "     faces  closed  genus   error %  seconds      MB";
    if (against_baseline_) out_ << "    time  memory  mesh";
    out_ << std::endl;
}

void SuiteTable::print_row(const Outcome& outcome) {
    out_ << (is_ok(outcome) ? "ok    " : "MISS  ") << std::left << std::setw(width_)
         << printable(outcome.name) << std::right << std::setw(10) << cell_text(outcome, "mesh.faces")
         << std::setw(8) << cell_text(outcome, "mesh.closed") << std::setw(7)
         << cell_text(outcome, "mesh.genus") << std::setw(10) << error_text(outcome) << std::setw(9)
         << fixed_text(outcome.seconds, 2) << std::setw(8) << outcome.peak_memory_bytes / 1000000;
    const auto& before = outcome.baseline;
    if (before && before->not_judged.empty())
        out_ << std::setw(8) << times_text(outcome.seconds, before->seconds * before->machine) << std::setw(8)
             << times_text(static_cast<double>(outcome.peak_memory_bytes),
                           static_cast<double>(before->peak_memory_bytes));
    else if (against_baseline_)
        out_ << "       -       -";
    if (against_baseline_) out_ << std::setw(6) << mesh_word(outcome);
    out_ << '\n';
    for (const std::string& reason : outcome.misses) out_ << "      " << printable(reason) << '\n';
    out_ << std::flush;
}

std::string baseline_words(const std::vector<Outcome>& outcomes, const std::vector<std::string>& gone) {
    std::size_t slower = 0, more = 0, other = 0, fresh = 0, unjudged = 0;
    std::string why;
    for (const Outcome& one : outcomes) {
        if (!one.baseline) {
            ++fresh;
            continue;
        }
        slower += one.baseline->slower;
        more += one.baseline->more;
        other += !one.report.is_null() && !one.baseline->same_mesh;
        if (one.baseline->not_judged.empty() || one.report.is_null()) continue;
        ++unjudged;
        why = one.baseline->not_judged;
    }
    std::string words = std::to_string(slower) + " slower, " + std::to_string(more) + " with more memory, "
                        + std::to_string(other) + " with another mesh, " + std::to_string(fresh) + " new";
    if (!gone.empty())
        words += ", " + std::to_string(gone.size()) + " gone (" + printable(gone.front())
                 + (gone.size() > 1 ? ", ...)" : ")");
    if (unjudged > 0) words += ", " + std::to_string(unjudged) + " not judged (" + printable(why) + ')';
    return words;
}

} // namespace hsdm::command

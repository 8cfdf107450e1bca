#include "file_claims.hh"

#include "command.hh"

#include "hsdm/core/system.hh"
#include "hsdm/errors.hh"
#include "hsdm/io/output_target.hh"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <tuple>
#include <utility>

namespace hsdm::command {
namespace {

namespace fs = std::filesystem;
using Kind = os::FileStatus::Kind;

/// What the name stands for, if it is there: "-" for the descriptor `standard`.
bool status_of(const std::string& path, int standard, os::FileStatus& status) {
    return path == "-" ? os::status_of(standard, status) : os::status_of(path, status);
}

/// For a file that cannot be told from others.
[[noreturn]] void fail(const std::string& path, const std::string& cause) {
    throw Error(path, "cannot be looked at: " + cause + "; check the permissions of its folders");
}

} // namespace

void FileClaims::add(Claim claim, const std::string& path, int standard) {
    os::FileStatus status;
    if (status_of(path, standard, status)) {
        if (status.is_null_device) return;
        claim.two_way = status.kind == Kind::terminal_or_device || status.kind == Kind::socket;
    } else {
        if (path == "-") return; // closed: reading or writing will say so
        if (errno != ENOENT && errno != ENOTDIR) fail(path, std::strerror(errno));
        std::error_code error;
        fs::path above = fs::weakly_canonical(fs::absolute(find_target(path).path), error), below;
        if (error) fail(path, error.message());
        do {
            below = above.filename() / below;
            above = above.parent_path();
            if (os::status_of(above.string(), status)) break;
            if (!above.has_relative_path()) fail(path, std::strerror(errno));
        } while (true);
        claim.below = below.string();
    }
    claim.device = status.device;
    claim.inode = status.inode;
    claim.order = claims_.size();
    claims_.push_back(std::move(claim));
}

void FileClaims::reads(const std::string& what, const std::string& path) {
    Claim claim;
    claim.words = path == "-" ? "standard input" : what + ' ' + path;
    add(std::move(claim), path, os::standard_input);
}

void FileClaims::writes(const std::string& option, const std::string& path) {
    Claim claim;
    claim.writes = true;
    claim.words = path == "-" || option.ends_with(path) ? option : option + " (" + path + ')';
    add(std::move(claim), path, os::standard_output);
}

void FileClaims::check() const {
    std::vector<const Claim*> sorted;
    for (const Claim& claim : claims_) sorted.push_back(&claim);
    const auto file = [](const Claim* c) { return std::tie(c->device, c->inode, c->below); };
    std::sort(sorted.begin(), sorted.end(), [&](const Claim* a, const Claim* b) {
        return std::tuple(file(a), !a->writes, a->order) < std::tuple(file(b), !b->writes, b->order);
    });
    const Claim *worst = nullptr, *other = nullptr; // the first in the user's order, not in the inodes'
    for (std::size_t i = 1; i < sorted.size(); ++i) {
        const Claim &first = *sorted[i - 1], &second = *sorted[i]; // of one file the writers come first
        if (file(&first) != file(&second) || !first.writes || (first.two_way && !second.writes)) continue;
        if (worst && worst->order < first.order) continue;
        worst = &first;
        other = &second;
    }
    if (!worst) return;
    if (other->writes)
        throw UsageError(worst->words + " and " + other->words + " are one file; give each its own");
    throw UsageError(worst->words + " is " + other->words + ", which would be destroyed; write elsewhere");
}

bool is_standard_output(const std::string& path) {
    if (path == "-") return true;
    os::FileStatus named, standard;
    return !path.empty() && os::status_of(path, named) && os::status_of(os::standard_output, standard)
           && named.device == standard.device && named.inode == standard.inode && !named.is_null_device;
}

} // namespace hsdm::command

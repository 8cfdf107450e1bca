#include "hsdm/modules/trusted_path.hh"

#include <filesystem>
#include <vector>

namespace hsdm {
namespace {

namespace fs = std::filesystem;
using Kind = os::FileStatus::Kind;

/// Follows a path entry by entry, links included, and asks of each what it is.
class PathWalk {
public:
    explicit PathWalk(const fs::path& path) { push(fs::absolute(path)); }

    std::string run() {
        std::string reason = look(true);
        for (int links = 0; reason.empty() && !rest_.empty();) {
            const fs::path entry = rest_.front();
            rest_.erase(rest_.begin());
            if (entry.empty() || entry == ".") continue;
            if (entry == "..") {
                at_ = at_.parent_path();
                continue;
            }
            at_ /= entry;
            os::FileStatus status;
            if (!os::status_of_entry(at_.string(), status)) return "";
            if (status.kind != Kind::link) {
                reason = look(!rest_.empty());
                continue;
            }
            if (++links > most_links) return at_.string() + " is a link that leads in a circle";
            status.mode = 0; // a link's own says nothing
            reason = said(distrust(status, os::effective_user(), true));
            if (reason.empty()) reason = follow();
        }
        return reason;
    }

private:
    static constexpr int most_links = 40;

    void push(const fs::path& path) {
        if (path.is_absolute()) at_ = path.root_path();
        const fs::path entries = path.relative_path();
        rest_.insert(rest_.begin(), entries.begin(), entries.end());
    }

    /// The link may stand in another folder than what it leads to.
    std::string follow() {
        std::error_code error;
        const fs::path target = fs::read_symlink(at_, error);
        at_ = at_.parent_path();
        std::string reason = rest_.empty() ? look(false) : "";
        if (reason.empty()) push(target);
        return reason;
    }

    /// Why others could change the entry reached; for a file at the end of the path also the folder that
    /// holds it.
    std::string look(bool above) const {
        os::FileStatus status;
        if (!os::status_of(at_.string(), status)) return "";
        const std::string reason = distrust(status, os::effective_user(), above);
        if (!reason.empty() || above || status.kind == Kind::folder) return said(reason);
        PathWalk folder(*this);
        folder.at_ = at_.parent_path();
        return folder.look(false);
    }

    std::string said(const std::string& reason) const {
        return reason.empty() ? "" : at_.string() + " " + reason;
    }

    fs::path at_;
    std::vector<fs::path> rest_;
};

} // namespace

std::string distrust(const os::FileStatus& status, std::uint32_t user, bool above) {
    constexpr std::uint32_t sticky = 01000, group_may_write = 020, all_may_write = 02;
    if (status.owner != 0 && status.owner != user)
        return "belongs to another user (" + std::to_string(status.owner)
               + "), who could have put anything there; move the module to a folder of your own";
    if (above && status.kind == Kind::folder && (status.mode & sticky) != 0) return "";
    if ((status.mode & all_may_write) != 0)
        return "can be written by everybody; run `chmod go-w` on it if it is yours";
    if ((status.mode & group_may_write) != 0)
        return "can be written by its group; run `chmod g-w` on it if it is yours";
    return "";
}

std::string distrust(const std::string& path) {
    return PathWalk(path).run();
}

} // namespace hsdm

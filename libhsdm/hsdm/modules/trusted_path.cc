#include "hsdm/modules/trusted_path.hh"

#include <filesystem>
#include <vector>

#include <unistd.h>

namespace hsdm {
namespace {

namespace fs = std::filesystem;

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
            struct stat status {};
            if (::lstat(at_.c_str(), &status) != 0) return "";
            if (!S_ISLNK(status.st_mode)) {
                reason = look(!rest_.empty());
                continue;
            }
            if (++links > most_links) return at_.string() + " is a link that leads in a circle";
            status.st_mode = 0; // a link's own says nothing
            reason = said(distrust(status, ::geteuid(), true));
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
        struct stat status {};
        if (::stat(at_.c_str(), &status) != 0) return "";
        const std::string reason = distrust(status, ::geteuid(), above);
        if (!reason.empty() || above || S_ISDIR(status.st_mode)) return said(reason);
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

std::string distrust(const struct stat& status, uid_t user, bool above) {
    if (status.st_uid != 0 && status.st_uid != user)
        return "belongs to another user (" + std::to_string(status.st_uid)
               + "), who could have put anything there; move the module to a folder of your own";
    if (above && S_ISDIR(status.st_mode) && (status.st_mode & S_ISVTX) != 0) return "";
    if ((status.st_mode & S_IWOTH) != 0)
        return "can be written by everybody; run `chmod go-w` on it if it is yours";
    if ((status.st_mode & S_IWGRP) != 0)
        return "can be written by its group; run `chmod g-w` on it if it is yours";
    return "";
}

std::string distrust(const std::string& path) {
    return PathWalk(path).run();
}

} // namespace hsdm

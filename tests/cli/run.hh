#pragma once
// Runs the built command as a user would, in a folder of its own.

#include <string>

namespace hsdm::test {

struct CommandResult {
    int status = -1; ///< 128 + signal if one ended it
    std::string out, err;
};

/// A scratch folder, removed with its content.
class Folder {
public:
    Folder();
    ~Folder();
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;

    const std::string& path() const { return path_; }
    std::string operator/(const std::string& name) const { return path_ + "/" + name; }
    std::string write(const std::string& name, const std::string& content) const;
    /// Names in the folder, sorted, one per line.
    std::string list() const;

private:
    std::string path_;
};

/// Through the shell, in `folder`; `arguments` may hold pipes and redirections: they follow the command's
/// name. `before` stands in front of it, e.g. `cat scan.xyz |`.
CommandResult run(const Folder& folder, const std::string& arguments, const std::string& before = "");

/// Copies the modules of the build, where others may write, into `modules` in the folder; returns what makes
/// them known, to stand before the command.
std::string with_modules(const Folder& folder);

std::string read_file(const std::string& path);
bool exists(const std::string& path);

} // namespace hsdm::test

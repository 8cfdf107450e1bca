#pragma once
// A folder for the files of one test.

#include <set>
#include <string>

namespace hsdm::support {

/// A scratch folder, removed with its content.
class Folder {
public:
    Folder();
    ~Folder();
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;

    const std::string& path() const { return path_; }
    std::string operator/(const std::string& name) const { return path_ + "/" + name; }
    /// Returns the path of the file.
    std::string write(const std::string& name, const std::string& content) const;
    std::set<std::string> names() const;

private:
    std::string path_;
};

std::string read_file(const std::string& path);

} // namespace hsdm::support

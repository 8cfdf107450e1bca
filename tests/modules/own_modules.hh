#pragma once
// Modules where nobody but this user can have put them.

#include "support/folder.hh"

#include <filesystem>
#include <string>
#include <vector>

namespace hsdm::test {

/// The modules of a folder, copied into one of this user's alone: where the build tree lies others may write.
class OwnModules : public support::Folder {
public:
    explicit OwnModules(const std::string& from) {
        namespace fs = std::filesystem;
        for (const auto& file : fs::directory_iterator(from)) {
            if (file.path().extension() != ".so") continue;
            const std::string copy = *this / file.path().filename().string();
            fs::copy_file(file.path(), copy);
            fs::permissions(copy, fs::perms::owner_all);
        }
    }
    operator std::vector<std::string>() const { return {path()}; }
};

} // namespace hsdm::test

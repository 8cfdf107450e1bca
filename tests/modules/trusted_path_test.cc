#include "hsdm/modules/trusted_path.hh"

#include "support/folder.hh"

#include <catch2/catch.hpp>

#include <filesystem>
#include <fstream>

using Catch::Matchers::Contains;
using hsdm::distrust;
using Kind = hsdm::os::FileStatus::Kind;

namespace fs = std::filesystem;

namespace {

/// What is said of a file or folder of `owner` to user 1000.
std::string said_of(Kind kind, std::uint32_t mode, std::uint32_t owner, bool above = false) {
    hsdm::os::FileStatus status;
    status.kind = kind;
    status.mode = mode;
    status.owner = owner;
    return distrust(status, 1000, above);
}

} // namespace

TEST_CASE("trusted is what root or the user alone can write") {
    CHECK(said_of(Kind::regular, 0755, 1000).empty());
    CHECK(said_of(Kind::regular, 0644, 0).empty());
    CHECK_THAT(said_of(Kind::regular, 0600, 1001), Contains("another user (1001)"));
    CHECK_THAT(said_of(Kind::regular, 0664, 1000), Contains("its group"));
    CHECK_THAT(said_of(Kind::regular, 0646, 0), Contains("everybody"));
    CHECK_THAT(said_of(Kind::folder, 0775, 1000, true), Contains("its group"));
}

TEST_CASE("the sticky bit helps a folder farther up, not the one that modules are in") {
    CHECK(said_of(Kind::folder, 01777, 0, true).empty());
    CHECK_THAT(said_of(Kind::folder, 01777, 0), Contains("everybody"));
    CHECK_THAT(said_of(Kind::folder, 01777, 1001, true), Contains("another user"));
}

TEST_CASE("a file is distrusted for any folder above it, and for where its links lead through") {
    const hsdm::support::Folder folder;
    const fs::path root = folder.path();
    fs::create_directories(root / "open/inner");
    fs::create_directories(root / "safe");
    for (const char* file : {"open/inner/a", "safe/a"}) std::ofstream(root / file) << "x";
    fs::create_symlink("../safe/a", root / "open/link");
    fs::create_symlink("open/inner", root / "way");
    fs::create_symlink("circle", root / "circle");
    for (const char* file : {"open/inner/a", "open/link", "way/a", "safe/a", "way/../../safe/a"}) {
        INFO(file);
        CHECK(distrust((root / file).string()).empty());
    }
    fs::permissions(root / "open", fs::perms::all);
    for (const char* file : {"open/inner/a", "open/link", "way/a", "way/../../safe/a"}) {
        INFO(file);
        CHECK_THAT(distrust((root / file).string()), Contains("open can be written by everybody"));
    }
    CHECK(distrust((root / "safe/a").string()).empty());
    CHECK(distrust((root / "missing/a").string()).empty());
    CHECK_THAT(distrust((root / "circle").string()), Contains("circle"));
}

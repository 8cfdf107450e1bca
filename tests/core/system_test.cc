#include "hsdm/core/system.hh"

#include "support/folder.hh"

#include <catch2/catch.hpp>

#include <atomic>
#include <cerrno>
#include <filesystem>
#include <set>
#include <thread>
#include <vector>

using namespace hsdm;
using hsdm::support::Folder;
using Kind = os::FileStatus::Kind;

namespace fs = std::filesystem;

TEST_CASE("the status of a path says what it stands for, and which names are one file") {
    const Folder folder;
    folder.write("file", "twelve bytes");
    fs::create_directory(folder / "inner");
    fs::create_symlink("file", folder / "link");
    fs::create_hard_link(folder / "file", folder / "other");
    os::FileStatus file, link, entry, other, inner, null;
    REQUIRE(os::status_of(folder / "file", file));
    REQUIRE(os::status_of(folder / "link", link));
    REQUIRE(os::status_of_entry(folder / "link", entry));
    REQUIRE(os::status_of(folder / "other", other));
    REQUIRE(os::status_of(folder / "inner", inner));
    REQUIRE(os::status_of("/dev/null", null));
    CHECK((file.kind == Kind::regular && link.kind == Kind::regular && entry.kind == Kind::link));
    CHECK((inner.kind == Kind::folder && null.kind == Kind::terminal_or_device));
    CHECK((null.is_null_device && !file.is_null_device));
    CHECK((file.size == 12 && file.names == 2));
    CHECK((link.inode == file.inode && other.inode == file.inode && entry.inode != file.inode));
    CHECK(inner.device == file.device);
    fs::permissions(folder / "file", fs::perms(0640));
    REQUIRE(os::status_of(folder / "file", file));
    CHECK(file.mode == 0640);
    CHECK_FALSE(os::status_of(folder / "missing", file));
    CHECK(errno == ENOENT);
}

TEST_CASE("a lock keeps others off until its descriptor is closed") {
    const Folder folder;
    const int first = os::create(folder / "file", 0600), second = os::open_entry_to_write(folder / "file");
    REQUIRE((first >= 0 && second >= 0));
    CHECK(os::lock(first));
    CHECK_FALSE(os::try_lock(second));
    os::close(first);
    CHECK(os::try_lock(second));
    os::close(second);
    CHECK(os::create(folder / "file", 0600) == -1);
    CHECK(errno == EEXIST);
}

TEST_CASE("the folder of this process's descriptors is known, and that of another is not") {
    CHECK(os::is_folder_of_descriptors(fs::canonical("/dev/fd").string()));
    CHECK_FALSE(os::is_folder_of_descriptors("/proc/1/fd"));
    CHECK_FALSE(os::is_folder_of_descriptors("/dev"));
}

TEST_CASE("space set aside is not part of a file") {
    const Folder folder;
    const int file = os::create(folder / "file", 0600);
    CHECK(os::write(file, "abc", 3) == 3);
    CHECK(os::reserve(file, 1 << 16));
    CHECK(fs::file_size(folder / "file") == 3);
    CHECK(os::resize(file, 2));
    char bytes[4] = {};
    CHECK(os::read_at(file, bytes, 4, 0) == 2);
    CHECK(std::string(bytes) == "ab");
    os::close(file);
}

TEST_CASE("every new name is another, and a folder tells all of them") {
    const Folder folder;
    std::set<std::string> made;
    for (int i = 0; i < 20; ++i) {
        std::string name = folder / "part-XXXXXX.off";
        const int file = os::create_with_new_name(name, 4);
        REQUIRE(file >= 0);
        os::close(file);
        made.insert(fs::path(name).filename().string());
    }
    CHECK(made.size() == 20);
    std::set<std::string> found;
    os::for_each_name(folder.path(), [&found](const char* name) { found.insert(name); });
    CHECK(found == made);
    os::for_each_name(folder / "missing", [](const char*) { FAIL(); });
}

// Beside another allocator than glibc's, as under the address sanitizer, threads that came first at once
// aborted as they ended.
TEST_CASE("threads give back freed memory at once") {
    constexpr int count = 4;
    std::atomic<int> ready = 0;
    std::vector<std::thread> threads;
    for (int i = 0; i < count; ++i)
        threads.emplace_back([&] {
            ++ready;
            while (ready < count) std::this_thread::yield();
            os::give_back_freed_memory();
        });
    for (std::thread& thread : threads) thread.join();
    CHECK(ready == count);
}

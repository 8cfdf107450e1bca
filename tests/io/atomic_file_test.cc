#include "hsdm/io/atomic_file.hh"

#include "hsdm/errors.hh"
#include "hsdm/io/file_registry.hh"
#include "support/folder.hh"

#include <catch2/catch.hpp>

#include <filesystem>
#include <thread>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

using namespace hsdm;
using support::Folder;
using support::read_file;
namespace fs = std::filesystem;

namespace {

void replace(const std::string& path, const std::string& text) {
    AtomicFile file(path);
    file.write(text);
    file.commit();
}

struct stat status(const std::string& path) {
    struct stat result {};
    REQUIRE(::stat(path.c_str(), &result) == 0);
    return result;
}

} // namespace

TEST_CASE("a file that is not committed leaves what was there and nothing else", "[io]") {
    const Folder folder; // its own: what a folder holds is looked up once per process
    folder.write("a", "old");
    {
        AtomicFile file(folder / "a");
        file.write("new");
        CHECK(folder.names().size() == 2);
        CHECK(read_file(folder / "a") == "old");
    }
    CHECK(read_file(folder / "a") == "old");
    CHECK(folder.names() == std::set<std::string>{"a"});
    replace(folder / "a", "new");
    CHECK(read_file(folder / "a") == "new");
    CHECK(folder.names() == std::set<std::string>{"a"});
}

TEST_CASE("a file that is replaced keeps its mode, a new one has the usual one", "[io]") {
    const Folder folder;
    folder.write("secret", "old");
    REQUIRE(::chmod((folder / "secret").c_str(), 0640) == 0);
    {
        AtomicFile file(folder / "secret");
        file.write("new");
        for (const std::string& name : folder.names()) // the temporary, too: before it is in place
            CHECK((status(folder / name).st_mode & 0777) == 0640);
        file.commit();
    }
    CHECK((status(folder / "secret").st_mode & 0777) == 0640);
    const mode_t mask = ::umask(027);
    replace(folder / "fresh", "new");
    ::umask(mask);
    CHECK((status(folder / "fresh").st_mode & 0777) == 0640);
    if (::geteuid() != 0) return;
    REQUIRE(::chown((folder / "secret").c_str(), 1, 2) == 0);
    replace(folder / "secret", "again");
    CHECK(status(folder / "secret").st_uid == 1);
    CHECK(status(folder / "secret").st_gid == 2);
}

TEST_CASE("a file with two names keeps both, shorter and longer than before", "[io]") {
    const Folder folder;
    folder.write("a", "what was there before");
    fs::create_hard_link(folder / "a", folder / "b");
    const auto inode = status(folder / "a").st_ino;
    for (const std::string& text : {std::string("short"), std::string(200000, 'x'), std::string()}) {
        replace(folder / "b", text);
        CHECK(read_file(folder / "a") == text);
        CHECK(status(folder / "a").st_ino == inode);
        CHECK(status(folder / "b").st_ino == inode);
        CHECK(folder.names() == std::set<std::string>{"a", "b"});
    }
}

TEST_CASE("symbolic links are followed, also to what is not there yet", "[io]") {
    const Folder folder;
    fs::create_directory(folder / "sub");
    folder.write("a", "old");
    fs::create_symlink("a", folder / "link");
    fs::create_symlink("sub/new", folder / "dangling");
    fs::create_symlink("dangling", folder / "twice");
    fs::create_symlink("loop", folder / "loop");
    replace(folder / "link", "one");
    CHECK(read_file(folder / "a") == "one");
    replace(folder / "twice", "two");
    CHECK(read_file(folder / "sub/new") == "two");
    CHECK(fs::is_symlink(folder / "link"));
    CHECK(fs::is_symlink(folder / "dangling"));
    CHECK_THROWS_AS(AtomicFile(folder / "loop"), Error);
}

TEST_CASE("a descriptor is written on from where it stands, whatever is open there", "[io]") {
    const Folder folder;
    const int file = ::open((folder / "log").c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
    REQUIRE(file >= 0);
    REQUIRE(::write(file, "before ", 7) == 7);
    replace("/dev/fd/" + std::to_string(file), "here");
    REQUIRE(::write(file, " after", 6) == 6);
    ::close(file);
    CHECK(read_file(folder / "log") == "before here after");
    int ends[2];
    REQUIRE(::pipe(ends) == 0);
    replace("/proc/self/fd/" + std::to_string(ends[1]), "through");
    char bytes[16];
    CHECK(::read(ends[0], bytes, sizeof bytes) == 7);
    CHECK_THROWS_AS(check_writable("/dev/fd/" + std::to_string(ends[0])), Error); // the reading end
    ::close(ends[0]);
    ::close(ends[1]);
    CHECK_THROWS_AS(AtomicFile("/dev/fd/" + std::to_string(ends[1])), Error); // closed
    replace("/dev/null", "nothing");
}

TEST_CASE("a named pipe is written to its reader", "[io]") {
    const Folder folder;
    REQUIRE(::mkfifo((folder / "pipe").c_str(), 0600) == 0);
    std::string read;
    std::thread reader([&] { read = read_file(folder / "pipe"); });
    replace(folder / "pipe", "through");
    reader.join();
    CHECK(read == "through");
    CHECK(folder.names() == std::set<std::string>{"pipe"});
}

TEST_CASE("temporaries of killed runs are removed and named, those of living ones are not", "[io]") {
    const Folder folder;
    folder.write(".a.123-4.tmp", "left");
    folder.write(".a.5-6.tmp", "alive");
    for (const char* other : {".ab.1-2.tmp", ".a.1-x.tmp", ".a.tmp", "a.1-2.tmp", ".a.1-2.tmp.bak"})
        folder.write(other, "of others");
    const int alive = ::open((folder / ".a.5-6.tmp").c_str(), O_RDWR | O_CLOEXEC);
    REQUIRE(::flock(alive, LOCK_EX) == 0);
    take_removed_leftovers();
    std::set<std::string> expected = folder.names();
    expected.erase(".a.123-4.tmp");
    expected.insert("a");
    replace(folder / "a", "new");
    CHECK(folder.names() == expected);
    CHECK(take_removed_leftovers() == std::vector<std::string>{folder / ".a.123-4.tmp"});
    CHECK(take_removed_leftovers().empty());
    ::close(alive);
}

TEST_CASE("two files of one target at a time do not take each other's temporary away", "[io]") {
    const Folder folder;
    AtomicFile first(folder / "a"), second(folder / "a");
    first.write("first");
    second.write("second");
    CHECK(folder.names().size() == 2);
    first.commit();
    CHECK(read_file(folder / "a") == "first");
    second.commit();
    CHECK(read_file(folder / "a") == "second");
    CHECK(folder.names() == std::set<std::string>{"a"});
}

TEST_CASE("what cannot be written is refused before anything is made", "[io]") {
    const Folder folder;
    CHECK_THROWS_AS(AtomicFile(""), Error);
    CHECK_THROWS_AS(AtomicFile(folder / "."), Error);
    CHECK_THROWS_AS(AtomicFile(folder / "missing/a"), Error);
    CHECK(folder.names().empty());
    if (::geteuid() == 0) return; // to whom nothing is protected
    folder.write("fixed", "old");
    REQUIRE(::chmod((folder / "fixed").c_str(), 0400) == 0);
    CHECK_THROWS_AS(AtomicFile(folder / "fixed"), Error);
    CHECK(read_file(folder / "fixed") == "old");
}

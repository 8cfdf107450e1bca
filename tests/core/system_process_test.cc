#include "hsdm/core/system.hh"
#include "hsdm/core/system_process.hh"

#include <catch2/catch.hpp>

#include <array>
#include <cerrno>
#include <csignal>
#include <filesystem>
#include <string>

#include <sys/types.h>

using namespace hsdm;

namespace {

struct Ends {
    int read = -1, write = -1;

    Ends() { REQUIRE(os::open_pipe(read, write)); }
    ~Ends() {
        os::close(read);
        os::close(write);
    }
    Ends(const Ends&) = delete;
    Ends& operator=(const Ends&) = delete;

    void close_writing() {
        os::close(write);
        write = -1;
    }
    std::string rest() const {
        std::string all;
        char bytes[4096];
        for (std::ptrdiff_t count; (count = os::read(read, bytes, sizeof bytes)) > 0;)
            all.append(bytes, static_cast<std::size_t>(count));
        return all;
    }
};

/// What a descriptor of a process leads to, such as a pipe by its number; empty without one.
std::filesystem::path target_of(const std::string& process, int descriptor) {
    std::error_code error;
    return std::filesystem::read_symlink("/proc/" + process + "/fd/" + std::to_string(descriptor), error);
}

/// Whether a process has a descriptor of ours: one that it opened itself may have the same number.
bool has(std::int64_t process, int descriptor) {
    return target_of(std::to_string(process), descriptor) == target_of("self", descriptor);
}

} // namespace

TEST_CASE("of several pipes those are told that have something to read or have ended") {
    Ends first, second, third;
    const std::array pipes{first.read, second.read, -1, third.read};
    CHECK(os::ready_to_read(pipes, 0) == 0);
    CHECK(os::write_all(second.write, "x"));
    CHECK(os::ready_to_read(pipes, -1) == 2);
    third.close_writing();
    CHECK(os::ready_to_read(pipes, -1) == 10);
    second.close_writing();
    CHECK(second.rest() == "x");
}

TEST_CASE(
    "a pipe that nobody reads refuses what is written, once writing fails instead of ending the process") {
    const auto before = std::signal(SIGPIPE, SIG_DFL);
    const auto before_size = std::signal(SIGXFSZ, SIG_DFL);
    os::let_writing_fail();
    Ends pipe;
    os::close(pipe.read);
    pipe.read = -1;
    CHECK_FALSE(os::write_all(pipe.write, "x"));
    CHECK(errno == EPIPE);
    std::signal(SIGPIPE, before);
    std::signal(SIGXFSZ, before_size);
}

TEST_CASE("this program started anew prints into a pipe and tells its status") {
    Ends printed;
    const std::int64_t process = os::start_this_program(
        {.words = {"hsdm_tests", "--no-such-option"}, .kept = {}, .printed = printed.write});
    REQUIRE(process > 0);
    printed.close_writing();
    CHECK(printed.rest().find("no-such-option") != std::string::npos);
    const os::ProcessEnd end = os::wait_for_end(process);
    CHECK(end.status == 255); // of Catch, where words are wrong
    CHECK((end.signal.empty() && !end.was_killed));
}

TEST_CASE(
    "a process that is started has the descriptors that it is to keep and no others, and a kill is told") {
    Ends kept, own, printed;
    // It stays at its first word, for which there is no room: pages are filled whole.
    while (os::is_ready_to_write(printed.write, 0))
        REQUIRE(os::write_all(printed.write, std::string(4096, '.')));
    const std::int64_t process = os::start_this_program(
        {.words = {"hsdm_tests", "--no-such-option"}, .kept = {kept.read}, .printed = printed.write});
    REQUIRE(process > 0);
    CHECK(has(process, kept.read));
    CHECK_FALSE(has(process, kept.write));
    CHECK_FALSE(has(process, own.read));
    REQUIRE(::kill(static_cast<pid_t>(process), SIGKILL) == 0);
    const os::ProcessEnd end = os::wait_for_end(process);
    CHECK(end.status == 137);
    CHECK(end.signal == "9 (Killed)");
    CHECK(end.was_killed);
}

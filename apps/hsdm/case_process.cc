#include "case_process.hh"

#include "activity.hh"
#include "command.hh"
#include "machine_speed.hh"
#include "mesh_picture.hh"
#include "messages.hh"
#include "suite_run.hh"
#include "threads.hh"

#include "hsdm/core/number_of.hh"
#include "hsdm/core/system.hh"
#include "hsdm/errors.hh"
#include "hsdm/io/file_registry.hh"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <new>
#include <optional>
#include <span>
#include <system_error>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ; // NOLINT: POSIX has it in no header

namespace hsdm::command {
namespace {

/// Of what a case prints: the last so many bytes.
constexpr std::size_t most_printed = 16384;

class Descriptor {
public:
    Descriptor() = default;
    explicit Descriptor(int number) : number_(number) {}
    Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
    Descriptor& operator=(Descriptor&& other) noexcept {
        std::swap(number_, other.number_);
        return *this;
    }
    ~Descriptor() { close(); }

    int number() const { return number_; }
    void close() {
        if (number_ >= 0) ::close(number_);
        number_ = -1;
    }

private:
    int number_ = -1;
};

[[noreturn]] void fail_to_start(const std::string& what, int error) {
    if (error == ENOMEM) throw std::bad_alloc();
    throw Error("a process for the case could not be " + what + ": " + std::strerror(error)
                + "; are there too many processes or open files? try fewer --jobs");
}

struct Pipe {
    Descriptor read, write;

    Pipe() {
        int ends[2];
        if (pipe2(ends, O_CLOEXEC) != 0) fail_to_start("reached", errno);
        read = Descriptor(ends[0]);
        write = Descriptor(ends[1]);
    }
};

/// False where the reader is gone.
bool write_all(int descriptor, std::span<const std::uint8_t> bytes) {
    while (!bytes.empty()) {
        const auto count = ::write(descriptor, bytes.data(), bytes.size());
        if (count <= 0 && errno != EINTR) return false;
        if (count > 0) bytes = bytes.subspan(static_cast<std::size_t>(count));
    }
    return true;
}

/// Appends what there is; false at the end.
bool read_some(int descriptor, std::string& text) {
    std::array<char, 65536> bytes;
    ssize_t count = 0;
    do count = ::read(descriptor, bytes.data(), bytes.size());
    while (count < 0 && errno == EINTR);
    if (count > 0) text.append(bytes.data(), static_cast<std::size_t>(count));
    return count > 0;
}

/// One JSON value with its length before it. Texts need not be UTF-8.
std::vector<std::uint8_t> packed(const Json& value) {
    const std::vector<std::uint8_t> body = Json::to_cbor(value);
    std::vector<std::uint8_t> all;
    for (int shift = 56; shift >= 0; shift -= 8)
        all.push_back(static_cast<std::uint8_t>(std::uint64_t{body.size()} >> shift & 255));
    all.insert(all.end(), body.begin(), body.end());
    return all;
}

/// The value, once its bytes are all there.
std::optional<Json> unpacked(const std::string& bytes) {
    constexpr std::size_t head = 8;
    if (bytes.size() < head) return std::nullopt;
    std::uint64_t size = 0;
    for (std::size_t i = 0; i < head; ++i) size = size << 8 | static_cast<unsigned char>(bytes[i]);
    if (bytes.size() - head < size) return std::nullopt;
    return Json::from_cbor(bytes.begin() + head, bytes.end(), true, false);
}

Json task_json(const Case& one, const CaseTask& task) {
    Json fails;
    if (one.fails) fails = {{"message", one.fails->message}, {"status", one.fails->status}};
    return {{"name", one.name},           {"input", one.input},
            {"folder", one.folder},       {"args", one.arguments},
            {"reference", one.reference}, {"output", one.output},
            {"expect", one.expect},       {"fails", fails},
            {"threads", task.threads},    {"measure_machine", task.measure_machine},
            {"picture", task.picture}};
}

std::pair<Case, CaseTask> case_of(const Json& object) {
    Case one;
    object.at("name").get_to(one.name);
    object.at("input").get_to(one.input);
    object.at("folder").get_to(one.folder);
    object.at("args").get_to(one.arguments);
    object.at("reference").get_to(one.reference);
    object.at("output").get_to(one.output);
    one.expect = object.at("expect");
    if (const Json& fails = object.at("fails"); !fails.is_null())
        one.fails = Failure{fails.at("message").get<std::string>(), fails.at("status").get<int>()};
    return {std::move(one),
            {object.at("threads").get<int>(), object.at("measure_machine").get<bool>(),
             object.at("picture").get<bool>()}};
}

/// What posix_spawn() asks for, freed in the end.
struct SpawnSettings {
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;

    SpawnSettings() {
        if (const int error = posix_spawn_file_actions_init(&actions)) fail_to_start("started", error);
        if (const int error = posix_spawnattr_init(&attributes)) {
            posix_spawn_file_actions_destroy(&actions);
            fail_to_start("started", error);
        }
    }
    ~SpawnSettings() {
        posix_spawn_file_actions_destroy(&actions);
        posix_spawnattr_destroy(&attributes);
    }
    SpawnSettings(const SpawnSettings&) = delete;
    SpawnSettings& operator=(const SpawnSettings&) = delete;
};

/// This program's file: by its name, which tools that run it see through; by the link itself if it was
/// replaced.
std::string this_program() {
    const std::string link = "/proc/self/exe";
    std::error_code error;
    const std::filesystem::path file = std::filesystem::read_symlink(link, error);
    return !error && std::filesystem::exists(file, error) ? file.string() : link;
}

/// The three pipes between the two processes.
struct Lines {
    Pipe task, result, printed;
};

/// A process of its own group, so that what a terminal sends ends this one alone, which ends the others.
pid_t start_process(const Lines& lines) {
    SpawnSettings settings;
    const int in = lines.task.read.number(), out = lines.result.write.number();
    sigset_t none;
    sigemptyset(&none);
    posix_spawnattr_setsigmask(&settings.attributes, &none);
    posix_spawnattr_setpgroup(&settings.attributes, 0);
    posix_spawnattr_setflags(&settings.attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETPGROUP);
    // A descriptor copied onto itself is one that the new program keeps.
    const std::pair<int, int> kept[] = {{in, in},
                                        {out, out},
                                        {lines.printed.write.number(), STDOUT_FILENO},
                                        {lines.printed.write.number(), STDERR_FILENO}};
    for (const auto& [from, to] : kept)
        if (const int error = posix_spawn_file_actions_adddup2(&settings.actions, from, to))
            fail_to_start("started", error);
    std::string pipes = std::to_string(in) + ':' + std::to_string(out);
    std::string words[] = {"hsdm", "regress", "--case", std::move(pipes), "-"};
    char* arguments[] = {words[0].data(), words[1].data(), words[2].data(),
                         words[3].data(), words[4].data(), nullptr};
    pid_t child = -1;
    if (const int error = posix_spawn(&child, this_program().c_str(), &settings.actions, &settings.attributes,
                                      arguments, environ))
        fail_to_start("started", error);
    return child;
}

/// What came through the pipes until the process ended.
struct Received {
    std::string result, printed;
    int status = 0; ///< as of waitpid()
};

void keep_end(std::string& text) {
    if (text.size() <= most_printed) return;
    const std::size_t line = text.find('\n', text.size() - most_printed);
    text.erase(0, line == std::string::npos ? text.size() - most_printed : line + 1);
}

/// Until the result's pipe ends: grandchildren may keep the other open.
Received receive(Lines& lines, pid_t child) {
    Received got;
    pollfd ends[] = {{lines.result.read.number(), POLLIN, 0}, {lines.printed.read.number(), POLLIN, 0}};
    for (bool open = true; open;) {
        if (poll(ends, 2, -1) < 0 && errno != EINTR) break;
        if (ends[1].revents != 0 && !read_some(ends[1].fd, got.printed)) ends[1].fd = -1;
        if (ends[0].revents != 0) open = read_some(ends[0].fd, got.result);
        keep_end(got.printed);
    }
    while (waitpid(child, &got.status, 0) < 0 && errno == EINTR) {
    }
    while (ends[1].fd >= 0 && poll(ends + 1, 1, 0) == 1 && read_some(ends[1].fd, got.printed)) {
    }
    keep_end(got.printed);
    return got;
}

/// Why a process gave no outcome: its own last word, or how it ended.
std::string words_of_end(const Received& got) {
    const bool by_signal = WIFSIGNALED(got.status);
    std::string end = by_signal ? std::string("signal ") + std::to_string(WTERMSIG(got.status)) + " ("
                                      + strsignal(WTERMSIG(got.status)) + ')'
                                : "status " + std::to_string(WEXITSTATUS(got.status));
    if (by_signal && WTERMSIG(got.status) == SIGKILL) end += ", as by a system without memory";
    const std::string mark = "hsdm: ";
    const std::size_t last = got.printed.rfind(mark);
    const std::string word =
        last == std::string::npos
            ? "its process"
            : got.printed.substr(last + mark.size(), got.printed.find('\n', last) - last - mark.size()) + ';';
    return word + " ended by " + end;
}

int status_of_end(int status) {
    return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

/// The task's two pipes, which programs that this one starts do not get.
std::pair<Descriptor, Descriptor> open_pipes(const std::string& pipes) {
    const std::size_t colon = std::min(pipes.find(':'), pipes.size() - 1);
    const auto in = number_of<int>(pipes.substr(0, colon)), out = number_of<int>(pipes.substr(colon + 1));
    if (!in || !out || fcntl(*in, F_SETFD, FD_CLOEXEC) != 0 || fcntl(*out, F_SETFD, FD_CLOEXEC) != 0)
        throw UsageError("--case is for the command itself, which runs the cases of a suite by it");
    return {Descriptor(*in), Descriptor(*out)};
}

/// Ends this process when the pipe does, which therefore stays open to the end.
void end_with(Descriptor pipe) {
    try {
        std::thread([from = std::move(pipe)] {
            std::string nothing;
            while (read_some(from.number(), nothing)) nothing.clear();
            abandon_files();
            _exit(failed);
        }).detach();
    } catch (const std::system_error&) { // it ends when it is done
    }
}

Outcome run_task(const Case& one, const CaseTask& task) {
    const double before = task.measure_machine ? time_fixed_work() : 0;
    std::optional<PolygonMesh> mesh;
    if (task.picture) mesh.emplace();
    Outcome outcome = run_case(one, mesh ? &*mesh : nullptr);
    outcome.peak_memory_bytes = os::peak_memory();
    if (task.measure_machine) outcome.machine_seconds = (before + time_fixed_work()) / 2;
    if (mesh && mesh->facet_count() > 0) outcome.picture = draw_picture(*mesh);
    return outcome;
}

} // namespace

Outcome run_in_process(const Case& one, const CaseTask& task) {
    const auto begin = std::chrono::steady_clock::now();
    Outcome outcome;
    outcome.status = failed;
    bool came = false;
    try {
        Lines lines;
        const pid_t child = start_process(lines);
        lines.task.read.close();
        lines.result.write.close();
        lines.printed.write.close();
        write_all(lines.task.write.number(), packed(task_json(one, task)));
        const Received got = receive(lines, child);
        if (const std::optional<Json> result = unpacked(got.result); result && result->is_object()) {
            outcome = outcome_of(*result);
            came = true;
        } else {
            outcome.status = status_of_end(got.status);
            outcome.failure = one.input + ": " + words_of_end(got);
        }
        outcome.printed = got.printed;
    } catch (const std::bad_alloc&) {
        outcome.failure = one.input + ": out of memory in phase start" + memory_advice;
    } catch (const std::exception& error) {
        outcome.failure = words_of(error);
    }
    if (!came) outcome.misses.push_back(outcome.failure);
    if (outcome.seconds == 0)
        outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    outcome.name = one.name;
    outcome.input = one.input;
    outcome.arguments = one.arguments;
    return outcome;
}

int serve_case(const std::string& pipes) {
    auto [in, out] = open_pipes(pipes);
    std::string bytes;
    std::optional<Json> task;
    while (!(task = unpacked(bytes)))
        if (!read_some(in.number(), bytes)) return failed;
    end_with(std::move(in));
    pthread_setname_np(pthread_self(), "hsdm"); // it may have been started by a link
    const auto [one, what] = case_of(*task);
    if (what.threads > 0) bound_threads(std::min(what.threads, most_threads));
    const std::vector<std::uint8_t> result = packed(json_of(run_task(one, what)));
    return write_all(out.number(), result) ? done : failed;
}

} // namespace hsdm::command

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
#include "hsdm/core/system_process.hh"
#include "hsdm/errors.hh"
#include "hsdm/io/file_registry.hh"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <new>
#include <optional>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>

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
        if (number_ >= 0) os::close(number_);
        number_ = -1;
    }

private:
    int number_ = -1;
};

[[noreturn]] void fail_to_start(const std::string& what) {
    const int error = errno;
    if (error == ENOMEM) throw std::bad_alloc();
    throw Error("a process for the case could not be " + what + ": " + std::strerror(error)
                + "; are there too many processes or open files? try fewer --jobs");
}

struct Pipe {
    Descriptor read, write;

    Pipe() {
        int read_end = -1, write_end = -1;
        if (!os::open_pipe(read_end, write_end)) fail_to_start("reached");
        read = Descriptor(read_end);
        write = Descriptor(write_end);
    }
};

/// Appends what there is; false at the end.
bool read_some(int descriptor, std::string& text) {
    std::array<char, 65536> bytes;
    std::ptrdiff_t count = 0;
    do count = os::read(descriptor, bytes.data(), bytes.size());
    while (count < 0 && errno == EINTR);
    if (count > 0) text.append(bytes.data(), static_cast<std::size_t>(count));
    return count > 0;
}

/// One JSON value with its length before it. Texts need not be UTF-8.
std::string packed(const Json& value) {
    std::string body, all;
    Json::to_cbor(value, body);
    for (int shift = 56; shift >= 0; shift -= 8)
        all.push_back(static_cast<char>(std::uint64_t{body.size()} >> shift & 255));
    return all + body;
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

/// The three pipes between the two processes.
struct Lines {
    Pipe task, result, printed;
};

/// Its interrupts are this process's, which ends it by the pipe of its task.
std::int64_t start_process(const Lines& lines) {
    const int in = lines.task.read.number(), out = lines.result.write.number();
    const std::int64_t process = os::start_this_program(
        {.words = {"hsdm", "regress", "--case", std::to_string(in) + ':' + std::to_string(out), "-"},
         .kept = {in, out},
         .printed = lines.printed.write.number()});
    if (process < 0) fail_to_start("started");
    return process;
}

/// What came through the pipes until the process ended.
struct Received {
    std::string result, printed;
    os::ProcessEnd end;
};

void keep_end(std::string& text) {
    if (text.size() <= most_printed) return;
    const std::size_t line = text.find('\n', text.size() - most_printed);
    text.erase(0, line == std::string::npos ? text.size() - most_printed : line + 1);
}

/// Until the result's pipe ends: grandchildren may keep the other open.
Received receive(Lines& lines, std::int64_t process) {
    Received got;
    const int result = lines.result.read.number();
    int printed = lines.printed.read.number(); // -1 once it has ended
    const auto read_printed = [&] {
        if (!read_some(printed, got.printed)) printed = -1;
        keep_end(got.printed);
    };
    for (bool open = true; open;) {
        const std::int64_t ready = os::ready_to_read(std::array{result, printed}, -1);
        if (ready < 0 && errno == EINTR) continue;
        if (ready < 0) break;
        if (ready & 2) read_printed();
        if (ready & 1) open = read_some(result, got.result);
    }
    got.end = os::wait_for_end(process);
    while (printed >= 0 && os::ready_to_read(std::array{printed}, 0) == 1) read_printed();
    return got;
}

/// Why a process gave no outcome: its own last word, or how it ended.
std::string words_of_end(const Received& got) {
    std::string end =
        got.end.signal.empty() ? "status " + std::to_string(got.end.status) : "signal " + got.end.signal;
    if (got.end.was_killed) end += ", as by a system without memory";
    const std::string mark = "hsdm: ";
    const std::size_t last = got.printed.rfind(mark);
    const std::string word =
        last == std::string::npos
            ? "its process"
            : got.printed.substr(last + mark.size(), got.printed.find('\n', last) - last - mark.size()) + ';';
    return word + " ended by " + end;
}

/// The task's two pipes, which programs that this one starts do not get.
std::pair<Descriptor, Descriptor> open_pipes(const std::string& pipes) {
    const std::size_t colon = std::min(pipes.find(':'), pipes.size() - 1);
    const auto in = number_of<int>(pipes.substr(0, colon)), out = number_of<int>(pipes.substr(colon + 1));
    if (!in || !out || !os::keep_from_others(*in) || !os::keep_from_others(*out))
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
            os::end_at_once(failed);
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
        const std::int64_t process = start_process(lines);
        lines.task.read.close();
        lines.result.write.close();
        lines.printed.write.close();
        os::write_all(lines.task.write.number(), packed(task_json(one, task))); // or it has ended before
        const Received got = receive(lines, process);
        if (const std::optional<Json> result = unpacked(got.result); result && result->is_object()) {
            outcome = outcome_of(*result);
            came = true;
        } else {
            outcome.status = got.end.status;
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
    os::set_process_name("hsdm"); // it may have been started by a link
    const auto [one, what] = case_of(*task);
    if (what.threads > 0) bound_threads(std::min(what.threads, most_threads));
    const std::string result = packed(json_of(run_task(one, what)));
    return os::write_all(out.number(), result) ? done : failed;
}

} // namespace hsdm::command

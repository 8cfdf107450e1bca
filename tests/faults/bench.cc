#include "faults/bench.hh"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <new>
#include <regex>
#include <stdexcept>
#include <thread>

#include <fcntl.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

namespace hsdm::faults {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr std::chrono::seconds longest_run{20};

Files files_below(const std::string& folder) {
    Files files;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        const std::string name = entry.path().string().substr(folder.size() + 1);
        if (entry.is_directory())
            files[name + "/"];
        else
            files[name] = test::read_file(entry.path().string());
    }
    return files;
}

void remove_measurements(Json& json) {
    if (json.is_object()) {
        for (const char* key : {"seconds", "machine_seconds", "peak_memory_bytes"}) json.erase(key);
    }
    if (json.is_structured())
        for (Json& part : json) remove_measurements(part);
}

/// The part of a page that tells neither: its mesh, and whether it comes to its end.
std::string lasting_part_of_page(const std::string& content) {
    const std::size_t mesh = content.find("id=\"mesh\"");
    if (mesh == std::string::npos || !content.ends_with("</html>\n")) return "";
    return content.substr(mesh, content.find("</script>", mesh) - mesh);
}

/// The part of a file that must be the same in each run: all but the seconds and bytes in a report.
std::string lasting_content(const std::string& name, const std::string& content) {
    if (name.ends_with(".html")) return lasting_part_of_page(content);
    if (!name.ends_with(".json")) return content;
    Json json = Json::parse(content, nullptr, false);
    remove_measurements(json);
    return json.is_discarded() ? content : json.dump();
}

/// A report that is complete and is a failure's or has one among its entries.
bool tells_of_failure(const std::string& name, const std::string& content) {
    const Json json = name.ends_with(".json") ? Json::parse(content, nullptr, false) : Json();
    const auto failed = [](const Json& entry) {
        return entry.is_object() && (entry.contains("failure") || entry.value("ok", true) == false);
    };
    return failed(json) || (json.is_array() && std::any_of(json.begin(), json.end(), failed));
}

Plan* map_plan(const std::string& file) {
    const int descriptor = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    void* memory = MAP_FAILED;
    if (descriptor >= 0 && ::ftruncate(descriptor, sizeof(Plan)) == 0)
        memory = ::mmap(nullptr, sizeof(Plan), PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
    ::close(descriptor);
    if (memory == MAP_FAILED) throw std::runtime_error("the plan of faults cannot be mapped");
    return static_cast<Plan*>(memory);
}

/// In the child: the given files become the standard streams, and one processor is left, so that TBB has no
/// other thread and calls come in the same order each time.
void prepare_child(const std::string& folder, const std::string& in, const std::string& out,
                   const std::string& err) {
    const int source = ::open(in.c_str(), O_RDONLY), target = ::open(out.c_str(), O_WRONLY | O_TRUNC),
              messages = ::open(err.c_str(), O_WRONLY | O_TRUNC);
    cpu_set_t one;
    CPU_ZERO(&one);
    const int here = ::sched_getcpu(); // the one it runs on: tests side by side do not crowd one processor
    if (here >= 0) CPU_SET(static_cast<std::size_t>(here), &one);
    const bool ready = ::sched_setaffinity(0, sizeof one, &one) == 0 && ::dup2(source, STDIN_FILENO) >= 0
                       && ::dup2(target, STDOUT_FILENO) >= 0 && ::dup2(messages, STDERR_FILENO) >= 0
                       && ::chdir(folder.c_str()) == 0;
    for (const int descriptor : {source, target, messages}) ::close(descriptor);
    if (!ready) ::_exit(98);
}

/// 128 + signal if one ended the child, -1 if it had to be ended.
int wait_for(pid_t child) {
    const auto start = std::chrono::steady_clock::now();
    int raw = 0;
    while (::waitpid(child, &raw, WNOHANG) == 0) {
        if (std::chrono::steady_clock::now() - start > longest_run) {
            ::kill(child, SIGKILL);
            ::waitpid(child, &raw, 0);
            return -1;
        }
        std::this_thread::sleep_for(std::chrono::microseconds(300));
    }
    return WIFEXITED(raw) ? WEXITSTATUS(raw) : 128 + WTERMSIG(raw);
}

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

/// The same words, whatever letter the first begins with.
bool contains_words(const std::string& text, const std::string& words) {
    return contains(text, words.substr(1));
}

/// Text of an exception that was passed on as it came, which says nothing to a user.
bool has_raw_text(const std::string& message) {
    for (const char* part : {"std::", "filesystem error", "basic_string", "terminate called", "vector::"})
        if (contains(message, part)) return true;
    return false;
}

} // namespace

Bench::Bench(Scenario scenario)
    : scenario_(std::move(scenario)), plan_(map_plan(capture_ / "plan")), before_(scenario_.inputs) {
    for (const std::string& name : scenario_.outputs) before_[name] = "what stood here before\n";
    capture_.write("out", "");
    capture_.write("err", "");
    put_back({});
    before_ = files_below(folder_.path()); // with the folders
    clean_ = run({});
    if (clean_.status != 0)
        throw std::runtime_error(scenario_.name + ": status " + std::to_string(clean_.status)
                                 + " without any fault: " + clean_.err);
    for (std::size_t k = 0; k < kinds; ++k) calls_[k] = plan_->calls[k];
    starting_calls_ = plan_->memory_calls_before_open;
}

void Bench::put_back(const Files& found) const {
    for (const auto& [name, content] : found)
        if (!before_.contains(name)) fs::remove_all(folder_ / name);
    for (const auto& [name, content] : before_) {
        const auto there = found.find(name);
        if (there != found.end() && there->second == content) continue;
        fs::create_directories(fs::path(folder_ / name).parent_path());
        folder_.write(name, content);
    }
}

int Bench::start_and_wait(const std::string& out, const std::string& err) const {
    const std::string in =
        scenario_.standard_input.empty() ? "/dev/null" : folder_ / scenario_.standard_input;
    std::vector<std::string> words = {HSDM_COMMAND};
    words.insert(words.end(), scenario_.arguments.begin(), scenario_.arguments.end());
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    const pid_t child = ::fork();
    if (child < 0) throw std::runtime_error("no process can be started");
    if (child > 0) return wait_for(child);
    prepare_child(folder_.path(), in, out, err);
    ::setenv("LD_PRELOAD", HSDM_INJECT_LIBRARY, 1);
    ::setenv(plan_variable, (capture_ / "plan").c_str(), 1);
    ::setenv("HSDM_PLUGIN_PATH", HSDM_MODULE_DIR, 1);
    ::execv(HSDM_COMMAND, pointers.data());
    ::_exit(97);
}

/// What was printed; where it holds seconds, without numbers.
std::string Bench::text_of(const std::string& out) const {
    static const std::regex numbers(" *[0-9.]+");
    return scenario_.prints_result ? out : std::regex_replace(out, numbers, "#");
}

Outcome Bench::run(const Fault& fault) {
    new (plan_) Plan;
    plan_->kind = fault.kind;
    plan_->at = fault.at;
    plan_->error = fault.error;
    plan_->lasting = fault.lasting;
    plan_->tracing = std::getenv("HSDM_FAULT_TRACE") != nullptr;
    std::strncpy(plan_->folder, folder_.path().c_str(), sizeof plan_->folder - 1);
    Outcome outcome;
    outcome.status = start_and_wait(capture_ / "out", capture_ / "err");
    outcome.out = test::read_file(capture_ / "out");
    outcome.err = test::read_file(capture_ / "err");
    outcome.files = files_below(folder_.path());
    put_back(outcome.files);
    return outcome;
}

std::string Bench::broken_files(const Outcome& outcome) const {
    for (const auto& [name, content] : before_)
        if (!outcome.files.contains(name)) return name + " is gone";
    for (const auto& [name, content] : outcome.files) {
        const auto old = before_.find(name);
        const auto wanted = clean_.files.find(name);
        if (wanted == clean_.files.end()) return name + " was left behind";
        if (lasting_content(name, content) == lasting_content(name, wanted->second)) continue;
        if (outcome.status == 0) return name + " is not what it is without a fault";
        if (tells_of_failure(name, content)) continue;
        if (old == before_.end() || content != old->second)
            return name + " is neither the old file nor the new";
    }
    if (outcome.status != 0) return "";
    for (const auto& [name, content] : clean_.files)
        if (!outcome.files.contains(name)) return name + " is not there, with status 0";
    if (text_of(outcome.out) != text_of(clean_.out)) return "standard output is not complete";
    return "";
}

std::string Bench::broken_message(const Outcome& outcome, const Fault& fault) const {
    const std::string text = scenario_.tells_in_table ? outcome.err + outcome.out : outcome.err;
    if (fault.kind == Kind::tell) return ""; // what had to be said could not be
    if (!scenario_.tells_in_table && !text.starts_with("hsdm: ") && !contains(text, "\nhsdm: "))
        return "no message";
    if (has_raw_text(text)) return "a raw message";
    const bool memory = fault.kind == Kind::memory || fault.kind == Kind::map;
    const std::string cause = memory ? "out of memory" : std::strerror(fault.error);
    if (!contains_words(text, cause)) return "the cause is not named (" + cause + ")";
    const bool of_folder = plan_->path == folder_.path() || plan_->path == std::string(".");
    // Where more than one call fails, the first need not be the one that counts.
    if (memory || fault.lasting || of_folder) {
        if (memory && !plan_->after_open) return "";
        if (contains(text, "standard ") || contains(text, "<std")) return "";
        for (const auto* files : {&before_, &clean_.files})
            for (const auto& [name, content] : *files)
                if (contains(text, name)) return "";
        for (const std::string& word : scenario_.arguments) // a folder, or what levels' names are made of
            if (word.front() != '-' && word.size() > 3 && contains(text, word)) return "";
        return "no file is named";
    }
    const std::string path = plan_->path;
    if (path == "-") return contains(text, "standard ") || contains(text, "<std") ? "" : "no stream is named";
    for (const auto* files : {&before_, &clean_.files})
        for (const auto& [name, content] : *files)
            if (contains(path, fs::path(name).filename().string()) && contains(text, name)) return "";
    return contains(text, path) ? "" : "the file is not named (" + path + ")";
}

std::string Bench::broken_promise(const Fault& fault) {
    const Outcome outcome = run(fault);
    ++runs_;
    done_in_spite_ += outcome.status == 0;
    std::string reason;
    // The digits of measured seconds change how often texts grow at the end of a run.
    const bool may_be_missed = fault.kind == Kind::memory && fault.at + 32 > calls(Kind::memory);
    if (!plan_->hit && !may_be_missed)
        reason = "no such call came: runs differ";
    else if (outcome.status == -1)
        reason = "it did not end";
    else if (outcome.status != 0 && outcome.status != 1)
        reason = "status " + std::to_string(outcome.status);
    else if (outcome.status == 1 && fault.error == partial)
        reason = "a call that moved fewer bytes was not continued";
    if (reason.empty()) reason = broken_files(outcome);
    if (reason.empty() && outcome.status == 1) reason = broken_message(outcome, fault);
    if (reason.empty()) return "";
    return scenario_.name + ", " + kind_names[static_cast<std::size_t>(fault.kind)] + " "
           + std::to_string(fault.at) + (fault.lasting ? " and on" : "") + " ("
           + (fault.error == partial ? "half" : std::strerror(fault.error)) + "): " + reason + "; status "
           + std::to_string(outcome.status) + ", " + outcome.err.substr(0, 3000);
}

} // namespace hsdm::faults

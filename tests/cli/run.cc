#include "cli/run.hh"

#include <cstdlib>
#include <filesystem>
#include <sys/wait.h>

namespace hsdm::test {

namespace fs = std::filesystem;

CommandResult run(const Folder& folder, const std::string& arguments, const std::string& before) {
    const Folder capture;
    const std::string line = "cd '" + folder.path() + "' && { " + before + " '" HSDM_COMMAND "' " + arguments
                             + "; } >'" + (capture / "out") + "' 2>'" + (capture / "err") + "'";
    const int raw = std::system(line.c_str());
    CommandResult result;
    result.status = WIFEXITED(raw) ? WEXITSTATUS(raw) : 128 + WTERMSIG(raw);
    result.out = read_file(capture / "out");
    result.err = read_file(capture / "err");
    return result;
}

std::string with_modules(const Folder& folder) {
    fs::create_directories(folder / "modules");
    fs::permissions(folder / "modules", fs::perms::owner_all);
    for (const auto& file : fs::directory_iterator(HSDM_MODULE_DIR)) {
        const std::string copy = folder / ("modules/" + file.path().filename().string());
        fs::copy_file(file.path(), copy);
        fs::permissions(copy, fs::perms::owner_all);
    }
    return "HSDM_PLUGIN_PATH=modules";
}

std::string list(const Folder& folder) {
    std::string text;
    for (const std::string& name : folder.names()) text += name + "\n";
    return text;
}

bool exists(const std::string& path) {
    return fs::exists(path);
}

} // namespace hsdm::test

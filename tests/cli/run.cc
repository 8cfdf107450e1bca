#include "cli/run.hh"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <stdexcept>
#include <sys/wait.h>

namespace hsdm::test {

namespace fs = std::filesystem;

Folder::Folder() {
    std::string name = (fs::temp_directory_path() / "hsdm-test-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no scratch folder can be made");
    path_ = name;
}

Folder::~Folder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
}

std::string Folder::write(const std::string& name, const std::string& content) const {
    std::ofstream(*this / name, std::ios::binary) << content;
    return *this / name;
}

std::string Folder::list() const {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(path_)) names.insert(entry.path().filename().string());
    std::string text;
    for (const std::string& name : names) text += name + "\n";
    return text;
}

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
    namespace fs = std::filesystem;
    fs::create_directories(folder / "modules");
    fs::permissions(folder / "modules", fs::perms::owner_all);
    for (const auto& file : fs::directory_iterator(HSDM_MODULE_DIR)) {
        const std::string copy = folder / ("modules/" + file.path().filename().string());
        fs::copy_file(file.path(), copy);
        fs::permissions(copy, fs::perms::owner_all);
    }
    return "HSDM_PLUGIN_PATH=modules";
}

std::string read_file(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

bool exists(const std::string& path) {
    return fs::exists(path);
}

} // namespace hsdm::test

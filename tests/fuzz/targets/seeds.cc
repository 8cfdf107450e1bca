// hsdm_fuzz_seeds FOLDER: writes a small valid input for each thing that the fuzzers' readers know, one
// folder per fuzzer: where they start from.

#include "fuzz/point_files.hh"
#include "fuzz/targets/fuzz.hh"
#include "io/temp_file.hh"
#include "support/random.hh"

#include <filesystem>
#include <fstream>

using namespace hsdm;
using namespace hsdm::test;

namespace {

class Seeds {
public:
    explicit Seeds(std::filesystem::path folder) : folder_(std::move(folder)) {}

    void add(const std::string& fuzzer, const std::string& content) {
        const auto folder = folder_ / fuzzer;
        std::filesystem::create_directories(folder);
        std::ofstream file(folder / ("seed_" + std::to_string(count_++)), std::ios::binary);
        file << content;
        fuzz::promise(file.flush().good(), "the folder for seeds can be written");
    }

private:
    std::filesystem::path folder_;
    int count_ = 0;
};

std::string reader_of(const std::string& name) {
    const std::string extension = name.substr(name.find('.') + 1);
    for (const char* table : {"xyz", "csv", "txt", "pts", "pwn"})
        if (extension == table) return "table";
    return extension == "p" ? "hoppe" : extension;
}

void add_points(Seeds& seeds) {
    // The last byte chooses how a file is called and read: the first few ways of each reader.
    for (const NamedContent& file : valid_point_files())
        for (char way : {'\0', '\1', '\2', '\3'})
            seeds.add("points_" + reader_of(file.name), file.content + way);
}

void add_meshes(Seeds& seeds) {
    for (const NamedContent& file : valid_point_files()) {
        const std::string reader = reader_of(file.name);
        if (reader == "ply" || reader == "off" || reader == "obj" || reader == "stl" || reader == "om")
            seeds.add("mesh_" + reader, file.content);
    }
    const std::string corners = "0 0 0\n1 0 0\n1 1 0\n0 1 0.5\n";
    seeds.add("mesh_off", "OFF 4 2 0 # c\n" + corners + "3 0 1 2 255 0 0\n4 0 2 \\\n 3 1\n");
    seeds.add("mesh_obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nvn 0 0 1\nvn 0 0 1\nvn 0 0 1\n"
                          "f 1//1 2//2 3//3\nf -1/1 -2/2/2 -3\n");
    const std::string header =
        " 1.0\nelement vertex 4\nproperty double x\nproperty double y\nproperty double z\n"
        "property float nx\nproperty float ny\nproperty float nz\nproperty uchar red\n"
        "element face 2\nproperty list uchar int vertex_indices\nproperty short label\n"
        "element edge 1\nproperty int vertex1\nproperty int vertex2\nend_header\n";
    std::string text = "ply\nformat ascii" + header;
    for (const char* v : {"0 0 0", "1 0 0", "1 1 0", "0 1 0.5"}) text += std::string(v) + " 0 0 1 7\n";
    seeds.add("mesh_ply", text + "3 0 1 2 5\n4 3 2 1 0 6\n0 1\n");
    for (const bool big : {false, true}) {
        std::string binary =
            std::string("ply\nformat binary_") + (big ? "big" : "little") + "_endian" + header;
        for (int v = 0; v < 4; ++v) {
            for (double x : {v > 1 ? 1.0 : 0.0, v % 3 ? 1.0 : 0.0, 0.25 * v}) binary += bytes_of(x, big);
            for (float x : {0.f, 0.f, 1.f}) binary += bytes_of(x, big);
            binary += '\7';
        }
        for (const int count : {3, 4}) {
            binary += static_cast<char>(count);
            for (std::int32_t i = 0; i < count; ++i) binary += bytes_of(i, big);
            binary += bytes_of(std::int16_t(5), big);
        }
        seeds.add("mesh_ply", binary + bytes_of(std::int32_t(0), big) + bytes_of(std::int32_t(1), big));
    }
}

void add_texts(Seeds& seeds) {
    for (const char* text : {"scale", "scale:factor=2", "a/b.so:rounds=3,name=x y,factor=-1e-3", "m:a=,b=="})
        seeds.add("module_options", text);
    seeds.add("suite", R"({"root": "scans", "cases": [{"name": "part, depth 5", "input": "part.ply",
        "args": ["--depth", "5"], "expect": {"mesh.closed": true, "mesh.genus": 3, "grid.leaves_per_level.0": 1,
        "mesh.faces": {"value": 1200, "relative": 0.05, "tolerance": 1},
        "error.normalised_max": {"min": 0, "max": 0.02}}}]})");
}

/// Bytes from which the fuzzer builds some cloud or other: every choice is there from the start.
void add_clouds(Seeds& seeds) {
    support::Random random(1);
    for (std::size_t size = 32; size <= 256; size += 4) {
        std::string bytes;
        while (bytes.size() < size) bytes += static_cast<char>(random.below(256));
        seeds.add("cloud", bytes);
    }
}

} // namespace

int main(int count, char** arguments) {
    fuzz::promise(count == 2, "one folder is given");
    Seeds seeds(arguments[1]);
    add_points(seeds);
    add_meshes(seeds);
    add_texts(seeds);
    add_clouds(seeds);
}

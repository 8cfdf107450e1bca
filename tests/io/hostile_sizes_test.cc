// Headers and lines that announce or hold very much in very few bytes: memory and time follow the bytes.
#include "io/temp_file.hh"

#include "hsdm/io/mesh_readers.hh"

#include <catch2/catch.hpp>

#include <ctime>
#include <sstream>

using namespace hsdm;
using namespace hsdm::test;

namespace {

std::string times(std::size_t count, const std::string& text) {
    std::string all;
    all.reserve(count * text.size());
    for (std::size_t i = 0; i < count; ++i) all += text;
    return all;
}

bool says(const std::string& name, const std::string& content, const std::string& part) {
    const std::string message = error_of(name, content);
    UNSCOPED_INFO(message);
    return message.find(part) != std::string::npos;
}

/// The error of reading a mesh from memory; empty if there is none.
std::string mesh_error(const std::string& name, const std::string& content) {
    std::istringstream stream(content);
    try {
        io::read_mesh(io::SourceBytes::read(stream, name));
    } catch (const std::exception& error) {
        return error.what();
    }
    return "";
}

/// Processor time of what is run, in seconds.
template <class Run>
double seconds_of(const Run& run) {
    const std::clock_t begin = std::clock();
    run();
    return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

constexpr const char* xyz_properties = "property float x\nproperty float y\nproperty float z\n";

} // namespace

TEST_CASE("points of more values than any point has are refused before room is made for them", "[io]") {
    const std::string counts = "VERSION .7\nFIELDS x y z" + times(400, " a") + "\nCOUNT 1 1 1"
                               + times(400, " 4096") + "\nWIDTH 1\nDATA binary\n";
    CHECK(says("a.pcd", counts, "a point of 1638403 values, more than 4096; leave out descriptors"));
    CHECK(says("a.pcd", "VERSION .7\nFIELDS x y z a\nCOUNT 1 1 1 4097\nWIDTH 1\nDATA binary\n",
               "\"4097\" is no count of a field"));
    CHECK(says("a.pcd", "VERSION .7\nFIELDS" + times(5000, " x") + "\nWIDTH 1\nDATA ascii\n",
               "more than 4096 FIELDS"));
    CHECK(says("a.ply",
               std::string("ply\nformat ascii 1.0\nelement vertex 1\n") + xyz_properties
                   + times(5000, "property int a\n") + "end_header\n",
               "a.ply:4100: more than 4096 properties"));
    CHECK(says("a.xyz", "1 2 3" + times(5000, " 1") + "\n", "a.xyz:1: more than 4096 columns"));
    CHECK(says("a.off", "OFF\n1 0 0\n1 2 3" + times(5000, " 1") + "\n",
               "a.off:3: more than 4096 numbers for a vertex"));
}

TEST_CASE("points of very many values are read if the columns wanted are named", "[io]") {
    const ReadOptions options{"", "x,y,z"};
    const PointFile file = read("a.xyz", "1 2 3" + times(5000, " 1") + "\n4 5 6\n", options);
    CHECK(file.cloud.positions == std::vector<Vec3>{Vec3(1, 2, 3), Vec3(4, 5, 6)});
}

TEST_CASE("very long lines of no meaning are passed over", "[io]") {
    const std::string words = times(5000, "a b ");
    CHECK(read("a.xyz", words + "\n# " + words + "\n1 2 3\n").cloud.size() == 1);
    const std::string ply = "ply\nformat ascii 1.0\ncomment " + words + "\nelement vertex 1\n"
                            + xyz_properties + "end_header\n1 2 3\n";
    CHECK(read("a.ply", ply).cloud.size() == 1);
}

// A tenth of a second, under sanitizers one; ten and more where a step costs what the rest of the file does.
constexpr double far_too_long = 5;

TEST_CASE("very many elements of a PLY file are passed in the time of their lines", "[io]") {
    const std::size_t count = 40000;
    const std::string file = "ply\nformat ascii 1.0\n" + times(count, "element a 1\nproperty int a\n")
                             + "element vertex 40000\n" + xyz_properties + "end_header\n"
                             + times(count, "1\n") + times(count, "1 2 3\n");
    std::size_t found = 0;
    const double seconds = seconds_of([&] { found = read("a.ply", file).cloud.size(); });
    CHECK(found == count);
    CHECK(seconds < far_too_long);
}

TEST_CASE("rows are passed alike one by one and in pieces", "[io]") {
    for (const std::size_t count : {8191u, 8192u, 8193u, 500000u}) {
        const std::string file = "ply\nformat ascii 1.0\nelement a " + std::to_string(count)
                                 + "\nproperty int a\nelement vertex 2\n" + xyz_properties + "end_header\n"
                                 + times(count, "\n1234567\n") + "1 2 3\n4 5 6\n";
        CHECK(read("a.ply", file).cloud.positions == std::vector<Vec3>{Vec3(1, 2, 3), Vec3(4, 5, 6)});
        CHECK(says("a.ply", file.substr(0, file.size() - 20),
                   "the file ends after " + std::to_string(count - 1) + " of " + std::to_string(count)
                       + " lines of element a"));
    }
}

TEST_CASE("carriage returns by the hundred thousand are passed once each", "[io]") {
    const std::string off = "OFF\n" + times(400000, "\r") + "\n3 1 0\n0 0 0\n1 0 0\n0 1 \\\r\r\n0\n3 0 1 2\n";
    std::string error;
    const double seconds = seconds_of([&] { error = mesh_error("a.off", off); });
    CHECK(error.empty());
    CHECK(seconds < far_too_long);
}

TEST_CASE("a mesh whose vertices are described twice is refused", "[io]") {
    const std::string vertex = std::string("element vertex 1\n") + xyz_properties;
    CHECK(mesh_error("a.ply", "ply\nformat ascii 1.0\n" + vertex + "property int a\n" + vertex
                                  + "end_header\n1 2 3 4\n5 6 7\n")
          == "a.ply: the header names element vertex twice; export the mesh again");
}

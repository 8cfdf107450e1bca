// The point readers, one at a time: the program's name ends with the one that is fuzzed, so that executions
// and coverage are known for each. The last byte of the input chooses among the names and options it is read
// with.

#include "fuzz/targets/fuzz.hh"
#include "hsdm/errors.hh"
#include "hsdm/io/formats.hh"

#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cstring>

using namespace hsdm;
using hsdm::fuzz::promise;

namespace {

struct Way {
    const char* name;
    ReadOptions options;
};

struct Reader {
    const char* name;
    std::vector<Way> ways;
};

const std::array<Reader, 12> readers{{
    {"ply", {{"a.ply", {}}, {"a", {"ply", ""}}}},
    {"pcd", {{"a.pcd", {}}, {"a", {"pcd", ""}}}},
    {"table",
     {{"a.xyz", {}},
      {"a.csv", {}},
      {"a.pts", {}},
      {"a.pwn", {}},
      {"a", {"txt", ""}},
      {"a", {"pts", ""}},
      {"a", {"pwn", ""}},
      {"a.xyz", {"", "x,y,z"}},
      {"a.xyz", {"xyz", "_,z,y,x,label"}},
      {"a.csv", {"", "x,y,z,nx,ny,nz,r,g,b"}}}},
    {"ptx", {{"a.ptx", {}}, {"a", {"ptx", ""}}}},
    {"las", {{"a.las", {}}, {"a", {"las", ""}}}},
    {"npy", {{"a.npy", {}}, {"a", {"npy", ""}}, {"a.npy", {"", "x,y,z"}}}},
    {"npz", {{"a.npz", {}}, {"a", {"npz", ""}}}},
    {"off", {{"a.off", {}}, {"a", {"off", ""}}}},
    {"obj", {{"a.obj", {}}, {"a", {"obj", ""}}}},
    {"stl", {{"a.stl", {}}, {"a", {"stl", ""}}}},
    {"om", {{"a.om", {}}, {"a", {"om", ""}}}},
    {"hoppe", {{"a", {}}, {"a", {"hoppe", ""}}}},
}};

const Reader* chosen = nullptr;

void check(const PointCloud& cloud, std::size_t bytes) {
    const std::size_t n = cloud.size();
    promise(n > 0, "a cloud holds points");
    const std::size_t expansion = std::strcmp(chosen->name, "npz") == 0 ? 1040 : 1; // of deflate
    promise(n <= bytes * expansion, "no more points than bytes");
    promise(cloud.normals.empty() || cloud.normals.size() == n, "a normal for each point or none");
    promise(cloud.colors.empty() || cloud.colors.size() == n, "a colour for each point or none");
    for (const Scalar& scalar : cloud.scalars) promise(scalar.values.size() == n, "a value for each point");
}

} // namespace

extern "C" int LLVMFuzzerInitialize(int*, char*** arguments) {
    // Threads would make the same input cover something else each time.
    static const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
    const std::string_view program = **arguments;
    for (const Reader& reader : readers)
        if (program.ends_with(reader.name)) chosen = &reader;
    promise(chosen != nullptr, "the program's name ends with that of a reader");
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    if (size == 0) return 0;
    const Way& way = chosen->ways[bytes[--size] % chosen->ways.size()];
    std::unique_ptr<char[]> copy(new char[size]); // of just this size: a byte beyond is no one's
    std::memcpy(copy.get(), bytes, size);
    try {
        check(io::read_points(io::SourceBytes::of(std::move(copy), size, way.name), way.options).cloud, size);
    } catch (const Error& error) {
        promise(std::string_view(error.what()).starts_with(way.name),
                "a message begins with the file's name");
    } catch (const OptionError&) { // columns of what is no table
    }
    return 0;
}

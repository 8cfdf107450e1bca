// hsdm_bench NAME [ARGUMENT...]: the measurements that docs/ shows, one of them at a time.
#include "benchmarks.hh"

#include <cstdio>
#include <cstring>
#include <exception>

namespace {

struct Benchmark {
    const char* name;
    int (*run)(int argc, char** argv);
    const char* what;
};

constexpr Benchmark benchmarks[] = {
    {"creases", hsdm::bench::creases, "how blunt an edge may be and come out sharp"},
    {"growth", hsdm::bench::growth, "seconds of a whole run, by phase, over clouds of growing size"},
    {"input", hsdm::bench::input, "memory and time by the way that points come in"},
    {"judge", hsdm::bench::judge_mesh, "topology and error of anyone's mesh of a known solid"},
    {"neighbors", hsdm::bench::neighbors, "neighbours for normals, by the octree and by FLANN"},
    {"normals", hsdm::bench::normals, "estimated normals against true ones"},
    {"phases", hsdm::bench::phases, "where the nanoseconds go: time, bytes and bandwidth of each phase"},
    {"robustness", hsdm::bench::robustness, "noise, outliers, holes, density: what comes out right"},
    {"scans", hsdm::bench::scans, "scans from a few places, completed"},
    {"silences", hsdm::bench::silences, "the longest times between two questions whether to go on"},
    {"threads", hsdm::bench::threads, "time of each phase by the number of threads"},
    {"uneven", hsdm::bench::uneven, "density that differs by place: what comes out right"},
    {"walls", hsdm::bench::walls, "how thin walls and gaps may be"},
    {"yard", hsdm::bench::yard, "what seconds and bytes of different machines are measured by"}};

} // namespace

int main(int argc, char** argv) {
    try {
        for (const Benchmark& benchmark : benchmarks)
            if (argc > 1 && std::strcmp(argv[1], benchmark.name) == 0)
                return benchmark.run(argc - 1, argv + 1);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "hsdm_bench %s: %s\n", argv[1], error.what());
        return 1;
    }
    const bool asked = argc > 1 && (std::strcmp(argv[1], "--help") == 0 || std::strcmp(argv[1], "-h") == 0);
    std::FILE* out = asked ? stdout : stderr;
    std::fprintf(out, "usage: hsdm_bench NAME [ARGUMENT...]; NAME --help tells its arguments\n\n");
    for (const Benchmark& benchmark : benchmarks)
        std::fprintf(out, "  %-10s  %s\n", benchmark.name, benchmark.what);
    return asked ? 0 : 2;
}

#include "benchmarks.hh"

#include <chrono>

double hsdm::bench::now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// The cloud fuzzer's target over random bytes, without the fuzzer and its sanitizers, many times as many
// clouds in the same time:
//
//     hsdm_cloud_sweep FIRST COUNT
//
// Prints what breaks a promise with its seed, then how many did; status 1 if any. One process per core works
// through its share; where one ends by a signal, or a cloud takes longer than 20 seconds, another goes on
// behind that cloud.

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <thread>
#include <vector>

#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size);

namespace {

constexpr unsigned patience = 20; // seconds

/// Shared by the processes: the seeds that nobody has taken yet.
struct Work {
    std::atomic<std::uint64_t> next{0};
    std::uint64_t end = 0;
};

std::vector<std::uint8_t> bytes_of(std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::vector<std::uint8_t> bytes(48 + random() % 240);
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
    return bytes;
}

/// Takes one seed after the other; `current` tells which, should it end here.
[[noreturn]] void run(Work& work, std::uint64_t& current) {
    while ((current = work.next++) < work.end) {
        const std::vector<std::uint8_t> bytes = bytes_of(current);
        alarm(patience);
        LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
    }
    _exit(0);
}

template <class T>
T* shared(std::size_t count) {
    void* memory =
        mmap(nullptr, count * sizeof(T), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) std::perror("mmap"), std::exit(2);
    return new (memory) T[count];
}

} // namespace

int main(int argc, char** argv) {
    if (argc != 3) return std::fputs("usage: hsdm_cloud_sweep FIRST COUNT\n", stderr), 2;
    const std::uint64_t first = std::strtoull(argv[1], nullptr, 10),
                        count = std::strtoull(argv[2], nullptr, 10);
    Work& work = *shared<Work>(1);
    work.next = first;
    work.end = first + count;
    const std::size_t cores = std::max(1u, std::thread::hardware_concurrency());
    std::uint64_t* current = shared<std::uint64_t>(cores);
    std::vector<pid_t> process(cores);
    std::size_t failed = 0;
    const auto launch = [&](std::size_t i) {
        process[i] = fork();
        if (process[i] == 0) run(work, current[i]);
        if (process[i] < 0) std::perror("fork"), std::exit(2);
    };
    for (std::size_t i = 0; i < cores; ++i) launch(i);
    int status = 0;
    for (pid_t ended; (ended = wait(&status)) > 0;) {
        if (WIFEXITED(status) && WEXITSTATUS(status) == 0) continue;
        const auto i =
            static_cast<std::size_t>(std::find(process.begin(), process.end(), ended) - process.begin());
        std::printf("seed %llu: ended by signal %d\n", static_cast<unsigned long long>(current[i]),
                    WIFSIGNALED(status) ? WTERMSIG(status) : 0);
        std::fflush(stdout);
        ++failed;
        launch(i);
    }
    std::printf("%llu clouds, %zu broke a promise\n", static_cast<unsigned long long>(count), failed);
    return failed > 0;
}

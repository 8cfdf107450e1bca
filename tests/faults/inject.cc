// Loaded into the command by LD_PRELOAD: stands before the C library's functions, counts their calls from the
// beginning of main() on, and makes those fail that the plan names. Everything else is passed on.

#include "plan.hh"

#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include <dirent.h>
#include <dlfcn.h>
#include <execinfo.h>
#include <fcntl.h>
#include <pthread.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

extern "C" {
// The C library's own entries to its allocator: dlsym() may allocate, so malloc cannot be looked up by it.
void* __libc_malloc(size_t size);
void* __libc_calloc(size_t count, size_t size);
void* __libc_realloc(void* memory, size_t size);
void* __libc_memalign(size_t alignment, size_t size);
}

namespace {

using hsdm::faults::Kind;
using hsdm::faults::Plan;

Plan* plan = nullptr;
std::atomic<bool> armed{false}; // in main(), but not while the loader is at work
std::atomic<bool> opened{false};

/// By descriptor: the file it was opened as, empty for files that are not watched.
constexpr int most_descriptors = 256;
char names[most_descriptors][sizeof Plan::path];

void set_name(int descriptor, const char* name) {
    if (descriptor >= 0 && descriptor < most_descriptors)
        std::snprintf(names[descriptor], sizeof names[descriptor], "%s", name);
}

const char* name_of(int descriptor) {
    return descriptor >= 0 && descriptor < most_descriptors ? names[descriptor] : "";
}

/// True for files of the run's folder. What the loader and libraries look up elsewhere is theirs.
bool watched(const char* path) {
    if (!armed || path == nullptr || path[0] == '\0') return false;
    return path[0] != '/' || std::strncmp(path, plan->folder, std::strlen(plan->folder)) == 0;
}

bool watched(int descriptor) {
    return armed && name_of(descriptor)[0] != '\0';
}

/// Where the call came from, for whoever mends what a fault has found.
void print_trace() {
    armed = false;
    void* frames[64];
    backtrace_symbols_fd(frames, backtrace(frames, 64), STDERR_FILENO);
    armed = true;
}

/// Counts a call; true, and errno is set, if it has to fail.
bool fails(Kind kind, const char* path = "") {
    if (!armed) return false;
    const std::uint64_t call = ++plan->calls[static_cast<std::size_t>(kind)];
    if (kind != plan->kind || call < plan->at || (call > plan->at && !plan->lasting)) return false;
    if (!plan->hit.exchange(true)) {
        plan->after_open = opened;
        std::snprintf(plan->path, sizeof plan->path, "%s", path);
        if (plan->tracing) print_trace();
    }
    errno = plan->error;
    return true;
}

/// For calls that move `count` bytes: false if the call has to fail, else how many to ask for.
bool bytes_to_move(Kind kind, int descriptor, size_t& count) {
    if (!watched(descriptor) || !fails(kind, name_of(descriptor))) return true;
    if (plan->error != hsdm::faults::partial) return false;
    count = count > 1 ? count / 2 : count;
    return true;
}

int noted(int descriptor, const char* path) {
    if (descriptor >= 0 && watched(path)) {
        set_name(descriptor, path);
        if (!opened.exchange(true))
            plan->memory_calls_before_open = plan->calls[static_cast<std::size_t>(Kind::memory)];
    }
    return descriptor;
}

/// Plans are for the command alone, not for a shell that may have started it.
void map_plan() {
    const char* const file = std::getenv(hsdm::faults::plan_variable);
    if (file == nullptr) return;
    const int descriptor = ::open(file, O_RDWR | O_CLOEXEC);
    void* const memory = ::mmap(nullptr, sizeof(Plan), PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
    ::close(descriptor);
    if (descriptor >= 0 && memory != MAP_FAILED) plan = static_cast<Plan*>(memory);
}

using Main = int (*)(int, char**, char**);
Main real_main = nullptr;

int armed_main(int argc, char** argv, char** environment) {
    map_plan();
    if (plan == nullptr) {
        std::fputs("no plan of faults\n", stderr);
        return 99;
    }
    set_name(STDIN_FILENO, "-");
    set_name(STDOUT_FILENO, "-");
    if (plan->tracing) {
        void* frame = nullptr;
        backtrace(&frame, 1); // loads what it needs now
    }
    armed = true;
    return real_main(argc, argv, environment);
}

/// Standard error is what goes through streams; standard output is written as files are.
bool fails_to_tell(FILE* stream) {
    return stream == stderr && fails(Kind::tell, "-");
}

} // namespace

// The function of the same name that would have been called.
#define NEXT(name) static const auto next = reinterpret_cast<decltype(&::name)>(dlsym(RTLD_NEXT, #name))

#pragma GCC diagnostic ignored "-Wnonnull-compare" // callers of C functions may break their promises

extern "C" {

int __libc_start_main(Main main, int argc, char** argv, void (*init)(), void (*fini)(), void (*loader_fini)(),
                      void* stack_end) {
    real_main = main;
    const auto next = reinterpret_cast<decltype(&__libc_start_main)>(dlsym(RTLD_NEXT, "__libc_start_main"));
    return next(armed_main, argc, argv, init, fini, loader_fini, stack_end);
}

// Memory.

void* malloc(size_t size) noexcept {
    return fails(Kind::memory) ? nullptr : __libc_malloc(size);
}

void* calloc(size_t count, size_t size) noexcept {
    return fails(Kind::memory) ? nullptr : __libc_calloc(count, size);
}

void* realloc(void* memory, size_t size) noexcept {
    return fails(Kind::memory) ? nullptr : __libc_realloc(memory, size);
}

void* memalign(size_t alignment, size_t size) noexcept {
    return fails(Kind::memory) ? nullptr : __libc_memalign(alignment, size);
}

void* aligned_alloc(size_t alignment, size_t size) noexcept {
    return memalign(alignment, size);
}

int posix_memalign(void** result, size_t alignment, size_t size) noexcept {
    void* const memory = memalign(alignment, size);
    if (memory == nullptr) return ENOMEM;
    *result = memory;
    return 0;
}

void* mmap(void* address, size_t size, int protection, int flags, int descriptor, off_t offset) noexcept {
    NEXT(mmap);
    return fails(Kind::map) ? MAP_FAILED : next(address, size, protection, flags, descriptor, offset);
}

// The loader cannot be stopped half-way: where its allocations fail while TBB starts, it crashes. They are
// neither counted nor failed.

void* dlopen(const char* file, int flags) {
    NEXT(dlopen);
    const bool was_armed = armed.exchange(false);
    void* const library = next(file, flags);
    armed = was_armed;
    return library;
}

// Opening and closing.

int open(const char* path, int flags, ...) {
    NEXT(open);
    std::va_list rest;
    va_start(rest, flags);
    const mode_t mode = (flags & O_CREAT) != 0 ? va_arg(rest, mode_t) : 0;
    va_end(rest);
    return watched(path) && fails(Kind::open, path) ? -1 : noted(next(path, flags, mode), path);
}

int open64(const char* path, int flags, ...) {
    std::va_list rest;
    va_start(rest, flags);
    const mode_t mode = (flags & O_CREAT) != 0 ? va_arg(rest, mode_t) : 0;
    va_end(rest);
    return open(path, flags, mode);
}

int openat(int folder, const char* path, int flags, ...) {
    NEXT(openat);
    std::va_list rest;
    va_start(rest, flags);
    const mode_t mode = (flags & O_CREAT) != 0 ? va_arg(rest, mode_t) : 0;
    va_end(rest);
    return watched(path) && fails(Kind::open, path) ? -1 : noted(next(folder, path, flags, mode), path);
}

FILE* fopen(const char* path, const char* mode) {
    NEXT(fopen);
    if (watched(path) && fails(Kind::open, path)) return nullptr;
    FILE* const file = next(path, mode);
    if (file != nullptr) noted(fileno(file), path);
    return file;
}

FILE* fopen64(const char* path, const char* mode) {
    return fopen(path, mode);
}

DIR* opendir(const char* path) {
    NEXT(opendir);
    return watched(path) && fails(Kind::open, path) ? nullptr : next(path);
}

int close(int descriptor) {
    NEXT(close);
    char name[sizeof Plan::path];
    std::snprintf(name, sizeof name, "%s", name_of(descriptor));
    const bool fail = watched(descriptor) && fails(Kind::close, name);
    const int error = errno;
    set_name(descriptor, "");
    const int result = next(descriptor);
    if (!fail) return result;
    errno = error;
    return -1;
}

int fclose(FILE* file) {
    NEXT(fclose);
    const int descriptor = fileno(file);
    const bool fail = watched(descriptor) && fails(Kind::close, name_of(descriptor));
    const int error = errno;
    set_name(descriptor, "");
    const int result = next(file);
    if (!fail) return result;
    errno = error;
    return EOF;
}

// Reading and writing.

ssize_t read(int descriptor, void* bytes, size_t count) {
    NEXT(read);
    return bytes_to_move(Kind::read, descriptor, count) ? next(descriptor, bytes, count) : -1;
}

ssize_t pread(int descriptor, void* bytes, size_t count, off_t offset) {
    NEXT(pread);
    return bytes_to_move(Kind::read, descriptor, count) ? next(descriptor, bytes, count, offset) : -1;
}

ssize_t pread64(int descriptor, void* bytes, size_t count, off64_t offset) {
    return pread(descriptor, bytes, count, offset);
}

ssize_t write(int descriptor, const void* bytes, size_t count) {
    NEXT(write);
    return bytes_to_move(Kind::write, descriptor, count) ? next(descriptor, bytes, count) : -1;
}

ssize_t writev(int descriptor, const iovec* pieces, int count) {
    NEXT(writev);
    return watched(descriptor) && fails(Kind::write, name_of(descriptor)) ? -1
                                                                          : next(descriptor, pieces, count);
}

int fsync(int descriptor) {
    NEXT(fsync);
    // Files of this test need no disk: the call takes as long as all the rest of a run.
    return watched(descriptor) ? (fails(Kind::sync, name_of(descriptor)) ? -1 : 0) : next(descriptor);
}

int fdatasync(int descriptor) {
    return fsync(descriptor);
}

size_t fwrite(const void* bytes, size_t size, size_t count, FILE* stream) {
    NEXT(fwrite);
    return fails_to_tell(stream) ? 0 : next(bytes, size, count, stream);
}

int putc(int character, FILE* stream) {
    NEXT(putc);
    return fails_to_tell(stream) ? EOF : next(character, stream);
}

int fputc(int character, FILE* stream) {
    NEXT(fputc);
    return fails_to_tell(stream) ? EOF : next(character, stream);
}

int fflush(FILE* stream) {
    NEXT(fflush);
    return fails_to_tell(stream) ? EOF : next(stream);
}

// Names and folders. The path that counts is the one a user knows: where the file shall be.

int rename(const char* from, const char* to) noexcept {
    NEXT(rename);
    return watched(to) && fails(Kind::rename, to) ? -1 : next(from, to);
}

int renameat2(int from_folder, const char* from, int to_folder, const char* to, unsigned flags) noexcept {
    NEXT(renameat2);
    return watched(to) && fails(Kind::rename, to) ? -1 : next(from_folder, from, to_folder, to, flags);
}

int link(const char* from, const char* to) noexcept {
    NEXT(link);
    return watched(to) && fails(Kind::link, to) ? -1 : next(from, to);
}

int symlink(const char* from, const char* to) noexcept {
    NEXT(symlink);
    return watched(to) && fails(Kind::link, to) ? -1 : next(from, to);
}

int mkdir(const char* path, mode_t mode) noexcept {
    NEXT(mkdir);
    return watched(path) && fails(Kind::folder, path) ? -1 : next(path, mode);
}

int unlink(const char* path) noexcept {
    NEXT(unlink);
    return watched(path) && fails(Kind::remove, path) ? -1 : next(path);
}

int rmdir(const char* path) noexcept {
    NEXT(rmdir);
    return watched(path) && fails(Kind::remove, path) ? -1 : next(path);
}

int stat(const char* path, struct stat* status) noexcept {
    NEXT(stat);
    return watched(path) && fails(Kind::status, path) ? -1 : next(path, status);
}

int lstat(const char* path, struct stat* status) noexcept {
    NEXT(lstat);
    return watched(path) && fails(Kind::status, path) ? -1 : next(path, status);
}

int fstat(int descriptor, struct stat* status) noexcept {
    NEXT(fstat);
    return watched(descriptor) && fails(Kind::status, name_of(descriptor)) ? -1 : next(descriptor, status);
}

int access(const char* path, int wanted) noexcept {
    NEXT(access);
    return watched(path) && fails(Kind::status, path) ? -1 : next(path, wanted);
}

int faccessat(int folder, const char* path, int wanted, int flags) noexcept {
    NEXT(faccessat);
    return watched(path) && fails(Kind::status, path) ? -1 : next(folder, path, wanted, flags);
}

ssize_t readlink(const char* path, char* target, size_t size) noexcept {
    NEXT(readlink);
    return watched(path) && fails(Kind::status, path) ? -1 : next(path, target, size);
}

int chmod(const char* path, mode_t mode) noexcept {
    NEXT(chmod);
    return watched(path) && fails(Kind::mode, path) ? -1 : next(path, mode);
}

int fchmod(int descriptor, mode_t mode) noexcept {
    NEXT(fchmod);
    return watched(descriptor) && fails(Kind::mode, name_of(descriptor)) ? -1 : next(descriptor, mode);
}

int fchown(int descriptor, uid_t owner, gid_t group) noexcept {
    NEXT(fchown);
    return watched(descriptor) && fails(Kind::mode, name_of(descriptor)) ? -1
                                                                         : next(descriptor, owner, group);
}

int ftruncate(int descriptor, off_t size) noexcept {
    NEXT(ftruncate);
    return watched(descriptor) && fails(Kind::mode, name_of(descriptor)) ? -1 : next(descriptor, size);
}

int flock(int descriptor, int operation) noexcept {
    NEXT(flock);
    return watched(descriptor) && fails(Kind::lock, name_of(descriptor)) ? -1 : next(descriptor, operation);
}

int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*start)(void*),
                   void* argument) noexcept {
    NEXT(pthread_create);
    return fails(Kind::thread) ? plan->error : next(thread, attributes, start, argument);
}

} // extern "C"

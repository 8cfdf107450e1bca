#include "hsdm/io/source_bytes.hh"

#include "hsdm/errors.hh"

#include <tbb/parallel_for.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>

namespace hsdm::io {
namespace {

constexpr std::size_t block_size = std::size_t(1) << 22;

class Descriptor {
public:
    explicit Descriptor(const std::string& path) : value_(::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {}
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    ~Descriptor() {
        if (value_ >= 0) ::close(value_);
    }
    operator int() const { return value_; }

private:
    int value_;
};

[[noreturn]] void fail(const std::string& name, int error) {
    switch (error) {
    case ENOENT:
        throw Error(name, "no such file; check the path");
    case EACCES:
        throw Error(name, "permission denied; make the file readable");
    case EISDIR:
        throw Error(name, "is a directory; give a file");
    default:
        throw Error(name, std::string("cannot be read: ") + std::strerror(error));
    }
}

/// Reads up to `size` bytes; fewer only at the end of the source. Returns -1 with errno on failure.
ssize_t read_fully(int descriptor, char* bytes, std::size_t size, off_t offset, bool seekable) {
    std::size_t done = 0;
    while (done < size) {
        const ssize_t n =
            seekable ? ::pread(descriptor, bytes + done, size - done, offset + static_cast<off_t>(done))
                     : ::read(descriptor, bytes + done, size - done);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return -1;
        if (n == 0) break;
        done += static_cast<std::size_t>(n);
    }
    return static_cast<ssize_t>(done);
}

} // namespace

SourceBytes::SourceBytes(std::string name, std::size_t size)
    : name_(std::move(name)), bytes_(new char[size]), size_(size) {} // left uninitialised: read over at once

SourceBytes SourceBytes::open(const std::string& path) {
    if (path == "-") return read_stream(STDIN_FILENO, "<stdin>");
    const Descriptor file(path);
    struct stat status {};
    if (file < 0 || ::fstat(file, &status) != 0) fail(path, errno);
    if (S_ISDIR(status.st_mode)) fail(path, EISDIR);
    // Pipes and the files of /proc do not know their size.
    if (!S_ISREG(status.st_mode) || status.st_size == 0) return read_stream(file, path);

    SourceBytes source(path, static_cast<std::size_t>(status.st_size));
    std::atomic<int> error = 0;
    const std::size_t blocks = (source.size_ + block_size - 1) / block_size;
    tbb::parallel_for(std::size_t(0), blocks, [&](std::size_t block) {
        const std::size_t offset = block * block_size, size = std::min(block_size, source.size_ - offset);
        const ssize_t n =
            read_fully(file, source.bytes_.get() + offset, size, static_cast<off_t>(offset), true);
        if (n != static_cast<ssize_t>(size)) error = n < 0 ? errno : -1;
    });
    if (error < 0) throw Error(path, "became shorter while it was read; read it again when it is complete");
    if (error > 0) fail(path, error);
    return source;
}

SourceBytes SourceBytes::read_stream(int descriptor, const std::string& name) {
    SourceBytes source(name, block_size);
    for (std::size_t filled = 0;;) {
        const ssize_t n =
            read_fully(descriptor, source.bytes_.get() + filled, source.size_ - filled, 0, false);
        if (n < 0) fail(name, errno);
        filled += static_cast<std::size_t>(n);
        if (filled < source.size_) {
            source.size_ = filled;
            return source;
        }
        SourceBytes larger(name, 2 * source.size_);
        std::memcpy(larger.bytes_.get(), source.bytes_.get(), filled);
        source = std::move(larger);
    }
}

SourceBytes SourceBytes::read(std::istream& stream, const std::string& name) {
    std::string text;
    for (char buffer[1 << 16]; stream.read(buffer, sizeof buffer) || stream.gcount() > 0;)
        text.append(buffer, static_cast<std::size_t>(stream.gcount()));
    if (stream.bad()) throw Error(name, "the stream cannot be read");
    SourceBytes source(name, text.size());
    std::copy(text.begin(), text.end(), source.bytes_.get());
    return source;
}

} // namespace hsdm::io

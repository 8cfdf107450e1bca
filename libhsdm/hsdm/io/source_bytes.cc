#include "hsdm/io/source_bytes.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/huge_pages.hh"
#include "hsdm/core/system.hh"
#include "hsdm/errors.hh"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

namespace hsdm::io {
namespace {

constexpr std::size_t block_size = std::size_t(1) << 22;

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

std::unique_ptr<char[]> uninitialised(std::size_t size) {
    std::unique_ptr<char[]> bytes(new char[size]);
    advise_huge_pages(bytes.get(), size);
    return bytes;
}

} // namespace

SourceBytes::SourceBytes(std::string name, std::size_t size) : name_(std::move(name)), size_(size) {}

SourceBytes::SourceBytes(SourceBytes&& other) noexcept
    : name_(std::move(other.name_)),
      size_(other.size_),
      bytes_(std::move(other.bytes_)),
      complete_(other.complete_),
      descriptor_(std::exchange(other.descriptor_, -1)) {}

SourceBytes::~SourceBytes() {
    if (descriptor_ >= 0) os::close(descriptor_);
}

SourceBytes SourceBytes::open(const std::string& path) {
    if (path == "-") return read_stream(os::standard_input, "<stdin>");
    SourceBytes source(path, 0);
    source.descriptor_ = os::open_to_read(path);
    os::FileStatus status;
    if (source.descriptor_ < 0 || !os::status_of(source.descriptor_, status)) fail(path, errno);
    if (status.kind == os::FileStatus::Kind::folder) fail(path, EISDIR);
    // Pipes and the files of /proc do not know their size.
    if (status.kind != os::FileStatus::Kind::regular || status.size == 0)
        return read_stream(source.descriptor_, path);

    source.size_ = static_cast<std::size_t>(status.size);
    source.complete_ = source.size_ <= head_size;
    const std::size_t head = std::min(source.size_, head_size);
    source.bytes_ = uninitialised(head);
    source.read_at(source.bytes_.get(), head, 0);
    return source;
}

void SourceBytes::read_at(char* bytes, std::size_t count, std::size_t offset) const {
    const std::ptrdiff_t n = os::read_all_at(descriptor_, bytes, count, offset);
    if (n < 0) fail(name_, errno);
    if (static_cast<std::size_t>(n) != count)
        throw Error(name_, "became shorter while it was read; read it again when it is complete");
}

std::string_view SourceBytes::view() const {
    if (!complete_) {
        auto all = uninitialised(size_);
        const std::size_t blocks = (size_ + block_size - 1) / block_size;
        for_each_task(blocks, [&](std::size_t block) {
            const std::size_t offset = block * block_size;
            read_at(all.get() + offset, std::min(block_size, size_ - offset), offset);
        });
        bytes_ = std::move(all);
        complete_ = true;
    }
    return {bytes_.get(), size_};
}

const char* SourceBytes::piece(std::size_t offset, std::size_t count, char* scratch) const {
    if (complete_) return bytes_.get() + offset;
    read_at(scratch, count, offset);
    return scratch;
}

SourceBytes SourceBytes::read_stream(int descriptor, const std::string& name) {
    auto bytes = uninitialised(block_size);
    for (std::size_t capacity = block_size, filled = 0;;) {
        const std::ptrdiff_t n = os::read_all(descriptor, bytes.get() + filled, capacity - filled);
        if (n < 0) fail(name, errno);
        filled += static_cast<std::size_t>(n);
        if (filled < capacity) {
            SourceBytes source(name, filled);
            source.bytes_ = std::move(bytes);
            return source;
        }
        capacity *= 2;
        auto larger = uninitialised(capacity);
        std::memcpy(larger.get(), bytes.get(), filled);
        bytes = std::move(larger);
    }
}

SourceBytes SourceBytes::of(std::unique_ptr<char[]> bytes, std::size_t size, const std::string& name) {
    SourceBytes source(name, size);
    source.bytes_ = std::move(bytes);
    return source;
}

SourceBytes SourceBytes::read(std::istream& stream, const std::string& name) {
    std::string text;
    for (char buffer[1 << 14]; stream.read(buffer, sizeof buffer) || stream.gcount() > 0;)
        text.append(buffer, static_cast<std::size_t>(stream.gcount()));
    if (stream.bad()) throw Error(name, "the stream cannot be read");
    SourceBytes source(name, text.size());
    source.bytes_ = uninitialised(text.size());
    std::copy(text.begin(), text.end(), source.bytes_.get());
    return source;
}

void check_readable(const std::string& path) {
    os::FileStatus status;
    // Not opened: a pipe would wait for whoever writes it, and then be told that nobody reads.
    if (!os::status_of(path, status) || !os::may_read(path)) fail(path, errno);
    if (status.kind == os::FileStatus::Kind::folder) fail(path, EISDIR);
}

} // namespace hsdm::io

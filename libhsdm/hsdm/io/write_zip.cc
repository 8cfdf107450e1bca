#include "hsdm/core/interruption.hh"
#include "hsdm/errors.hh"
#include "hsdm/io/libzip_functions.hh"
#include "hsdm/io/zip_archive.hh"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <deque>
#include <exception>
#include <memory>

namespace hsdm::io {
namespace {

/// What libzip reads from or writes to, by commands. Nothing may be thrown through it, so what was thrown is
/// kept.
class ZipSource {
public:
    ZipSource() { libzip().error_init(&error_); }
    virtual ~ZipSource() { libzip().error_fini(&error_); }
    ZipSource(const ZipSource&) = delete;
    ZipSource& operator=(const ZipSource&) = delete;

    static zip_int64_t call(void* source, void* data, zip_uint64_t length, zip_source_cmd_t command) {
        auto& self = *static_cast<ZipSource*>(source);
        try {
            if (command == ZIP_SOURCE_ERROR) return libzip().error_to_data(&self.error_, data, length);
            if (command == ZIP_SOURCE_FREE) return 0; // by its owner
            return self.obey(data, length, command);
        } catch (...) {
            self.thrown_ = std::current_exception();
            return self.fail(ZIP_ER_INTERNAL, 0);
        }
    }

    void rethrow() const {
        if (thrown_) std::rethrow_exception(thrown_);
    }

protected:
    virtual zip_int64_t obey(void* data, zip_uint64_t length, zip_source_cmd_t command) = 0;
    zip_int64_t fail(int error, int system_error) {
        libzip().error_set(&error_, error, system_error);
        return -1;
    }
    zip_error_t error_;

private:
    std::exception_ptr thrown_;
};

/// A member's content, a stretch after the other.
class TextSource : public ZipSource {
public:
    explicit TextSource(const LongText& text) : text_(text), size_(text.size()) {}

private:
    zip_int64_t obey(void* data, zip_uint64_t length, zip_source_cmd_t command) override {
        switch (command) {
        case ZIP_SOURCE_OPEN:
            stretch_.clear();
            next_ = taken_ = 0;
            return 0;
        case ZIP_SOURCE_READ:
            return read(static_cast<char*>(data), length);
        case ZIP_SOURCE_CLOSE:
            return 0;
        case ZIP_SOURCE_STAT: {
            auto& status = *static_cast<zip_stat_t*>(data);
            status.valid |= ZIP_STAT_SIZE;
            status.size = size_; // known before, so that the archive is one that every reader knows
            return sizeof status;
        }
        case ZIP_SOURCE_SUPPORTS:
            return ZIP_SOURCE_SUPPORTS_READABLE;
        default:
            return fail(ZIP_ER_OPNOTSUPP, 0);
        }
    }

    zip_int64_t read(char* out, std::size_t length) {
        std::size_t done = 0;
        while (done < length) {
            if (taken_ == stretch_.size()) {
                if (next_ == text_.stretches()) break;
                Interruption::poll();
                stretch_ = text_.stretch(next_++);
                taken_ = 0;
            }
            const std::size_t count = std::min(length - done, stretch_.size() - taken_);
            std::memcpy(out + done, stretch_.data() + taken_, count);
            done += count, taken_ += count;
        }
        return static_cast<zip_int64_t>(done);
    }

    const LongText& text_;
    const std::uint64_t size_;
    std::string stretch_;
    std::size_t next_ = 0, taken_ = 0;
};

/// The archive. libzip goes back to what it could not know when it began; where the file cannot, in memory.
class ArchiveTarget : public ZipSource {
public:
    explicit ArchiveTarget(AtomicFile& file) : file_(file) {}

    /// To be called last.
    void finish() const {
        if (!file_.seeks()) file_.write(bytes_);
    }

private:
    zip_int64_t obey(void* data, zip_uint64_t length, zip_source_cmd_t command) override {
        switch (command) {
        case ZIP_SOURCE_STAT:
            return fail(ZIP_ER_READ, ENOENT); // there is no archive yet
        case ZIP_SOURCE_BEGIN_WRITE:
        case ZIP_SOURCE_COMMIT_WRITE:
        case ZIP_SOURCE_ROLLBACK_WRITE:
        case ZIP_SOURCE_REMOVE:
            return 0;
        case ZIP_SOURCE_WRITE:
            write({static_cast<const char*>(data), length});
            return static_cast<zip_int64_t>(length);
        case ZIP_SOURCE_TELL_WRITE:
            return static_cast<zip_int64_t>(place_);
        case ZIP_SOURCE_SEEK_WRITE: {
            const zip_int64_t to = libzip().source_seek_compute_offset(place_, size_, data, length, &error_);
            if (to < 0) return -1;
            place_ = static_cast<std::uint64_t>(to);
            return 0;
        }
        case ZIP_SOURCE_SUPPORTS:
            return ZIP_SOURCE_SUPPORTS_WRITABLE;
        default:
            return fail(ZIP_ER_OPNOTSUPP, 0);
        }
    }

    void write(std::string_view bytes) {
        if (file_.seeks())
            file_.write_at(place_, bytes);
        else
            bytes_.resize(std::max(bytes_.size(), place_ + bytes.size())),
                bytes_.replace(place_, bytes.size(), bytes);
        place_ += bytes.size();
        size_ = std::max(size_, place_);
    }

    AtomicFile& file_;
    std::string bytes_;
    std::uint64_t place_ = 0, size_ = 0;
};

zip_source_t* source_of(ZipSource& source, const std::string& path) {
    zip_error_t error;
    libzip().error_init(&error);
    zip_source_t* const made = libzip().source_function_create(ZipSource::call, &source, &error);
    if (!made) throw Error(path, "cannot write: " + words_of(error));
    libzip().error_fini(&error);
    return made;
}

void add_member(zip* archive, const std::string& path, const std::string& name, TextSource& content) {
    zip_source_t* const source = source_of(content, path);
    const zip_int64_t index = libzip().file_add(archive, name.c_str(), source, ZIP_FL_ENC_UTF_8);
    if (index < 0) {
        libzip().source_free(source);
        throw Error(path, std::string("cannot write: ") + libzip().strerror(archive));
    }
    // The fastest of nine levels: coordinates have few bits that repeat.
    constexpr zip_uint32_t fastest = 1;
    if (libzip().set_file_compression(archive, static_cast<zip_uint64_t>(index), ZIP_CM_DEFLATE, fastest)
        != 0)
        throw Error(path, std::string("cannot write: ") + libzip().strerror(archive));
    // Midnight of 1980-01-01, the first that the format knows, in whatever zone: the time of writing is none
    // of the mesh's.
    if (libzip().file_set_dostime(archive, static_cast<zip_uint64_t>(index), 0, 0x21, 0) != 0)
        throw Error(path, std::string("cannot write: ") + libzip().strerror(archive));
}

} // namespace

void write_zip(AtomicFile& file, const std::string& path,
               const std::vector<std::pair<std::string, LongText>>& members) {
    ArchiveTarget target(file);
    std::deque<TextSource> contents; // which must outlive the archive
    zip_source_t* const source = source_of(target, path);
    zip_error_t error;
    libzip().error_init(&error);
    std::unique_ptr<zip, void (*)(zip*)> archive(
        libzip().open_from_source(source, ZIP_CREATE | ZIP_TRUNCATE, &error),
        [](zip* opened) { libzip().discard(opened); });
    if (!archive) {
        libzip().source_free(source);
        throw Error(path, "cannot write: " + words_of(error));
    }
    libzip().error_fini(&error);
    for (const auto& [name, content] : members)
        add_member(archive.get(), path, name, contents.emplace_back(content));
    if (libzip().close(archive.get()) != 0) {
        target.rethrow();
        for (const TextSource& content : contents) content.rethrow();
        throw Error(path, std::string("cannot write: ") + libzip().strerror(archive.get()));
    }
    static_cast<void>(archive.release()); // closed, which frees it
    target.finish();
}

} // namespace hsdm::io

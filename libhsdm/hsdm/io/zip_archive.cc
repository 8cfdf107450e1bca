#include "hsdm/io/zip_archive.hh"

#include "hsdm/errors.hh"
#include "hsdm/io/text.hh"

#include <zip.h>

namespace hsdm::io {
namespace {

constexpr std::uint64_t most_expansion = 1040; // of deflate: 258 bytes in two bits, and what surrounds them

std::string words_of(zip_error_t& error) {
    std::string words = zip_error_strerror(&error);
    zip_error_fini(&error);
    return words;
}

void close(zip* archive) {
    zip_discard(archive);
}

} // namespace

ZipArchive::ZipArchive(const SourceBytes& bytes) : bytes_(bytes), archive_(nullptr, close) {
    const std::string_view content = bytes.view();
    zip_error_t error;
    zip_error_init(&error);
    zip_source_t* const source = zip_source_buffer_create(content.data(), content.size(), 0, &error);
    if (source) archive_.reset(zip_open_from_source(source, ZIP_RDONLY, &error));
    if (!archive_) {
        if (source) zip_source_free(source);
        fail("cannot be opened (" + words_of(error) + ")");
    }
    zip_error_fini(&error);
    const zip_int64_t count = zip_get_num_entries(archive_.get(), 0);
    for (zip_int64_t i = 0; i < count; ++i) {
        const char* const name = zip_get_name(archive_.get(), static_cast<zip_uint64_t>(i), ZIP_FL_ENC_RAW);
        if (!name) fail("has a member without a name");
        names_.emplace_back(name);
    }
    // Members that share their bytes would together expand to more than the file can hold.
    std::size_t free = bytes_.size();
    for (std::size_t member = 0; member < names_.size(); ++member) {
        const std::size_t packed = lengths_of(member).packed;
        if (packed > free) fail("has members that lie over each other");
        free -= packed;
    }
}

void ZipArchive::fail(const std::string& what) const {
    throw Error(bytes_.name(), "the ZIP archive " + what + "; it was cut off, or is damaged");
}

ZipArchive::Lengths ZipArchive::lengths_of(std::size_t member) const {
    zip_stat_t stat;
    constexpr zip_uint64_t wanted = ZIP_STAT_SIZE | ZIP_STAT_COMP_SIZE;
    if (zip_stat_index(archive_.get(), member, 0, &stat) != 0 || (stat.valid & wanted) != wanted)
        fail("does not say how long " + io::quoted(names_[member]) + " is");
    // Neither number is to be trusted.
    if (stat.comp_size > bytes_.size() || stat.size / most_expansion > stat.comp_size)
        fail("says that " + std::to_string(stat.comp_size) + " bytes of " + io::quoted(names_[member])
             + " hold " + std::to_string(stat.size));
    return {static_cast<std::size_t>(stat.comp_size), static_cast<std::size_t>(stat.size)};
}

SourceBytes ZipArchive::read(std::size_t member, std::size_t most) const {
    const std::size_t total = bytes_of(member), size = std::min(total, most);
    const std::unique_ptr<zip_file_t, int (*)(zip_file_t*)> opened(zip_fopen_index(archive_.get(), member, 0),
                                                                   zip_fclose);
    const auto because = [](zip_error_t* error) {
        return std::string(" (") + zip_error_strerror(error) + ')';
    };
    if (!opened)
        fail("has a member " + io::quoted(names_[member]) + " that cannot be read"
             + because(zip_get_error(archive_.get())));
    std::unique_ptr<char[]> content(new char[size]);
    std::size_t filled = 0;
    while (filled < size) {
        const zip_int64_t got = zip_fread(opened.get(), content.get() + filled, size - filled);
        if (got <= 0)
            fail("has a member " + io::quoted(names_[member]) + " that ends after " + std::to_string(filled)
                 + " of " + std::to_string(total) + " bytes" + because(zip_file_get_error(opened.get())));
        filled += static_cast<std::size_t>(got);
    }
    char beyond = 0; // the checksum is looked at where the member ends
    if (size == total && zip_fread(opened.get(), &beyond, 1) != 0)
        fail("has a member " + io::quoted(names_[member]) + " that is not what it was"
             + because(zip_file_get_error(opened.get())));
    return SourceBytes::of(std::move(content), size, bytes_.name() + ", " + names_[member]);
}

namespace {

/// The bytes that libzip has written into a source of its own.
void copy_to_file(AtomicFile& file, const std::string& path, zip_source_t* source) {
    if (zip_source_open(source) != 0) throw Error(path, "cannot write: the archive cannot be read back");
    std::string buffer(std::size_t(1) << 20, '\0');
    zip_int64_t got = 0;
    while ((got = zip_source_read(source, buffer.data(), buffer.size())) > 0)
        file.write(std::string_view(buffer).substr(0, static_cast<std::size_t>(got)));
    zip_source_close(source);
    if (got < 0) throw Error(path, "cannot write: the archive cannot be read back");
}

void add_member(zip* archive, const std::string& path, const std::string& name, const std::string& content) {
    zip_source_t* const source = zip_source_buffer(archive, content.data(), content.size(), 0);
    const zip_int64_t index = source ? zip_file_add(archive, name.c_str(), source, ZIP_FL_ENC_UTF_8) : -1;
    if (index < 0) {
        if (source) zip_source_free(source);
        throw Error(path, std::string("cannot write: ") + zip_strerror(archive));
    }
    // The fastest of nine levels: coordinates have few bits that repeat.
    constexpr zip_uint32_t fastest = 1;
    if (zip_set_file_compression(archive, static_cast<zip_uint64_t>(index), ZIP_CM_DEFLATE, fastest) != 0)
        throw Error(path, std::string("cannot write: ") + zip_strerror(archive));
    // Midnight of 1980-01-01, the first that the format knows, in whatever zone: the time of writing is none
    // of the mesh's.
    if (zip_file_set_dostime(archive, static_cast<zip_uint64_t>(index), 0, 0x21, 0) != 0)
        throw Error(path, std::string("cannot write: ") + zip_strerror(archive));
}

} // namespace

void write_zip(AtomicFile& file, const std::string& path,
               const std::vector<std::pair<std::string, std::string>>& members) {
    zip_error_t error;
    zip_error_init(&error);
    const std::unique_ptr<zip_source_t, void (*)(zip_source_t*)> target(
        zip_source_buffer_create(nullptr, 0, 0, &error), zip_source_free);
    if (!target) throw Error(path, "cannot write: " + words_of(error));
    std::unique_ptr<zip, void (*)(zip*)> archive(
        zip_open_from_source(target.get(), ZIP_CREATE | ZIP_TRUNCATE, &error), close);
    if (!archive) throw Error(path, "cannot write: " + words_of(error));
    zip_error_fini(&error);
    zip_source_keep(target.get()); // what is written is read after the archive is closed
    for (const auto& [name, content] : members) add_member(archive.get(), path, name, content);
    if (zip_close(archive.get()) != 0)
        throw Error(path, std::string("cannot write: ") + zip_strerror(archive.get()));
    static_cast<void>(archive.release()); // closed, which frees it
    copy_to_file(file, path, target.get());
}

} // namespace hsdm::io

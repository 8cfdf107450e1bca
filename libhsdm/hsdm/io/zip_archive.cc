#include "hsdm/io/zip_archive.hh"

#include "hsdm/core/system.hh"
#include "hsdm/errors.hh"
#include "hsdm/io/libzip.hh"
#include "hsdm/io/text.hh"

#include <zip.h>

namespace hsdm::io {
namespace {

constexpr std::uint64_t most_expansion = 1040; // of deflate: 258 bytes in two bits, and what surrounds them

/// What is used of libzip.
struct Functions {
    decltype(&zip_close) close;
    decltype(&zip_discard) discard;
    decltype(&zip_error_fini) error_fini;
    decltype(&zip_error_init) error_init;
    decltype(&zip_error_strerror) error_strerror;
    decltype(&zip_fclose) fclose;
    decltype(&zip_file_add) file_add;
    decltype(&zip_file_get_error) file_get_error;
    decltype(&zip_file_set_dostime) file_set_dostime;
    decltype(&zip_fopen_index) fopen_index;
    decltype(&zip_fread) fread;
    decltype(&zip_get_error) get_error;
    decltype(&zip_get_name) get_name;
    decltype(&zip_get_num_entries) get_num_entries;
    decltype(&zip_open_from_source) open_from_source;
    decltype(&zip_set_file_compression) set_file_compression;
    decltype(&zip_source_buffer) source_buffer;
    decltype(&zip_source_buffer_create) source_buffer_create;
    decltype(&zip_source_close) source_close;
    decltype(&zip_source_free) source_free;
    decltype(&zip_source_keep) source_keep;
    decltype(&zip_source_open) source_open;
    decltype(&zip_source_read) source_read;
    decltype(&zip_stat_index) stat_index;
    decltype(&zip_strerror) strerror;
};

Functions load_libzip() {
    void* const library = os::load_library(libzip_name);
    if (!library) throw Error(libzip_name, "cannot be loaded, for ZIP archives: " + os::library_error());
    Functions functions;
    const auto take = [&]<class Function>(const char* name, Function*& function) {
        function = reinterpret_cast<Function*>(os::symbol_of(library, name));
        if (!function) throw Error(libzip_name, os::library_error());
    };
    take("zip_close", functions.close);
    take("zip_discard", functions.discard);
    take("zip_error_fini", functions.error_fini);
    take("zip_error_init", functions.error_init);
    take("zip_error_strerror", functions.error_strerror);
    take("zip_fclose", functions.fclose);
    take("zip_file_add", functions.file_add);
    take("zip_file_get_error", functions.file_get_error);
    take("zip_file_set_dostime", functions.file_set_dostime);
    take("zip_fopen_index", functions.fopen_index);
    take("zip_fread", functions.fread);
    take("zip_get_error", functions.get_error);
    take("zip_get_name", functions.get_name);
    take("zip_get_num_entries", functions.get_num_entries);
    take("zip_open_from_source", functions.open_from_source);
    take("zip_set_file_compression", functions.set_file_compression);
    take("zip_source_buffer", functions.source_buffer);
    take("zip_source_buffer_create", functions.source_buffer_create);
    take("zip_source_close", functions.source_close);
    take("zip_source_free", functions.source_free);
    take("zip_source_keep", functions.source_keep);
    take("zip_source_open", functions.source_open);
    take("zip_source_read", functions.source_read);
    take("zip_stat_index", functions.stat_index);
    take("zip_strerror", functions.strerror);
    return functions;
}

/// libzip, loaded when the first archive is read or written: with the libraries that it needs itself that
/// takes as long as all others together, and few runs have an archive. Throws Error.
const Functions& libzip() {
    static const Functions functions = load_libzip();
    return functions;
}

std::string words_of(zip_error_t& error) {
    std::string words = libzip().error_strerror(&error);
    libzip().error_fini(&error);
    return words;
}

void close(zip* archive) {
    libzip().discard(archive);
}

} // namespace

ZipArchive::ZipArchive(const SourceBytes& bytes) : bytes_(bytes), archive_(nullptr, close) {
    const std::string_view content = bytes.view();
    zip_error_t error;
    libzip().error_init(&error);
    zip_source_t* const source = libzip().source_buffer_create(content.data(), content.size(), 0, &error);
    if (source) archive_.reset(libzip().open_from_source(source, ZIP_RDONLY, &error));
    if (!archive_) {
        if (source) libzip().source_free(source);
        fail("cannot be opened (" + words_of(error) + ")");
    }
    libzip().error_fini(&error);
    const zip_int64_t count = libzip().get_num_entries(archive_.get(), 0);
    for (zip_int64_t i = 0; i < count; ++i) {
        const char* const name =
            libzip().get_name(archive_.get(), static_cast<zip_uint64_t>(i), ZIP_FL_ENC_RAW);
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
    if (libzip().stat_index(archive_.get(), member, 0, &stat) != 0 || (stat.valid & wanted) != wanted)
        fail("does not say how long " + io::quoted(names_[member]) + " is");
    // Neither number is to be trusted.
    if (stat.comp_size > bytes_.size() || stat.size / most_expansion > stat.comp_size)
        fail("says that " + std::to_string(stat.comp_size) + " bytes of " + io::quoted(names_[member])
             + " hold " + std::to_string(stat.size));
    return {static_cast<std::size_t>(stat.comp_size), static_cast<std::size_t>(stat.size)};
}

SourceBytes ZipArchive::read(std::size_t member, std::size_t most) const {
    const std::size_t total = bytes_of(member), size = std::min(total, most);
    const std::unique_ptr<zip_file_t, int (*)(zip_file_t*)> opened(
        libzip().fopen_index(archive_.get(), member, 0), libzip().fclose);
    const auto because = [](zip_error_t* error) {
        return std::string(" (") + libzip().error_strerror(error) + ')';
    };
    if (!opened)
        fail("has a member " + io::quoted(names_[member]) + " that cannot be read"
             + because(libzip().get_error(archive_.get())));
    std::unique_ptr<char[]> content(new char[size]);
    std::size_t filled = 0;
    while (filled < size) {
        const zip_int64_t got = libzip().fread(opened.get(), content.get() + filled, size - filled);
        if (got <= 0)
            fail("has a member " + io::quoted(names_[member]) + " that ends after " + std::to_string(filled)
                 + " of " + std::to_string(total) + " bytes"
                 + because(libzip().file_get_error(opened.get())));
        filled += static_cast<std::size_t>(got);
    }
    char beyond = 0; // the checksum is looked at where the member ends
    if (size == total && libzip().fread(opened.get(), &beyond, 1) != 0)
        fail("has a member " + io::quoted(names_[member]) + " that is not what it was"
             + because(libzip().file_get_error(opened.get())));
    return SourceBytes::of(std::move(content), size, bytes_.name() + ", " + names_[member]);
}

namespace {

/// The bytes that libzip has written into a source of its own.
void copy_to_file(AtomicFile& file, const std::string& path, zip_source_t* source) {
    if (libzip().source_open(source) != 0) throw Error(path, "cannot write: the archive cannot be read back");
    std::string buffer(std::size_t(1) << 20, '\0');
    zip_int64_t got = 0;
    while ((got = libzip().source_read(source, buffer.data(), buffer.size())) > 0)
        file.write(std::string_view(buffer).substr(0, static_cast<std::size_t>(got)));
    libzip().source_close(source);
    if (got < 0) throw Error(path, "cannot write: the archive cannot be read back");
}

void add_member(zip* archive, const std::string& path, const std::string& name, const std::string& content) {
    zip_source_t* const source = libzip().source_buffer(archive, content.data(), content.size(), 0);
    const zip_int64_t index =
        source ? libzip().file_add(archive, name.c_str(), source, ZIP_FL_ENC_UTF_8) : -1;
    if (index < 0) {
        if (source) libzip().source_free(source);
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
               const std::vector<std::pair<std::string, std::string>>& members) {
    zip_error_t error;
    libzip().error_init(&error);
    const std::unique_ptr<zip_source_t, void (*)(zip_source_t*)> target(
        libzip().source_buffer_create(nullptr, 0, 0, &error), libzip().source_free);
    if (!target) throw Error(path, "cannot write: " + words_of(error));
    std::unique_ptr<zip, void (*)(zip*)> archive(
        libzip().open_from_source(target.get(), ZIP_CREATE | ZIP_TRUNCATE, &error), close);
    if (!archive) throw Error(path, "cannot write: " + words_of(error));
    libzip().error_fini(&error);
    libzip().source_keep(target.get()); // what is written is read after the archive is closed
    for (const auto& [name, content] : members) add_member(archive.get(), path, name, content);
    if (libzip().close(archive.get()) != 0)
        throw Error(path, std::string("cannot write: ") + libzip().strerror(archive.get()));
    static_cast<void>(archive.release()); // closed, which frees it
    copy_to_file(file, path, target.get());
}

} // namespace hsdm::io

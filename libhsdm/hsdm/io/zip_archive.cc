#include "hsdm/io/zip_archive.hh"

#include "hsdm/errors.hh"
#include "hsdm/io/libzip_functions.hh"
#include "hsdm/io/text.hh"

namespace hsdm::io {
namespace {

constexpr std::uint64_t most_expansion = 1040; // of deflate: 258 bytes in two bits, and what surrounds them

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

} // namespace hsdm::io

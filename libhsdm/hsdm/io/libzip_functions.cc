#include "hsdm/io/libzip_functions.hh"

#include "hsdm/core/system.hh"
#include "hsdm/errors.hh"
#include "hsdm/io/libzip.hh"

namespace hsdm::io {
namespace {

ZipFunctions load_libzip() {
    void* const library = os::load_library(libzip_name);
    if (!library) throw Error(libzip_name, "cannot be loaded, for ZIP archives: " + os::library_error());
    ZipFunctions functions;
    const auto take = [&]<class Function>(const char* name, Function*& function) {
        function = reinterpret_cast<Function*>(os::symbol_of(library, name));
        if (!function) throw Error(libzip_name, os::library_error());
    };
    take("zip_close", functions.close);
    take("zip_discard", functions.discard);
    take("zip_error_fini", functions.error_fini);
    take("zip_error_init", functions.error_init);
    take("zip_error_set", functions.error_set);
    take("zip_error_strerror", functions.error_strerror);
    take("zip_error_to_data", functions.error_to_data);
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
    take("zip_source_buffer_create", functions.source_buffer_create);
    take("zip_source_free", functions.source_free);
    take("zip_source_function_create", functions.source_function_create);
    take("zip_source_seek_compute_offset", functions.source_seek_compute_offset);
    take("zip_stat_index", functions.stat_index);
    take("zip_strerror", functions.strerror);
    return functions;
}

} // namespace

const ZipFunctions& libzip() {
    static const ZipFunctions functions = load_libzip();
    return functions;
}

std::string words_of(zip_error_t& error) {
    std::string words = libzip().error_strerror(&error);
    libzip().error_fini(&error);
    return words;
}

} // namespace hsdm::io

#pragma once
// libzip, loaded when the first archive is read or written.

#include <zip.h>

#include <string>

namespace hsdm::io {

/// What is used of libzip.
struct ZipFunctions {
    decltype(&zip_close) close;
    decltype(&zip_discard) discard;
    decltype(&zip_error_fini) error_fini;
    decltype(&zip_error_init) error_init;
    decltype(&zip_error_set) error_set;
    decltype(&zip_error_strerror) error_strerror;
    decltype(&zip_error_to_data) error_to_data;
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
    decltype(&zip_source_buffer_create) source_buffer_create;
    decltype(&zip_source_free) source_free;
    decltype(&zip_source_function_create) source_function_create;
    decltype(&zip_source_seek_compute_offset) source_seek_compute_offset;
    decltype(&zip_stat_index) stat_index;
    decltype(&zip_strerror) strerror;
};

/// With the libraries that it needs itself loading takes as long as all others together, and few runs have an
/// archive. Throws Error.
const ZipFunctions& libzip();

/// What went wrong; frees it.
std::string words_of(zip_error_t& error);

} // namespace hsdm::io

#pragma once
// NPY and NPZ files, put together byte by byte for tests.

#include "io/temp_file.hh"

#include <utility>
#include <vector>

namespace hsdm::test {

/// NPY of version 1; `type` and `shape` as Python writes them.
std::string npy_file(const std::string& type, bool fortran, const std::string& shape,
                     const std::string& data);

/// A ZIP archive of members, each a name and its content.
std::string zip_file(const std::vector<std::pair<std::string, std::string>>& members, bool deflated);

/// An archive of one stored content that the directory lists under each of the names.
std::string shared_zip_file(const std::vector<std::string>& names, const std::string& content);

} // namespace hsdm::test

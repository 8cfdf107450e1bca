#include "io/npy_bytes.hh"

#include "hsdm/io/zip_archive.hh"

#include <array>

namespace hsdm::test {
namespace {

/// The checksum of ZIP, bit by bit.
std::uint32_t crc_of(const std::string& content) {
    std::uint32_t crc = 0xffffffff;
    for (const char c : content) {
        crc ^= static_cast<unsigned char>(c);
        for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320 : 0);
    }
    return ~crc;
}

/// What a member's own header and its entry in the directory have in common.
std::string common_fields(const std::string& content) {
    return bytes_of(std::uint16_t(20)) + std::string(8, '\0') + bytes_of(crc_of(content))
           + bytes_of(static_cast<std::uint32_t>(content.size()))
           + bytes_of(static_cast<std::uint32_t>(content.size()));
}

std::string fields_of(const std::string& name, const std::string& content) {
    return common_fields(content) + bytes_of(static_cast<std::uint16_t>(name.size()));
}

std::string directory_entry(const std::string& name, const std::string& content, std::size_t at) {
    return "PK\1\2" + bytes_of(std::uint16_t(20)) + fields_of(name, content) + std::string(12, '\0')
           + bytes_of(static_cast<std::uint32_t>(at)) + name;
}

std::string local_file(const std::string& name, const std::string& content) {
    return "PK\3\4" + fields_of(name, content) + std::string(2, '\0') + name + content;
}

std::string with_directory(const std::string& file, const std::string& directory, std::size_t members) {
    const std::string count = bytes_of(static_cast<std::uint16_t>(members));
    return file + directory + "PK\5\6" + std::string(4, '\0') + count + count
           + bytes_of(static_cast<std::uint32_t>(directory.size()))
           + bytes_of(static_cast<std::uint32_t>(file.size())) + std::string(2, '\0');
}

std::string stored(const std::vector<std::pair<std::string, std::string>>& members) {
    std::string file, directory;
    for (const auto& [name, content] : members) {
        directory += directory_entry(name, content, file.size());
        file += local_file(name, content);
    }
    return with_directory(file, directory, members.size());
}

} // namespace

std::string npy_file(const std::string& type, bool fortran, const std::string& shape,
                     const std::string& data) {
    std::string header = "{'descr': " + type + ", 'fortran_order': " + (fortran ? "True" : "False")
                         + ", 'shape': " + shape + ", }";
    header.resize((header.size() + 11 + 63) / 64 * 64 - 10, ' ');
    header.back() = '\n';
    return "\x93NUMPY" + std::string("\1\0", 2) + bytes_of(static_cast<std::uint16_t>(header.size())) + header
           + data;
}

std::string zip_file(const std::vector<std::pair<std::string, std::string>>& members, bool deflated) {
    if (!deflated) return stored(members);
    const support::Folder folder;
    AtomicFile file(folder / "a.zip");
    std::vector<std::pair<std::string, LongText>> texts;
    for (const auto& [name, content] : members) texts.emplace_back(name, LongText()).second.add(content);
    io::write_zip(file, folder / "a.zip", texts);
    file.commit();
    return support::read_file(folder / "a.zip");
}

std::string shared_zip_file(const std::vector<std::string>& names, const std::string& content) {
    std::string directory;
    for (const std::string& name : names) directory += directory_entry(name, content, 0);
    return with_directory(local_file(names.front(), content), directory, names.size());
}

} // namespace hsdm::test

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

std::string stored(const std::vector<std::pair<std::string, std::string>>& members) {
    std::string file, directory;
    for (const auto& [name, content] : members) {
        const std::string fields = common_fields(content) + bytes_of(static_cast<std::uint16_t>(name.size()));
        directory += "PK\1\2" + bytes_of(std::uint16_t(20)) + fields + std::string(12, '\0')
                     + bytes_of(static_cast<std::uint32_t>(file.size())) + name;
        file += "PK\3\4" + fields + std::string(2, '\0') + name + content;
    }
    const auto count = static_cast<std::uint16_t>(members.size());
    return file + directory + "PK\5\6" + std::string(4, '\0') + bytes_of(count) + bytes_of(count)
           + bytes_of(static_cast<std::uint32_t>(directory.size()))
           + bytes_of(static_cast<std::uint32_t>(file.size())) + std::string(2, '\0');
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
    io::write_zip(file, folder / "a.zip", members);
    file.commit();
    return support::read_file(folder / "a.zip");
}

} // namespace hsdm::test

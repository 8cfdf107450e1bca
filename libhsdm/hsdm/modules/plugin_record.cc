#include "hsdm/modules/plugin_record.hh"

#include "hsdm/io/source_bytes.hh"
#include "hsdm/plugin.hh"

#include <link.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstring>
#include <string_view>
#include <type_traits>
#include <vector>

namespace hsdm {
namespace {

using io::SourceBytes;
using Header = ElfW(Ehdr);
using Section = ElfW(Shdr);

constexpr std::string_view section_name = ".hsdm_plugin";
constexpr std::size_t longest_record = std::size_t(1) << 16;

/// Bytes offset .. offset + count; nothing where the file has fewer.
std::optional<std::string> bytes_at(const SourceBytes& file, std::uint64_t offset, std::uint64_t count) {
    if (offset > file.size() || count > file.size() - offset) return std::nullopt;
    std::string bytes(count, '\0');
    const char* const found = file.piece(offset, count, bytes.data());
    if (found != bytes.data()) bytes.assign(found, count);
    return bytes;
}

/// The header, if it is one of a file that this machine's loader takes.
std::optional<Header> header_of(const SourceBytes& file) {
    const auto bytes = bytes_at(file, 0, sizeof(Header));
    if (!bytes || !bytes->starts_with(ELFMAG)) return std::nullopt;
    Header header;
    std::memcpy(&header, bytes->data(), sizeof header);
    constexpr unsigned char size = sizeof(void*) == 8 ? ELFCLASS64 : ELFCLASS32;
    constexpr unsigned char order = std::endian::native == std::endian::little ? ELFDATA2LSB : ELFDATA2MSB;
    const bool own_kind = header.e_ident[EI_CLASS] == size && header.e_ident[EI_DATA] == order;
    if (!own_kind || header.e_type != ET_DYN || header.e_shentsize != sizeof(Section)
        || header.e_shstrndx >= header.e_shnum)
        return std::nullopt;
    return header;
}

std::vector<Section> sections_of(const SourceBytes& file, const Header& header) {
    const auto bytes = bytes_at(file, header.e_shoff, header.e_shnum * sizeof(Section));
    std::vector<Section> sections(bytes ? header.e_shnum : 0);
    if (bytes) std::memcpy(sections.data(), bytes->data(), bytes->size());
    return sections;
}

/// The content of the section that holds the record.
std::optional<std::string> record_bytes(const SourceBytes& file) {
    const auto header = header_of(file);
    if (!header) return std::nullopt;
    const std::vector<Section> sections = sections_of(file, *header);
    if (sections.empty()) return std::nullopt;
    const Section& names = sections[header->e_shstrndx];
    const std::string wanted(section_name.data(), section_name.size() + 1); // with the zero behind it
    for (const Section& section : sections) {
        if (section.sh_type != SHT_PROGBITS || section.sh_size > longest_record) continue;
        // A place behind the end of the file, which no sum can then bring back to its front.
        if (names.sh_offset > file.size() || section.sh_name > file.size()) continue;
        if (bytes_at(file, names.sh_offset + section.sh_name, wanted.size()) == wanted)
            return bytes_at(file, section.sh_offset, section.sh_size);
    }
    return std::nullopt;
}

/// The texts that zeros end, at most `most`.
std::vector<std::string> texts_of(std::string_view bytes, std::size_t most) {
    std::vector<std::string> texts;
    for (std::size_t end; texts.size() < most && (end = bytes.find('\0')) != std::string_view::npos;) {
        texts.emplace_back(bytes.substr(0, end));
        bytes.remove_prefix(end + 1);
    }
    return texts;
}

} // namespace

std::optional<PluginRecord> read_plugin_record(const SourceBytes& file) {
    const auto bytes = record_bytes(file);
    if (!bytes) return std::nullopt;
    const std::vector<std::string> texts = texts_of(*bytes, 5);
    constexpr std::string_view mark = "hsdm module ";
    if (texts.size() < 2 || !texts[0].starts_with(mark)) return std::nullopt;
    PluginRecord record;
    const char* const end = texts[0].data() + texts[0].size();
    const auto number = std::from_chars(texts[0].data() + mark.size(), end, record.abi);
    if (number.ec != std::errc() || number.ptr != end) return std::nullopt;
    record.build = texts[1];
    if (record.abi != plugin_abi) return record;
    if (texts.size() < 5) return std::nullopt;
    record.name = texts[2];
    record.description = texts[3];
    record.options = texts[4];
    return record;
}

} // namespace hsdm

#include "io/las_bytes.hh"

namespace hsdm::test {
namespace {

template <class T>
void put(std::string& bytes, T value) {
    bytes += bytes_of(value);
}

std::string las_point(int format, const LasPoint& p, const std::string& extra) {
    std::string bytes;
    for (const std::int32_t x : p.at) put(bytes, x);
    put(bytes, p.intensity);
    const bool wide = format >= 6;
    put(bytes, std::uint8_t(wide ? 0x11 : 0x09)); // the first of one return
    if (wide) put(bytes, std::uint8_t(p.withheld ? 0x04 : 0));
    put(bytes, static_cast<std::uint8_t>(p.classification | (!wide && p.withheld ? 0x80 : 0)));
    put(bytes, std::uint8_t(7)); // scan angle, or user data of the wide formats
    put(bytes, std::uint8_t(9));
    if (wide) put(bytes, std::uint8_t(1)); // the upper byte of the angle
    put(bytes, p.source);
    if (wide || format == 1 || format == 3 || format == 4 || format == 5) put(bytes, 12345.5);
    if (format == 2 || format == 3 || format == 5 || format == 7 || format == 8 || format == 10)
        for (const std::uint16_t channel : p.color) put(bytes, channel);
    if (format == 8 || format == 10) put(bytes, std::uint16_t(4711)); // near infrared
    if (format == 4 || format == 5 || format == 9 || format == 10) bytes += std::string(29, '\3'); // a wave
    return bytes + extra;
}

std::string las_record(const std::string& content) {
    std::string bytes(2, '\0');
    bytes += std::string("hsdm test") + std::string(16 - 9, '\0');
    put(bytes, std::uint16_t(1));
    put(bytes, static_cast<std::uint16_t>(content.size()));
    return bytes + std::string(32, '\0') + content;
}

} // namespace

std::string las_file(const LasLayout& layout, const std::vector<LasPoint>& points) {
    const std::size_t size = layout.minor == 4 ? 375 : layout.minor == 3 ? 235 : 227;
    std::string records, body;
    for (const std::string& content : layout.records) records += las_record(content);
    for (const LasPoint& p : points) body += las_point(layout.format, p, layout.extra);
    const auto count = static_cast<std::uint32_t>(points.size());
    std::string h = "LASF" + std::string(20, '\0');
    put(h, std::uint8_t(1));
    put(h, static_cast<std::uint8_t>(layout.minor));
    h += std::string(68, '\0'); // system, software, day and year
    put(h, static_cast<std::uint16_t>(size));
    put(h, static_cast<std::uint32_t>(size + records.size() + layout.between.size()));
    put(h, static_cast<std::uint32_t>(layout.records.size()));
    put(h, static_cast<std::uint8_t>(layout.format));
    put(h, static_cast<std::uint16_t>(points.empty() ? 20 : body.size() / points.size()));
    put(h, layout.minor == 4 ? std::uint32_t(0) : count);
    h += std::string(20, '\0'); // points by return
    for (const double x : layout.scale) put(h, x);
    for (const double x : layout.offset) put(h, x);
    h += std::string(48, '\0'); // bounds
    if (layout.minor >= 3) put(h, std::uint64_t(0));
    if (layout.minor == 4) {
        h += std::string(12, '\0'); // extended records
        put(h, std::uint64_t(count));
        h += std::string(120, '\0');
    }
    return h + records + layout.between + body + layout.behind;
}

} // namespace hsdm::test

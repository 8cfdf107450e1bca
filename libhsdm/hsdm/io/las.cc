// LAS 1.0 to 1.4, the ASPRS's format for scans: a header, records of variable length, points of one of eleven
// formats.

#include "hsdm/core/chunks.hh"
#include "hsdm/errors.hh"
#include "hsdm/io/binary_columns.hh"
#include "hsdm/io/formats.hh"

#include <algorithm>
#include <array>
#include <cmath>

namespace hsdm::io {
namespace {

constexpr std::size_t no_field = 0; // no field of these lies where a point begins

/// What is read of the points of one format, by where it lies in their records.
struct PointFormat {
    std::size_t size; ///< bytes at least
    std::size_t red = no_field;
};

/// By their numbers. Those from 6 on hold flags and classes of eight bits.
constexpr std::array<PointFormat, 11> point_formats_of_las{
    {{20}, {28}, {26, 20}, {34, 28}, {57}, {63, 28}, {30}, {36, 30}, {38, 30}, {59}, {67, 30}}};
constexpr unsigned first_wide_format = 6;
constexpr std::size_t source_id_of_wide = 20, source_id_of_narrow = 18;
constexpr std::size_t flags_of_wide = 15, flags_of_narrow = 15;
constexpr unsigned withheld_of_wide = 0x04, withheld_of_narrow = 0x80;
constexpr unsigned class_mask_of_narrow = 0x1f; ///< what the flags leave of its byte
constexpr unsigned compressed_bits = 0xc0;      ///< of the format's number: LASzip's mark

struct LasHeader {
    unsigned minor = 0, format = 0;
    std::size_t size = 0, points_at = 0, record = 0;
    std::uint64_t points = 0;
    std::array<double, 3> scale{}, offset{};

    bool is_wide() const { return format >= first_wide_format; }
};

class LasHeaderReader {
public:
    explicit LasHeaderReader(const SourceBytes& bytes) : bytes_(bytes), head_(bytes.head()) {}

    LasHeader read() {
        if (head_.size() < 227)
            throw Error(bytes_.name(), "the file ends within its LAS header (at byte "
                                           + std::to_string(bytes_.size()) + " of 227); it was cut off");
        read_places();
        read_format();
        check_records();
        read_count();
        read_frame();
        return header_;
    }

private:
    [[noreturn]] void fail(std::size_t at, const std::string& what) const {
        throw Error(bytes_.name(), what + " (at byte " + std::to_string(at) + ")");
    }
    double number(StoredType type, std::size_t at) const {
        double value = 0;
        gather_of(type, false)(head_.data() + at, 0, 1, &value);
        return value;
    }
    std::size_t count(StoredType type, std::size_t at) const {
        return static_cast<std::size_t>(number(type, at));
    }
    /// Of eight bytes, none of them lost.
    std::uint64_t long_count(std::size_t at) const {
        return std::uint64_t(count(StoredType::uint32, at))
               | std::uint64_t(count(StoredType::uint32, at + 4)) << 32;
    }

    void read_places() {
        const std::size_t major = count(StoredType::uint8, 24);
        header_.minor = static_cast<unsigned>(count(StoredType::uint8, 25));
        if (major != 1 || header_.minor > 4)
            fail(24, "LAS version " + std::to_string(major) + '.' + std::to_string(header_.minor)
                         + " is not known; export the file as 1.2 or 1.4");
        const std::size_t least = header_.minor == 4 ? 375 : header_.minor == 3 ? 235 : 227;
        header_.size = count(StoredType::uint16, 94);
        header_.points_at = count(StoredType::uint32, 96);
        if (header_.size < least)
            fail(94, "a LAS header of " + std::to_string(header_.size) + " bytes, version 1."
                         + std::to_string(header_.minor) + " has " + std::to_string(least)
                         + "; the file is damaged, export it again");
        if (header_.points_at < header_.size)
            fail(96, "points that begin at byte " + std::to_string(header_.points_at)
                         + ", within the header; the file is damaged, export it again");
        if (header_.size > head_.size() || header_.points_at > bytes_.size())
            throw Error(bytes_.name(), "the file ends before its points (at byte "
                                           + std::to_string(bytes_.size()) + " of "
                                           + std::to_string(header_.points_at) + "); it was cut off");
    }

    void read_format() {
        const std::size_t number = count(StoredType::uint8, 104);
        if (number & compressed_bits)
            throw Error(bytes_.name(),
                        "is LAZ, which is compressed and not read; unpack it first: `laszip -i "
                        "scan.laz -o scan.las`, or `pdal translate scan.laz scan.las`");
        if (number >= point_formats_of_las.size())
            fail(104, "LAS point format " + std::to_string(number)
                          + " is not known; export the file with one from 0 to 10");
        header_.format = static_cast<unsigned>(number);
        header_.record = count(StoredType::uint16, 105);
        const std::size_t least = point_formats_of_las[number].size;
        if (header_.record < least)
            fail(105, "points of " + std::to_string(header_.record) + " bytes, format "
                          + std::to_string(number) + " has " + std::to_string(least)
                          + "; the file is damaged, export it again");
    }

    /// The records of variable length lie between header and points, each with its own header of 54 bytes.
    void check_records() const {
        const std::size_t records = count(StoredType::uint32, 100);
        std::size_t at = header_.size;
        // Millions of short records would each take a call to the system.
        std::vector<char> scratch(std::min(SourceBytes::head_size, header_.points_at));
        const char* block = nullptr;
        std::size_t block_begin = 0, block_end = 0;
        for (std::size_t i = 0; i < records; ++i) {
            if (header_.points_at - at < record_header)
                fail(at, "record " + std::to_string(i) + " of " + std::to_string(records)
                             + " does not fit before the points; the file is damaged, export it again");
            if (at + record_header > block_end) {
                block_begin = at;
                block_end = at + std::min(scratch.size(), header_.points_at - at);
                block = bytes_.piece(at, block_end - at, scratch.data());
            }
            double length = 0;
            gather_of(StoredType::uint16, false)(block + (at - block_begin) + 20, 0, 1, &length);
            at += record_header;
            if (header_.points_at - at < static_cast<std::size_t>(length))
                fail(at, "record " + std::to_string(i) + " of " + std::to_string(records)
                             + " is longer than what "
                               "is left before the points; the file is damaged, export it again");
            at += static_cast<std::size_t>(length);
        }
    }

    void read_count() {
        header_.points = count(StoredType::uint32, 107);
        std::size_t at = 107;
        if (header_.minor == 4 && long_count(247) > 0) header_.points = long_count(at = 247);
        if (header_.points == 0) throw Error(bytes_.name(), "holds no points: the header says 0");
        const std::size_t room = bytes_.size() - header_.points_at, found = room / header_.record;
        if (header_.points > found)
            throw Error(bytes_.name(), "the file ends after " + std::to_string(found) + " of "
                                           + std::to_string(header_.points) + " points (at byte "
                                           + std::to_string(bytes_.size())
                                           + "); it was cut off, or its header counts wrong");
        // From 1.3 on, waves and records of other kinds may follow.
        if (header_.minor < 3 && found > header_.points)
            fail(at, "room for " + std::to_string(found) + " points, but the header says "
                         + std::to_string(header_.points) + "; its count is wrong, correct it");
        if (header_.points >= no_index)
            throw Error(bytes_.name(), "holds more points than can be numbered; split the file");
    }

    void read_frame() {
        for (std::size_t k = 0; k < 3; ++k) {
            header_.scale[k] = number(StoredType::float64, 131 + 8 * k);
            header_.offset[k] = number(StoredType::float64, 155 + 8 * k);
            if (!std::isfinite(header_.scale[k]) || header_.scale[k] == 0)
                fail(131 + 8 * k, "a scale that is zero or no number; export the file again");
            if (!std::isfinite(header_.offset[k]))
                fail(155 + 8 * k, "an offset that is no number; export the file again");
        }
    }

    static constexpr std::size_t record_header = 54;

    const SourceBytes& bytes_;
    std::string_view head_;
    LasHeader header_;
};

/// The columns of a file's points, and where they lie.
struct LasColumns {
    std::vector<Column> columns;
    std::vector<BinaryColumn> values;

    void add(Role role, const std::string& name, const BinaryColumn& value) {
        columns.push_back({role, name});
        values.push_back(value);
    }
};

BinaryColumn column_at(const SourceBytes& bytes, const LasHeader& header, std::size_t at, StoredType type) {
    return {&bytes, header.points_at + at, header.record, type};
}

/// What is zero throughout was never set: no colour, no intensity, no classes.
LasColumns columns_of(const SourceBytes& bytes, const LasHeader& header) {
    const auto count = static_cast<std::size_t>(header.points);
    LasColumns all;
    for (std::size_t k = 0; k < 3; ++k) {
        BinaryColumn axis = column_at(bytes, header, 4 * k, StoredType::int32);
        axis.scale = header.scale[k];
        axis.offset = header.offset[k];
        all.add(static_cast<Role>(k), std::string(1, static_cast<char>('x' + k)), axis);
    }
    const std::size_t red = point_formats_of_las[header.format].red;
    if (red != no_field) {
        std::array<BinaryColumn, 3> colors;
        for (std::size_t k = 0; k < 3; ++k)
            colors[k] = column_at(bytes, header, red + 2 * k, StoredType::uint16);
        if (std::any_of(colors.begin(), colors.end(),
                        [count](const BinaryColumn& color) { return is_any_nonzero(color, count); }))
            for (std::size_t k = 0; k < 3; ++k)
                all.add(static_cast<Role>(static_cast<std::size_t>(Role::red) + k),
                        std::array{"red", "green", "blue"}[k], colors[k]);
    }
    const auto add_scalar = [&](const char* name, std::size_t at, StoredType type) {
        const BinaryColumn column = column_at(bytes, header, at, type);
        if (is_any_nonzero(column, count)) all.add(Role::scalar, name, column);
    };
    add_scalar("intensity", 12, StoredType::uint16);
    add_scalar("classification", header.is_wide() ? 16 : 15, StoredType::uint8);
    add_scalar("point_source_id", header.is_wide() ? source_id_of_wide : source_id_of_narrow,
               StoredType::uint16);
    return all;
}

/// The bytes that hold the flag of withheld points.
std::vector<std::uint8_t> read_flags(const SourceBytes& bytes, const LasHeader& header) {
    const auto count = static_cast<std::size_t>(header.points);
    std::vector<std::uint8_t> flags(count);
    for_chunks(count, chunks::quick, [&](std::size_t begin, std::size_t end, std::size_t) {
        std::vector<char> scratch((end - begin) * header.record);
        const char* at =
            bytes.piece(header.points_at + begin * header.record, scratch.size(), scratch.data());
        for (std::size_t i = begin; i != end; ++i)
            flags[i] = static_cast<std::uint8_t>(
                at[(i - begin) * header.record + (header.is_wide() ? flags_of_wide : flags_of_narrow)]);
    });
    return flags;
}

template <class T>
void keep(std::vector<T>& values, const std::vector<std::uint8_t>& kept) {
    if (values.empty()) return;
    std::size_t out = 0;
    for (std::size_t i = 0; i < kept.size(); ++i)
        if (kept[i]) values[out++] = values[i];
    values.resize(out);
}

/// Leaves out the points that are marked as deleted; takes the marks from the classes that share their bytes.
void apply_flags(const SourceBytes& bytes, const LasHeader& header, PointFile& file) {
    PointCloud& cloud = file.cloud;
    std::vector<std::uint8_t> flags = read_flags(bytes, header);
    const unsigned withheld = header.is_wide() ? withheld_of_wide : withheld_of_narrow;
    for (std::size_t i = 0; i < flags.size(); ++i) {
        const bool kept = (flags[i] & withheld) == 0;
        if (!kept && file.withheld++ == 0) file.first_withheld = cloud.positions[i];
        flags[i] = kept;
    }
    if (file.withheld == flags.size())
        throw Error(bytes.name(), "holds no points: all are marked as withheld");
    if (file.withheld > 0) {
        keep(cloud.positions, flags);
        keep(cloud.colors, flags);
        for (Scalar& scalar : cloud.scalars) keep(scalar.values, flags);
    }
    if (header.is_wide()) return;
    const auto classes = std::ranges::find(cloud.scalars, "classification", &Scalar::name);
    if (classes == cloud.scalars.end()) return;
    for (double& value : classes->values)
        value = static_cast<double>(static_cast<unsigned>(value) & class_mask_of_narrow);
    if (std::ranges::all_of(classes->values, [](double value) { return value == 0; }))
        cloud.scalars.erase(classes);
}

} // namespace

bool is_las(const SourceBytes& bytes) {
    return bytes.head().starts_with("LASF");
}

PointFile read_las(const SourceBytes& bytes) {
    if (!is_las(bytes))
        throw Error(bytes.name(), "a LAS file begins with \"LASF\"; this one does not, check it");
    const LasHeader header = LasHeaderReader(bytes).read();
    const LasColumns all = columns_of(bytes, header);
    PointFile file;
    file.format = "las";
    file.cloud = read_columns(all.values, all.columns, static_cast<std::size_t>(header.points));
    apply_flags(bytes, header, file);
    return file;
}

} // namespace hsdm::io

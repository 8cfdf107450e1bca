#include "hsdm/io/read_points.hh"

#include "hsdm/errors.hh"
#include "hsdm/io/columns.hh"
#include "hsdm/io/formats.hh"

#include <algorithm>
#include <array>
#include <cmath>

namespace hsdm {
namespace io {
namespace {

enum class Format { unknown, table, ply, pcd, ptx, las, npy, npz, off, obj, hoppe, stl, om };

struct KnownName {
    std::string_view name;
    Format format;
    TableKind kind = TableKind::plain;
};

/// Extensions, which are also the values of ReadOptions::format.
constexpr KnownName known_names[] = {
    {"ply", Format::ply},
    {"pcd", Format::pcd},
    {"xyz", Format::table},
    {"xyzn", Format::table},
    {"xyzrgb", Format::table, TableKind::xyzrgb},
    {"csv", Format::table},
    {"txt", Format::table},
    {"asc", Format::table},
    {"pts", Format::table, TableKind::pts},
    {"pwn", Format::table, TableKind::pwn},
    {"ptx", Format::ptx},
    {"las", Format::las},
    {"npy", Format::npy},
    {"npz", Format::npz},
    {"off", Format::off},
    {"obj", Format::obj},
    {"stl", Format::stl},
    {"om", Format::om},
    {"hoppe", Format::hoppe},
};

constexpr auto names_only = [] {
    std::array<std::string_view, std::size(known_names)> names;
    for (std::size_t i = 0; i < names.size(); ++i) names[i] = known_names[i].name;
    return names;
}();

struct Magic {
    std::string_view bytes, name;
};

/// Formats that are often met and not read here, by how they begin.
constexpr Magic unread[] = {
    {"ASTM-E57", "an E57 file"},
    {"\x1f\x8b", "a gzip file"},
    {"PK\x03\x04", "a ZIP file"},
    {"glTF", "a glTF file"},
    {"\xff\xfe", "text in UTF-16"},
    {"\xfe\xff", "text in UTF-16"},
    {"\x89PNG", "a PNG picture"},
    {"\xfd"
     "7zXZ",
     "an xz file"},
    {"BZh", "a bzip2 file"},
    {"%PDF", "a PDF file"},
};

std::string extension_of(const std::string& path) {
    const std::size_t dot = path.find_last_of("./");
    return dot == std::string::npos || path[dot] == '/' ? "" : lower(std::string_view(path).substr(dot + 1));
}

const KnownName* find_name(std::string_view name) {
    const auto* found = std::find_if(std::begin(known_names), std::end(known_names),
                                     [=](const KnownName& k) { return k.name == name; });
    return found == std::end(known_names) ? nullptr : found;
}

/// True if the start holds bytes that no text has.
bool is_binary(const Text& text) {
    const std::size_t size = std::min<std::size_t>(4096, static_cast<std::size_t>(text.end - text.begin));
    return std::any_of(text.begin, text.begin + size, [](char c) {
        return static_cast<unsigned char>(c) < ' ' && c != '\n' && !is_blank(c) && c != '\x1a';
    });
}

bool is_number(std::string_view line) {
    const auto cells = fields(line, 1);
    return !cells.empty() && to_number(cells[0]);
}

/// The format that the first lines are sure signs of.
Format recognise_lines(const Text& text) {
    const char* at = text.begin;
    Format points = Format::unknown; // what `p` lines mean is open until a `v` line is or is not seen
    for (int lines = 0; lines < 200 && at != text.end;) {
        const std::string_view line = trim(text.line(at));
        if (line.empty() || line.front() == '#') continue;
        if (lines++ == 0 && is_off_keyword(line)) return Format::off;
        if (line.size() > 2 && is_blank(line[1]) && is_number(line.substr(2))) {
            if (line[0] == 'v') return Format::obj;
            if (line[0] == 'p') points = Format::hoppe;
        }
    }
    return points;
}

/// The format that the content is a sure sign of; unknown if there is none.
Format recognise(const SourceBytes& bytes) {
    const Text text = Text::head_of(bytes);
    const std::string_view view = text.view();
    if (view.starts_with("ply") && view.size() > 3 && (is_blank(view[3]) || view[3] == '\n'))
        return Format::ply;
    if (is_las(bytes)) return Format::las;
    if (is_npy(bytes)) return Format::npy;
    if (is_npz(bytes)) return Format::npz;
    if (is_pcd(text)) return Format::pcd;
    if (is_om(bytes)) return Format::om;
    if (is_binary_stl(bytes) || is_text_stl(bytes)) return Format::stl;
    if (is_binary(text)) return Format::unknown;
    return is_ptx(text) ? Format::ptx : recognise_lines(text);
}

[[noreturn]] void fail_unread(const SourceBytes& bytes) {
    for (const Magic& magic : unread)
        if (bytes.head().starts_with(magic.bytes))
            throw Error(bytes.name(), "is " + std::string(magic.name)
                                          + ", which is not read; convert it to PLY or XYZ text");
    throw Error(bytes.name(),
                "neither text nor a binary format that is known; convert it to PLY or XYZ text");
}

/// A file whose content says nothing for sure: what its name promises must hold.
PointFile read_unrecognised(const SourceBytes& bytes, Format promised, TableKind kind,
                            const std::string& columns) {
    const Text text = Text::head_of(bytes);
    const bool binary =
        is_binary(text) || bytes.head().starts_with("\xff\xfe") || bytes.head().starts_with("\xfe\xff");
    if (promised == Format::stl && binary) return read_stl(bytes);
    if (binary) fail_unread(bytes);
    // OFF files may lack the keyword; nothing else that was promised may lack what it is recognised by, and
    // rows of numbers speak for themselves whatever the file is called.
    if (promised == Format::off) return read_off(bytes);
    if (promised != Format::table && promised != Format::unknown) {
        const char* at = text.begin;
        while (at != text.end) {
            const std::string_view line = trim(text.line(at));
            if (line.empty() || line.front() == '#') continue;
            if (is_number(line)) break;
            throw Error(bytes.name(), text.line_of(line.data()),
                        io::quoted(line)
                            + " is not how this format begins; check the file's name and content");
        }
    }
    for (const Magic& magic : unread)
        if (bytes.head().starts_with(magic.bytes)) fail_unread(bytes);
    return read_table(bytes, kind, columns);
}

PointFile read_as(const SourceBytes& bytes, Format format, TableKind kind, const std::string& columns) {
    switch (format) {
    case Format::ply:
        return read_ply(bytes);
    case Format::pcd:
        return read_pcd(bytes);
    case Format::ptx:
        return read_ptx(bytes);
    case Format::las:
        return read_las(bytes);
    case Format::npy:
        return read_npy(bytes, columns);
    case Format::npz:
        return read_npz(bytes, columns);
    case Format::off:
        return read_off(bytes);
    case Format::obj:
        return read_obj(bytes);
    case Format::hoppe:
        return read_hoppe(bytes);
    case Format::stl:
        return read_stl(bytes);
    case Format::om:
        return read_om(bytes);
    default:
        return read_table(bytes, kind, columns);
    }
}

bool takes_columns(Format format) {
    return format == Format::table || format == Format::unknown || format == Format::npy
           || format == Format::npz;
}

PointFile read_cloud(const SourceBytes& bytes, const ReadOptions& options) {
    if (bytes.size() == 0) throw Error(bytes.name(), "is empty; expected points");
    check_options(options);
    const KnownName* forced = find_name(lower(options.format));
    const KnownName* named = forced ? forced : find_name(extension_of(bytes.name()));
    const TableKind kind = named ? named->kind : TableKind::plain;
    const Format format = forced ? forced->format : recognise(bytes);
    if (!options.columns.empty() && !takes_columns(format))
        throw OptionError("columns: " + bytes.name() + " is no table of numbers; leave the option out");
    if (forced && !(format == Format::table && is_binary(Text::head_of(bytes))))
        return read_as(bytes, format, kind, options.columns);
    if (format != Format::unknown && format != Format::table)
        return read_as(bytes, format, kind, options.columns);
    return read_unrecognised(bytes, named ? named->format : Format::unknown, kind, options.columns);
}

} // namespace

void set_sensors(const SourceBytes& bytes, const ReadOptions& options, PointCloud& cloud) {
    if (options.sensors.empty()) return;
    cloud.sensor.reset();
    cloud.sensors = options.sensors;
    cloud.sensor_of = std::vector<std::int32_t>();
    if (options.sensor_column.empty()) return;
    const auto column = std::ranges::find(cloud.scalars, options.sensor_column, &Scalar::name);
    if (column == cloud.scalars.end())
        throw Error(bytes.name(), "has no column " + io::quoted(options.sensor_column)
                                      + " that says which scanner saw a point; name one that it has");
    cloud.sensor_of.reserve(cloud.size());
    for (const double number : column->values) {
        const bool is_one = number >= 0 && number < static_cast<double>(options.sensors.size())
                            && number == std::floor(number);
        cloud.sensor_of.push_back(is_one ? static_cast<std::int32_t>(number) : -1);
    }
    column->is_label = true; // a vertex takes the scanner of most points
}

std::string_view mesh_format_of(const SourceBytes& bytes) {
    Format format = recognise(bytes);
    const KnownName* named = find_name(extension_of(bytes.name()));
    if (format == Format::unknown && named) {
        const bool binary = is_binary(Text::head_of(bytes));
        if (named->format == (binary ? Format::stl : Format::off)) format = named->format;
    }
    for (const Format known : {Format::ply, Format::off, Format::obj, Format::stl, Format::om})
        if (format == known)
            return std::find_if(std::begin(known_names), std::end(known_names),
                                [=](const KnownName& k) { return k.format == known; })
                ->name;
    return {};
}

PointFile read_points(const SourceBytes& bytes, const ReadOptions& options) {
    PointFile file = read_cloud(bytes, options);
    set_sensors(bytes, options, file.cloud);
    return file;
}

} // namespace io

void check_options(const ReadOptions& options) {
    if (!options.format.empty() && !io::find_name(io::lower(options.format))) {
        std::string names;
        for (const std::string_view name : io::names_only)
            names += (names.empty() ? "" : ", ") + std::string(name);
        throw OptionError("format " + io::quoted(options.format) + ": known are " + names);
    }
    if (!options.columns.empty()) io::parse_columns(options.columns);
    if (options.sensors.size() > 1 && options.sensor_column.empty())
        throw OptionError("sensors: of several, sensor_column must say which of them saw a point");
    if (!options.sensor_column.empty() && options.sensors.empty())
        throw OptionError("sensor_column " + io::quoted(options.sensor_column) + ": goes with sensors");
    for (const Vec3& sensor : options.sensors)
        if (!is_finite(sensor)) throw OptionError("sensors: their coordinates must be finite");
}

std::span<const std::string_view> point_formats() {
    return io::names_only;
}

PointFile read_points(const std::string& path, const ReadOptions& options) {
    return io::read_points(io::SourceBytes::open(path), options);
}

} // namespace hsdm

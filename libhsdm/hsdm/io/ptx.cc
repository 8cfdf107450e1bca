// PTX, the text form of a terrestrial scanner's grid: per scan ten lines of header, then a line per ray.

#include "hsdm/errors.hh"
#include "hsdm/io/formats.hh"
#include "hsdm/io/rows.hh"

#include <algorithm>
#include <array>

namespace hsdm::io {
namespace {

/// Numbers in each line of the header: columns, rows, where the scanner stood and its axes, the matrix.
constexpr std::array<std::size_t, 10> header_widths{1, 1, 3, 3, 3, 3, 4, 4, 4, 4};

struct ScanHeader {
    std::uint64_t rays = 0;
    std::array<Vec3, 4> matrix; ///< rows of the matrix that takes (x, y, z, 1) from the scanner to the world

    Vec3 to_world(const Vec3& p) const {
        return matrix[0] * p[0] + matrix[1] * p[1] + matrix[2] * p[2] + matrix[3];
    }
};

/// The next line that is not empty; empty at the end.
std::string_view next_line(const Text& text, const char*& at) {
    while (at != text.end)
        if (const std::string_view line = trim(text.line(at)); !line.empty()) return line;
    return {};
}

/// The numbers of a header line; empty if it does not hold that many.
std::vector<double> numbers_in(std::string_view line, std::size_t width) {
    std::vector<double> numbers;
    for (std::string_view field : fields(line, width + 1))
        if (const auto number = to_number(field))
            numbers.push_back(*number);
        else
            return {};
    return numbers.size() == width ? numbers : std::vector<double>{};
}

ScanHeader read_header(const Text& text, const char*& at) {
    ScanHeader header;
    header.rays = 1;
    for (std::size_t i = 0; i < header_widths.size(); ++i) {
        const char* const line_begin = at;
        const std::string_view line = next_line(text, at);
        const auto numbers = numbers_in(line, header_widths[i]);
        if (numbers.empty())
            text.fail(line.empty() ? line_begin : line.data(),
                      "line " + std::to_string(i + 1) + " of a scan's header must hold "
                          + std::to_string(header_widths[i])
                          + " numbers; correct the header, or name the format if this is no PTX file");
        if (i < 2) {
            const auto count = to_count(trim(line));
            if (!count || *count > no_index)
                text.fail(line.data(),
                          io::quoted(line) + " is no count of columns or rows; correct the header");
            header.rays *= *count;
        }
        if (i >= 6) header.matrix[i - 6] = Vec3(numbers[0], numbers[1], numbers[2]);
    }
    return header;
}

/// Whether another line follows.
bool has_line(const Text& text, const char* at) {
    return !next_line(text, at).empty();
}

/// The lines of one scan's rays; moves `at` behind them.
Text take_rays(const Text& text, std::uint64_t rays, const char*& at) {
    Text body = text.from(at);
    for (std::uint64_t ray = 0; ray < rays; ++ray)
        if (next_line(text, at).empty())
            text.fail(text.end, "the file ends after " + std::to_string(ray) + " of " + std::to_string(rays)
                                    + " rays of a scan; it was cut off, or its header counts wrong");
    body.end = at;
    return body;
}

/// Column names of x y z intensity [r g b].
std::vector<Column> columns_of(const Text& text, const char* at, std::size_t width) {
    if (width != 3 && width != 4 && width != 6 && width != 7)
        text.fail(at, std::to_string(width) + (width == 8 ? " or more" : "")
                          + " columns; x y z intensity, or x y z intensity r g b, are wanted");
    std::vector<Column> columns{{Role::x, "x"}, {Role::y, "y"}, {Role::z, "z"}};
    if (width == 4 || width == 7) columns.push_back({Role::scalar, "intensity"});
    if (width > 4) columns.insert(columns.end(), {{Role::red, "r"}, {Role::green, "g"}, {Role::blue, "b"}});
    return columns;
}

template <class T>
void append(std::vector<T>& values, const std::vector<T>& more, const std::vector<std::uint8_t>& hit) {
    for (std::size_t i = 0; i < more.size(); ++i)
        if (hit[i]) values.push_back(more[i]);
}

/// Adds the rays of one scan that hit something, in world coordinates. A ray that did not is 0 0 0.
void append_scan(const Text& text, const ScanHeader& header, PointCloud& scan, PointCloud& cloud) {
    std::vector<std::uint8_t> hit(scan.size());
    for (std::size_t i = 0; i < scan.size(); ++i) {
        hit[i] = scan.positions[i] != Vec3(0, 0, 0);
        scan.positions[i] = header.to_world(scan.positions[i]);
    }
    if (const auto hits = static_cast<std::size_t>(std::count(hit.begin(), hit.end(), 1));
        hits > no_index - cloud.size())
        throw Error(text.file(), "holds more points than can be numbered; split the file");
    append(cloud.positions, scan.positions, hit);
    append(cloud.colors, scan.colors, hit);
    if (cloud.scalars.empty())
        for (const Scalar& scalar : scan.scalars) cloud.scalars.push_back({scalar.name, {}, false});
    for (std::size_t s = 0; s < scan.scalars.size(); ++s)
        append(cloud.scalars[s].values, scan.scalars[s].values, hit);
}

} // namespace

bool is_ptx(const Text& text) {
    const char* at = text.begin;
    return std::all_of(header_widths.begin(), header_widths.end(),
                       [&](std::size_t width) { return !numbers_in(next_line(text, at), width).empty(); });
}

std::optional<Vec3> ptx_scanner(const SourceBytes& bytes) {
    const Text text = Text::head_of(bytes);
    if (!is_ptx(text)) return std::nullopt;
    const char* at = text.begin;
    return read_header(text, at).matrix[3];
}

PointFile read_ptx(const SourceBytes& bytes) {
    const Text text(bytes);
    PointFile file;
    file.format = "ptx";
    std::size_t scans = 0, width = 0; // scans that hit something
    for (const char* at = text.begin; has_line(text, at);) {
        const ScanHeader header = read_header(text, at);
        const Text body = take_rays(text, header.rays, at);
        if (header.rays == 0) continue;
        const char* first = body.begin;
        const std::string_view first_row = next_line(body, first);
        if (width == 0) width = fields(first_row, 8).size();
        const auto columns = columns_of(text, first_row.data(), width);
        RowLayout layout;
        layout.cells.assign(width, RowLayout::Cell::number);
        layout.origin = "the first ray has " + std::to_string(width);
        layout.advice = "correct the line, or the counts in the scan's header";
        Rows rows(body, layout);
        const double factor = rows.color_factor(columns, false);
        PointCloud scan = std::move(rows).to_cloud(columns, factor);
        const std::size_t before = file.cloud.size();
        append_scan(text, header, scan, file.cloud);
        file.nonfinite += scan.size() - (file.cloud.size() - before);
        if (file.cloud.size() == before) continue;
        const auto scan_number = static_cast<std::int32_t>(scans++);
        file.cloud.sensor = header.matrix[3]; // the scanner is the origin of its own coordinates
        file.cloud.sensors.push_back(*file.cloud.sensor);
        file.cloud.sensor_of.resize(file.cloud.size(), scan_number);
    }
    const std::vector<Vec3>& sensors = file.cloud.sensors;
    if (scans > 1) file.cloud.sensor.reset();
    // One is known by `sensor`; several at one place are no scanners but points that were moved already.
    if (std::ranges::all_of(sensors, [&](const Vec3& sensor) { return sensor == sensors[0]; })) {
        file.cloud.sensors.clear();
        file.cloud.sensor_of = std::vector<std::int32_t>();
    }
    if (file.cloud.size() == 0)
        throw Error(bytes.name(), "holds no points: no ray of its scans hit anything");
    return file;
}

} // namespace hsdm::io

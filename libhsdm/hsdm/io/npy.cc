#include "hsdm/io/npy.hh"

#include "hsdm/errors.hh"
#include "hsdm/io/formats.hh"

#include <algorithm>

namespace hsdm::io {
namespace {

constexpr std::size_t sampled_points = 4096; // as of tables

constexpr std::string_view position_names[] = {"points", "point",       "positions", "position",
                                               "pos",    "xyz",         "pcd",       "coords",
                                               "coord",  "coordinates", "cloud",     "vertices"};
constexpr std::string_view normal_names[] = {"normals", "normal", "n", "nxyz"};
constexpr std::string_view color_names[] = {"colors", "color", "colours", "colour", "rgb", "rgba"};

/// What the numbers of a field are called: of three by what they are, else numbered.
std::vector<std::string> component_names(const std::string& name, std::size_t count) {
    if (count == 1) return {name};
    const VectorName kind = vector_name(name);
    if (kind == VectorName::position && count == 3) return {"x", "y", "z"};
    if (kind == VectorName::normal && count == 3) return {"nx", "ny", "nz"};
    if (kind == VectorName::color && count == 3) return {"red", "green", "blue"};
    if (kind == VectorName::color && count == 4) return {"red", "green", "blue", "alpha"};
    std::vector<std::string> names;
    for (std::size_t i = 0; i < count; ++i) names.push_back(name + '_' + std::to_string(i));
    return names;
}

ArrayColumns columns_by_fields(const NpyArray& array, const SourceBytes& bytes) {
    std::vector<std::string> names;
    std::vector<BinaryColumn> values;
    for (const NpyField& field : array.fields) {
        const auto own = component_names(field.name, field.count);
        if (names.size() + own.size() > most_columns)
            throw Error(bytes.name(),
                        "has more than " + std::to_string(most_columns) + " numbers a point; leave some out");
        for (std::size_t i = 0; i < own.size(); ++i) {
            names.push_back(own[i]);
            values.push_back({&bytes, array.data_at + field.offset + i * size_of(field.type), array.element,
                              field.type, field.big_endian});
        }
    }
    auto columns = columns_from_names(names);
    if (!columns) {
        std::string present;
        for (const std::string& name : names) present += (present.empty() ? "" : ", ") + name;
        throw Error(bytes.name(),
                    "the array has no fields x, y and z, only " + io::quoted(present) + "; name them so");
    }
    return {std::move(*columns), std::move(values)};
}

/// Throws for arrays that are no rows of at least three numbers.
void check_plain(const NpyArray& array, const SourceBytes& bytes) {
    const std::size_t width = array.width(), rows = array.rows();
    const std::string is = "is an array of shape " + array.shape_words();
    if (array.shape.size() < 2) throw Error(bytes.name(), is + "; points are rows of three or more numbers");
    if (width > most_columns || (width > 32 && rows < width))
        throw Error(bytes.name(), is + "; points are rows, save its transpose (array.T)");
    if (width < 3) throw Error(bytes.name(), is + "; points have three numbers or more");
    if (array.fortran && array.shape.size() > 2)
        throw Error(bytes.name(), is + " in Fortran's order; save it with np.ascontiguousarray");
}

std::vector<Column> listed_columns(const NpyArray& array, const SourceBytes& bytes, const std::string& list) {
    std::vector<Column> columns = parse_columns(list);
    if (columns.size() > array.width())
        throw Error(bytes.name(), "has " + std::to_string(array.width()) + " columns, but "
                                      + std::to_string(columns.size()) + " are named; name those there are");
    columns.resize(array.width());
    return columns;
}

} // namespace

void ArrayColumns::add(Column column, const BinaryColumn& value) {
    columns.push_back(std::move(column));
    values.push_back(value);
}

bool ArrayColumns::has(Role role) const {
    return std::any_of(columns.begin(), columns.end(), [role](const Column& c) { return c.role == role; });
}

VectorName vector_name(std::string_view name) {
    const std::string plain = lower(name);
    if (std::ranges::find(position_names, plain) != std::end(position_names)) return VectorName::position;
    if (std::ranges::find(normal_names, plain) != std::end(normal_names)) return VectorName::normal;
    if (std::ranges::find(color_names, plain) != std::end(color_names)) return VectorName::color;
    return VectorName::none;
}

BinaryColumn plain_column(const NpyArray& array, const SourceBytes& bytes, std::size_t c) {
    const NpyField& number = array.fields.front();
    const std::size_t across = array.fortran ? array.rows() : 1, along = array.fortran ? 1 : array.width();
    return {&bytes, array.data_at + c * across * array.element, along * array.element, number.type,
            number.big_endian};
}

ArrayColumns columns_of_points(const NpyArray& array, const SourceBytes& bytes, const std::string& list,
                               bool& told) {
    told = false;
    if (array.rows() == 0) throw Error(bytes.name(), "holds no points: its shape is " + array.shape_words());
    if (array.rows() >= no_index)
        throw Error(bytes.name(), "holds more points than can be numbered; split the file");
    if (array.structured && !list.empty())
        throw OptionError("columns: " + bytes.name() + " names its columns itself; leave the option out");
    if (array.structured) return columns_by_fields(array, bytes);
    check_plain(array, bytes);
    if (array.fields.empty()) throw Error(bytes.name(), "is an array of texts; save numbers");
    ArrayColumns all;
    for (std::size_t c = 0; c < array.width(); ++c) all.values.push_back(plain_column(array, bytes, c));
    told = list.empty() && array.width() > 3;
    all.columns = list.empty() ? columns_from_values(sample_rows(all.values, array.rows(), sampled_points),
                                                     array.width(), false)
                               : listed_columns(array, bytes, list);
    return all;
}

PointFile read_npy(const SourceBytes& bytes, const std::string& columns) {
    const NpyArray array = read_npy_header(bytes, bytes.size());
    bool told = false;
    const ArrayColumns all = columns_of_points(array, bytes, columns, told);
    PointFile file;
    file.format = "npy";
    if (told) file.columns = list_of(all.columns);
    file.cloud = read_columns(all.values, all.columns, array.rows());
    return file;
}

} // namespace hsdm::io

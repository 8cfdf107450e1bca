#pragma once
// NumPy's arrays in files, and what their columns are to a cloud.

#include "hsdm/io/binary_columns.hh"

#include <string>
#include <vector>

namespace hsdm::io {

/// Numbers of an array's elements: one of a plain array, as many as it has fields of a structured one.
struct NpyField {
    std::string name;       ///< empty in a plain array
    std::size_t offset = 0; ///< in an element
    StoredType type = StoredType::float64;
    bool big_endian = false;
    std::size_t count = 1; ///< of a field that is an array itself, all its dimensions together
};

/// An array as its header describes it.
struct NpyArray {
    std::vector<NpyField> fields; ///< those that are numbers
    std::size_t element = 0;      ///< bytes of an element
    bool structured = false;
    bool fortran = false; ///< columns one after the other
    std::vector<std::size_t> shape;
    std::size_t data_at = 0; ///< bytes of the header

    std::size_t elements() const;
    /// Points: rows of a plain array, elements of a structured one or of one dimension.
    std::size_t rows() const;
    /// Numbers of a row of a plain array; 1 of one dimension.
    std::size_t width() const;
    /// As NumPy prints it.
    std::string shape_words() const;
};

/// Parses the header. `total` is how many bytes the whole array has, of which `bytes` may hold the head only.
/// Throws Error for headers that do not fit it, and for elements that are no numbers.
NpyArray read_npy_header(const SourceBytes& bytes, std::size_t total);

/// Columns of a cloud, and where their numbers lie.
struct ArrayColumns {
    std::vector<Column> columns;
    std::vector<BinaryColumn> values;

    void add(Column column, const BinaryColumn& value);
    /// Whether a column has this role.
    bool has(Role role) const;
};

/// What an array is called decides what three numbers of it are.
enum class VectorName { none, position, normal, color };
VectorName vector_name(std::string_view name);

/// The columns of an array of points. Of a structured one by the fields' names, of a plain one by `list`
/// (ReadOptions::columns) or from the values. `told`: they were told from the values alone. Throws Error if
/// they have no positions.
ArrayColumns columns_of_points(const NpyArray& array, const SourceBytes& bytes, const std::string& list,
                               bool& told);

/// Column `c` of a plain array.
BinaryColumn plain_column(const NpyArray& array, const SourceBytes& bytes, std::size_t c);

} // namespace hsdm::io

#pragma once
// What the columns of a table (or the properties of a vertex) mean, and where their values go.

#include "hsdm/point_cloud.hh"

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hsdm::io {

/// A row of more values than these is refused: a column costs some hundred bytes, whatever few of the file it
/// takes, and nothing that is a point has so many.
inline constexpr std::size_t most_columns = 4096;

enum class Role : std::uint8_t { x, y, z, nx, ny, nz, red, green, blue, alpha, scalar, skip };

struct Column {
    Role role = Role::skip;
    std::string name; ///< as the file spells it; scalars keep it
};

/// Whether the column is red, green or blue.
inline bool is_color(const Column& column) {
    return column.role >= Role::red && column.role <= Role::blue;
}

/// The role of a column called so (`normal_x`, `diffuse_red`, ...), letter case aside; scalar if the name is
/// none of the known ones, skip for `_` and the empty name.
Role role_of(std::string_view name);
/// Whether a scalar called so is a label, if its values are integers.
bool is_label_name(std::string_view name);

/// ReadOptions::columns, e.g. "x,y,z,nx,ny,nz,_". Throws OptionError naming what is unknown, double or
/// missing.
std::vector<Column> parse_columns(const std::string& list);

/// The list that parse_columns would take for these; a scalar by its name.
std::string list_of(std::span<const Column> columns);

/// The roles that names give: normals only if all three are there, colours likewise, a repeated name once;
/// the others become scalars. Returns nothing if x, y or z is missing.
std::optional<std::vector<Column>> columns_from_names(std::span<const std::string> names);

/// The roles that values suggest, over sample rows of `count` columns each (count >= 3): x y z, then unit
/// vectors are normals, integers in 0..255 colours, the rest scalars. `scan` says that four columns of
/// integers are an intensity and a colour, as in PTS files, even if the last is always 255.
std::vector<Column> columns_from_values(std::span<const double> rows, std::size_t count, bool scan);

/// What colour values must be multiplied by to lie in 0..255. `fractions` says that 1 is full intensity
/// (values of floating type, or some value that is no integer); else 255 is, or 65535 if any is above 255.
double color_factor(double max_value, bool fractions);

/// Fills the arrays of a cloud column by column, any block in any order and from any thread.
class CloudColumns {
public:
    CloudColumns(std::vector<Column> columns, std::size_t points, double color_factor);

    const std::vector<Column>& columns() const { return columns_; }
    /// Values of points first .. first + count of one column, `stride` apart.
    void store(std::size_t column, std::size_t first, std::size_t count, const double* values,
               std::size_t stride);
    /// The cloud; integer scalars with a label's name are marked as labels.
    PointCloud finish();

private:
    std::vector<Column> columns_;
    std::vector<std::size_t> scalar_; ///< per column, its index among the cloud's scalars
    PointCloud cloud_;
    double color_factor_;
};

} // namespace hsdm::io

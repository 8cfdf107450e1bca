#pragma once
// Colours and scalars of points and vertices as rows of bytes, one a point, that go where the points go.

#include "hsdm/cloud/point_attributes.hh"
#include "hsdm/core/ranks.hh"
#include "hsdm/octree/octree.hh"

namespace hsdm {

/// What every point of a cloud has beside its place and normal, by the parts that it comes in.
struct CloudAttributes {
    struct Named {
        std::string name;
        bool is_label;
    };
    bool colors = false;
    bool scanners = false;               ///< numbers of scanners, which are told once all parts are known
    std::vector<Named> scalars{};        ///< of several of one name the first
    std::vector<std::string> left_out{}; ///< names of what only some parts have, as in PointFile::partial

    static CloudAttributes of(const PointView& part);
    /// Adds those of more points, as JoinedPoints does; `has_some`: of others, that came before.
    void join(const CloudAttributes& next, bool has_some);
    void put(Ranks::Bytes& bytes) const;
    static CloudAttributes from(ByteReader& bytes);

private:
    void leave_out(const std::string& name);
};

/// How they lie in a row: those of attributes_of(), one after the other, channels as bytes and all else as
/// doubles; then of points the number of their scanner, if there are several; then, of a cloud with points
/// that were added, the PointKind, of a vertex that of the point nearest to being measured.
class AttributeRows {
public:
    struct Column {
        std::string name;
        VertexProperty::Type type;
        std::size_t at; ///< byte of the row
    };

    AttributeRows() = default; ///< of a cloud that has none
    explicit AttributeRows(const CloudAttributes& attributes);

    AttributeRows of_vertices() const; ///< without scanners
    AttributeRows with_kinds() const;

    std::size_t bytes() const { return bytes_; } ///< of a row; 0: there are none
    bool has_scanners() const { return has_scanners_; }
    std::int32_t scanner(const char* row) const;
    void set_scanner(char* row, std::int32_t number) const;
    bool has_kinds() const { return has_kinds_; }
    PointKind kind(const char* row) const { return static_cast<PointKind>(row[bytes_ - 1]); }
    void set_kind(char* row, PointKind kind) const { row[bytes_ - 1] = static_cast<char>(kind); }
    const std::vector<Column>& columns() const { return columns_; }
    double value(const char* row, std::size_t column) const;

    /// A part's attributes, one a column. It must outlive them. Throws Error if it lacks one.
    std::vector<PointAttribute> in(const PointView& part) const;
    /// Writes the row of a point of that part, but for its scanner.
    void write(const std::vector<PointAttribute>& of_part, Index point, char* row) const;
    /// Writes what several equal points are together, in whatever order they come; their scanner and kind are
    /// those of the first.
    void write_mean(std::span<const char* const> rows, char* row) const;

    /// Rows as a cloud without places.
    PointView view(const std::vector<char>& rows) const;
    /// Rows of vertices that have these properties, the columns first.
    std::vector<char> rows_of(std::span<const VertexProperty> properties, std::size_t vertices) const;
    /// And back.
    std::vector<VertexProperty> properties_of(const std::vector<char>& rows) const;
    /// Per row a 1 if it is of a completed one.
    std::vector<double> are_completed(const std::vector<char>& rows) const;

private:
    void set(char* row, std::size_t column, double value) const;
    std::size_t scanner_at() const { return bytes_ - (has_kinds_ ? 1 : 0) - sizeof(std::int32_t); }

    std::vector<Column> columns_;
    std::size_t bytes_ = 0;
    bool has_scanners_ = false, has_kinds_ = false;
};

} // namespace hsdm

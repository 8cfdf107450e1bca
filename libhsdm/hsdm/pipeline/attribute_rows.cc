#include "hsdm/pipeline/attribute_rows.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/errors.hh"

#include <algorithm>
#include <cstring>
#include <utility>

namespace hsdm {
namespace {

using Type = VertexProperty::Type;

std::size_t bytes_of(Type type) {
    return type == Type::uint8 ? sizeof(std::uint8_t) : sizeof(double);
}

bool is_channel(const std::string& name) {
    return std::ranges::find(color_properties, name) != color_properties.end();
}

/// Rows of one number behind `at` bytes of each row, if there are some.
StridedSpan numbers_at(const std::vector<char>& rows, std::size_t at, std::size_t stride, NumberType type) {
    StridedSpan numbers;
    if (rows.empty()) return numbers;
    numbers.data = rows.data() + at;
    numbers.count = rows.size() / stride, numbers.stride = stride;
    numbers.type = type;
    return numbers;
}

} // namespace

CloudAttributes CloudAttributes::of(const PointView& part) {
    CloudAttributes attributes;
    attributes.colors = part.colors.count > 0;
    for (const ScalarView& scalar : part.scalars)
        if (std::ranges::find(attributes.scalars, scalar.name, &Named::name) == attributes.scalars.end())
            attributes.scalars.push_back({scalar.name, scalar.is_label});
    return attributes;
}

void CloudAttributes::leave_out(const std::string& name) {
    if (std::ranges::find(left_out, name) == left_out.end()) left_out.push_back(name);
}

void CloudAttributes::join(const CloudAttributes& next, bool has_some) {
    if (!has_some) {
        *this = next;
        return;
    }
    for (const std::string& name : next.left_out) leave_out(name);
    if (colors != next.colors) leave_out("colours");
    colors = colors && next.colors;
    const auto named = [](const std::vector<Named>& all, const std::string& name) {
        return std::ranges::find(all, name, &Named::name);
    };
    std::erase_if(scalars, [&](Named& scalar) {
        const auto same = named(next.scalars, scalar.name);
        if (same == next.scalars.end())
            leave_out(scalar.name);
        else
            scalar.is_label = scalar.is_label && same->is_label;
        return same == next.scalars.end();
    });
    for (const Named& scalar : next.scalars)
        if (named(scalars, scalar.name) == scalars.end()) leave_out(scalar.name);
}

void CloudAttributes::put(Ranks::Bytes& bytes) const {
    hsdm::put(colors, bytes), hsdm::put(scanners, bytes);
    hsdm::put(std::uint64_t{scalars.size()}, bytes);
    for (const Named& scalar : scalars) put_text(scalar.name, bytes), hsdm::put(scalar.is_label, bytes);
    hsdm::put(std::uint64_t{left_out.size()}, bytes);
    for (const std::string& name : left_out) put_text(name, bytes);
}

CloudAttributes CloudAttributes::from(ByteReader& bytes) {
    CloudAttributes attributes;
    attributes.colors = bytes.take<bool>(), attributes.scanners = bytes.take<bool>();
    for (auto count = bytes.take<std::uint64_t>(); count > 0; --count) {
        std::string name = bytes.take_text();
        attributes.scalars.push_back({std::move(name), bytes.take<bool>()});
    }
    for (auto count = bytes.take<std::uint64_t>(); count > 0; --count)
        attributes.left_out.push_back(bytes.take_text());
    return attributes;
}

AttributeRows::AttributeRows(const CloudAttributes& attributes) {
    const auto add = [&](const std::string& name, Type type) {
        columns_.push_back({name, type, bytes_});
        bytes_ += bytes_of(type);
    };
    if (attributes.colors)
        for (const char* name : color_properties) add(name, Type::uint8);
    for (const auto& [name, is_label] : attributes.scalars) // as attributes_of() has it
        if (!name.starts_with("hsdm_") && !(attributes.colors && is_channel(name)))
            add(name, is_label ? Type::int32 : Type::float64);
    has_scanners_ = attributes.scanners;
    if (has_scanners_) bytes_ += sizeof(std::int32_t);
}

AttributeRows AttributeRows::of_vertices() const {
    AttributeRows rows = *this;
    if (std::exchange(rows.has_scanners_, false)) rows.bytes_ -= sizeof(std::int32_t);
    return rows;
}

AttributeRows AttributeRows::with_kinds() const {
    AttributeRows rows = *this;
    if (!std::exchange(rows.has_kinds_, true)) ++rows.bytes_;
    return rows;
}

std::int32_t AttributeRows::scanner(const char* row) const {
    std::int32_t number;
    std::memcpy(&number, row + scanner_at(), sizeof number);
    return number;
}

void AttributeRows::set_scanner(char* row, std::int32_t number) const {
    std::memcpy(row + scanner_at(), &number, sizeof number);
}

double AttributeRows::value(const char* row, std::size_t column) const {
    const Column& of = columns_[column];
    if (of.type == Type::uint8) return static_cast<std::uint8_t>(row[of.at]);
    double value;
    std::memcpy(&value, row + of.at, sizeof value);
    return value;
}

void AttributeRows::set(char* row, std::size_t column, double value) const {
    const Column& of = columns_[column];
    if (of.type == Type::uint8)
        row[of.at] = static_cast<char>(static_cast<std::uint8_t>(value));
    else
        std::memcpy(row + of.at, &value, sizeof value);
}

std::vector<PointAttribute> AttributeRows::in(const PointView& part) const {
    const auto channels = static_cast<std::size_t>(part.color_channels);
    std::vector<PointAttribute> attributes;
    for (const Column& column : columns_) {
        const std::size_t place = attributes.size();
        const bool is_channel = column.type == Type::uint8;
        const auto scalar = std::ranges::find(part.scalars, column.name, &ScalarView::name);
        if (is_channel ? part.colors.count == 0 : scalar == part.scalars.end())
            throw Error("the points have changed while they were read: there is no " + column.name
                        + " any more; read them again");
        attributes.push_back({column.name, column.type, is_channel ? part.colors : scalar->values, place,
                              is_channel && place >= channels});
    }
    return attributes;
}

void AttributeRows::write(const std::vector<PointAttribute>& of_part, Index point, char* row) const {
    for (std::size_t k = 0; k < columns_.size(); ++k) set(row, k, of_part[k](point));
}

void AttributeRows::write_mean(std::span<const char* const> rows, char* row) const {
    std::vector<WeightedValue> values;
    for (std::size_t k = 0; k < columns_.size(); ++k) {
        values.clear();
        for (const char* one : rows) values.push_back({value(one, k), 1});
        set(row, k, average_of_equal(columns_[k].type, values));
    }
    if (has_scanners_) set_scanner(row, scanner(rows.front()));
    if (has_kinds_) set_kind(row, kind(rows.front()));
}

PointView AttributeRows::view(const std::vector<char>& rows) const {
    PointView view;
    for (const Column& column : columns_)
        if (column.type != Type::uint8)
            view.scalars.push_back({column.name, numbers_at(rows, column.at, bytes_, NumberType::float64),
                                    column.type == Type::int32});
        else if (column.at == 0)
            view.colors = numbers_at(rows, 0, bytes_, NumberType::uint8);
    return view;
}

std::vector<char> AttributeRows::rows_of(std::span<const VertexProperty> properties,
                                         std::size_t vertices) const {
    std::vector<char> rows = large_vector<char>(vertices * bytes_);
    for_each_index(bytes_ > 0 ? vertices : 0, chunks::light, [&](Index v) {
        for (std::size_t k = 0; k < columns_.size(); ++k)
            set(rows.data() + v * bytes_, k, properties[k].values[v]);
    });
    return rows;
}

std::vector<VertexProperty> AttributeRows::properties_of(const std::vector<char>& rows) const {
    std::vector<VertexProperty> properties;
    for (std::size_t k = 0; k < columns_.size(); ++k) {
        VertexProperty& property = properties.emplace_back();
        property.name = columns_[k].name, property.type = columns_[k].type;
        property.values.resize(rows.size() / bytes_);
        for_each_index(property.values.size(), chunks::light,
                       [&](Index v) { property.values[v] = value(rows.data() + v * bytes_, k); });
    }
    return properties;
}

std::vector<double> AttributeRows::are_completed(const std::vector<char>& rows) const {
    std::vector<double> are(rows.size() / bytes_);
    for_each_index(are.size(), chunks::light,
                   [&](Index v) { are[v] = kind(rows.data() + v * bytes_) == PointKind::completed; });
    return are;
}

} // namespace hsdm

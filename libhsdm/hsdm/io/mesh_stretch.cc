#include "hsdm/io/mesh_stretch.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/io/mesh_document.hh"

#include <algorithm>

namespace hsdm {
namespace {

void put_values(const VertexProperty& property, Ranks::Bytes& bytes) {
    put(property.type, bytes);
    with_type(property.type, 0, [&]<class Number>(Number) {
        std::vector<Number> values(property.values.size());
        std::ranges::transform(property.values, values.begin(),
                               [](double value) { return static_cast<Number>(value); });
        put_vector(values, bytes);
    });
}

VertexProperty taken_values(ByteReader& reader) {
    VertexProperty property;
    property.type = reader.take<VertexProperty::Type>();
    with_type(property.type, 0, [&]<class Number>(Number) {
        const auto values = reader.take_vector<Number>();
        property.values.assign(values.begin(), values.end());
    });
    return property;
}

} // namespace

PolygonMesh stretch_of_vertices(const PolygonMesh& mesh, const VertexRows& rows, const Vec3& shift,
                                std::size_t begin, std::size_t end) {
    PolygonMesh stretch;
    const std::size_t count = end - begin, columns = rows.columns.size();
    stretch.positions.resize(count);
    if (rows.normals) stretch.normals.resize(count);
    for (const auto& [name, type] : rows.columns)
        stretch.properties.push_back({name, type, std::vector<double>(count)});
    constexpr std::size_t chunk = 1024;
    for_each_task(chunk_count(count, chunk), [&](std::size_t i) {
        const std::size_t first = i * chunk, last = std::min(count, first + chunk);
        std::vector<Vec3> normals;
        std::vector<double> values;
        if (rows.fill) rows.fill(begin + first, begin + last, normals, values);
        for (std::size_t v = first; v < last; ++v) {
            stretch.positions[v] = mesh.positions[begin + v] - shift;
            if (rows.normals) stretch.normals[v] = normals[v - first];
            for (std::size_t k = 0; k < columns; ++k)
                stretch.properties[k].values[v] = values[(v - first) * columns + k];
        }
    });
    return stretch;
}

PolygonMesh stretch_of_facets(const PolygonMesh& mesh, std::size_t begin, std::size_t end) {
    PolygonMesh stretch;
    const Index first = mesh.first[begin];
    stretch.corners.assign(mesh.corners.data() + first, mesh.corners.data() + mesh.first[end]);
    stretch.first.resize(end - begin + 1);
    for (std::size_t f = begin; f <= end; ++f) stretch.first[f - begin] = mesh.first[f] - first;
    return stretch;
}

PlacedStretches::PlacedStretches(const PolygonMesh& mesh, const Vec3& shift)
    : mesh_(mesh), shift_(shift), number_(large_vector<Index>(mesh.vertex_count(), no_index)) {}

PolygonMesh PlacedStretches::facets(std::size_t begin, std::size_t end) {
    PolygonMesh stretch = stretch_of_facets(mesh_, begin, end);
    for (Index& v : stretch.corners) {
        Index& number = number_[v];
        if (number == no_index) {
            number = static_cast<Index>(stretch.positions.size());
            stretch.positions.push_back(mesh_.positions[v] - shift_);
        }
        v = number;
    }
    for (std::size_t c = mesh_.first[begin]; c < mesh_.first[end]; ++c) number_[mesh_.corners[c]] = no_index;
    return stretch;
}

Ranks::Bytes bytes_of_stretch(const PolygonMesh& stretch) {
    Ranks::Bytes bytes;
    put_vector(stretch.positions, bytes);
    put_vector(stretch.normals, bytes);
    put_vector(stretch.corners, bytes);
    put_vector(stretch.first, bytes);
    put(std::uint64_t{stretch.properties.size()}, bytes);
    for (const VertexProperty& property : stretch.properties) put_values(property, bytes);
    return bytes;
}

PolygonMesh stretch_from(const Ranks::Bytes& bytes) {
    ByteReader reader(bytes);
    PolygonMesh stretch;
    stretch.positions = reader.take_vector<Vec3>();
    stretch.normals = reader.take_vector<Vec3>();
    stretch.corners = reader.take_vector<Index>();
    stretch.first = reader.take_vector<Index>();
    for (auto count = reader.take<std::uint64_t>(); count > 0; --count)
        stretch.properties.push_back(taken_values(reader));
    return stretch;
}

} // namespace hsdm

#include "hsdm/spatial/transfer_attributes.hh"

#include "hsdm/cloud/point_attributes.hh"
#include "hsdm/core/check_option.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/core/lanes.hh"
#include "hsdm/mesh/vertex_properties.hh"
#include "hsdm/spatial/neighbor_search.hh"

#include <algorithm>
#include <cmath>

namespace hsdm {
namespace {

using Type = VertexProperty::Type;

struct Source {
    Index point;
    double weight;
};

/// The points that many places take their values from.
class Sources {
public:
    Sources(const PointCloud& cloud, std::span<const Vec3> places, const TransferOptions& options)
        : count_(static_cast<std::size_t>(options.neighbors)), reach_(options.max_distance) {
        const NeighborSearch search(cloud.positions);
        const int one_more = options.neighbors + (options.neighbors < std::numeric_limits<int>::max());
        near_ = std::isfinite(reach_) ? search.nearest_within(places, one_more, reach_)
                                      : search.nearest(places, one_more);
    }

    std::size_t places() const { return near_.places(); }
    bool none_for(std::size_t place) const { return near_.of(place).empty(); }
    /// Replaces `sources` by those of a place; see transfer_attributes().
    void take(std::size_t place, std::vector<Source>& sources) const {
        const auto points = near_.of(place);
        const auto distances = near_.distances_of(place);
        const double radius = points.size() > count_ ? distances[count_] : reach_;
        double total = 0;
        sources.clear();
        for (std::size_t k = 0; k < std::min(count_, points.size()); ++k) {
            const double share = radius > 0 ? std::min(1.0, distances[k] / radius) : 1;
            sources.push_back({points[k], square(1 - square(share))});
            total += sources.back().weight;
        }
        if (!(total > 0)) // all of them at the radius, or it is 0
            for (Source& source : sources) source.weight = 1;
    }

private:
    std::size_t count_;
    double reach_;
    NearPoints near_; // one more than count
};

double missing(const PointAttribute& attribute, const TransferOptions& options) {
    switch (attribute.type) {
    case Type::uint8:
        return options.missing_color[attribute.place];
    case Type::int32:
        return options.missing_label;
    default:
        return options.missing_value;
    }
}

VertexProperty property_of(const PointAttribute& attribute, const Sources& sources, double missing) {
    VertexProperty property{attribute.name, attribute.type, std::vector<double>(sources.places(), missing)};
    for_chunks(sources.places(), chunks::slow, [&](std::size_t begin, std::size_t end, std::size_t) {
        std::vector<Source> near;
        std::vector<WeightedValue> values;
        for (std::size_t place = begin; place < end; ++place) {
            sources.take(place, near);
            values.clear();
            for (const Source& source : near)
                if (const double value = attribute(source.point); std::isfinite(value))
                    values.push_back({value, source.weight});
            if (!values.empty()) property.values[place] = average_of(attribute.type, values);
        }
    });
    return property;
}

/// Unit, or (0, 0, 0) where no point is near or normals cancel.
std::vector<Vec3> normals_of(const PointCloud& cloud, const Sources& sources) {
    constexpr double rounding = 1e-9;
    std::vector<Vec3> normals(sources.places(), Vec3(0, 0, 0));
    for_chunks(normals.size(), chunks::slow, [&](std::size_t begin, std::size_t end, std::size_t) {
        std::vector<Source> near;
        for (std::size_t place = begin; place < end; ++place) {
            sources.take(place, near);
            Vec3 sum(0, 0, 0);
            double total = 0;
            for (const Source& source : near) {
                const Vec3& n = cloud.normals[source.point];
                const double largest = n.max_abs(); // its square may be no number
                if (!(largest > 0) || !std::isfinite(largest)) continue;
                sum += (n / largest).normalized() * source.weight;
                total += source.weight;
            }
            if (sum.norm() > rounding * total) normals[place] = sum.normalized();
        }
    });
    return normals;
}

/// What is carried to places.
struct Carried {
    std::vector<VertexProperty> properties;
    std::vector<Vec3> normals; ///< empty if they are not asked for or not there
    TransferCounts counts;
};

Carried carry(const PointCloud& cloud, std::span<const Vec3> places, const TransferOptions& options) {
    check_option(options.neighbors > 0, "neighbors", options.neighbors, "be at least 1");
    check_option(options.max_distance >= 0, "max_distance", options.max_distance, "not be negative");
    check_arrays(cloud);
    if (!all_finite(places)) throw Error("the mesh has vertices that are not finite; move or remove them");
    const Sources sources(cloud, places, options);
    Carried carried;
    for (const PointAttribute& attribute : attributes_of(view_of(cloud)))
        if (attribute.type == Type::uint8 ? options.colors : options.scalars)
            carried.properties.push_back(property_of(attribute, sources, missing(attribute, options)));
    if (options.normals && cloud.has_normals()) carried.normals = normals_of(cloud, sources);
    carried.counts.vertices = places.size();
    for (std::size_t p = 0; p < places.size(); ++p) carried.counts.too_far += sources.none_for(p);
    carried.counts.properties = carried.properties.size();
    for (const Vec3& n : carried.normals) carried.counts.normals += n.sqrnorm() > 0;
    return carried;
}

} // namespace

TransferCounts transfer_attributes(const PointCloud& cloud, PolygonMesh& mesh,
                                   const TransferOptions& options) {
    Carried carried = carry(cloud, mesh.positions, options);
    for (VertexProperty& property : carried.properties) {
        std::erase_if(mesh.properties, [&](const VertexProperty& p) { return p.name == property.name; });
        mesh.properties.push_back(std::move(property));
    }
    if (!carried.normals.empty()) mesh.normals.resize(mesh.vertex_count(), Vec3(0, 0, 0));
    for (std::size_t v = 0; v < carried.normals.size(); ++v)
        if (carried.normals[v].sqrnorm() > 0) mesh.normals[v] = carried.normals[v];
    return carried.counts;
}

TransferCounts transfer_attributes(const PointCloud& cloud, PolyMesh& mesh, const TransferOptions& options) {
    std::vector<Vec3> places;
    std::vector<Index> place(mesh.n_vertices(), 0); // a deleted vertex may have any values
    for (const auto v : mesh.vertices()) {
        place[static_cast<std::size_t>(v.idx())] = static_cast<Index>(places.size());
        places.push_back(mesh.point(v));
    }
    const Carried carried = carry(cloud, places, options);
    if (places.empty()) return carried.counts;
    for (const VertexProperty& property : carried.properties) set_vertex_property(property, place, mesh);
    if (carried.normals.empty()) return carried.counts;
    if (!mesh.has_vertex_normals()) {
        mesh.request_vertex_normals();
        for (const auto v : mesh.vertices()) mesh.set_normal(v, Vec3(0, 0, 0));
    }
    for (const auto v : mesh.vertices())
        if (const Vec3& n = carried.normals[place[static_cast<std::size_t>(v.idx())]]; n.sqrnorm() > 0)
            mesh.set_normal(v, n);
    return carried.counts;
}

} // namespace hsdm

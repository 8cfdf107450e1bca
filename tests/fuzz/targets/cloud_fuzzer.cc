// Clouds built from bytes through reconstruct: whatever they are, an error that is one of ours or a mesh that
// keeps every promise, the same for any order of the points and any number of threads.

#include "fuzz/targets/cloud_from_bytes.hh"
#include "fuzz/targets/fuzz.hh"
#include "fuzz/targets/show_cloud.hh"
#include "hsdm/cloud/cloud_frame.hh"
#include "hsdm/errors.hh"
#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/quality/topology.hh"
#include "support/random.hh"

#include <algorithm>
#include <cmath>
#include <numeric>

using namespace hsdm;
using hsdm::fuzz::broken;
using hsdm::fuzz::promise;

namespace {

/// What a caller sees.
struct Outcome {
    std::string error; ///< empty: there is a mesh
    PolygonMesh mesh;
    std::string report;
};

Outcome run(const PointCloud& cloud, const ReconstructOptions& options) {
    Outcome outcome;
    try {
        Reconstruction result = reconstruct(cloud, options);
        outcome.mesh = to_polygons(result.mesh);
        result.report.seconds = {};
        result.report.peak_memory_bytes = 0;
        result.report.threads = 0;
        result.report.input.first_nonfinite.reset(); // follows the order
        result.report.options.erase("threads");
        outcome.report = to_json(result.report);
    } catch (const Error& error) {
        outcome.error = error.what();
    } catch (const OptionError& error) {
        outcome.error = error.what();
    } catch (const std::exception& error) {
        broken(std::string("another exception: ") + error.what());
    }
    return outcome;
}

void check_finite(const std::vector<Vec3>& vectors, const char* what) {
    for (const Vec3& v : vectors)
        for (double x : v)
            if (!std::isfinite(x)) broken(std::string("finite ") + what);
}

bool has_scalar(const PointCloud& cloud, const std::string& name) {
    return std::ranges::find(cloud.scalars, name, &Scalar::name) != cloud.scalars.end();
}

/// Closed parts face outward. What encloses next to nothing, both sides of a sheet, has no outside.
bool is_inside_out(const PolygonMesh& mesh, const Topology& topology) {
    Box box;
    for (const Vec3& p : mesh.positions) box.add(p);
    return topology.closed() && topology.signed_volume < -1e-6 * std::pow(box.diagonal(), 3);
}

void check_mesh(PolygonMesh mesh, const PointCloud& cloud) {
    check_finite(mesh.positions, "positions");
    check_finite(mesh.normals, "normals");
    for (const VertexProperty& property : mesh.properties) {
        if (property.values.size() != mesh.vertex_count()) broken("a value per vertex of " + property.name);
        if (!property.name.starts_with("hsdm_") || has_scalar(cloud, property.name)) continue;
        for (double value : property.values)
            if (!std::isfinite(value)) broken("finite " + property.name);
    }
    // Volumes are those in a unit of the mesh's own: at 2^-1000 none is a double.
    const double unit = CloudFrame(bounds_of(mesh.positions)).unit();
    for (Vec3& p : mesh.positions) p *= 1 / unit;
    const Topology topology = measure_topology(mesh);
    promise(topology.faces > 0, "a mesh has facets");
    promise(topology.manifold(), "a 2-manifold");
    promise(topology.misoriented_edges == 0, "facets of one orientation");
    promise(topology.degenerate_facets == 0, "no degenerate facet");
    promise(topology.duplicate_facets == 0, "no duplicate facet");
    promise(topology.isolated_vertices == 0, "no isolated vertex");
    promise(!is_inside_out(mesh, topology), "a closed mesh faces outward");
}

bool same_bits(double a, double b) {
    return (std::isnan(a) && std::isnan(b)) || (a == b && std::signbit(a) == std::signbit(b));
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
    return std::ranges::equal(a, b, [](double x, double y) { return same_bits(x, y); });
}

bool same_bits(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    return std::ranges::equal(a, b, [](const Vec3& p, const Vec3& q) {
        return std::equal(p.begin(), p.end(), q.begin(), [](double x, double y) { return same_bits(x, y); });
    });
}

void check_same(const Outcome& a, const Outcome& b, const std::string& change) {
    if (a.error != b.error) broken("the same error " + change + ": " + a.error + " | " + b.error);
    if (a.mesh.first != b.mesh.first || a.mesh.corners != b.mesh.corners) broken("the same facets " + change);
    if (!same_bits(a.mesh.positions, b.mesh.positions)) broken("the same positions " + change);
    if (!same_bits(a.mesh.normals, b.mesh.normals)) broken("the same normals " + change);
    const bool same = std::ranges::equal(
        a.mesh.properties, b.mesh.properties, [](const VertexProperty& p, const VertexProperty& q) {
            return p.name == q.name && p.type == q.type && same_bits(p.values, q.values);
        });
    if (!same) broken("the same properties of vertices " + change);
    if (a.report != b.report) broken("the same report " + change + "\n" + a.report + "\n" + b.report);
}

template <class T>
void permute(std::vector<T>& values, const std::vector<std::size_t>& order) {
    if (values.empty()) return;
    std::vector<T> permuted;
    for (std::size_t i : order) permuted.push_back(std::move(values[i]));
    values = std::move(permuted);
}

PointCloud shuffled(PointCloud cloud, std::uint64_t seed) {
    support::Random random(seed);
    std::vector<std::size_t> order(cloud.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
    permute(cloud.positions, order);
    permute(cloud.normals, order);
    permute(cloud.colors, order);
    for (Scalar& scalar : cloud.scalars) permute(scalar.values, order);
    return cloud;
}

/// Stops the work at a call of the progress callback: Cancelled, or done before it.
void check_cancelling(const PointCloud& cloud, ReconstructOptions options, int calls) {
    options.progress = [calls](const char*, double) mutable { return calls-- > 0; };
    try {
        reconstruct(cloud, options);
    } catch (const Cancelled&) {
    } catch (const Error&) {
    } catch (const OptionError&) {
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    FuzzedDataProvider data(bytes, size);
    const int checks = data.ConsumeIntegral<std::uint8_t>();
    const auto seed = data.ConsumeIntegral<std::uint8_t>();
    const auto [cloud, exponent] = fuzz::cloud_from(data);
    ReconstructOptions options = fuzz::options_from(data, exponent);
    options.threads = 1;

    if (const char* path = std::getenv("HSDM_FUZZ_SHOW")) fuzz::show_cloud(path, cloud, options);
    const Outcome outcome = run(cloud, options);
    if (outcome.error.empty()) {
        check_mesh(outcome.mesh, cloud);
        if (outcome.report.find("null") != std::string::npos) broken("a finite report: " + outcome.report);
    }
    if (checks % 4 == 0) check_same(outcome, run(shuffled(cloud, seed), options), "in another order");
    if (checks % 16 == 1) {
        options.threads = 2;
        check_same(outcome, run(cloud, options), "with two threads");
    }
    if (checks % 32 == 2) check_cancelling(cloud, options, seed % 16);
    return 0;
}

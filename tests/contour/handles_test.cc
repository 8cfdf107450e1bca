#include "contour/stages.hh"

#include "hsdm/contour/dual_contour.hh"
#include "hsdm/contour/handles.hh"
#include "hsdm/contour/witnesses.hh"
#include "hsdm/mesh/area_vector.hh"
#include "hsdm/mesh/remove_facets.hh"
#include "hsdm/quality/topology.hh"
#include "hsdm/reconstruct.hh"
#include "support/check.hh"
#include "support/crowded_parts.hh"

#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

using namespace hsdm;
using namespace hsdm::support;

namespace {

/// Two boxes that face each other across a gap in x, or with all normals turned a wall in a cavity.
PointCloud facing_boxes(bool turned_normals, std::uint64_t seed) {
    const Solid boxes = box({0.5, 1, 1}).placed(turned({0, 0, 1}, 0, {-0.32, 0, 0}))
                        | box({0.5, 1, 1}).placed(turned({0, 0, 1}, 0, {0.32, 0, 0}));
    PointCloud cloud = sample(boxes, {.points = 12000, .seed = seed});
    if (turned_normals)
        for (Vec3& n : cloud.normals) n = -n;
    return cloud;
}

/// The quad on the plane x = `plane` nearest to the x axis.
std::size_t quad_at(const PolygonMesh& mesh, double plane) {
    std::size_t best = mesh.facet_count();
    double least = Box::inf;
    for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
        if (mesh.facet(f).size() != 4) continue;
        double away = 0;
        for (const Index v : mesh.facet(f)) away += (mesh.positions[v] - Vec3(plane, 0, 0)).sqrnorm();
        if (away < least) least = away, best = f;
    }
    return best;
}

/// The corners of two quads that face each other, each of the one beside its partner of the other.
std::array<std::array<Index, 4>, 2> facing_corners(const PolygonMesh& mesh, std::size_t from,
                                                   std::size_t to) {
    std::array<Index, 4> a{}, b{};
    for (unsigned i = 0; i < 4; ++i) a[i] = mesh.facet(from)[i], b[i] = mesh.facet(to)[3 - i];
    const auto distance = [&](unsigned shift) {
        double sum = 0;
        for (unsigned i = 0; i < 4; ++i)
            sum += (mesh.positions[a[i]] - mesh.positions[b[(i + shift) % 4]]).sqrnorm();
        return sum;
    };
    unsigned shift = 0;
    for (const unsigned other : {1u, 2u, 3u})
        if (distance(other) < distance(shift)) shift = other;
    std::rotate(b.begin(), b.begin() + shift, b.end());
    return {a, b};
}

/// Four quads from the sides of one ring to those of another.
void join(PolygonMesh& mesh, const std::array<Index, 4>& a, const std::array<Index, 4>& b) {
    for (unsigned i = 0; i < 4; ++i) mesh.add_facet(std::array{a[i], a[(i + 1) % 4], b[(i + 1) % 4], b[i]});
}

/// Takes both quads out, and leads four others from the one's sides to the other's.
void bridge(PolygonMesh& mesh, std::size_t from, std::size_t to) {
    const auto [a, b] = facing_corners(mesh, from, to);
    join(mesh, a, b);
    remove_facets(mesh, [&](std::size_t f) { return f == from || f == to; });
}

/// The same with a ring of vertices in the middle, which is returned.
std::array<Index, 4> bridge_with_ring(PolygonMesh& mesh, std::size_t from, std::size_t to) {
    const auto [a, b] = facing_corners(mesh, from, to);
    std::array<Index, 4> ring{};
    for (unsigned i = 0; i < 4; ++i) {
        ring[i] = static_cast<Index>(mesh.vertex_count());
        mesh.positions.push_back(0.5 * (mesh.positions[a[i]] + mesh.positions[b[i]]));
        mesh.origin.push_back(mesh.origin[a[i]]);
    }
    join(mesh, a, ring);
    join(mesh, ring, b);
    remove_facets(mesh, [&](std::size_t f) { return f == from || f == to; });
    return ring;
}

/// The facets that have a vertex of a ring.
std::vector<Index> facets_at(const PolygonMesh& mesh, std::span<const Index> ring) {
    std::vector<Index> facets;
    for (std::size_t f = 0; f < mesh.facet_count(); ++f)
        if (std::ranges::any_of(mesh.facet(f),
                                [&](Index v) { return std::ranges::find(ring, v) != ring.end(); }))
            facets.push_back(static_cast<Index>(f));
    return facets;
}

/// Two boxes that face each other across a gap, bridged, and the ring round the bridge's middle.
struct BridgedBoxes {
    Stages stages;
    DualContour part;
    PolygonMesh& mesh = part.mesh; ///< relative to the octree's origin
    std::array<Index, 4> ring{};

    BridgedBoxes(bool turned_normals, int depth)
        : stages(facing_boxes(turned_normals, 5), depth),
          part(dual_contour(stages.octree, stages.level, stages.sets)) {
        for (Vec3& p : mesh.positions) p += stages.octree.origin;
        mesh.origin = indices_below(mesh.vertex_count());
        ring = bridge_with_ring(mesh, quad_at(mesh, -0.07), quad_at(mesh, 0.07));
        for (Vec3& p : mesh.positions) p -= stages.octree.origin;
    }
    std::vector<Index> beside() const { return facets_at(mesh, ring); }
    Witnesses witnesses() const { return {stages.octree, stages.level, part.voxel, mesh}; }
};

} // namespace

TEST_CASE("a bridge through the air is taken away, and a tunnel that no points speak for filled",
          "[contour]") {
    // Two depths: the ring round the bridge cuts off what has fewer facets than are looked at, and more.
    for (const auto& [turned_normals, depth] :
         {std::pair{false, 5}, std::pair{true, 5}, std::pair{false, 4}, std::pair{true, 4}}) {
        INFO((turned_normals ? "tunnel" : "bridge") << ", depth " << depth);
        const Stages stages(facing_boxes(turned_normals, 5), depth);
        DualContour part = dual_contour(stages.octree, stages.level, stages.sets);
        PolygonMesh& mesh = part.mesh;
        for (Vec3& p : mesh.positions) p += stages.octree.origin;
        REQUIRE(measure_topology(mesh).euler == 4);
        mesh.origin = indices_below(mesh.vertex_count());
        bridge(mesh, quad_at(mesh, -0.07), quad_at(mesh, 0.07));
        for (Vec3& p : mesh.positions) p -= stages.octree.origin;
        REQUIRE(measure_topology(mesh).euler == 2);
        REQUIRE(measure_topology(mesh).components == 1);
        std::optional<FacetLinks> links; // of the mesh before, which are not to be taken for those after
        CHECK(cut_handles(stages.octree, stages.level, stages.sets, part.voxel, mesh, links).cut == 1);
        const Topology topology = measure_topology(mesh);
        CHECK(topology.euler == 4);
        CHECK(topology.components == 2);
        CHECK(topology.closed());
        CHECK(faults(mesh) == (turned_normals ? "closed but not outward; " : ""));
        CHECK(cut_handles(stages.octree, stages.level, stages.sets, part.voxel, mesh, links).cut == 0);
        if (links) CHECK(links->twin == link_facets(mesh).twin);
    }
}

TEST_CASE("points across a ring of edges deny it where none lie as on a rod or in a bore", "[contour]") {
    for (const bool turned_normals : {false, true}) {
        const BridgedBoxes boxes(turned_normals, 3); // the gap is 0.85 voxels wide
        const auto is_denied = [&](const Octree& octree) {
            return Witnesses(octree, boxes.stages.level, boxes.part.voxel, boxes.mesh)
                .deny(boxes.ring, boxes.beside());
        };
        const Octree& octree = boxes.stages.octree;
        CHECK(is_denied(octree));
        Octree completed = octree;
        completed.source.front() = no_index; // far off
        CHECK(is_denied(completed));
        std::ranges::fill(completed.source, no_index);
        CHECK_FALSE(is_denied(completed));
        Octree round = octree; // as if they lay round a rod: every second one faces away from its axis
        for (std::size_t i = 0; i < round.size(); i += 2) {
            Vec3 away = round.positions[i] + octree.origin;
            away[0] = 0;
            round.normals[i] = away.normalized();
        }
        CHECK_FALSE(is_denied(round));
        Octree wall = octree; // as if the two sides of the gap were those of a wall
        for (Vec3& n : wall.normals)
            if (std::abs(n[0]) > 0.7) n = -n;
        CHECK_FALSE(is_denied(wall));
    }
}

TEST_CASE("points surround the axis of a ring round a rod or in a bore, not that of a bridge", "[contour]") {
    for (const bool turned_normals : {false, true}) {
        const Pose pose = random_pose(7);
        PointCloud cloud = sample(cylinder(0.6, 10).placed(pose), {.points = 320, .seed = 7});
        if (turned_normals)
            for (Vec3& n : cloud.normals) n = -n;
        const Stages rod(cloud, 4, 16);
        const DualContour part = dual_contour(rod.octree, rod.level, rod.sets);
        std::array<Index, 5> ring{};
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const double angle = 2 * std::numbers::pi * static_cast<double>(i) / ring.size();
            const Vec3 at =
                pose.to_world({0.6 * std::cos(angle), 0.6 * std::sin(angle), 0}) - rod.octree.origin;
            const auto nearest = std::ranges::min_element(part.mesh.positions, {},
                                                          [&](const Vec3& p) { return (p - at).sqrnorm(); });
            ring[i] = static_cast<Index>(nearest - part.mesh.positions.begin());
        }
        PolygonMesh mesh = part.mesh;
        mesh.origin = indices_below(mesh.vertex_count());
        const Witnesses witnesses(rod.octree, rod.level, part.voxel, mesh);
        CHECK(witnesses.surround(ring));
        CHECK(witnesses.are_missing_across(ring, facets_at(mesh, ring))); // nothing stands across it
        Octree half = rod.octree; // as if nothing were known of one side
        for (std::size_t i = 0; i < half.size(); ++i)
            if (pose.to_local(half.positions[i] + half.origin)[0] < 0) half.source[i] = no_index;
        CHECK_FALSE(Witnesses(half, rod.level, part.voxel, mesh).surround(ring));
        Octree wall = rod.octree; // as if the points lay on the two sides of a wall
        for (std::size_t i = 0; i < wall.size(); ++i) {
            const bool behind = pose.to_local(wall.positions[i] + wall.origin)[0] < 0;
            wall.normals[i] = pose.rotate({behind != turned_normals ? -1.0 : 1.0, 0, 0});
        }
        CHECK_FALSE(Witnesses(wall, rod.level, part.voxel, mesh).surround(ring));

        const BridgedBoxes boxes(turned_normals, 3);
        CHECK_FALSE(boxes.witnesses().surround(boxes.ring));
        CHECK_FALSE(boxes.witnesses().are_missing_across(boxes.ring, boxes.beside()));
        Octree aside = boxes.stages.octree; // as if nothing stood on one side of the gap
        for (std::size_t i = 0; i < aside.size(); ++i)
            if (aside.positions[i][0] + aside.origin[0] > 0) aside.normals[i] = Vec3(0, 1, 0);
        CHECK(Witnesses(aside, boxes.stages.level, boxes.part.voxel, boxes.mesh)
                  .are_missing_across(boxes.ring, boxes.beside()));
    }
}

TEST_CASE("measured points speak for a bridge, completed ones do not", "[contour]") {
    const Stages stages(facing_boxes(false, 5), 5);
    DualContour part = dual_contour(stages.octree, stages.level, stages.sets);
    PolygonMesh& mesh = part.mesh;
    for (Vec3& p : mesh.positions) p += stages.octree.origin;
    mesh.origin = indices_below(mesh.vertex_count());
    bridge(mesh, quad_at(mesh, -0.07), quad_at(mesh, 0.07));
    for (Vec3& p : mesh.positions) p -= stages.octree.origin;
    const PolygonMesh bridged = mesh;
    const double half_width = 0.5 * stages.level.voxel_size;
    // Every second point at the bridge's ends lies on its sides, and faces away from its axis.
    Octree octree = stages.octree;
    std::vector<std::size_t> beside;
    for (std::size_t i = 0; i < octree.size(); i += 2) {
        Vec3 away = octree.positions[i] + octree.origin;
        if (std::abs(away[0]) > 0.1) continue;
        const double along = away[0];
        away[0] = 0;
        if (away.norm() > 0.2) continue;
        octree.normals[i] = away.normalized();
        octree.positions[i] = Vec3(along, 0, 0) + half_width * octree.normals[i] - octree.origin;
        beside.push_back(i);
    }
    REQUIRE(beside.size() > 20);
    std::optional<FacetLinks> links;
    CHECK(cut_handles(octree, stages.level, stages.sets, part.voxel, mesh, links).cut == 0);
    mesh = bridged;
    for (std::size_t i : beside) octree.source[i] = no_index;
    CHECK(cut_handles(octree, stages.level, stages.sets, part.voxel, mesh, links).cut == 1);
    if (links) CHECK(links->twin == link_facets(mesh).twin);
}

TEST_CASE("a ring narrower than points are apart is cut, in full view of them", "[contour]") {
    BridgedBoxes boxes(false, 5);
    const Stages& stages = boxes.stages;
    PolygonMesh& mesh = boxes.mesh;
    const auto& ring = boxes.ring;
    CHECK_FALSE(boxes.witnesses().is_narrow(ring));
    Vec3 middle(0, 0, 0);
    for (const Index v : ring) middle += 0.25 * mesh.positions[v];
    for (const Index v : ring) mesh.positions[v] += 0.9 * (middle - mesh.positions[v]);
    CHECK(boxes.witnesses().is_narrow(ring));
    // For every facet of the bridge, every second point: near its ends, so that none surround the ring.
    Octree speaking = stages.octree;
    const std::vector<Index> beside = boxes.beside();
    std::size_t count = 0;
    for (std::size_t i = 0; i < speaking.size(); i += 2) {
        const Vec3 from = speaking.positions[i] - middle;
        if (std::abs(from[0]) > 0.1 || from.norm() > 0.2) continue;
        const auto facet = mesh.facet(beside[count++ % beside.size()]);
        Vec3 end(0, 0, 0);
        for (const Index v : facet)
            if (std::ranges::find(ring, v) == ring.end()) end += 0.5 * mesh.positions[v];
        speaking.positions[i] = 0.5 * (centroid(mesh, facet) + end);
        speaking.normals[i] = unit(area_vector(mesh, facet));
    }
    std::optional<FacetLinks> links;
    CHECK(cut_handles(speaking, stages.level, stages.sets, boxes.part.voxel, mesh, links).cut == 1);
    CHECK(measure_topology(mesh).euler == 4);
    CHECK(faults(mesh) == "");
}

TEST_CASE("a part tells whether it looked farther behind its rings than it knows", "[contour]") {
    const BridgedBoxes boxes(false, 5);
    const Stages& stages = boxes.stages;
    const std::vector<Index>& voxel = boxes.part.voxel;
    // Both ends of the bridge are looked at; what lies behind it is a box of far more facets.
    const double voxel_size = stages.level.voxel_size;
    const auto cut = [&](double near, double own) {
        const auto is_within = [&](Index v, double distance) {
            const auto at = morton_decode(stages.level.codes[v]);
            Vec3 centre = stages.octree.origin;
            for (unsigned k = 0; k < 3; ++k) centre[k] += (at[k] + 0.5) * voxel_size;
            return std::abs(centre[0]) < distance && std::hypot(centre[1], centre[2]) < distance;
        };
        PolygonMesh mesh = boxes.mesh;
        std::optional<FacetLinks> links;
        const PartVoxels part{[&](Index v) { return is_within(v, own); },
                              [&](Index v) { return is_within(v, near); }};
        const HandleCounts counts =
            cut_handles(stages.octree, stages.level, stages.sets, voxel, mesh, links, part);
        CHECK(counts.cut > 0);
        return counts.looked_far;
    };
    CHECK_FALSE(cut(2, 2));
    CHECK(cut(4 * voxel_size, 4 * voxel_size));
    CHECK_FALSE(cut(16 * voxel_size, 4 * voxel_size)); // 216 facets reach some ten voxels
    CHECK_FALSE(cut(4 * voxel_size, 0));               // no ring is its own
}

TEST_CASE("the same rings are cut by any number of threads", "[contour][determinism]") {
    // Bars of two spacings: hundreds of rings are doubtful, and some of those beside each other.
    const Solid bars = lattice(0.06, 0.4).placed(turned({1, 2, 3}, 0.7));
    const PointCloud cloud = sample(bars, {.points = 7000, .seed = 7});
    std::vector<std::size_t> cut;
    std::vector<std::vector<Index>> corners;
    for (const int threads : {1, 2, 5}) {
        ReconstructOptions options;
        options.threads = threads;
        const Reconstruction made = reconstruct(cloud, options);
        cut.push_back(made.report.rejected.at("handles_cut"));
        corners.push_back({});
        for (const auto f : made.mesh.faces())
            for (const auto v : f.vertices()) corners.back().push_back(static_cast<Index>(v.idx()));
    }
    CHECK(cut[0] > 3);
    CHECK(cut[1] == cut[0]);
    CHECK(cut[2] == cut[0]);
    CHECK(corners[1] == corners[0]);
    CHECK(corners[2] == corners[0]);
}

TEST_CASE("holes and rods of the part that points speak for stay, however short the way round", "[contour]") {
    const double voxel = 1.0 / 16;
    for (const double diameter : {1.2, 2.0}) { // voxels
        INFO("diameter " << diameter);
        const Solid hole = box({1, 1, 0.3}) - cylinder(0.5 * diameter * voxel, 1);
        const Solid rod = box({1, 1, 0.2}).placed(turned({0, 0, 1}, 0, {0, 0, 0.3}))
                          | box({1, 1, 0.2}).placed(turned({0, 0, 1}, 0, {0, 0, -0.3}))
                          | cylinder(0.5 * diameter * voxel, 0.6);
        for (const auto& [solid, euler] : {std::pair{hole, 0L}, std::pair{rod, 2L}}) {
            const PointCloud cloud = sample(solid.placed(random_pose(3)), {.points = 16000, .seed = 3});
            const Report report = reconstruct(cloud, {.voxel_size = voxel}).report;
            CHECK(report.rejected.at("handles_cut") == 0);
            CHECK(report.mesh.euler == euler);
        }
    }
}

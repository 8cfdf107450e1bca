#include "hsdm/normals/vote_on_normals.hh"
#include "support/sample.hh"

#include <catch2/catch.hpp>
#include <tbb/global_control.h>

#include <algorithm>

using namespace hsdm;

namespace {

/// A scan with exact normals, which tests then spoil.
struct Scan {
    Octree octree;
    Neighbors neighbors;
    EstimatedNormals estimate;

    explicit Scan(const support::Solid& solid) : Scan(support::sample(solid, {.points = 4000})) {}
    explicit Scan(const PointCloud& cloud, int around = 16)
        : octree(build_octree(cloud)), neighbors(find_neighbors(octree, {.count = around})) {
        estimate.normals = octree.normals;
        for (double reach : neighbors.reach) estimate.tolerance.push_back(0.05 * reach);
        for (Index i = 0; i < octree.size(); ++i) estimate.bent.push_back(i);
    }
    void vote() { vote_on_normals(octree, neighbors, estimate); }

    /// Points whose neighbours are not all of one face with them.
    std::vector<Index> near_creases() const {
        std::vector<Index> found;
        for (Index i = 0; i < octree.size(); ++i) {
            const auto around = neighbors.of(i);
            if (std::any_of(around.begin(), around.end(),
                            [&](Index j) { return (octree.normals[i] | octree.normals[j]) < 0.5; }))
                found.push_back(i);
        }
        return found;
    }
    /// So near a crease that it may be of either face.
    bool is_of_both(Index i) const {
        const auto around = neighbors.of(i);
        return std::any_of(around.begin(), around.end(), [&](Index j) {
            const Vec3 d = octree.positions[i] - octree.positions[j];
            return (octree.normals[i] | octree.normals[j]) < 0.5
                   && std::abs(octree.normals[j] | d) < 2 * estimate.tolerance[i];
        });
    }
    /// How many normals are off the exact ones by more than ten degrees.
    std::size_t wrong() const {
        std::size_t count = 0;
        for (Index i = 0; i < octree.size(); ++i)
            count += (estimate.normals[i] | octree.normals[i]) < 0.985 && !is_of_both(i);
        return count;
    }
};

support::Solid turned_cube() {
    return support::box({1, 1, 1}).placed(support::turned(Vec3(1, 2, 3), 0.5));
}

} // namespace

TEST_CASE("single points that are oriented wrongly are turned", "[normals]") {
    for (const support::Solid& solid : {turned_cube(), support::sphere(1)}) {
        Scan scan(solid);
        for (Index i = 0; i < scan.octree.size(); i += 23) scan.estimate.normals[i] *= -1;
        CHECK(scan.wrong() > 150);
        scan.vote();
        CHECK(scan.wrong() == 0);
    }
}

TEST_CASE("beside a crease points take the normal of their own face", "[normals]") {
    Scan scan(turned_cube());
    const std::vector<Index> near = scan.near_creases();
    for (std::size_t k = 0; k < near.size(); k += 4) { // every fourth has that of the other face
        const auto around = scan.neighbors.of(near[k]);
        const auto other = std::find_if(around.begin(), around.end(), [&](Index j) {
            return (scan.octree.normals[near[k]] | scan.octree.normals[j]) < 0.5;
        });
        scan.estimate.normals[near[k]] = scan.octree.normals[*other];
    }
    const std::size_t before = scan.wrong();
    CHECK(before > 100);
    scan.vote();
    CHECK(scan.wrong() < before / 20);
}

TEST_CASE("normals that neighbours agree on stay as they are", "[normals]") {
    Scan ball(support::sphere(1));
    ball.vote();
    CHECK(ball.estimate.normals == ball.octree.normals);
    Scan box(turned_cube());
    box.vote();
    CHECK(box.wrong() == 0); // near creases too
}

TEST_CASE("a point stays of its face where not clearly more neighbours are of another", "[normals]") {
    PointCloud cloud; // two faces in grids, on the edge between them two points of either by turns
    constexpr int side = 30;
    for (int y = 0; y < side; ++y)
        for (int k = 1 - side; k < side; ++k) {
            const bool upright = k < 0 || (k == 0 && y % 4 < 2);
            const double away = 1.1 * std::abs(k); // so that as many neighbours are of either face
            cloud.positions.push_back(k < 0 ? Vec3(0, y, away) : Vec3(away, y, 0));
            cloud.normals.push_back(upright ? Vec3(1, 0, 0) : Vec3(0, 0, 1));
        }
    Scan scan(cloud, 26); // twelve of one's own, fourteen others
    scan.estimate.bent.clear();
    for (Index i = 0; i < scan.octree.size(); ++i) { // some on the edge, out of each other's reach
        const Vec3& p = scan.octree.positions[i];
        if (p[0] == 0 && p[2] == 0 && (p[1] == 9 || p[1] == 14 || p[1] == 20))
            scan.estimate.bent.push_back(i);
    }
    REQUIRE(scan.estimate.bent.size() == 3);
    scan.vote();
    for (Index i : scan.estimate.bent) CHECK((scan.estimate.normals[i] | scan.octree.normals[i]) > 0.9);
}

TEST_CASE("points that are not said to be bent have no vote", "[normals]") {
    Scan scan(turned_cube());
    scan.estimate.bent = scan.near_creases();
    std::vector<std::uint8_t> bent(scan.octree.size(), 0);
    for (Index i : scan.estimate.bent) bent[i] = 1;
    for (Index i = 0; i < scan.octree.size(); i += 17) scan.estimate.normals[i] *= -1;
    const std::vector<Vec3> before = scan.estimate.normals;
    scan.vote();
    std::size_t changed = 0, turned = 0;
    for (Index i = 0; i < scan.octree.size(); ++i) {
        changed += !bent[i] && scan.estimate.normals[i] != before[i];
        turned += bent[i] && (scan.estimate.normals[i] | before[i]) < 0;
    }
    CHECK(changed == 0);
    CHECK(turned > 20);
}

TEST_CASE("votes leave unit normals and do not depend on the number of threads", "[normals]") {
    Scan many(support::mechanical_part());
    for (Index i = 0; i < many.octree.size(); i += 11) many.estimate.normals[i] *= -1;
    Scan single = many;
    many.vote();
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    single.vote();
    CHECK(single.estimate.normals == many.estimate.normals);
    double off = 0;
    for (const Vec3& n : many.estimate.normals) off = std::max(off, std::abs(n.norm() - 1));
    CHECK(off < 1e-9);
}

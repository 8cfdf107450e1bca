#include <hsdm/hsdm.hh>

int main() {
    hsdm::PointCloud cloud; // a cube's surface, as a grid of points
    for (int i = 0; i < 400; ++i) {
        const double u = i % 20 / 19.0, v = i / 20 / 19.0;
        for (double w : {0.0, 1.0})
            cloud.positions.insert(cloud.positions.end(), {{u, v, w}, {u, w, v}, {w, u, v}});
    }
    return hsdm::reconstruct(cloud).report.mesh.closed ? 0 : 1;
}

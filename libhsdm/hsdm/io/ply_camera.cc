#include "hsdm/io/ply.hh"

#include <cmath>

namespace hsdm::io {

std::optional<PlyCamera> find_camera(const PlyHeader& header) {
    std::optional<PlyCamera> found;
    std::size_t cameras = 0;
    for (std::size_t e = 0; e < header.elements.size(); ++e) {
        const PlyElement& element = header.elements[e];
        if (element.name != "camera") continue;
        ++cameras;
        if (element.count != 1 || element.has_list()) continue;
        PlyCamera camera{e, {}};
        unsigned axes = 0; // a bit each
        bool twice = false;
        for (std::size_t i = 0; i < element.properties.size(); ++i) {
            const std::string& name = element.properties[i].name;
            if (name.size() != 7 || !name.starts_with("view_p") || name[6] < 'x' || name[6] > 'z') continue;
            const auto axis = static_cast<unsigned>(name[6] - 'x');
            twice |= (axes >> axis & 1) != 0;
            axes |= 1u << axis;
            camera.position[axis] = i;
        }
        if (axes == 7 && !twice) found = camera;
    }
    if (cameras != 1) return std::nullopt;
    return found;
}

std::optional<Vec3> sensor_of_camera(const PlyCamera& camera, std::span<const double> values) {
    const Vec3 at(values[camera.position[0]], values[camera.position[1]], values[camera.position[2]]);
    // Programs write the element for every cloud, with zeros where they know of no camera.
    if (!(std::isfinite(at.sqrnorm()) && at.sqrnorm() > 0)) return std::nullopt;
    return at;
}

} // namespace hsdm::io

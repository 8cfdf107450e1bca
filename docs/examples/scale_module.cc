// A processing module: hsdm process in.off -o out.off --module scale:factor=25.4
#include <hsdm/plugin.hh>

std::string scale(hsdm::PolyMesh& mesh, const hsdm::PluginOptions& options) {
    const double factor = options.number("factor", 1);
    for (const auto v : mesh.vertices()) mesh.set_point(v, factor * mesh.point(v));
    return "scaled by " + options.text("factor", "1");
}

HSDM_PLUGIN("scale", "multiplies all coordinates", "factor=1 (length): above 0", scale)

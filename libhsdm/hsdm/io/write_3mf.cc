// 3MF, core specification 1.3: a ZIP archive with the mesh as XML. Decimals hold doubles in it.

#include "hsdm/io/format_chunks.hh"
#include "hsdm/io/mesh_writers.hh"
#include "hsdm/io/zip_archive.hh"
#include "hsdm/mesh/triangulate.hh"
#include "hsdm/quality/topology.hh"

#include <algorithm>

namespace hsdm {
namespace {

constexpr const char* content_types =
    R"(<?xml version="1.0" encoding="UTF-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">
<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>
<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/>
</Types>
)";

constexpr const char* relationships =
    R"(<?xml version="1.0" encoding="UTF-8"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
<Relationship Target="/3D/3dmodel.model" Id="model" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>
</Relationships>
)";

/// The format cannot do without; its own default is the millimetre.
const char* unit_word(LengthUnit unit) {
    switch (unit) {
    case LengthUnit::centimetre:
        return "centimeter";
    case LengthUnit::metre:
        return "meter";
    case LengthUnit::inch:
        return "inch";
    default:
        return "millimeter";
    }
}

void append_vertices(const PolygonMesh& mesh, std::string& xml) {
    for (const Vec3& p : mesh.positions) {
        for (unsigned k = 0; k < 3; ++k) {
            xml += k == 0 ? "<vertex x=\"" : k == 1 ? "\" y=\"" : "\" z=\"";
            append_number(xml, p[k]);
        }
        xml += "\"/>\n";
    }
}

/// What takes no area is no triangle of the format, which wants three different vertices.
void append_triangles(const Triangulation& cut, std::string& xml) {
    for (const Triangle& t : cut.triangles) {
        if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
        for (std::size_t k = 0; k < 3; ++k) {
            xml += k == 0 ? "<triangle v1=\"" : k == 1 ? "\" v2=\"" : "\" v3=\"";
            append_number(xml, t[k]);
        }
        xml += "\"/>\n";
    }
}

std::string model_of(const PolygonMesh& mesh, LengthUnit unit) {
    // What is open is no body to be printed, but a surface.
    const char* const type = measure_topology(mesh).closed() ? "model" : "surface";
    std::string xml = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"";
    xml += unit_word(unit);
    xml += "\" xml:lang=\"en-US\" xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">\n"
           "<metadata name=\"Application\">hsdm</metadata>\n<resources>\n<object id=\"1\" type=\"";
    xml += type;
    xml += "\">\n<mesh>\n<vertices>\n";
    append_vertices(mesh, xml);
    xml += "</vertices>\n<triangles>\n";
    append_triangles(triangulate(mesh), xml);
    xml += "</triangles>\n</mesh>\n</object>\n</resources>\n<build>\n<item "
           "objectid=\"1\"/>\n</build>\n</model>\n";
    return xml;
}

} // namespace

void write_3mf(AtomicFile& file, const std::string& path, const PolygonMesh& mesh, LengthUnit unit) {
    // Not as a list of members, out of which the model would be copied.
    std::vector<std::pair<std::string, std::string>> members{{"[Content_Types].xml", content_types},
                                                             {"_rels/.rels", relationships}};
    members.emplace_back("3D/3dmodel.model", model_of(mesh, unit));
    io::write_zip(file, path, members);
}

} // namespace hsdm

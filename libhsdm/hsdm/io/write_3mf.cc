// 3MF, core specification 1.3: a ZIP archive with the mesh as XML. Decimals hold doubles in it.

#include "hsdm/io/format_chunks.hh"
#include "hsdm/io/long_text.hh"
#include "hsdm/io/mesh_writers.hh"
#include "hsdm/io/zip_archive.hh"
#include "hsdm/mesh/triangulate.hh"

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

void append_vertices(std::string& xml, const PolygonMesh& mesh, std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
        for (unsigned k = 0; k < 3; ++k) {
            xml += k == 0 ? "<vertex x=\"" : k == 1 ? "\" y=\"" : "\" z=\"";
            append_number(xml, mesh.positions[v][k]);
        }
        xml += "\"/>\n";
    }
}

/// Of facets begin .. end - 1. What takes no area is no triangle of the format, which wants three different
/// vertices.
void append_triangle_lines(std::string& xml, const PolygonMesh& mesh, std::size_t begin, std::size_t end) {
    std::vector<Triangle> cut;
    for (std::size_t f = begin; f < end; ++f) append_triangles(mesh, f, cut);
    for (const Triangle& t : cut) {
        if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
        for (std::size_t k = 0; k < 3; ++k) {
            xml += k == 0 ? "<triangle v1=\"" : k == 1 ? "\" v2=\"" : "\" v3=\"";
            append_number(xml, t[k]);
        }
        xml += "\"/>\n";
    }
}

/// The mesh must outlive it.
LongText model_of(const PolygonMesh& mesh, bool closed, LengthUnit unit) {
    // What is open is no body to be printed, but a surface.
    const char* const type = closed ? "model" : "surface";
    std::string head = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"";
    head += unit_word(unit);
    head += "\" xml:lang=\"en-US\" xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">\n"
            "<metadata name=\"Application\">hsdm</metadata>\n<resources>\n<object id=\"1\" type=\"";
    head += type;
    head += "\">\n<mesh>\n<vertices>\n";
    LongText model;
    model.add(std::move(head));
    model.add(mesh.vertex_count(), [&mesh](std::string& out, std::size_t begin, std::size_t end) {
        append_vertices(out, mesh, begin, end);
    });
    model.add("</vertices>\n<triangles>\n");
    model.add(mesh.facet_count(), [&mesh](std::string& out, std::size_t begin, std::size_t end) {
        append_triangle_lines(out, mesh, begin, end);
    });
    model.add("</triangles>\n</mesh>\n</object>\n</resources>\n<build>\n<item "
              "objectid=\"1\"/>\n</build>\n</model>\n");
    return model;
}

LongText text_of(const char* text) {
    LongText all;
    all.add(text);
    return all;
}

} // namespace

void write_3mf(AtomicFile& file, const std::string& path, const PolygonMesh& mesh, bool closed,
               LengthUnit unit) {
    io::write_zip(file, path,
                  {{"[Content_Types].xml", text_of(content_types)},
                   {"_rels/.rels", text_of(relationships)},
                   {"3D/3dmodel.model", model_of(mesh, closed, unit)}});
}

} // namespace hsdm

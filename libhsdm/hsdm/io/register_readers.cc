#include "hsdm/io/register_readers.hh"

#include "hsdm/errors.hh"
#include "hsdm/io/formats.hh"
#include "hsdm/mesh/vertex_normals.hh"

#include <OpenMesh/Core/IO/IOManager.hh>
#include <OpenMesh/Core/Utils/PropertyCreator.hh>

#include <exception>

namespace hsdm {
namespace {

using OpenMesh::IO::BaseImporter;
using OpenMesh::IO::Options;

class PointReader : public OpenMesh::IO::BaseReader {
public:
    std::string get_description() const override { return "Point clouds as text"; }
    /// No extension that OpenMesh reads itself, because its modules are asked in the order of their
    /// addresses.
    std::string get_extensions() const override {
        std::string extensions;
        for (const std::string_view name : point_formats())
            if (std::string_view(" ply off obj stl om hoppe ").find(' ' + std::string(name) + ' ')
                == std::string_view::npos)
                extensions.append(extensions.empty() ? "" : " ").append(name);
        return extensions;
    }

    bool read(const std::string& path, BaseImporter& mesh, Options& options) override {
        return add_points([&] { return read_points(path); }, mesh, options);
    }
    bool read(std::istream& stream, BaseImporter& mesh, Options& options) override {
        return add_points([&] { return io::read_points(io::SourceBytes::read(stream, "<stream>"), {}); },
                          mesh, options);
    }

private:
    /// OpenMesh's readers report by their return value, so no exception may leave this one.
    template <class Read>
    static bool add_points(const Read& read, BaseImporter& mesh, Options& options) {
        try {
            const PointCloud cloud = read().cloud;
            const bool normals = cloud.has_normals() && options.vertex_has_normal();
            const bool colors = !cloud.colors.empty() && options.vertex_has_color();
            mesh.reserve(static_cast<unsigned>(cloud.size()), 0, 0);
            for (std::size_t i = 0; i < cloud.size(); ++i) {
                const auto vertex = mesh.add_vertex(cloud.positions[i]);
                if (normals) mesh.set_normal(vertex, cloud.normals[i]);
                if (colors) mesh.set_color(vertex, OpenMesh::Vec4uc(cloud.colors[i].data()));
            }
            options.clear(); // what was asked for becomes what there was
            if (normals) options += Options::VertexNormal;
            if (colors) options += Options::VertexColor | Options::ColorAlpha;
            return true;
        } catch (const std::exception&) {
            return false;
        }
    }
};

/// Makes the property `hsdm_normals` of an .om file where the mesh that is read does not have it. OpenMesh
/// keeps a pointer to it.
template <class Scalar>
class NormalsCreator : public OpenMesh::PropertyCreatorImpl<NormalsCreator<Scalar>> {
public:
    using type = NormalTriple<OpenMesh::VectorT<Scalar, 3>>;

    NormalsCreator() { OpenMesh::PropertyCreationManager::instance().register_property_creator(this); }
    std::string type_string() override { return OpenMesh::IO::binary<type>::type_identifier(); }
};

} // namespace

void register_readers() {
    static NormalsCreator<double> doubles;
    static NormalsCreator<float> floats;
    static PointReader reader;
    static const bool registered = OpenMesh::IO::IOManager().register_module(&reader);
    static_cast<void>(registered);
}

} // namespace hsdm

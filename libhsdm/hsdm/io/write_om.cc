#include "hsdm/io/write_om.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/interruption.hh"
#include "hsdm/errors.hh"
#include "hsdm/io/linked_exporter.hh"
#include "hsdm/io/mesh_writers.hh"
#include "hsdm/mesh/to_mesh.hh"

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/System/omstream.hh>

#include <algorithm>
#include <array>
#include <exception>
#include <limits>
#include <mutex>
#include <ostream>
#include <streambuf>

namespace hsdm {
namespace {

/// OpenMesh's writer reports bytes to its log, which is standard error unless the user says otherwise; a
/// library call prints nothing.
class QuietLog {
public:
    QuietLog() : was_enabled_(omlog().is_enabled()) { omlog().disable(); }
    ~QuietLog() {
        if (was_enabled_) omlog().enable();
    }
    QuietLog(const QuietLog&) = delete;
    QuietLog& operator=(const QuietLog&) = delete;

private:
    bool was_enabled_;
};

/// Hands bytes on to a file as they come. OpenMesh ends the process when a stream refuses bytes, be it that
/// the disk is full or, with a stream into memory, that the memory is: so this one takes everything, and what
/// went wrong is thrown once OpenMesh is done.
class FileBuffer : public std::streambuf {
public:
    explicit FileBuffer(AtomicFile& file) : file_(file) {
        setp(bytes_.data(), bytes_.data() + bytes_.size());
    }

    /// To be called last. Throws Error.
    void finish() {
        sync();
        if (failure_) std::rethrow_exception(failure_);
    }

protected:
    int_type overflow(int_type c) override {
        sync();
        if (!traits_type::eq_int_type(c, traits_type::eof())) sputc(traits_type::to_char_type(c));
        return traits_type::not_eof(c);
    }
    int sync() override {
        try {
            if (!failure_) {
                Interruption::poll();
                file_.write({pbase(), static_cast<std::size_t>(pptr() - pbase())});
            }
        } catch (...) {
            failure_ = std::current_exception();
        }
        setp(bytes_.data(), bytes_.data() + bytes_.size());
        return 0;
    }

private:
    AtomicFile& file_;
    std::array<char, 1 << 16> bytes_;
    std::exception_ptr failure_;
};

void check_sizes(const std::string& path, OpenMesh::IO::BaseExporter& exporter) {
    OmSizes sizes{exporter.n_vertices(), exporter.n_faces(), exporter.n_edges(), 0};
    const OpenMesh::BaseKernel& kernel = *exporter.kernel();
    for (auto it = kernel.vprops_begin(); it != kernel.vprops_end(); ++it)
        if (*it && (*it)->persistent()) sizes.property = std::max(sizes.property, (*it)->size_of());
    check_sizes(path, sizes);
}

void write_om(const std::string& path, OpenMesh::IO::BaseExporter& exporter) {
    check_sizes(path, exporter);
    using OpenMesh::IO::Options;
    Options options(Options::Binary);
    options += Options::VertexNormal;
    options += Options::Status;
    options += Options::Custom;
    AtomicFile file(path);
    FileBuffer buffer(file);
    std::ostream stream(&buffer);
    const bool written = [&] {
        static std::mutex one_at_a_time; // the log is the process's
        const std::lock_guard held(one_at_a_time);
        const QuietLog quiet;
        bool is_written = false;
        isolated([&] { is_written = OpenMesh::IO::IOManager().write(stream, ".om", exporter, options); });
        return is_written;
    }();
    buffer.finish();
    if (!written) throw Error(path, "OpenMesh could not write this mesh as .om; write OFF or PLY instead");
    file.commit();
}

} // namespace

void check_sizes(const std::string& path, const OmSizes& sizes) {
    constexpr std::size_t most = std::numeric_limits<int>::max();
    if (std::max({sizes.vertices, sizes.facets, 2 * sizes.edges}) > most)
        throw Error(path, "cannot write: " + std::to_string(2 * sizes.edges)
                              + " half-edges, more than OpenMesh can number; write PLY");
    if (sizes.property > std::numeric_limits<std::uint32_t>::max())
        throw Error(path, "cannot write: a property of " + std::to_string(sizes.property)
                              + " bytes, of which .om holds less than 4 GiB; write PLY, or --plain");
}

void write_om(const std::string& path, const PolyMesh& mesh) {
    OpenMesh::IO::ExporterT<PolyMesh> exporter(mesh);
    write_om(path, exporter);
}

void write_om(const std::string& path, const LinkedMesh& mesh) {
    LinkedExporter exporter(mesh);
    write_om(path, exporter);
}

void write_polygons_om(const std::string& path, const PolygonMesh& mesh) {
    const ToMeshResult result = to_mesh(mesh);
    if (result.rejected > 0)
        throw Error(path,
                    std::to_string(result.rejected)
                        + " facets meet where a half-edge mesh cannot hold them; write OFF or PLY instead");
    write_om(path, result.mesh);
}

} // namespace hsdm

#include "hsdm/io/write_by_ranks.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/interruption.hh"
#include "hsdm/core/system.hh"
#include "hsdm/io/float_precision.hh"
#include "hsdm/io/format_chunks.hh"
#include "hsdm/io/mesh_document.hh"
#include "hsdm/io/mesh_stretch.hh"
#include "hsdm/io/mesh_writers.hh"
#include "hsdm/io/output_target.hh"

#include <algorithm>
#include <optional>

namespace hsdm {
namespace {

/// What all ranks must know of the file.
struct FileOfAll {
    std::string name;        ///< of the temporary; empty: the first rank writes alone
    std::uint64_t inode = 0; ///< which tells it from one of that name on another machine
    bool ascii = false, normals = false;
    MeshCounts counts{};
};

FileOfAll told_by_first(const FileOfAll& own, Ranks& ranks) {
    Ranks::Bytes bytes;
    put_text(own.name, bytes);
    put(own.inode, bytes), put(own.ascii, bytes), put(own.normals, bytes);
    put(own.counts, bytes);
    const Ranks::Bytes told = ranks.of_first(std::move(bytes));
    ByteReader reader(told);
    FileOfAll file;
    file.name = reader.take_text();
    file.inode = reader.take<std::uint64_t>();
    file.ascii = reader.take<bool>(), file.normals = reader.take<bool>();
    file.counts = reader.take<MeshCounts>();
    return file;
}

std::uint64_t inode_of(const std::string& path) {
    os::FileStatus status;
    return !path.empty() && os::status_of(path, status) ? status.inode : 0;
}

/// Null on all ranks unless each of them can write the file. MPI may wait for ever for one that cannot, so
/// that is asked first.
std::unique_ptr<SharedFile> opened_by_all(const FileOfAll& file, Ranks& ranks) {
    const bool sees = inode_of(file.name) == file.inode && os::may_write(file.name);
    if (file.name.empty() || ranks.any(!sees)) return nullptr;
    std::unique_ptr<SharedFile> opened = ranks.open_shared(file.name);
    return ranks.any(!opened) ? nullptr : std::move(opened);
}

/// One stretch after the other, each rank's behind that of the rank before.
class StretchWriter {
public:
    /// `path`: for messages.
    StretchWriter(SharedFile& file, const std::string& path, Ranks& ranks)
        : file_(file), path_(path), ranks_(ranks) {}

    std::uint64_t size() const { return size_; } ///< of the file, so far

    /// The first rank's `text`.
    void write_of_first(const std::string& text) { write(ranks_.is_first() ? text : std::string()); }

    /// `count` elements, of which the first rank gives stretch(begin, end); each rank writes format(stretch).
    void write_elements(std::size_t count,
                        const std::function<PolygonMesh(std::size_t begin, std::size_t end)>& stretch,
                        const std::function<std::string(const PolygonMesh&)>& format) {
        const std::size_t each = of_rank(count), at_once = each * static_cast<std::size_t>(ranks_.size());
        const auto of_round = [&](std::size_t begin) {
            std::vector<Ranks::Bytes> out(static_cast<std::size_t>(ranks_.size()));
            for (std::size_t r = 0; ranks_.is_first() && r < out.size() && begin < count; ++r, begin += each)
                out[r] = bytes_of_stretch(stretch(begin, std::min(count, begin + each)));
            return out;
        };
        std::vector<Ranks::Bytes> out = of_round(0);
        for (std::size_t begin = 0; begin < count; begin += at_once) {
            Interruption::poll();
            const std::vector<Ranks::Bytes> got = ranks_.exchange(std::move(out));
            out = of_round(begin + at_once); // while others are at theirs
            write(got.front().empty() ? std::string() : format(stretch_from(got.front())));
        }
    }

    void close() {
        ranks_.any(false); // who could not write tells so: closing waits for all
        refuse(file_.close());
        ranks_.any(false);
    }

private:
    /// Elements of a rank at once. What the first one has for all of them is some 25 MB, and as much again
    /// for the next round; of very many ranks each has enough to be worth a message.
    std::size_t of_rank(std::size_t count) const {
        constexpr std::size_t of_all = std::size_t{1} << 18, fewest = 4096;
        const auto ranks = static_cast<std::size_t>(ranks_.size());
        return std::min(std::max(fewest, of_all / ranks), chunk_count(count, ranks));
    }

    void write(const std::string& text) {
        const std::vector<std::uint64_t> sizes = ranks_.gather(std::uint64_t{text.size()});
        std::uint64_t offset = size_;
        for (std::size_t r = 0; r < sizes.size(); ++r) {
            if (r < static_cast<std::size_t>(ranks_.rank())) offset += sizes[r];
            size_ += sizes[r];
        }
        refuse(file_.write_at(offset, text));
    }

    void refuse(const std::string& why) const {
        if (!why.empty()) throw Error(path_, "cannot write: " + why);
    }

    SharedFile& file_;
    const std::string& path_;
    Ranks& ranks_;
    std::uint64_t size_ = 0;
};

/// All of the document; returns its size.
std::uint64_t write_stretches(StretchWriter& writer, const MeshDocument& document, const MeshCounts& counts,
                              const PolygonMesh& mesh, const VertexRows& rows, const Vec3& shift) {
    writer.write_of_first(document.head);
    for (const MeshDocument::OfVertices& row : document.vertices)
        writer.write_elements(
            counts.vertices,
            [&](std::size_t begin, std::size_t end) {
                return stretch_of_vertices(mesh, row.reads_rows ? rows : VertexRows(), shift, begin, end);
            },
            [&](const PolygonMesh& stretch) {
                const VertexRows own = rows_of(stretch);
                return formatted(stretch.vertex_count(),
                                 [&](std::string& out, std::size_t begin, std::size_t end) {
                                     row.append(out, stretch, own, begin, end);
                                 });
            });
    std::optional<PlacedStretches> placed;
    if (document.facets_have_places) placed.emplace(mesh, shift);
    writer.write_elements(
        counts.facets,
        [&](std::size_t begin, std::size_t end) {
            return placed ? placed->facets(begin, end) : stretch_of_facets(mesh, begin, end);
        },
        [&](const PolygonMesh& stretch) {
            return formatted(stretch.facet_count(),
                             [&](std::string& out, std::size_t begin, std::size_t end) {
                                 document.facets(out, stretch, begin, end);
                             });
        });
    writer.write_of_first(document.tail);
    writer.close();
    return writer.size();
}

} // namespace

WrittenMesh write_mesh_by_ranks(const std::string& path, const LinkedMesh& linked, MeshFormat format,
                                const WriteOptions& options, Ranks& ranks) {
    WrittenMesh written;
    const auto alone = [&] { return ranks.is_first() ? write_mesh(path, linked, format, options) : written; };
    if (ranks.size() == 1 || !is_document(format)) return alone();
    const PolygonMesh& mesh = linked.facets;
    std::optional<AtomicFile> temporary;
    FileOfAll own;
    if (ranks.is_first()) {
        check_consistent(path, mesh);
        const Vec3 shift = options.recentre ? recentring_shift(mesh.positions) : Vec3(0, 0, 0);
        written = precision_of(mesh.positions, shift, format, options.ascii);
        own.ascii = options.ascii || written.text_for_precision;
        own.normals = rows_held(format, linked.rows).normals, own.counts = counts_of(mesh);
        if (find_target(path).kind == OutputTarget::Kind::file) { // others cannot be opened twice
            temporary.emplace(path);
            own.name = temporary->shared_name();
            own.inode = inode_of(own.name);
        }
    }
    const FileOfAll file = told_by_first(own, ranks);
    const std::unique_ptr<SharedFile> shared = opened_by_all(file, ranks);
    if (!shared) {
        temporary.reset();
        return alone();
    }
    StretchWriter writer(*shared, path, ranks);
    VertexRows told = rows_held(format, linked.rows);
    told.normals = file.normals; // which rows there are is the same for all
    const std::uint64_t size = write_stretches(writer, document_of(format, file.counts, told, file.ascii),
                                               file.counts, mesh, told, written.shift);
    if (ranks.is_first()) temporary->check_size(size), temporary->commit();
    written.by_all_ranks = true;
    return written;
}

} // namespace hsdm

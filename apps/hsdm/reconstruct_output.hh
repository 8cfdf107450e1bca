#pragma once
// Where the meshes of `hsdm reconstruct` go, settled and checked before any work.

#include "file_claims.hh"
#include "mesh_stages.hh"
#include "reconstruct_arguments.hh"

namespace hsdm::command {

/// One mesh to write.
struct MeshTarget {
    std::string mesh; ///< "-": standard output
    MeshFormat format = MeshFormat::off;
    bool ascii = false;
    bool plain = false;   ///< positions and facets only
    std::string features; ///< empty: none
    std::string page;     ///< empty: none
    LengthUnit unit = LengthUnit::none;
    bool recentre = false; ///< mesh and features
};

class OutputPlan {
public:
    /// Makes the folders. Throws UsageError for options that do not fit together and for outputs that would
    /// destroy inputs or each other, Error for what cannot be written. `levels` as of level_range(), checked;
    /// `clouds` and `stages` are those of the arguments.
    OutputPlan(const ReconstructArguments& arguments, const std::vector<CloudFiles>& clouds,
               std::optional<std::pair<int, int>> levels, const std::vector<StageCall>& stages);

    /// `depth` is set when --levels names several.
    MeshTarget target(const std::string& input, std::optional<int> depth) const;

    /// Folder for the phases of one input: of several each has its own; empty if none is asked for.
    std::string debug_dir(const std::string& input) const;

    /// True if the mesh is written with properties: normals and classes of vertices, sharp edges.
    bool writes_properties() const;
    /// True if sharp edges or classes are written, there or into a file of their own.
    bool writes_features() const;

    /// True if something other than the summary goes to standard output, which must then stay clean.
    bool uses_standard_output() const;

private:
    void check_combinations() const;
    void check_claims(const std::vector<CloudFiles>& clouds, const std::vector<StageCall>& stages) const;
    void claim_outputs(const std::string& input, FileClaims& claims) const;
    void make_folders() const;

    const ReconstructArguments& arguments_;
    std::size_t meshes_; // without the levels of each
    std::optional<std::pair<int, int>> levels_;
    MeshFormat format_ = MeshFormat::off;
};

/// The format that --format names, else the file's extension; OFF for standard output, and for pipes and
/// devices without one. Throws UsageError.
MeshFormat format_for(const std::string& output, const std::string& format);

/// The mesh for the writers; plain: positions and facets only.
PolygonMesh polygons_to_write(const PolyMesh& mesh, bool plain);

/// What a report tells of it.
Report::Written report_of(const MeshTarget& target, const WrittenMesh& written);

/// Writes mesh and features. Throws Error.
WrittenMesh write_outputs(const MeshTarget& target, const PolyMesh& mesh);
/// The same if the mesh's polygons are at hand.
WrittenMesh write_outputs(const MeshTarget& target, const PolyMesh& mesh, PolygonMesh polygons);

} // namespace hsdm::command

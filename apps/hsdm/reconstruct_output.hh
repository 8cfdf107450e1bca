#pragma once
// Where the meshes of `hsdm reconstruct` go, settled and checked before any work.

#include "reconstruct_arguments.hh"

namespace hsdm::command {

/// One mesh to write.
struct MeshTarget {
    std::string mesh; ///< "-": standard output
    MeshFormat format = MeshFormat::off;
    bool ascii = false;
    bool plain = false;   ///< positions and facets only
    std::string features; ///< empty: none
};

class OutputPlan {
public:
    /// Throws UsageError for options that do not fit together, Error for a folder that cannot be written.
    explicit OutputPlan(const ReconstructArguments& arguments);

    /// `depth` is set when --levels names several.
    MeshTarget target(const std::string& input, std::optional<int> depth) const;

    /// True if the mesh is written with properties: normals and classes of vertices, sharp edges.
    bool writes_properties() const;
    /// True if sharp edges or classes are written, there or into a file of their own.
    bool writes_features() const;

    /// True if something other than the summary goes to standard output, which must then stay clean.
    bool uses_standard_output() const;

private:
    void check_combinations() const;
    void check_inputs() const;
    void check_folders() const;

    const ReconstructArguments& arguments_;
    MeshFormat format_ = MeshFormat::off;
};

/// Writes mesh and features. Throws Error.
void write_outputs(const MeshTarget& target, const PolyMesh& mesh);

} // namespace hsdm::command

#pragma once
// The stages a mesh goes through after its reconstruction, by name: those built in and the modules loaded at
// run time, which are called and told of the same way.

#include "hsdm/mesh_types.hh"
#include "hsdm/modules/plugin_loader.hh"

#include <functional>
#include <string>
#include <vector>

namespace hsdm {

/// A named step on a mesh.
struct Stage {
    std::string name;
    std::string description; ///< one line
    std::vector<StageOption> options;
    std::string module; ///< path of the shared library; empty for a stage that is built in
    /// Changes the mesh and returns one line on what it did. Throws OptionError and Error, `NAME: ...`; what
    /// a module leaves is checked as Plugin::process() says.
    std::function<std::string(PolyMesh&, const StageArguments&)> run;
};

/// classify, smooth-normals, decimate and so on, in the order in which they are mostly used.
const std::vector<Stage>& built_in_stages();

/// The stage of a name: one that is built in, else the module that load_plugin() finds, which runs the
/// module's constructors. Throws Error, also for a name that neither has.
Stage find_stage(const std::string& name, const std::vector<std::string>& folders = plugin_folders());

/// A stage and what it is called with.
struct StageCall {
    Stage stage;
    StageArguments arguments;
    std::string text; ///< as it was asked for

    /// Runs the stage.
    std::string operator()(PolyMesh& mesh) const { return stage.run(mesh, arguments); }
};
/// `name` or `name:key=value,key=value`, as parse_plugin_request() reads it. Throws OptionError for arguments
/// that are not as the stage's options have them, Error for a name that there is not.
StageCall parse_stage_call(const std::string& text,
                           const std::vector<std::string>& folders = plugin_folders());

} // namespace hsdm

#pragma once
// The stages a mesh goes through after its reconstruction, by name: those built in and the modules loaded at
// run time, which are called and told of the same way.

#include "hsdm/mesh_types.hh"
#include "hsdm/modules/plugin_loader.hh"
#include "hsdm/point_cloud.hh"

#include <functional>
#include <string>
#include <vector>

namespace hsdm {

/// What a stage may need to know beside its arguments.
struct StageContext {
    /// The cloud that the mesh was made of, in the mesh's own units; null where there is none.
    const PointCloud* scan = nullptr;
    /// The mesh's own units in those that its coordinates are in while the stages run: the mesh's own are
    /// the coordinates times this.
    double unit = 1;
};

/// A named step on a mesh.
struct Stage {
    std::string name;
    std::string description; ///< one line
    std::vector<StageOption> options;
    std::string module; ///< path of the shared library; empty for a stage that is built in
    /// Changes the mesh and returns one line on what it did. Throws OptionError and Error, `NAME: ...`; what
    /// a module leaves is checked as Plugin::process() says.
    std::function<std::string(PolyMesh&, const StageArguments&, const StageContext&)> run;
    /// Key of the option without which the stage takes StageContext::scan; empty for stages that never do.
    std::string instead_of_scan{};
    /// Throws OptionError `NAME: ...` for arguments of which run() would say, whatever the mesh, that they do
    /// not fit. May be empty.
    std::function<void(const StageArguments&)> check{};
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
    std::string operator()(PolyMesh& mesh, const StageContext& context = {}) const {
        return stage.run(mesh, arguments, context);
    }
    /// The files that its arguments name: values of options of the kind `file`.
    std::vector<std::string> files() const;
    /// Whether it needs StageContext::scan.
    bool takes_scan() const;
};
/// `name` or `name:key=value,key=value`, as parse_plugin_request() reads it. Throws OptionError for arguments
/// that are not as the stage's options have them, Error for a name that there is not and for a file among the
/// arguments that cannot be read. Names of files are taken from `base` on, unless that is empty.
StageCall parse_stage_call(const std::string& text,
                           const std::vector<std::string>& folders = plugin_folders(),
                           const std::string& base = "");

} // namespace hsdm

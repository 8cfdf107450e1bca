#pragma once
// --stage: what a mesh goes through before it is written.

#include "hsdm/mesh_types.hh"
#include "hsdm/reconstruct.hh"
#include "hsdm/stages/stages.hh"

namespace hsdm::command {

class FileClaims;

/// The stages asked for, in their order; modules are loaded. Names of files among their arguments are taken
/// from `folder` on, unless that is empty. Throws OptionError and Error as parse_stage_call() does.
std::vector<StageCall> parse_stages(const std::vector<std::string>& texts, const std::string& folder = "");

/// Claims the files that the stages are loaded from, and those that they read.
void claim_stage_files(const std::vector<StageCall>& stages, FileClaims& claims);

/// Whether one of them takes the cloud that the mesh was made of.
bool take_scan(const std::vector<StageCall>& stages);

/// A power of two in which the lengths of a mesh of extreme size are measured while its stages, which
/// multiply them, run; 1 for others.
double unit_for_stages(const Box& box);
/// What to say of it: the stages' options are lengths, too.
std::string words_of_unit(const std::string& input, double unit);

/// Runs one stage on the mesh of an input; crashes and errors name both. Returns what it did and how long it
/// took. Throws Error and OptionError.
Report::Stage run_stage(const std::string& input, const StageCall& stage, PolyMesh& mesh,
                        const StageContext& context);

/// What is kept of a cloud for stages that come when it is gone: its positions if the mesh is `measured`
/// again, all of it if a stage takes it.
PointCloud scan_for_stages(const std::vector<StageCall>& stages, const PointCloud& cloud, bool measured);

/// Runs the stages on a reconstruction and notes them in its report, which is brought up to date for the mesh
/// that they leave: error and mesh are measured again if `measured`. `scan` is that of scan_for_stages().
void run_stages(const std::string& input, const std::vector<StageCall>& stages, const PointCloud& scan,
                bool measured, bool quiet, Reconstruction& result);

} // namespace hsdm::command

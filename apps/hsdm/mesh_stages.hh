#pragma once
// --stage: what a mesh goes through before it is written.

#include "hsdm/mesh_types.hh"
#include "hsdm/reconstruct.hh"
#include "hsdm/stages/stages.hh"

#include <span>

namespace hsdm::command {

class FileClaims;

/// The stages asked for, in their order; modules are loaded. Throws OptionError and Error as
/// parse_stage_call() does.
std::vector<StageCall> parse_stages(const std::vector<std::string>& texts);

/// Claims the files that the stages are loaded from.
void claim_modules(const std::vector<StageCall>& stages, FileClaims& claims);

/// A power of two in which the lengths of a mesh of extreme size are measured while its stages, which
/// multiply them, run; 1 for others.
double unit_for_stages(const Box& box);
/// What to say of it: the stages' options are lengths, too.
std::string words_of_unit(const std::string& input, double unit);

/// Runs one stage on the mesh of an input; crashes and errors name both. Returns what it did and how long it
/// took. Throws Error and OptionError.
Report::Stage run_stage(const std::string& input, const StageCall& stage, PolyMesh& mesh);

/// Runs the stages on a reconstruction and notes them in its report, which is brought up to date for the mesh
/// that they leave: error and mesh are measured again if points, those of the cloud, are given.
void run_stages(const std::string& input, const std::vector<StageCall>& stages, std::span<const Vec3> points,
                bool quiet, Reconstruction& result);

} // namespace hsdm::command

#pragma once
// The stage that gives a mesh what the points of a cloud carry.

#include "hsdm/plugin.hh"
#include "hsdm/stages/stages.hh"

/// What it does and its options, as HSDM_PLUGIN wants them.
#define HSDM_TRANSFER_DESCRIPTION "gives vertices the colours and scalars of a cloud's nearest points"
#define HSDM_TRANSFER_OPTIONS                                                                                \
    "cloud= (file): whose points, without it those that the mesh was reconstructed from; "                   \
    "format= (text): of the file, where its content and name do not tell, as --input-format; "               \
    "columns= (text): of a table, as --columns, with a backslash before each comma; "                        \
    "neighbors=8 (count): nearest points whose mean a vertex gets; "                                         \
    "max-distance= (length): points farther away have no part; "                                             \
    "missing-value= (number): of scalars where no point has a part, without it nan; "                        \
    "colors=yes (yes|no): red, green, blue, alpha; "                                                         \
    "scalars=yes (yes|no): under their own names; "                                                          \
    "normals=no (yes|no): too, if the cloud's are on one side of the surface"

namespace hsdm {

/// transfer_attributes() from the file `cloud`, or else from the context's scan; points without finite
/// coordinates are left out. Throws OptionError, as check_transfer_options() and where there is neither file
/// nor scan; Error as read_points() and for a cloud that has nothing of what is asked for.
std::string transfer_stage(PolyMesh& mesh, const PluginOptions& options, const StageContext& context);

/// Throws OptionError for options that no mesh and no cloud make right.
void check_transfer_options(const PluginOptions& options);

} // namespace hsdm

#include "hsdm/errors.hh"
#include "hsdm/features/HoleFillerT.hh"
#include "hsdm/mesh/small_components.hh"
#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/mesh/triangle_mesh.hh"
#include "hsdm/stages/decimate_mesh.hh"
#include "hsdm/stages/feature_stages.hh"
#include "hsdm/stages/pair_triangles.hh"
#include "hsdm/stages/stages.hh"
#include "hsdm/stages/transfer_stage.hh"

#include <algorithm>
#include <cmath>

namespace hsdm {
namespace {

/// A count with its word, which is in the plural unless the count is one.
std::string counted(std::size_t count, const std::string& word) {
    return std::to_string(count) + " " + word + (count == 1 ? "" : "s");
}

std::size_t triangles_of(const PolyMesh& mesh) {
    std::size_t count = 0;
    for (const auto f : mesh.faces()) count += f.valence() - 2;
    return count;
}

std::string decimate_stage(PolyMesh& mesh, const PluginOptions& options) {
    if (!options.has("facets") && !options.has("ratio") && !options.has("max-error"))
        throw OptionError("one of facets, ratio and max-error says when to stop");
    if (options.has("facets") && options.has("ratio"))
        throw OptionError("facets and ratio both say how many are left; give one");
    DecimationOptions decimation;
    decimation.facets = static_cast<std::size_t>(options.count("facets", 0));
    if (options.has("ratio"))
        decimation.facets = static_cast<std::size_t>(
            std::ceil(options.number("ratio", 1) * static_cast<double>(triangles_of(mesh))));
    decimation.max_error = options.number("max-error", decimation.max_error);
    decimation.crease_angle = options.angle("crease-degrees", decimation.crease_angle);
    decimation.corner_angle = options.angle("corner-degrees", decimation.corner_angle);
    const DecimationCounts counts = decimate_mesh(mesh, decimation);
    return std::to_string(counts.after) + " of " + counted(counts.before, "triangle") + " left";
}

std::string fill_holes_stage(PolyMesh& mesh, const PluginOptions& options) {
    FillHolesOptions filling;
    filling.max_edges = options.count("max-edges", FillHolesOptions::no_limit);
    filling.max_diameter = options.number("max-diameter", filling.max_diameter);
    HoleFillerT<PolyMesh> filler(mesh);
    filler.initialize(filling);
    const std::size_t before = mesh.n_faces();
    const FillHolesCounts counts = filler.fill();
    for (std::size_t f = before; f < mesh.n_faces(); ++f)
        mesh.update_normal(mesh.face_handle(static_cast<unsigned>(f)));
    return std::to_string(counts.closed) + " of " + counted(counts.loops, "hole") + " closed by "
           + counted(counts.facets, "facet");
}

std::string drop_components_stage(PolyMesh& mesh, const PluginOptions& options) {
    if (!options.has("facets") && !options.has("share"))
        throw OptionError("facets or share says which components are small");
    const SmallComponentFacets small =
        find_small_components(to_polygons(mesh), {options.number("facets", 0), options.number("share", 0)});
    std::size_t at = 0; // to_polygons() keeps the order of facets
    for (const auto f : mesh.faces())
        if (small.facets[at++]) mesh.delete_face(f, true);
    mesh.garbage_collection();
    return counted(small.components, "component") + " of "
           + counted(static_cast<std::size_t>(std::ranges::count(small.facets, 1)), "facet") + " dropped";
}

std::string triangulate_stage(PolyMesh& mesh, const PluginOptions&) {
    const std::size_t before = mesh.n_faces();
    mesh = triangle_mesh(mesh);
    return counted(before, "facet") + " cut into " + counted(mesh.n_faces(), "triangle");
}

std::string quads_stage(PolyMesh& mesh, const PluginOptions& options) {
    PairingOptions pairing;
    pairing.max_bend = options.angle("bend-degrees", pairing.max_bend);
    pairing.max_skew = options.angle("skew-degrees", pairing.max_skew);
    const std::size_t quads = pair_triangles(mesh, pairing);
    return counted(quads, "pair") + " of triangles joined, " + counted(mesh.n_faces(), "facet") + " left";
}

/// Calls function(options) with arguments that fit; messages on options begin with the stage's name.
template <class Function>
auto with_options(const std::string& name, const std::vector<StageOption>& declared,
                  const StageArguments& given, const Function& function) {
    check_stage_arguments(name, declared, given);
    std::vector<PluginOption> plain;
    for (const auto& [key, value] : given) plain.push_back({key.c_str(), value.c_str()});
    try {
        return function(PluginOptions(plain.data(), plain.size()));
    } catch (const OptionError& error) {
        throw OptionError(name + ": " + error.what());
    }
}

Stage built_in(const std::string& name, const std::string& description, std::string_view options,
               PluginFunction function) {
    const auto declared = parse_stage_options(options);
    const auto run = [name, declared, function](PolyMesh& mesh, const StageArguments& given,
                                                const StageContext&) {
        return with_options(name, declared, given,
                            [&](const PluginOptions& checked) { return function(mesh, checked); });
    };
    return {name, description, declared, "", run};
}

Stage transfer_as_stage() {
    const std::string name = "transfer";
    const auto declared = parse_stage_options(HSDM_TRANSFER_OPTIONS);
    Stage stage{name, HSDM_TRANSFER_DESCRIPTION, declared, "", {}, "cloud", {}};
    stage.run = [name, declared](PolyMesh& mesh, const StageArguments& given, const StageContext& context) {
        return with_options(name, declared, given, [&](const PluginOptions& options) {
            return transfer_stage(mesh, options, context);
        });
    };
    stage.check = [name, declared](const StageArguments& given) {
        with_options(name, declared, given,
                     [](const PluginOptions& options) { check_transfer_options(options); });
    };
    return stage;
}

} // namespace

const std::vector<Stage>& built_in_stages() {
    static const std::vector<Stage> stages{
        built_in("classify", HSDM_CLASSIFY_DESCRIPTION, HSDM_CLASSIFY_OPTIONS, classify_stage),
        built_in("smooth-normals", HSDM_SMOOTH_NORMALS_DESCRIPTION, HSDM_SMOOTH_NORMALS_OPTIONS,
                 smooth_normals_stage),
        built_in("decimate",
                 "collapses edges, quadric errors first; sharp edges marked and the boundary stay",
                 "facets= (count): triangles to come down to; "
                 "ratio= (share): the same as a share of the triangles there are; "
                 "max-error= (length): no vertex comes to lie farther from the mesh; "
                 "crease-degrees=35 (angle): no unmarked edge becomes sharper; "
                 "corner-degrees=60 (angle): no crease or boundary turns by more where a vertex goes",
                 decimate_stage),
        built_in("smooth", HSDM_SMOOTH_DESCRIPTION, HSDM_SMOOTH_OPTIONS, smooth_stage),
        built_in("subdivide", HSDM_SUBDIVIDE_DESCRIPTION, HSDM_SUBDIVIDE_OPTIONS, subdivide_stage),
        built_in(
            "fill-holes", "closes holes by facets over their own vertices",
            "max-edges= (count): holes of more stay, 3 or more; max-diameter= (length): larger holes stay",
            fill_holes_stage),
        built_in("drop-components", "drops small components, never the largest",
                 "facets= (count): those of fewer facets go; share= (share): those of less of the largest "
                 "one's area go",
                 drop_components_stage),
        built_in("triangulate", "cuts every facet into triangles", "", triangulate_stage),
        built_in("quads", "joins pairs of triangles to quads, never across a sharp edge marked",
                 "bend-degrees=20 (angle): pairs that bend more stay triangles; "
                 "skew-degrees=60 (angle): a quad's corners differ by less from right angles",
                 quads_stage),
        transfer_as_stage(),
    };
    return stages;
}

} // namespace hsdm

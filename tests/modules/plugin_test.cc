#include "features/meshes.hh"
#include "hsdm/errors.hh"
#include "hsdm/features/features.hh"
#include "hsdm/mesh/check_links.hh"
#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/mesh/vertex_normals.hh"
#include "hsdm/modules/plugin_loader.hh"
#include "modules/own_modules.hh"
#include "support/meshes.hh"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <sys/stat.h>
#include <unistd.h>

using namespace hsdm;
using Catch::Matchers::Contains;
using hsdm::test::OwnModules;
using Options = StageArguments;

namespace {

namespace fs = std::filesystem;

std::string refusal(const std::string& name, const std::vector<std::string>& folders) {
    try {
        load_plugin(name, folders);
    } catch (const Error& error) {
        return error.what();
    }
    return "not refused";
}

std::string problems(const std::vector<PluginListing>& listings) {
    std::string text;
    for (const PluginListing& listing : listings) text += listing.problem;
    return text;
}

} // namespace

TEST_CASE("a module is found in its folder and tells what it is") {
    const OwnModules folders(HSDM_MODULE_DIR);
    const Plugin plugin = load_plugin("classify-features", folders);
    CHECK(plugin.name() == "classify-features");
    CHECK_FALSE(plugin.description().empty());
    REQUIRE(plugin.options().size() == 3);
    CHECK(plugin.options()[0].key == "crease-degrees");
    CHECK(plugin.options()[0].fallback == "35");
}

TEST_CASE("classify-features does what the library does") {
    const OwnModules folders(HSDM_MODULE_DIR);
    PolyMesh by_module = to_mesh(support::divided_cube(4)).mesh, by_library = by_module;
    const std::string summary = load_plugin("classify-features", folders).process(by_module);
    CHECK(summary == "48 sharp edges; vertices: 54 smooth, 36 edge, 8 corner");
    classify_features(by_library);
    CHECK(feature_lines(by_module) == feature_lines(by_library));
    // Properties made by the module are the program's own kind.
    CHECK(OpenMesh::hasProperty<OpenMesh::VertexHandle, VertexNormalsT<PolyMesh>>(by_module, "hsdm_normals"));
    CHECK(to_polygons(by_module).properties.size() == to_polygons(by_library).properties.size());
}

TEST_CASE("smooth-normals after classify-features leaves a cube's normals alone") {
    const OwnModules folders(HSDM_MODULE_DIR);
    PolyMesh mesh = to_mesh(support::divided_cube(4)).mesh;
    load_plugin("classify-features", folders).process(mesh, {{"crease-degrees", "80"}});
    const std::string summary = load_plugin("smooth-normals", folders).process(mesh, {{"rounds", "5"}});
    CHECK(summary == "5 rounds; normals of 0 of 96 facets still turn");
    const auto normals =
        OpenMesh::getProperty<OpenMesh::VertexHandle, VertexNormalsT<PolyMesh>>(mesh, "hsdm_normals");
    for (const auto v : mesh.vertices()) CHECK(normals[v][0].max_abs() == Approx(1));
}

TEST_CASE("the module that the documentation shows works") {
    PolyMesh mesh = to_mesh(support::divided_cube(1)).mesh;
    const Plugin scale = load_plugin("scale", OwnModules(HSDM_EXAMPLE_DIR));
    CHECK(scale.process(mesh, {{"factor", "25.4"}}) == "scaled by 25.4");
    for (const auto v : mesh.vertices()) CHECK(mesh.point(v).max_abs() == 25.4);
}

TEST_CASE("a module's options are checked: unknown, twice, no number, out of range") {
    const OwnModules folders(HSDM_MODULE_DIR);
    PolyMesh mesh = to_mesh(support::divided_cube(1)).mesh;
    const Plugin plugin = load_plugin("classify-features", folders);
    const auto process = [&](const Options& options) { plugin.process(mesh, options); };
    CHECK_THROWS_WITH(process({{"crease", "80"}}), Contains("unknown option") && Contains("crease-degrees"));
    CHECK_THROWS_WITH(process({{"crease-degrees", "1"}, {"crease-degrees", "2"}}), Contains("twice"));
    CHECK_THROWS_AS(process({{"crease-degrees", "steep"}}), OptionError);
    CHECK_THROWS_AS(process({{"crease-degrees", "30x"}}), OptionError);
    CHECK_THROWS_AS(process({{"crease-degrees", ""}}), OptionError);
    CHECK_THROWS_WITH(
        process({{"crease-degrees", "400"}}),
        "classify-features: crease-degrees 400: must be an angle above 0 and below 180 degrees");
    for (const char* edge : {"0", "-0", "180", "1e-323"})
        CHECK_THROWS_WITH(process({{"corner-degrees", edge}}),
                          std::string("classify-features: corner-degrees ") + edge
                              + ": must be an angle above 0 and below 180 degrees");
    CHECK_NOTHROW(process({{"corner-degrees", "179.99999999999997"}}));
    CHECK_THROWS_WITH(process({{"confirmation-rounds", "-1"}}),
                      "classify-features: confirmation-rounds -1: must be a whole number, 0 or more");
    CHECK_THROWS_AS(load_plugin("smooth-normals", folders).process(mesh, {{"rounds", "1.5"}}), OptionError);
}

TEST_CASE("what is no module is refused with the reason") {
    const OwnModules odd(HSDM_ODD_MODULE_DIR);
    CHECK_THAT(refusal("absent", odd), Contains("no module of this name") && Contains("wrong_build"));
    CHECK_THAT(refusal("./absent.so", odd), Contains("./absent.so: no such file"));
    CHECK_THAT(refusal("not_a_module", odd), Contains("is not an hsdm module"));
    CHECK_THAT(refusal("no_function", odd), Contains("does not export hsdm_plugin"));
    CHECK_THAT(refusal("wrong_interface", odd), Contains("interface 4711"));
    CHECK_THAT(refusal("wrong_build", odd), Contains("compiler of old") && Contains("build it the same way"));
    CHECK_THAT(refusal("debug_mode", odd), Contains("is built with containers checked (_GLIBCXX_DEBUG), this "
                                                    "hsdm with containers unchecked; build it the same way"));
    std::ofstream(odd / "text.so") << "not even a shared library\n";
    CHECK_THAT(refusal("text", odd), Contains("text.so: is not an hsdm module"));
    fs::create_directory(odd / "folder.so");
    CHECK_THAT(refusal("folder", odd), Contains("is no regular file"));
}

TEST_CASE("a module with assertions runs in a program without, and the other way about") {
    PolyMesh mesh = to_mesh(support::divided_cube(2)).mesh;
    const Plugin other = load_plugin("other_assertions", OwnModules(HSDM_ODD_MODULE_DIR));
#ifdef NDEBUG
    CHECK(other.process(mesh) == "96 corners, assertions on");
#else
    CHECK(other.process(mesh) == "96 corners, assertions off");
#endif
    CHECK(mesh.n_faces() == 48);
    CHECK(fault_of(mesh).empty());
}

TEST_CASE("no code of a module runs when it is listed, nor when it is of another build") {
    const OwnModules odd(HSDM_ODD_MODULE_DIR);
    const std::string trace = odd / "loaded";
    setenv("HSDM_TEST_LOADED", trace.c_str(), 1);
    const auto listed = list_plugins(odd);
    const std::string refused = refusal("wrong_build", odd);
    const bool ran_unasked = fs::exists(trace);
    load_plugin("failing", odd);
    const bool ran = fs::exists(trace);
    unsetenv("HSDM_TEST_LOADED");
    CHECK_FALSE(ran_unasked);
    CHECK(ran);
    CHECK_THAT(refused, Contains("compiler of old"));
    const auto failing = std::find_if(listed.begin(), listed.end(),
                                      [](const PluginListing& one) { return one.name == "failing"; });
    REQUIRE(failing != listed.end());
    CHECK(failing->description == "always fails");
    REQUIRE(failing->options.size() == 1);
    CHECK(failing->options[0].help == "with a long message");
}

TEST_CASE("a pipe, a folder and a loose link among the modules are passed by") {
    const OwnModules folders(HSDM_MODULE_DIR);
    REQUIRE(mkfifo((folders / "pipe.so").c_str(), 0600) == 0);
    fs::create_directory(folders / "folder.so");
    fs::create_symlink("nowhere", folders / "loose.so");
    CHECK(list_plugins(folders).size() == 2);
    CHECK_THAT(refusal("pipe", folders), Contains("is no regular file"));
    CHECK_THAT(refusal(folders / "pipe.so", folders), Contains("is no regular file"));
    fs::create_symlink(folders / "smooth-normals.so", folders / "linked.so");
    CHECK(load_plugin("linked", folders).name() == "smooth-normals");
}

TEST_CASE("modules that others could have written are refused, by name, by path and in the list") {
    const OwnModules folders(HSDM_MODULE_DIR);
    const std::string file = folders / "smooth-normals.so";
    fs::permissions(file, fs::perms::group_write, fs::perm_options::add);
    CHECK_THAT(refusal("smooth-normals", folders), Contains("by its group") && Contains("chmod g-w"));
    CHECK_THAT(problems(list_plugins(folders)), Contains("smooth-normals.so can be written by its group"));
    CHECK(load_plugin("classify-features", folders).name() == "classify-features");
    fs::permissions(file, fs::perms::owner_all);
    fs::permissions(folders / "", fs::perms::others_write, fs::perm_options::add);
    CHECK_THAT(refusal("smooth-normals", folders), Contains("can be written by everybody"));
    CHECK_THAT(refusal(file, {}), Contains("can be written by everybody"));
    const auto listed = list_plugins(folders);
    REQUIRE(listed.size() == 1);
    CHECK_THAT(listed[0].problem, Contains("nothing is loaded from here"));
}

TEST_CASE("a module that throws becomes an error of the program, its message cut to fit") {
    PolyMesh mesh;
    const Plugin plugin = load_plugin("failing", OwnModules(HSDM_ODD_MODULE_DIR));
    CHECK_THROWS_WITH(plugin.process(mesh), "failing: out of luck");
    try {
        plugin.process(mesh, {{"long", ""}});
        FAIL("did not throw");
    } catch (const Error& error) {
        CHECK(std::string(error.what()).size() < 1100);
    }
}

TEST_CASE("a mesh that a module leaves unsound is an error that names the module and what is wrong") {
    const Plugin ill = load_plugin("ill", OwnModules(HSDM_ODD_MODULE_DIR));
    const auto left = [&](const char* how) {
        PolyMesh mesh = to_mesh(support::divided_cube(3)).mesh;
        try {
            ill.process(mesh, {{"how", how}});
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    CHECK(left("nothing").empty());
    CHECK(left("delete").empty());
    for (const char* how : {"next", "far-vertex", "far-face", "other-face", "no-side", "other-side",
                            "half-deleted", "released", "nan", "empty", "clear"}) {
        INFO(how);
        CHECK_THAT(left(how), Catch::Matchers::StartsWith("ill: left "));
    }
    CHECK_THAT(left("nan"), Contains("vertex 5 at no finite position"));
    CHECK_THAT(left("empty"), Contains("without faces"));
    PolyMesh mesh = to_mesh(support::divided_cube(3)).mesh;
    ill.process(mesh, {{"how", "nan-normal"}});
    CHECK(mesh.normal(OpenMesh::VertexHandle(5)) == Vec3(0, 0, 0));
}

TEST_CASE("meshes that OpenMesh's own operations leave are sound") {
    PolyMesh mesh = to_mesh(test::sphere(6)).mesh;
    CHECK(fault_of(mesh) == "");
    CHECK(fault_of(PolyMesh()) == "");
    for (int f : {3, 4, 50, 51, 100}) mesh.delete_face(OpenMesh::FaceHandle(f), f % 2 == 0);
    CHECK(fault_of(mesh) == "");
    mesh.garbage_collection();
    mesh.add_vertex({5, 5, 5});
    mesh.triangulate();
    CHECK(fault_of(mesh) == "");
    for (int e = 0; e < 200; e += 7) {
        const auto h = mesh.halfedge_handle(OpenMesh::EdgeHandle(e), 0);
        if (!mesh.status(mesh.edge_handle(h)).deleted() && mesh.is_collapse_ok(h)) mesh.collapse(h);
    }
    CHECK(fault_of(mesh) == "");
    mesh.garbage_collection();
    CHECK(fault_of(mesh) == "");
}

TEST_CASE("the listing names usable modules and tells why others are not") {
    const auto good = list_plugins(OwnModules(HSDM_MODULE_DIR));
    REQUIRE(good.size() == 2);
    CHECK(good[0].name == "classify-features");
    CHECK(good[1].name == "smooth-normals");
    CHECK(problems(good).empty());
    std::size_t refused = 0;
    for (const PluginListing& one : list_plugins(OwnModules(HSDM_ODD_MODULE_DIR)))
        refused += !one.problem.empty();
    CHECK(refused == 4);
    CHECK(list_plugins({"/nowhere/at/all"}).empty());
}

TEST_CASE("HSDM_PLUGIN_PATH comes before the folder of the installation, the only other one") {
    setenv("HSDM_PLUGIN_PATH", R"(/first::/sec\:ond:/th\\ird\)", 1);
    const auto all = plugin_folders();
    unsetenv("HSDM_PLUGIN_PATH");
    CHECK(all == std::vector<std::string>{"/first", "/sec:ond", "/th\\ird\\", HSDM_INSTALLED_MODULE_DIR});
    CHECK(plugin_folders() == std::vector<std::string>{HSDM_INSTALLED_MODULE_DIR});
}

TEST_CASE("a request reads name:key=value,key=value") {
    CHECK(parse_plugin_request("smooth-normals").name == "smooth-normals");
    CHECK(parse_plugin_request("smooth-normals").arguments.empty());
    const auto request = parse_plugin_request("a:b=1,c=,d=x=y");
    CHECK(request.name == "a");
    CHECK(request.arguments == Options{{"b", "1"}, {"c", ""}, {"d", "x=y"}});
    for (const char* wrong : {"", ":a=1", "a:", "a:b", "a:=1", "a:b=1,", "a:b=1,,c=2"})
        CHECK_THROWS_AS(parse_plugin_request(wrong), OptionError);
}

TEST_CASE("a colon in a module's path is told from the one before the options") {
    CHECK(parse_plugin_request(R"(./a\:b/x.so:c=1)").name == "./a:b/x.so");
    CHECK(parse_plugin_request(R"(a\\b:c=1)").name == R"(a\b)");
    const auto commas = parse_plugin_request(R"(a:b=x\,y,c=\d\\,e=\)").arguments;
    CHECK(commas == StageArguments{{"b", "x,y"}, {"c", R"(\d\)"}, {"e", "\\"}});
    const OwnModules folder(HSDM_EXAMPLE_DIR);
    fs::create_directory(folder / "a:b");
    fs::rename(folder / "scale.so", folder / "a:b/scale:2.so");
    const auto request = parse_plugin_request((folder / "a:b/scale:2.so") + ":factor=3");
    CHECK(request.arguments == Options{{"factor", "3"}});
    CHECK(load_plugin(request.name).name() == "scale");
    CHECK(parse_plugin_request(folder / "a:b/scale:2.so").name == folder / "a:b/scale:2.so");
}

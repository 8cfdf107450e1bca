#include "features/meshes.hh"
#include "hsdm/errors.hh"
#include "hsdm/facets/to_mesh.hh"
#include "hsdm/features/features.hh"
#include "hsdm/features/vertex_normals.hh"
#include "hsdm/plugin_loader.hh"

#include <catch2/catch.hpp>

#include <cstdlib>
#include <fstream>

using namespace hsdm;
using Catch::Matchers::Contains;
using Options = std::vector<std::pair<std::string, std::string>>;

namespace {

const std::vector<std::string> folders{HSDM_MODULE_DIR};
const std::vector<std::string> odd_folders{HSDM_ODD_MODULE_DIR};

std::string refusal(const std::string& name) {
    try {
        load_plugin(name, odd_folders);
    } catch (const Error& error) {
        return error.what();
    }
    return "not refused";
}

} // namespace

TEST_CASE("the modules are found beside the program without being told where") {
    const Plugin plugin = load_plugin("classify-features");
    CHECK(plugin.name() == "classify-features");
    CHECK_FALSE(plugin.description().empty());
    CHECK_THAT(plugin.options(), Contains("crease-degrees"));
}

TEST_CASE("classify-features does what the library does") {
    PolyMesh by_module = to_mesh(test::cube(4)).mesh, by_library = by_module;
    const std::string summary = load_plugin("classify-features", folders).process(by_module);
    CHECK(summary == "48 sharp edges; vertices: 54 smooth, 36 edge, 8 corner");
    classify_features(by_library);
    CHECK(feature_lines(by_module) == feature_lines(by_library));
    // Properties made by the module are the program's own kind.
    CHECK(OpenMesh::hasProperty<OpenMesh::VertexHandle, VertexNormalsT<PolyMesh>>(by_module, "hsdm_normals"));
    CHECK(to_polygons(by_module).properties.size() == to_polygons(by_library).properties.size());
}

TEST_CASE("smooth-normals after classify-features leaves a cube's normals alone") {
    PolyMesh mesh = to_mesh(test::cube(4)).mesh;
    load_plugin("classify-features", folders).process(mesh, {{"crease-degrees", "80"}});
    const std::string summary = load_plugin("smooth-normals", folders).process(mesh, {{"rounds", "5"}});
    CHECK(summary == "5 rounds; normals of 0 of 96 facets still turn");
    const auto normals =
        OpenMesh::getProperty<OpenMesh::VertexHandle, VertexNormalsT<PolyMesh>>(mesh, "hsdm_normals");
    for (const auto v : mesh.vertices()) CHECK(normals[v][0].max_abs() == Approx(1));
}

TEST_CASE("the module that the documentation shows works") {
    PolyMesh mesh = to_mesh(test::cube(1)).mesh;
    const Plugin scale = load_plugin("scale", {HSDM_EXAMPLE_DIR});
    CHECK(scale.process(mesh, {{"factor", "25.4"}}) == "scaled by 25.4");
    for (const auto v : mesh.vertices()) CHECK(mesh.point(v).max_abs() == 25.4);
}

TEST_CASE("a module's options are checked: unknown, twice, no number, out of range") {
    PolyMesh mesh = to_mesh(test::cube(1)).mesh;
    const Plugin plugin = load_plugin("classify-features", folders);
    const auto process = [&](const Options& options) { plugin.process(mesh, options); };
    CHECK_THROWS_WITH(process({{"crease", "80"}}), Contains("unknown option") && Contains("crease-degrees"));
    CHECK_THROWS_WITH(process({{"crease-degrees", "1"}, {"crease-degrees", "2"}}), Contains("twice"));
    CHECK_THROWS_AS(process({{"crease-degrees", "steep"}}), OptionError);
    CHECK_THROWS_AS(process({{"crease-degrees", "30x"}}), OptionError);
    CHECK_THROWS_AS(process({{"crease-degrees", ""}}), OptionError);
    CHECK_THROWS_AS(process({{"crease-degrees", "200"}}), OptionError);
    CHECK_THROWS_AS(load_plugin("smooth-normals", folders).process(mesh, {{"rounds", "1.5"}}), OptionError);
}

TEST_CASE("what is no module is refused with the reason") {
    CHECK_THAT(refusal("absent"), Contains("no module of this name") && Contains("wrong_build"));
    CHECK_THAT(refusal("./absent.so"), Contains("./absent.so: no such file"));
    CHECK_THAT(refusal("not_a_module"), Contains("does not export hsdm_plugin"));
    CHECK_THAT(refusal("wrong_interface"), Contains("interface 4711"));
    CHECK_THAT(refusal("wrong_build"), Contains("compiler of old") && Contains("build it the same way"));
    const std::string text = std::string(HSDM_ODD_MODULE_DIR) + "/text.so";
    std::ofstream(text) << "not even a shared library\n";
    CHECK_THAT(refusal("text"), Contains("text.so: cannot be loaded"));
    std::remove(text.c_str());
}

TEST_CASE("a module that throws becomes an error of the program, its message cut to fit") {
    PolyMesh mesh;
    const Plugin plugin = load_plugin("failing", odd_folders);
    CHECK_THROWS_WITH(plugin.process(mesh), "failing: out of luck");
    try {
        plugin.process(mesh, {{"long", ""}});
        FAIL("did not throw");
    } catch (const Error& error) {
        CHECK(std::string(error.what()).size() < 1100);
    }
}

TEST_CASE("the listing names usable modules and tells why others are not") {
    const auto good = list_plugins(folders);
    REQUIRE(good.size() == 2);
    CHECK(good[0].name == "classify-features");
    CHECK(good[1].name == "smooth-normals");
    CHECK((good[0].problem + good[1].problem).empty());
    std::size_t refused = 0;
    for (const PluginListing& listing : list_plugins(odd_folders)) refused += !listing.problem.empty();
    CHECK(refused == 3);
    CHECK(list_plugins({"/nowhere/at/all"}).empty());
}

TEST_CASE("HSDM_PLUGIN_PATH comes before the program's own folder") {
    setenv("HSDM_PLUGIN_PATH", "/first::/second", 1);
    const auto all = plugin_folders();
    unsetenv("HSDM_PLUGIN_PATH");
    REQUIRE(all.size() == 4);
    CHECK(all[0] == "/first");
    CHECK(all[1] == "/second");
    CHECK(plugin_folders().size() == 2);
}

TEST_CASE("a request reads name:key=value,key=value") {
    CHECK(parse_plugin_request("smooth-normals").name == "smooth-normals");
    CHECK(parse_plugin_request("smooth-normals").options.empty());
    const auto request = parse_plugin_request("a:b=1,c=,d=x=y");
    CHECK(request.name == "a");
    CHECK(request.options == Options{{"b", "1"}, {"c", ""}, {"d", "x=y"}});
    for (const char* wrong : {"", ":a=1", "a:", "a:b", "a:=1", "a:b=1,", "a:b=1,,c=2"})
        CHECK_THROWS_AS(parse_plugin_request(wrong), OptionError);
}

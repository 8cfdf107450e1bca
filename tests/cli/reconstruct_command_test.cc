#include "cli/run.hh"
#include "cli/scan.hh"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>

using namespace hsdm;
using namespace hsdm::test;
using Json = nlohmann::json;

TEST_CASE("a scan becomes a mesh, a report and features with one command", "[cli][threads]") {
    const Folder folder;
    folder.write("scan.xyz", xyz(sphere_scan()));
    const CommandResult result =
        run(folder, "reconstruct scan.xyz --depth 4 -o part.off --report part.json --features part.txt");
    CHECK(result.status == 0);
    CHECK(result.err == "");
    for (const char* word : {"cloud", "voxels", "mesh", "topology", "error", "written"})
        CHECK(result.out.find(word) != std::string::npos);
    CHECK(std::count(result.out.begin(), result.out.end(), '\n') == 6);
    CHECK(list(folder) == "part.json\npart.off\npart.txt\nscan.xyz\n");
    const Json report = Json::parse(read_file(folder / "part.json"));
    CHECK(report["input"]["file"] == "scan.xyz");
    CHECK(report["input"]["points"] == 4000);
    CHECK(report["grid"]["depth"] == 4);
    CHECK(report["mesh"]["closed"] == true);
    CHECK(report["mesh"]["euler"] == 2);
    CHECK(report["seconds"]["total"].get<double>() > 0);
    CHECK(report["peak_memory_bytes"].get<double>() > 1e6);
}

TEST_CASE("every format is written under its extension", "[cli]") {
    const Folder folder;
    folder.write("scan.xyz", xyz(sphere_scan(1000)));
    for (const char* name : {"a.off", "a.stl", "a.ply", "a.obj", "a.om"}) {
        INFO(name);
        CHECK(run(folder, std::string("reconstruct scan.xyz --depth 3 --quiet -o ") + name).status == 0);
        CHECK(read_file(folder / name).size() > 1000);
    }
    CHECK(run(folder, "reconstruct scan.xyz --depth 3 --ascii -o text.stl").status == 0);
    CHECK(read_file(folder / "text.stl").starts_with("solid"));
    CHECK(run(folder, "reconstruct scan.xyz --depth 3 --plain -o plain.ply").status == 0);
    CHECK(read_file(folder / "a.ply").find("hsdm_vertex_class") != std::string::npos);
    CHECK(read_file(folder / "plain.ply").find("hsdm_vertex_class") == std::string::npos);
    CHECK(read_file(folder / "plain.ply").size() < read_file(folder / "a.ply").size() / 2);
}

TEST_CASE("what is written does not depend on what is told", "[cli]") {
    const Folder folder;
    folder.write("scan.xyz", xyz(sphere_scan(1000)));
    const std::string command = "reconstruct scan.xyz --depth 3 ";
    for (const char* format : {"off", "stl", "ply", "off --features f", "off --report r"}) {
        INFO(format);
        CHECK(run(folder, command + "--quiet -o quiet --format " + format).status == 0);
        CHECK(run(folder, command + "-o told --format " + format).status == 0);
        CHECK(read_file(folder / "quiet") == read_file(folder / "told"));
    }
    const std::string features = read_file(folder / "f");
    CHECK(run(folder, command + "--quiet -o quiet --format off --features f").status == 0);
    CHECK(read_file(folder / "f") == features);
}

TEST_CASE("the resolution follows the spacing of the points when none is asked for, and says why", "[cli]") {
    const Folder folder;
    folder.write("scan.xyz", xyz(sphere_scan()));
    const CommandResult result = run(folder, "reconstruct scan.xyz -o part.off --report -");
    CHECK(result.status == 0);
    const Json report = Json::parse(result.out);
    const auto resolution = report["options"]["resolution"].get<std::string>();
    CHECK(resolution.find("spacing") != std::string::npos);
    CHECK(resolution.find("the surface bends") != std::string::npos); // so small a sphere
    CHECK(report["grid"]["voxel_size"].get<double>()
          == Approx(2.4 * report["input"]["spacing"].get<double>()).epsilon(1e-6));
    CHECK(result.err.find("voxels") != std::string::npos); // the summary gave way to the report
}

TEST_CASE("a voxel size is kept exactly", "[cli]") {
    const Folder folder;
    folder.write("scan.xyz", xyz(sphere_scan()));
    const CommandResult result =
        run(folder, "reconstruct scan.xyz --voxel-size 0.17 -o a.off --quiet --report -");
    CHECK(result.status == 0);
    CHECK(Json::parse(result.out)["grid"]["voxel_size"].get<double>() == Approx(0.17).epsilon(1e-12));
}

TEST_CASE("standard input and output carry clouds and meshes, messages go to standard error", "[cli]") {
    const Folder folder;
    folder.write("scan.xyz", xyz(sphere_scan()));
    const CommandResult result =
        run(folder, "reconstruct - --input-format xyz --depth 4 -o - --format off", "cat scan.xyz |");
    CHECK(result.status == 0);
    CHECK(result.out.starts_with("OFF"));
    CHECK(result.err.find("closed") != std::string::npos);
    CHECK(run(folder, "reconstruct scan.xyz --depth 4 -o part.off --quiet").out == "");
    CHECK(read_file(folder / "part.off") == result.out);
}

TEST_CASE("many inputs: one failure does not stop the others", "[cli][threads]") {
    const Folder folder;
    folder.write("a.xyz", xyz(sphere_scan(4000)));
    folder.write("b.xyz", "1 2 3\n4 five 6\n7 8 9\n1 1 1\n");
    folder.write("c.xyz", xyz(sphere_scan(3500)));
    const CommandResult result = run(folder, "reconstruct a.xyz b.xyz c.xyz missing.xyz --depth 4 --out-dir "
                                             "meshes --format stl --report all.json");
    CHECK(result.status == 1);
    CHECK(exists(folder / "meshes/a.stl"));
    CHECK(exists(folder / "meshes/c.stl"));
    CHECK_FALSE(exists(folder / "meshes/b.stl"));
    CHECK(result.out.find("meshes/a.stl: 4,000 points") != std::string::npos);
    CHECK(result.out.find("2 of 4 inputs done, 2 failed") != std::string::npos);
    CHECK(result.err.find("hsdm: b.xyz:2: ") != std::string::npos);
    CHECK(result.err.find("missing.xyz") != std::string::npos);
    const Json reports = Json::parse(read_file(folder / "all.json"));
    REQUIRE(reports.size() == 4);
    CHECK(reports[0]["mesh"]["closed"] == true);
    CHECK(reports[1].contains("failure"));
}

TEST_CASE("levels give one mesh per depth from one octree, the same as each depth alone", "[cli][threads]") {
    const Folder folder;
    folder.write("scan.xyz", xyz(sphere_scan()));
    CHECK(run(folder, "reconstruct scan.xyz --levels 3:4 -o part.off --report levels.json").status == 0);
    CHECK(list(folder) == "levels.json\npart.d3.off\npart.d4.off\nscan.xyz\n");
    CHECK(Json::parse(read_file(folder / "levels.json")).size() == 2);
    CHECK(run(folder, "reconstruct scan.xyz --depth 3 -o alone.off").status == 0);
    CHECK(read_file(folder / "alone.off") == read_file(folder / "part.d3.off"));
}

TEST_CASE("wrong usage has status 2, a message, and leaves no file", "[cli]") {
    const Folder folder;
    folder.write("scan.xyz", xyz(sphere_scan(500)));
    const std::vector<std::string> wrong = {
        "",
        "frobnicate",
        "reconstruct",
        "reconstruct scan.xyz",
        "reconstruct scan.xyz -o a.off --depth 17",
        "reconstruct scan.xyz -o a.off --depth 0",
        "reconstruct scan.xyz -o a.off --depth five",
        "reconstruct scan.xyz -o a.off --voxel-size -1",
        "reconstruct scan.xyz -o a.off --voxel-size 1e-9",
        "reconstruct scan.xyz -o a.off --depth 4 --voxel-size 0.1",
        "reconstruct scan.xyz -o a.off --levels 4",
        "reconstruct scan.xyz -o a.off --levels 5:3",
        "reconstruct scan.xyz -o - --levels 3:4",
        "reconstruct scan.xyz -o a.xyzzy",
        "reconstruct scan.xyz -o scan.xyz --format off",
        "reconstruct scan.xyz scan.xyz --out-dir d",
        "reconstruct scan.xyz other.xyz -o a.off",
        "reconstruct scan.xyz -o - --report -",
        "reconstruct scan.xyz -o a.off --method magic",
        "reconstruct scan.xyz -o a.off --method basic --normals estimate",
        "reconstruct scan.xyz -o a.off --crease-degrees 200",
        "reconstruct scan.xyz -o a.off --threads -1",
        "reconstruct scan.xyz -o a.off --unknown",
    };
    for (const std::string& arguments : wrong) {
        INFO("hsdm " << arguments);
        const CommandResult result = run(folder, arguments);
        CHECK(result.status == 2);
        CHECK(result.err != "");
        CHECK(result.out == "");
    }
    CHECK(list(folder) == "scan.xyz\n");
}

TEST_CASE("bounded memory gives the same file, and leaves nothing on scratch", "[cli]") {
    const Folder folder;
    std::filesystem::create_directory(folder / "scratch");
    PointCloud cloud = support::sample(support::torus(1, 0.3), {.points = 60000});
    std::string text;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        char line[192];
        const Vec3 &p = cloud.positions[i], &n = cloud.normals[i];
        std::snprintf(line, sizeof line, "%.17g %.17g %.17g %.17g %.17g %.17g\n", p[0], p[1], p[2], n[0],
                      n[1], n[2]);
        text += line;
    }
    folder.write("scan.xyz", text);
    REQUIRE(run(folder, "reconstruct scan.xyz --depth 7 --quiet -o one.ply").status == 0);
    const CommandResult result =
        run(folder, "reconstruct scan.xyz --depth 7 --quiet --memory 150M --scratch scratch -o tiles.ply");
    INFO(result.err);
    CHECK(result.status == 0);
    CHECK(read_file(folder / "one.ply") == read_file(folder / "tiles.ply"));
    CHECK(std::filesystem::is_empty(folder / "scratch"));
    const CommandResult lost =
        run(folder, "reconstruct scan.xyz --depth 7 --memory 150M --scratch nowhere -o lost.ply");
    CHECK(lost.status == 1);
    CHECK(lost.err.find("nowhere") != std::string::npos);
}

TEST_CASE("what does not go with bounded memory is refused before any work", "[cli]") {
    const Folder folder;
    folder.write("scan.xyz", xyz(sphere_scan(500)));
    for (const char* option :
         {"--memory much --depth 5", "--memory 0 --depth 5", "--scratch .",
          "--memory 1M --depth 5 --merge-layers", "--resume", "--memory 1M --depth 5 --resume",
          "--memory 1M --resume --scratch . scan.xyz", "--memory 1M --levels 4:5",
          "--memory 1M --max-error 1%", "--memory 1M --depth 5 --html a.html"}) {
        const CommandResult result = run(folder, std::string("reconstruct scan.xyz -o a.off ") + option);
        INFO(option << ": " << result.err);
        CHECK(result.status == 2);
        CHECK(result.err != "");
    }
    CHECK(list(folder) == "scan.xyz\n");
}

TEST_CASE("a cloud that fits in the bounded memory is done in one piece, with any option", "[cli]") {
    const Folder folder;
    std::filesystem::create_directory(folder / "scratch");
    folder.write("scan.xyz", xyz(sphere_scan(500)));
    for (const char* option :
         {"", "--normals estimate --depth 4", "--max-error 1% --stage quads", "--merge-layers"}) {
        const std::string call = std::string("reconstruct scan.xyz --quiet ") + option;
        INFO(call);
        REQUIRE(run(folder, call + " -o one.ply").status == 0);
        const CommandResult bounded = run(folder, call + " -o bounded.ply --memory 1G --scratch scratch");
        CHECK(bounded.status == 0);
        CHECK(bounded.err == "");
        CHECK(read_file(folder / "bounded.ply") == read_file(folder / "one.ply"));
    }
    REQUIRE(run(folder, "reconstruct scan.xyz --quiet --levels 3:4 -o a.off --memory 1G").status == 0);
}

TEST_CASE("an error is kept with fewer facets, as a length or as a share of the diagonal", "[cli]") {
    const Folder folder;
    folder.write("scan.xyz", xyz(sphere_scan(3000)));
    REQUIRE(run(folder, "reconstruct scan.xyz --quiet -o fine.off --report fine.json").status == 0);
    const Json fine = Json::parse(read_file(folder / "fine.json"));
    std::size_t fewer = fine["mesh"]["faces"];
    for (const char* error : {"0.5%", "2%"}) {
        INFO(error);
        const CommandResult result =
            run(folder,
                std::string("reconstruct scan.xyz --quiet -o a.off --report a.json --max-error ") + error);
        CHECK(result.status == 0);
        const Json report = Json::parse(read_file(folder / "a.json"));
        CHECK(report["grid"]["kind"] == "adaptive");
        CHECK(report["mesh"]["closed"] == true);
        CHECK(report["mesh"]["euler"] == 2);
        CHECK(report["mesh"]["faces"] < fewer);
        CHECK(report["error"]["points_to_mesh_max"] <= report["grid"]["max_error"]);
        CHECK(report["options"]["max-error"] == error);
        fewer = report["mesh"]["faces"];
    }
    const CommandResult kept = run(folder, "reconstruct scan.xyz -o b.off --max-error 0.05");
    CHECK(kept.status == 0);
    CHECK(kept.out.find("bound     0.05: kept by all points") != std::string::npos);
    const CommandResult missed = run(folder, "reconstruct scan.xyz -o b.off --max-error 1e-5");
    CHECK(missed.status == 0); // announced: the finest surface is no nearer
    CHECK(missed.out.find("points, which the finest surface misses already") != std::string::npos);
    CHECK(run(folder, "reconstruct scan.xyz --quiet -o b.off --depth 4 --grid adaptive").status == 0);
    CHECK(run(folder, "reconstruct scan.xyz --quiet -o l.off --levels 3:4 --grid adaptive").status == 0);
    for (const char* wrong :
         {"--max-error 0", "--max-error -1%", "--max-error few", "--max-error inf", "--max-error nan",
          "--max-error 1%%", "--max-error 0.1% --depth 5", "--max-error 0.1% --grid uniform"}) {
        INFO(wrong);
        CHECK(run(folder, std::string("reconstruct scan.xyz -o c.off ") + wrong).status == 2);
    }
}

TEST_CASE("bad input has status 1, names the file, and leaves no output", "[cli]") {
    const Folder folder;
    folder.write("empty.xyz", "");
    folder.write("three.xyz", "0 0 0\n1 0 0\n0 1 0\n");
    folder.write("equal.xyz", "1 2 3\n1 2 3\n1 2 3\n1 2 3\n1 2 3\n");
    folder.write("line.xyz", "0 0 0\n1 1 1\n2 2 2\n3 3 3\n4 4 4\n5 5 5\n");
    folder.write("nan.xyz", "nan 0 0\nnan 1 0\nnan 1 1\n0 0 0\n1 0 0\n");
    const std::string before = list(folder);
    for (const char* name :
         {"empty.xyz", "three.xyz", "equal.xyz", "line.xyz", "nan.xyz", "missing.xyz", "."}) {
        const CommandResult result = run(folder, std::string("reconstruct ") + name + " -o a.off");
        INFO(name << ": " << result.err);
        CHECK(result.status == 1);
        CHECK(result.err.find(name) != std::string::npos);
        CHECK(result.err.starts_with("hsdm: "));
    }
    CHECK(list(folder) == before);
}

TEST_CASE("an output that cannot be written has status 1 and leaves what was there", "[cli]") {
    const Folder folder;
    folder.write("scan.xyz", xyz(sphere_scan()));
    CHECK(run(folder, "reconstruct scan.xyz --depth 4 -o nowhere/a.off").status == 1);
    CHECK(run(folder, "reconstruct scan.xyz --depth 4 -o .").status != 0);
    folder.write("old.off", "what was there");
    CHECK(run(folder, "reconstruct scan.xyz --normals given -o old.off").status == 1);
    CHECK(read_file(folder / "old.off") == "what was there");
    CHECK(run(folder, "reconstruct scan.xyz --depth 4 -o - >/dev/full").status == 1);
}

TEST_CASE("points that are not finite are dropped and counted", "[cli]") {
    const Folder folder;
    folder.write("scan.xyz", xyz(sphere_scan()) + "nan 0 0\n0 inf 0\n");
    const CommandResult result = run(folder, "reconstruct scan.xyz --depth 4 -o a.off --quiet --report -");
    CHECK(result.status == 0);
    const Json report = Json::parse(result.out);
    CHECK(report["input"]["dropped_nonfinite"] == 2);
    CHECK(report["input"]["points"] == 4000);
}

TEST_CASE("one or two threads and any order of the points write the same bytes", "[cli][threads]") {
    const Folder folder;
    PointCloud cloud = support::sample(support::mechanical_part(), {.points = 20000, .normals = false});
    folder.write("scan.xyz", xyz(cloud));
    std::shuffle(cloud.positions.begin(), cloud.positions.end(), std::mt19937_64(3));
    folder.write("shuffled.xyz", xyz(cloud));
    // PLY has all that the other formats have.
    const std::string tail = " --depth 5 --quiet -o - --format ply";
    const std::string one = run(folder, "reconstruct scan.xyz --threads 1" + tail).out;
    CHECK(one.size() > 10000);
    CHECK((run(folder, "reconstruct scan.xyz --threads 2" + tail).out == one));
    CHECK((run(folder, "reconstruct shuffled.xyz" + tail).out == one));
}

TEST_CASE("an interrupt ends with status 130 and no partial file", "[cli]") {
    const Folder folder;
    folder.write("scan.xyz", xyz(sphere_scan(2000)));
    // The pipe stays open, so the command waits for more points when the interrupt comes.
    const CommandResult result =
        run(folder,
            "reconstruct - --input-format xyz -o a.off --progress always <pipe 2>said & command=$!; "
            "until grep -q read said; do sleep 0.1; done; kill -INT $command; wait $command; echo status $?",
            "mkfifo pipe; (cat scan.xyz; sleep 4) >pipe &");
    CHECK(result.out.find("status 130") != std::string::npos);
    CHECK_FALSE(exists(folder / "a.off"));
}

TEST_CASE("help and version go to standard output with status 0", "[cli]") {
    const Folder folder;
    for (const char* arguments : {"--help", "--version", "reconstruct --help", "info --help",
                                  "compare --help", "process --help", "regress --help"}) {
        INFO(arguments);
        const CommandResult result = run(folder, arguments);
        CHECK(result.status == 0);
        CHECK(result.out != "");
        CHECK(result.err == "");
    }
    CHECK(run(folder, "reconstruct --help").out.find("Examples:") != std::string::npos);
}

TEST_CASE("small components are dropped when asked, and said", "[cli]") {
    const Folder folder;
    PointCloud two = sphere_scan();
    for (const Vec3& p : sphere_scan(1000).positions) two.positions.push_back(0.4 * p + Vec3(3, 0, 0));
    folder.write("scan.xyz", xyz(two));
    const auto components = [&](const std::string& options) {
        const CommandResult result =
            run(folder, "reconstruct scan.xyz --voxel-size 0.15 -o a.off --report a.json " + options);
        CHECK(result.status == 0);
        CHECK((result.out.find("1 small component dropped") != std::string::npos) == !options.empty());
        return Json::parse(read_file(folder / "a.json"))["mesh"]["components"].get<int>();
    };
    CHECK(components("") == 2);
    CHECK(components("--min-component 20%") == 1);
    CHECK(components("--min-component 100%") == 1);
    CHECK(components("--min-component 300") == 1);
    const CommandResult bounded =
        run(folder, "reconstruct scan.xyz -o a.off --max-error 0.05 --min-component 100%");
    CHECK(bounded.status == 0);
    CHECK(bounded.out.find("bound     0.05: kept by all points but those of the components dropped\n")
          != std::string::npos);
    for (const char* bad : {"x", "-1", "101%", "5 %", "nan", "inf", ""})
        CHECK(run(folder, std::string("reconstruct scan.xyz -o a.off --min-component '") + bad + "'").status
              == (*bad == '\0' ? 0 : 2));
}

TEST_CASE("an open surface faces the scanner whose place is known", "[cli]") {
    const Folder folder;
    for (const auto& [side, told] : {std::pair(-5.0, false), {5.0, false}, {-5.0, true}, {5.0, true}}) {
        // The file says where the scanner stood, or the opposite, and --sensor tells better. A sheet that is
        // nowhere seen from two regions: z = 0.2 x^2 over a square.
        std::string body, z = std::to_string(told ? -side : side);
        for (int i = 0; i < 60; ++i)
            for (int j = 0; j < 60; ++j) {
                const double x = i / 30.0 - 1, y = j / 30.0 - 1;
                body +=
                    std::to_string(x) + ' ' + std::to_string(y) + ' ' + std::to_string(0.2 * x * x) + '\n';
            }
        folder.write("scan.ply", "ply\nformat ascii 1.0\nelement camera 1\nproperty float view_px\n"
                                 "property float view_py\nproperty float view_pz\nelement vertex 3600\n"
                                 "property float x\nproperty float y\nproperty float z\nend_header\n0 0 "
                                     + z + '\n' + body);
        const std::string sensor = told ? " --sensor 0,0," + std::to_string(side) : "";
        REQUIRE(run(folder, "reconstruct" + sensor + " scan.ply --ascii -o a.stl --quiet").status == 0);
        const std::string mesh = read_file(folder / "a.stl");
        double sum = 0;
        for (std::size_t at = mesh.find("normal"); at != std::string::npos;
             at = mesh.find("normal", at + 1)) {
            double x, y, nz;
            REQUIRE(std::sscanf(mesh.c_str() + at, "normal %lf %lf %lf", &x, &y, &nz) == 3);
            sum += nz;
        }
        CHECK(sum * side > 0);
    }
}

TEST_CASE("a scanner's place that is none is wrong usage", "[cli]") {
    const Folder folder;
    folder.write("scan.xyz", xyz(sphere_scan()));
    for (const char* bad : {"--sensor 1,2", "--sensor 1,2,x", "--sensor 1,2,3,4", "--sensor-column scan",
                            "--sensor 1,2,3 --sensor 4,5,6"})
        CHECK(run(folder, std::string("reconstruct scan.xyz -o a.off ") + bad).status == 2);
    CHECK(run(folder, "reconstruct scan.xyz -o a.off --sensor 1,2,3 --sensor-column scan").status == 1);
}

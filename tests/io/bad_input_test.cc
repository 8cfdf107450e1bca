// What is no point file at all, or goes by another name: every case is a message, none a crash.
#include "hsdm/errors.hh"
#include "hsdm/io/formats.hh"
#include "io/temp_file.hh"

#include <catch2/catch.hpp>

#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

using namespace hsdm;
using namespace hsdm::test;

TEST_CASE("a missing file, a directory and an unreadable file are told apart", "[io]") {
    const TempFile file("a.xyz", "1 2 3\n");
    const auto message = [](const std::string& path) {
        try {
            read_points(path);
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    const std::string missing = file.path() + ".none";
    CHECK(message(missing) == missing + ": no such file; check the path");
    const std::string folder = std::filesystem::path(file.path()).parent_path().string();
    CHECK(message(folder) == folder + ": is a directory; give a file");
    CHECK(message(file.path() + "/a.xyz").find("cannot be read: ") != std::string::npos);
    if (::geteuid() == 0) {
        WARN("permissions do not bind this user: the unreadable file is not tested");
    } else {
        std::filesystem::permissions(file.path(), std::filesystem::perms::none);
        CHECK(message(file.path()) == file.path() + ": permission denied; make the file readable");
    }
}

TEST_CASE("an empty file and one without points say so, whatever the format", "[io]") {
    for (const char* name : {"a.xyz", "a.ply", "a.off", "a.obj", "a.stl", "a.pts", "a"})
        CHECK(error_of(name, "") == std::string(name) + ": is empty; expected points");
    for (const char* content : {"\n\n", "# only this\n", "  \r\n", "\xef\xbb\xbf"})
        CHECK(error_of("a.xyz", content) == "a.xyz: holds no points; expected lines of x y z");
    CHECK(error_of("a.csv", "x,y,z\n")
          == "a.csv:1: \"x,y,z\" and what follows hold no point; expected lines of x y z");
    CHECK(error_of("a.xyz", "100\n")
          == "a.xyz:1: a count of points and no point after it; the file was cut off");
    CHECK(error_of("a.obj", "vn 0 0 1\n").find("a.obj:1: ") == 0);
}

TEST_CASE("text in a number column is reported with its line and column", "[io]") {
    CHECK(error_of("a.xyz", "1 2 3\n4 five 6\n")
          == "a.xyz:2: \"five\" in column 2 is not a number; correct the line, or name the columns and give "
             "this one as _");
    CHECK(
        error_of("a.xyz", "1 2 3\r\n4 5 6x\r\n").starts_with("a.xyz:2: \"6x\" in column 3 is not a number"));
    CHECK(error_of("a.xyz", "1 2 three\n").starts_with("a.xyz:1: \"three\" in column 3 is not a number"));
    CHECK(error_of("a.xyz", "1 2 0x10\n").starts_with("a.xyz:1: \"0x10\" in column 3"));
    CHECK(error_of("a.xyz", "1 2 --3\n").starts_with("a.xyz:1: \"--3\" in column 3"));
    CHECK(error_of("a.xyz", "1 2 3\n1 2 \x01\x80\n").starts_with("a.xyz: neither text"));
    CHECK(error_of("a.txt", "Dear reader,\nthere is no point here.\n")
              .starts_with("a.txt:1: \"Dear reader,\" and what follows"));
}

TEST_CASE("rows that are too short or too long for the table are reported", "[io]") {
    CHECK(error_of("a.xyz", "1 2\n3 4\n")
          == "a.xyz:1: 2 columns, but x, y and z are needed; complete the line");
    CHECK(error_of("a.xyz", "1 2 3\n4 5\n")
          == "a.xyz:2: ends after 2 columns, but line 1 has 3; complete or remove the line");
    CHECK(
        error_of("a.xyz", "# c\n1 2 3\n4 5 6 7\n").starts_with("a.xyz:3: more columns than line 2 has 3; "));
    CHECK(error_of("a.xyz", "1 2 3\n4\n").starts_with("a.xyz:2: ends after 1 column, but line 1 has 3"));
    CHECK(error_of("a.csv", "x,y,z\n1,2,3,4\n").starts_with("a.csv:1: names 3 columns, but line 2 has 4"));
    CHECK(error_of("a.xyz", "1 2 3\n4 5 6\n7 8").starts_with("a.xyz:3: ends after 2 columns")); // cut off
}

TEST_CASE("decimal commas are recognised and refused", "[io]") {
    for (const char* row : {"1,5 2,5 3,5\n", "1,5;2,5;3,5\n", "1,5\t2,5\t3,5\n"})
        CHECK(error_of("a.txt", row)
              == "a.txt:1: commas beside other separators look like decimal commas; write 1.5 for 1,5, or "
                 "separate columns in one way only");
    CHECK(read("a.txt", "1.5, 2.5, 3.5\n").cloud.size() == 1);
    CHECK(read("a.txt", "1 , 2 ,3\n").cloud.size() == 1);
}

TEST_CASE("a file is read by its content when its name is wrong", "[io]") {
    const std::string ply = "ply\nformat ascii 1.0\nelement vertex 1\nproperty int x\nproperty int "
                            "y\nproperty int z\nend_header\n1 2 3\n";
    for (const char* name : {"a.xyz", "a.csv", "a.off", "a.obj", "a.stl", "a"}) {
        CHECK(read(name, ply).format == "ply");
        CHECK(read(name, "OFF\n1 0 0\n1 2 3\n").format == "off");
        CHECK(read(name, "o x\nv 1 2 3\n").format == "obj");
        CHECK(read(name, "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
                         "0\nendloop\nendfacet\n"
                         "endsolid\n")
                  .format
              == "stl");
    }
    for (const char* name : {"a.ply", "a.stl", "a.obj", "a.dat"})
        CHECK(read(name, "# t\n1 2 3\n4 5 6\n").cloud.size() == 2);
    CHECK(error_of("a.ply", "plyometrics\n1 2 3\n")
              .starts_with("a.ply:1: \"plyometrics\" is not how this format begins"));
}

TEST_CASE("a format that the caller names is taken at its word", "[io]") {
    ReadOptions options;
    options.format = "ply";
    CHECK(
        error_of("a.xyz", "1 2 3\n", options).starts_with("a.xyz:1: a PLY file begins with a line \"ply\""));
    options.format = "off";
    CHECK(read("a.xyz", "1 0 0\n1 2 3\n", options).cloud.size() == 1);
    options.format = "xyz";
    CHECK(read("a.off", "1 0 0\n1 2 3\n", options).cloud.size() == 2);
    options.format = "las";
    CHECK(error_of("a.xyz", "1 2 3\n", options).starts_with("a.xyz: a LAS file begins with \"LASF\""));
    options.format = "npy";
    CHECK(error_of("a.xyz", "1 2 3\n", options).starts_with("a.xyz: an NPY file begins with"));
    options.format = "e57";
    CHECK_THROWS_AS(read("a.xyz", "1 2 3\n", options), OptionError);
}

TEST_CASE("binary files of other kinds are refused by their kind", "[io]") {
    CHECK(error_of("a.e57", "ASTM-E57\1")
          == "a.e57: is an E57 file, which is not read; convert it to PLY or XYZ text");
    CHECK(error_of("a.xyz", "\x1f\x8b\x08").find("is a gzip file") != std::string::npos);
    CHECK(error_of("a.csv", std::string("\xff\xfe"
                                        "1\0 \0",
                                        6))
              .find("is text in UTF-16")
          != std::string::npos);
    std::string garbage;
    for (int i = 0; i < 1000; ++i) garbage += static_cast<char>(i * 37 % 256);
    for (const char* name : {"a.xyz", "a.ply", "a.off", "a.obj", "a"})
        CHECK(error_of(name, garbage)
              == std::string(name)
                     + ": neither text nor a binary format that is known; convert it to PLY or XYZ text");
}

TEST_CASE("points are read from a stream as from a file, by content alone", "[io]") {
    std::istringstream table("1 2 3\n4 5 6\n"), off("OFF\n1 0 0\n1 2 3\n");
    CHECK(io::read_points(io::SourceBytes::read(table, "<stdin>"), {}).cloud.size() == 2);
    CHECK(io::read_points(io::SourceBytes::read(off, "<stdin>"), {}).format == "off");
    std::istringstream bad("1 2 3\n4 5\n");
    CHECK_THROWS_WITH(io::read_points(io::SourceBytes::read(bad, "<stdin>"), {}),
                      Catch::StartsWith("<stdin>:2: ends after"));
}

TEST_CASE("a pipe is read to its end", "[io]") {
    const TempFile folder("a.xyz", "");
    const std::string path = folder.path() + ".pipe";
    REQUIRE(::mkfifo(path.c_str(), 0600) == 0);
    std::string text; // longer than one block of reading
    while (text.size() < (std::size_t(9) << 20)) text += "1.25 2.5 3.75\n";
    std::thread writer([&] { std::ofstream(path) << text; });
    const auto cloud = read_points(path).cloud;
    writer.join();
    CHECK(cloud.size() == text.size() / 14);
    CHECK(cloud.positions.back() == Vec3(1.25, 2.5, 3.75));
}

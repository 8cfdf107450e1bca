"""read_tables.py PROGRAM COMMAND: tables of text as PROGRAM writes them, read by the command, against the same points."""
import csv
import os
import sys

from common import check, farthest, in_folder, info, need_module, need_program, run, skip, sphere, write_xyz
from read_points import FLOAT, expect

NAMES = ["x", "y", "z", "nx", "ny", "nz", "red", "green", "blue"]


def rows_of_sphere():
    points, normals, colors = sphere()
    write_xyz("ref.xyz", points)
    return [[*p, *n, *c] for p, n, c in zip(points, normals, colors)]


def python():
    rows = rows_of_sphere()
    for options in ({}, {"dialect": "excel-tab"}, {"dialect": "unix"}, {"delimiter": ";"}, {"delimiter": " "},
                    {"quoting": csv.QUOTE_NONNUMERIC}):
        with open("a.csv", "w", newline="") as file:
            writer = csv.writer(file, **options)
            writer.writerow(NAMES)
            writer.writerows(rows)
        expect("a.csv", 0, normals=True, colors=True, scalars=[])


def numpy():
    np = need_module("numpy")
    rows = rows_of_sphere()
    np.savetxt("a.xyz", rows)
    expect("a.xyz", 0, normals=True, colors=True, scalars=[])
    np.savetxt("a.xyz", [row[:3] for row in rows])
    expect("a.xyz", 0, normals=False, colors=False)
    for comments in ("", "# ", "//"):
        np.savetxt("a.csv", rows, delimiter=",", header=",".join(NAMES), comments=comments)
        expect("a.csv", 0, normals=True, colors=True, scalars=[])
    np.savetxt("a.txt", rows, delimiter="\t", fmt="%.7g", newline="\r\n")
    expect("a.txt", 1e-6, normals=True, colors=True)
    holes = np.array(rows)
    holes[::40, 2] = np.nan
    np.savetxt("a.txt", holes)
    check(info("a.txt")["cloud"]["dropped_nonfinite"] == 10, "points that NumPy knows no place of are counted")


def pandas():
    table = need_module("pandas").DataFrame(rows_of_sphere(), columns=NAMES)
    for options in ({}, {"index": False}, {"sep": "\t"}, {"index": False, "quoting": csv.QUOTE_ALL},
                    {"index": False, "float_format": "%.17e"}):
        table.to_csv("a.csv", **options)
        expect("a.csv", 0, normals=True, colors=True, scalars=[])
    table["label"] = range(len(table))
    table.to_csv("a.csv")
    expect("a.csv", 0, normals=True, colors=True, scalars=["label"])


def r():
    program = need_program("Rscript")
    with open("in.txt", "w") as file:
        for row in rows_of_sphere():
            file.write(" ".join(map(repr, row)) + "\n")
    with open("write.R", "w") as file:
        file.write('d <- read.table("in.txt", col.names = c(' + ", ".join(f'"{name}"' for name in NAMES) + "))\n"
                   'write.csv(d, "names.csv")\nwrite.csv(d, "a.csv", row.names = FALSE)\n'
                   'write.table(d, "a.txt", row.names = FALSE)\n'
                   'write.table(d, "bare.txt", row.names = FALSE, col.names = FALSE)\n'
                   'write.table(d, "named.txt", col.names = NA, sep = "\\t")\n')
    run(program, "--vanilla", "write.R")
    for name in ("names.csv", "a.csv", "a.txt", "bare.txt", "named.txt"):  # of 15 digits
        expect(name, 1e-14, normals=True, colors=True, scalars=[])


def octave():
    program = need_program("octave-cli")
    with open("in.txt", "w") as file:
        for row in rows_of_sphere():
            file.write(" ".join(map(repr, row)) + "\n")
    with open("write.m", "w") as file:
        file.write('d = load("in.txt"); csvwrite("a.csv", d);\n'
                   'dlmwrite("a.txt", d, "delimiter", "\\t", "precision", 17, "newline", "pc");\n'
                   'save("-ascii", "-double", "a.xyz", "d"); save("-text", "b.txt", "d");\n')
    run(program, "--no-gui", "--norc", "write.m", env={**os.environ, "HOME": os.getcwd()})
    for name, tolerance in (("a.csv", 1e-14), ("a.txt", 0), ("a.xyz", 1e-14), ("b.txt", 1e-14)):
        expect(name, tolerance, normals=True, colors=True)


def gdal():
    program = need_program("ogr2ogr")
    with open("in.csv", "w") as file:
        file.write("east,north,up,intensity\n")
        for i, row in enumerate(rows_of_sphere()):
            file.write(",".join(map(repr, [*row[:3], i % 7])) + "\n")
    for separator in ("COMMA", "SEMICOLON", "TAB", "SPACE"):
        run(program, "-f", "CSV", f"{separator}.csv", "in.csv", "-select", "intensity", "-lco", "GEOMETRY=AS_XYZ", "-lco",
            f"SEPARATOR={separator}", "-oo", "X_POSSIBLE_NAMES=east", "-oo", "Y_POSSIBLE_NAMES=north", "-oo",
            "Z_POSSIBLE_NAMES=up")
        expect(f"{separator}.csv", 1e-14, normals=False, colors=False, scalars=["intensity"])


CGAL = r"""
#include <CGAL/IO/read_xyz_points.h>
#include <CGAL/IO/write_off_points.h>
#include <CGAL/IO/write_ply_points.h>
#include <CGAL/IO/write_xyz_points.h>
#include <CGAL/Simple_cartesian.h>

#include <iterator>
#include <vector>

using Kernel = CGAL::Simple_cartesian<double>;
using Point = std::pair<Kernel::Point_3, Kernel::Vector_3>;

int main() {
    std::vector<Point> points;
    const auto place = CGAL::parameters::point_map(CGAL::First_of_pair_property_map<Point>()).stream_precision(17);
    const auto all = place.normal_map(CGAL::Second_of_pair_property_map<Point>());
    return !(CGAL::IO::read_XYZ("in.xyz", std::back_inserter(points), all) && CGAL::IO::write_XYZ("a.xyz", points, place)
             && CGAL::IO::write_XYZ("a.pwn", points, all) && CGAL::IO::write_OFF("a.off", points, all)
             && CGAL::IO::write_PLY("binary.ply", points, all.use_binary_mode(true))
             && CGAL::IO::write_PLY("text.ply", points, all.use_binary_mode(false)));
}
"""


def cgal():
    compiler = need_program("c++")
    if not os.path.exists("/usr/include/CGAL/IO/write_xyz_points.h"):
        skip("CGAL")
    with open("in.xyz", "w") as file:
        for row in rows_of_sphere():
            file.write(" ".join(map(repr, row[:6])) + "\n")
    with open("write.cc", "w") as file:
        file.write(CGAL)
    run(compiler, "-std=c++17", "-O0", "write.cc", "-o", "write", "-lmpfr", "-lgmp")
    run("./write")
    for name in ("a.pwn", "a.off", "binary.ply", "text.ply"):
        expect(name, 0, normals=True, colors=False, scalars=[])
    expect("a.xyz", 0, normals=False, colors=False, scalars=[])


def cloudcompare():
    program = need_program("CloudCompare", "cloudcompare.CloudCompare")
    with open("in.txt", "w") as file:
        for row in rows_of_sphere():
            file.write(" ".join(map(repr, [*row[:3], *row[6:], *row[3:6]])) + "\n")
    for separator in ("COMMA", "SEMICOLON", "TAB", "SPACE"):
        for more in ((), ("-ADD_HEADER",), ("-ADD_HEADER", "-ADD_PTS_COUNT")):
            run(program, "-SILENT", "-O", "in.txt", "-C_EXPORT_FMT", "ASC", "-PREC", "12", "-SEP", separator, "-EXT", "csv",
                *more, "-SAVE_CLOUDS", "FILE", "out.csv", env={**os.environ, "QT_QPA_PLATFORM": "offscreen"})
            # Its normals are of a table of directions, up to half a degree off.
            expect("out.csv", FLOAT, normals=True, colors=True)
            check(farthest("out.csv", "ref.xyz") > 0, "the file is of CloudCompare's floats")


PROGRAMS = {"python": python, "numpy": numpy, "pandas": pandas, "r": r, "octave": octave, "gdal": gdal, "cgal": cgal,
            "cloudcompare": cloudcompare}

if __name__ == "__main__":
    in_folder(PROGRAMS[sys.argv[1]])

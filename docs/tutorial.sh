#!/bin/sh
# sh docs/tutorial.sh: runs the commands of docs/tutorial.md in build/tutorial and draws its pictures into docs/images: meshes by
# f3d under xvfb-run, the sharp edges by awk. Takes the binaries of build/release (sh cmake/bootstrap.sh demo).
set -eu
cd "$(dirname "$0")/.."
images=$PWD/docs/images
PATH=$PWD/build/release/apps/hsdm:$PWD/build/release/tests/support:$PATH
for tool in hsdm hsdm_generate f3d xvfb-run; do
    if ! command -v "$tool" >/dev/null; then
        echo "tutorial: no $tool; sh cmake/bootstrap.sh demo builds and installs it" >&2
        exit 1
    fi
done
mkdir -p build/tutorial
cd build/tutorial

run() {
    echo "\$ $*"
    "$@"
}

# draw NAME FILE OPTION...: as the gallery's pictures are
draw() {
    name=$1 file=$2
    shift 2
    rm -f "$images/tutorial-$name.png"
    xvfb-run -a f3d "$file" --output "$images/tutorial-$name.png" --resolution 400,300 --quiet --line-width 1.2 \
        --color 0.93,0.95,1 --roughness 0.5 --tone-mapping --fxaa --bg-color 1,1,1 --up +X \
        --camera-azimuth-angle 35 --camera-elevation-angle 25 --camera-view-angle 17 "$@" >"$name.log" 2>&1 || true
    if [ ! -s "$images/tutorial-$name.png" ]; then
        cat "$name.log" >&2
        exit 1
    fi
}

# The lines of a file of --features from the same side, and its corners as dots.
draw_edges() {
    awk 'function X(x, y, z) { return sprintf("%.1f", 200 + 118 * (0.82 * z - 0.57 * y)) }
        function Y(x, y, z) { return sprintf("%.1f", 150 - 118 * (0.91 * x + 0.24 * z + 0.34 * y)) }
        BEGIN {
            print "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"400\" height=\"300\" viewBox=\"0 0 400 300\">"
            print "<rect width=\"400\" height=\"300\" fill=\"#ffffff\"/>"
        }
        $1 == "c" {
            dots = dots "<circle cx=\"" X($2, $3, $4) "\" cy=\"" Y($2, $3, $4) "\" r=\"2.5\" fill=\"#d55e00\"/>\n"
            next
        }
        { path = path "M" X($1, $2, $3) " " Y($1, $2, $3) "L" X($4, $5, $6) " " Y($4, $5, $6) }
        END {
            print "<path d=\"" path "\" stroke=\"#0072b2\" stroke-width=\"1.3\"/>"
            printf "%s</svg>\n", dots
        }' "$1" >"$images/tutorial-edges.svg"
}

run hsdm_generate part --points 100000 --noise 0.002 --normal-noise 5 --outliers 0.001 -o scan.ply
run hsdm_generate part --points 500000 --seed 2 -o truth.ply
run hsdm info scan.ply
run hsdm reconstruct scan.ply -o part.stl
run hsdm reconstruct scan.ply --levels 4:7 -o level.ply
for depth in 4 5 6 7; do run hsdm compare truth.ply level.d$depth.ply; done
for error in 0.1 0.2 0.5; do
    run hsdm reconstruct scan.ply --max-error $error% -o error$error.ply
    run hsdm compare truth.ply error$error.ply
done
run hsdm reconstruct scan.ply --max-error 0.5% -o part.ply --features edges.txt
run hsdm reconstruct scan.ply --max-error 0.5% --crease-degrees 50 -o part.ply --features edges.txt --report report.json
run hsdm regress ../../docs/examples/part_suite.json
run hsdm_generate part --points 20000 --noise 0.01 --normal-noise 5 --outliers 0.001 --seed 3 -o scan.ply
run hsdm regress ../../docs/examples/part_suite.json --json misses.json || true
run hsdm_generate part --points 100000 --noise 0.002 --normal-noise 5 --outliers 0.001 -o scan.ply

run hsdm reconstruct scan.ply --depth 4 --plain --quiet -o coarse.ply
run hsdm reconstruct scan.ply --max-error 0.5% --plain --quiet -o plain.ply
draw scan scan.ply --point-size 1.5
draw coarse coarse.ply --edges
draw part plain.ply --edges
draw_edges edges.txt

#!/bin/sh
# sh docs/gallery.sh: scans solids, reconstructs them and draws the pictures of README's gallery, by f3d under xvfb-run,
# into docs/images. Takes the binaries of build/release, or HSDM and HSDM_GENERATE; the rest goes to build/gallery.
set -eu
if [ -n "${HSDM:-}" ]; then HSDM=$(realpath "$HSDM"); fi
if [ -n "${HSDM_GENERATE:-}" ]; then HSDM_GENERATE=$(realpath "$HSDM_GENERATE"); fi
cd "$(dirname "$0")/.."
hsdm=${HSDM:-$PWD/build/release/apps/hsdm/hsdm}
generate=${HSDM_GENERATE:-$PWD/build/release/tests/support/hsdm_generate}
for tool in "$hsdm" "$generate" f3d xvfb-run; do
    if ! command -v "$tool" >/dev/null; then
        echo "gallery: no $tool; sh cmake/bootstrap.sh demo builds and installs it" >&2
        exit 1
    fi
done
images=$PWD/docs/images
mkdir -p build/gallery
cd build/gallery

# draw NAME UP AZIMUTH ELEVATION VIEW-ANGLE: NAME.ply, every facet flat; angles in degrees
draw() {
    picture=$images/gallery-$1.png
    rm -f "$picture"
    xvfb-run -a f3d "$1.ply" --output "$picture" --resolution 480,360 --quiet \
        --edges --line-width 1.2 --color 0.93,0.95,1 --roughness 0.5 --tone-mapping --fxaa --bg-color 1,1,1 \
        --up "$2" --camera-azimuth-angle "$3" --camera-elevation-angle "$4" --camera-view-angle "$5" \
        >"$1.log" 2>&1 || true
    if [ ! -s "$picture" ]; then
        cat "$1.log" >&2
        echo "gallery: $picture could not be drawn" >&2
        exit 1
    fi
}

# reconstruct SCAN NAME OPTION...: NAME.ply, without vertex normals
reconstruct() {
    scan=$1 name=$2
    shift 2
    echo "== $name"
    "$hsdm" reconstruct "$scan" "$@" --plain -o "$name.ply"
}

"$generate" part --points 200000 --noise 0.002 --normal-noise 5 -o scan.ply
"$generate" part --points 200000 --noise 0.003 --no-normals -o noisy.ply
"$generate" plate --points 20000 -o thin.ply
"$generate" fillet --points 200000 -o rounded.ply
for part in comb heat-sink honeycomb can roll; do
    "$generate" $part --width 0.04 --points 60000 -o $part-scan.ply
done
"$generate" hinge --width 0.08 --points 60000 -o hinge-scan.ply
"$generate" cup --positions 5 --points 24000 --noise 0.003 -o above.ply

reconstruct scan.ply uniform --depth 5
reconstruct scan.ply adaptive --max-error 0.5%
reconstruct scan.ply coarse --depth 3
reconstruct noisy.ply positions --depth 5
reconstruct thin.ply plate --depth 3
reconstruct rounded.ply fillet --max-error 0.1%
for part in comb heat-sink hinge; do reconstruct $part-scan.ply $part --voxel-size 0.04; done
for part in honeycomb can roll; do reconstruct $part-scan.ply $part --voxel-size 0.08; done
reconstruct above.ply seen
reconstruct above.ply completed --holes complete

for name in uniform adaptive coarse positions; do draw "$name" +X 35 25 17; done
draw plate +Z 30 20 24
draw fillet +Z 120 25 29
for part in comb heat-sink hinge honeycomb can roll; do draw $part +Z 35 40 29; done
for name in seen completed; do draw "$name" +Z 30 -25 24; done

#!/bin/sh
# sh cmake/bootstrap.sh tools|build|python|demo|test [CMAKE-ARGUMENT...]
#
# On Debian 12: installs what is missing, then
#   tools  nothing more (with the compilers and tools of .ci/run)
#   build  configures and builds build/release
#   python builds the Python package too, into build/release/python; then `pip install .` needs no network
#   demo   builds, scans a mechanical part, reconstructs it and draws it, into demo/
#   test   builds and runs every test; the last line is `N passed, N failed`
set -eu

usage() {
    sed -n '2,9s/^# \{0,1\}//p' "$0"
}

goal=${1:-}
case $goal in
tools | build | python | demo | test) shift ;;
-h | --help) usage && exit 0 ;;
*) usage >&2 && exit 2 ;;
esac
cd "$(dirname "$0")/.."

packages="g++ cmake ninja-build libopenmesh-dev libeigen3-dev libflann-dev libtbb-dev libfast-float-dev
    libboost-dev nlohmann-json3-dev libzip-dev libcli11-dev libpng-dev libjs-three catch2"
python="pybind11-dev python3-dev python3-numpy"
tests="$python python3-pytest python3-meshio mypy libopenmpi-dev openmpi-bin"
case $goal in
python) packages="$packages $python python3-skbuild python3-venv" ;;
test) packages="$packages $tests" ;;
demo) packages="$packages f3d xvfb xauth" ;;
tools) packages="$packages $tests clang-14 libclang-rt-14-dev clang-format-14 clang-tidy-14 llvm-14 doxygen git
    python3 libbenchmark-dev lintian zsh fish man-db libxml2-utils
    python3-numpy python3-ezdxf assimp-utils lib3mf1 chromium blender xvfb xauth" ;; # these for tests
esac

is_installed() {
    [ "$(dpkg-query -W -f '${db:Status-Status}' "$1" 2>/dev/null)" = installed ]
}

as_root() {
    if [ "$(id -u)" -eq 0 ]; then
        "$@"
    elif command -v sudo >/dev/null; then
        sudo "$@"
    else
        echo "bootstrap: not root and no sudo; install as root: apt-get install$missing" >&2
        exit 1
    fi
}

apt_install() {
    # shellcheck disable=SC2086  # a list of names, to be split
    as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends $missing
}

install_missing() {
    if ! command -v dpkg-query >/dev/null; then
        echo "bootstrap: no dpkg here; the build needs what these Debian packages hold:" $packages
        return
    fi
    missing=
    for package in $packages; do
        is_installed "$package" || missing="$missing $package"
    done
    [ -n "$missing" ] || return 0
    echo "bootstrap: installing$missing"
    log=$(mktemp)
    # The package lists may be absent or stale: they are fetched only if the first try fails.
    if ! apt_install >"$log" 2>&1; then
        as_root apt-get update -q >>"$log" 2>&1 || true
        apt_install >>"$log" 2>&1 || {
            cat "$log" >&2
            echo "bootstrap: apt-get could not install$missing" >&2
            exit 1
        }
    fi
    rm -f "$log"
}

configure() {
    mkdir -p build
    cmake --preset release -DHSDM_UNITY=ON "$@" >build/configure.log 2>&1 || {
        cat build/configure.log >&2
        exit 1
    }
}

demo() {
    # What `cmake --install` takes, and the scanner.
    cmake --build build/release --target hsdm_command hsdm_modules hsdm_generate
    hsdm=build/release/apps/hsdm/hsdm
    mkdir -p demo
    build/release/tests/support/hsdm_generate part --points 200000 --noise 0.002 --normal-noise 5 -o demo/scan.ply
    $hsdm reconstruct demo/scan.ply --depth 5 -o demo/part.off --report demo/part.json \
        --features demo/part.features.txt >demo/summary.txt
    $hsdm reconstruct demo/scan.ply --depth 5 -o demo/part.stl --quiet
    $hsdm reconstruct demo/scan.ply --depth 5 -o demo/part.ply --html demo/part.html --quiet
    # Without vertex normals the picture shows every facet flat, as it is.
    $hsdm reconstruct demo/scan.ply --depth 5 -o build/picture.ply --plain --quiet
    rm -f demo/part.png
    xvfb-run -a f3d build/picture.ply --output demo/part.png --resolution 1000,520 --quiet \
        --edges --line-width 1.3 --color 0.93,0.95,1 --roughness 0.5 --tone-mapping --fxaa --bg-color 1,1,1 \
        --up +X --camera-azimuth-angle 35 --camera-elevation-angle 25 --camera-view-angle 16 \
        >build/picture.log 2>&1 || true
    cat demo/summary.txt
    echo "scan      demo/scan.ply: 200,000 noisy points of two shafts on a block with crossing holes"
    echo "meshes    demo/part.off (polygons), demo/part.stl (triangles), demo/part.ply (with properties)"
    echo "report    demo/part.json, sharp edges in demo/part.features.txt"
    if [ ! -s demo/part.png ]; then
        cat build/picture.log >&2
        echo "picture   could not be drawn; try: xvfb-run -a f3d demo/part.ply --output demo/part.png" >&2
        exit 1
    fi
    echo "picture   demo/part.png"
    echo "page      demo/part.html, to turn the part in a browser"
}

run_tests() {
    cmake --build build/release >build/build.log 2>&1 || {
        tail -n 60 build/build.log
        echo "0 passed, 1 failed"
        exit 1
    }
    status=0
    ctest --preset release -j "$(nproc)" >build/ctest.log 2>&1 || status=$?
    sh cmake/count_tests.sh build/ctest.log "$status"
}

install_missing
[ "$goal" != tools ] || exit 0
configure "$@"
case $goal in
build | python) cmake --build build/release ;;
demo) demo ;;
test) run_tests ;;
esac

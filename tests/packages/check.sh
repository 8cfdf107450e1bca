#!/bin/sh
# sh tests/packages/check.sh folder|root [PACKAGES]: what the packages of `sh cmake/packages.sh` are worth to who installs them.
#
#   folder  in an empty folder, by dpkg --root, with the libraries of this machine
#   root    in a new Debian 12 of debootstrap, by apt, with what the packages say that they need; takes minutes, a network
#           and 1 GB in TMPDIR
#
# Lintian finds no error; they are installed; a part is scanned and reconstructed; a program is built against libhsdm-dev;
# they are removed, and nothing is left. As root, or by fakeroot in a folder.
set -eu
way=${1:-}
case $way in folder | root) ;; *)
    sed -n '2,9s/^# \{0,1\}//p' "$0" >&2
    exit 2
    ;;
esac
packages=$(cd "${2:-$(dirname "$0")/../../build/deb/packages}" && pwd)
work=$(mktemp -d)
root=$work/root
trap 'umount "$root/proc" 2>/dev/null || true; rm -rf --one-file-system "$work"' EXIT
libdir=/usr/lib/$(dpkg-architecture -q DEB_HOST_MULTIARCH)

say() {
    echo "== $*"
}

fail() {
    echo "packages: $*" >&2
    exit 1
}

# in_root COMMAND...: with the installation's programs and libraries; files are named from its root.
in_root() {
    if [ "$way" = root ]; then
        chroot "$root" "$@"
    else
        (cd "$root" && PATH=$root/usr/bin:$PATH LD_LIBRARY_PATH=$root$libdir HSDM_PLUGIN_PATH=$root$libdir/hsdm/plugins "$@")
    fi
}

# What is there but dpkg's own records and what was tried.
files() {
    (cd "$root" && find . \( -path ./var/lib/dpkg -o -path ./try \) -prune -o -print | sort)
}

check_lintian() {
    say lintian
    lintian --no-cfg --allow-root --fail-on error,warning --tag-display-limit 0 "$packages"/*.deb
}

make_root() {
    say "$way"
    mkdir -p "$root/try"
    if [ "$way" = root ]; then
        debootstrap --variant=minbase bookworm "$root" "${HSDM_MIRROR:-http://deb.debian.org/debian}" >"$work/log" 2>&1 ||
            { tail -n 20 "$work/log" >&2 && fail "debootstrap failed"; }
        mount -t proc proc "$root/proc" 2>/dev/null || true # threads are counted there, where a container lets it
        mkdir -p "$root/packages" "$root/try"
        cp "$packages"/*.deb "$root/packages"
    else
        mkdir -p "$root/var/lib/dpkg/info" "$root/var/lib/dpkg/updates" "$root/var/lib/dpkg/triggers"
        : >"$root/var/lib/dpkg/status"
    fi
}

apt() {
    in_root env DEBIAN_FRONTEND=noninteractive apt-get -y -q --no-install-recommends "$@" >"$work/log" 2>&1 ||
        { tail -n 20 "$work/log" >&2 && fail "apt-get $1 failed"; }
}

names() {
    for package in "$packages"/*.deb; do dpkg-deb -f "$package" Package; done
}

install_packages() {
    say install
    if [ "$way" = root ]; then
        apt update
        # The command first, alone: what it needs comes with it, and no compiler.
        apt install $(cd "$root" && ls packages/hsdm_*.deb packages/libhsdm0*.deb | sed 's,^,/,')
        in_root hsdm --version
        apt install $(cd "$root" && ls packages/*.deb | sed 's,^,/,') g++ cmake ninja-build pkg-config
    else
        $fake dpkg --root="$root" --log=/dev/null --force-depends --force-not-root --path-include='/usr/share/*' -i "$packages"/*.deb >"$work/log" 2>&1 ||
            { cat "$work/log" >&2 && fail "dpkg could not install them"; }
    fi
}

use_command() {
    say use
    in_root hsdm --version
    in_root hsdm_generate part --points 20000 --noise 0.002 -o try/scan.ply
    in_root hsdm reconstruct try/scan.ply --depth 5 -o try/part.off --report try/part.json
    in_root hsdm process try/part.off --stage classify-features -o try/classified.ply # a module
    in_root env -u HSDM_PLUGIN_PATH hsdm stages | grep -q "$libdir/hsdm/plugins" || fail "modules are looked for elsewhere"
    in_root hsdm_bench --help >/dev/null
    for page in "$root"/usr/share/man/man1/hsdm*.1.gz; do gzip -t "$page"; done
    bash -n "$root/usr/share/bash-completion/completions/hsdm"
    for file in zsh/vendor-completions/_hsdm fish/vendor_completions.d/hsdm.fish; do
        [ -s "$root/usr/share/$file" ] || fail "no $file"
    done
}

# If there is a package of it; Debian's own Python, which leaves nothing behind.
use_python() {
    [ -d "$root/usr/lib/python3/dist-packages/hsdm" ] || return 0
    say python3-hsdm
    in_root env PYTHONDONTWRITEBYTECODE=1 PYTHONPATH="$at/usr/lib/python3/dist-packages" /usr/bin/python3 -c '
import numpy, hsdm
points = numpy.random.default_rng(1).normal(size=(5000, 3))
points /= numpy.linalg.norm(points, axis=1)[:, None]
print(hsdm.reconstruct(points, depth=4))'
    in_root env PYTHONDONTWRITEBYTECODE=1 PYTHONPATH="$at/usr/lib/python3/dist-packages" /usr/bin/python3 -m hsdm --version
}

# The example of README, by CMake and by pkg-config.
build_consumer() {
    say "a program against libhsdm-dev"
    mkdir "$root/try/mine"
    cp "$root/usr/share/doc/libhsdm-dev/examples/scan_to_part.cc" "$root/try/mine/main.cc"
    cat >"$root/try/mine/CMakeLists.txt" <<'END'
cmake_minimum_required(VERSION 3.25)
project(mine LANGUAGES CXX)
find_package(hsdm 0.1 REQUIRED)
add_executable(mine main.cc)
target_link_libraries(mine PRIVATE hsdm::hsdm)
END
    cp "$root/try/scan.ply" "$root/try/mine/scan.ply"
    (
        [ "$way" = root ] || export CMAKE_PREFIX_PATH="$root/usr" PKG_CONFIG_PATH="$root$libdir/pkgconfig"
        in_root cmake -S "$at/try/mine" -B "$at/try/mine/build" -G Ninja -DCMAKE_CXX_FLAGS=-O0 >"$work/log" 2>&1 &&
            in_root cmake --build "$at/try/mine/build" >>"$work/log" 2>&1 &&
            in_root sh -c "cd '$at/try/mine' && build/mine && test -s part.stl &&
                g++ -std=c++20 -O0 main.cc \$(pkg-config --cflags --libs hsdm) -o by_pkg_config && ./by_pkg_config" >>"$work/log" 2>&1
    ) || { cat "$work/log" >&2 && fail "the program was not built, or failed"; }
}

# Of what was installed, that which is there and no other package's.
left_over() {
    while read -r path; do
        [ ! -e "$root$path" ] || in_root dpkg -S "$path" >/dev/null 2>&1 || echo "$path"
    done <"$work/installed"
}

remove_packages() {
    if [ "$way" = root ]; then
        in_root dpkg -L $(names) | grep "^/[^.]" | sort -u >"$work/installed"
        in_root dpkg -P $(names) >/dev/null
        left_over
    else
        $fake dpkg --root="$root" --log=/dev/null --force-depends --force-not-root -P $(names) >"$work/log" 2>&1 ||
            { cat "$work/log" >&2 && fail "dpkg could not remove them"; }
    fi
}

for tool in lintian dpkg-deb $([ "$way" = folder ] || echo debootstrap); do
    command -v "$tool" >/dev/null || { echo "packages: no $tool here; skipped" && exit 77; }
done
at=$([ "$way" = root ] || echo "$root") # where the root is for who stands outside of it, or not
fake=$([ "$(id -u)" -eq 0 ] || echo fakeroot)
[ "$way" = folder ] || [ -z "$fake" ] || fail "a root of its own needs the rights of root"
check_lintian
make_root
[ "$way" = root ] || files >"$work/before"
install_packages
use_command
use_python
build_consumer
say remove
remove_packages >"$work/left"
[ "$way" = root ] || files | diff "$work/before" - >"$work/left" || true
[ ! -s "$work/left" ] || { cat "$work/left" >&2 && fail "something is left that was not there before"; }
echo "packages: $(names | tr '\n' ' ')are installed, used and removed without a trace"

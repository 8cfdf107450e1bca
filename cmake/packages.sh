#!/bin/sh
# sh cmake/packages.sh [CMAKE-ARGUMENT...]: builds the Debian packages of hsdm, in build/deb/packages, with the flags that
# Debian builds with. The same sources give the same packages, to the byte. HSDM_DEB_TREE names another folder than build/deb.
set -eu
cd "$(dirname "$0")/.."
tree=${HSDM_DEB_TREE:-build/deb}
for tool in dpkg-buildflags dpkg-shlibdeps gzip; do
    command -v "$tool" >/dev/null || {
        echo "packages: no $tool here; install dpkg-dev (Debian, Ubuntu)" >&2
        exit 1
    }
done
flags() {
    DEB_BUILD_MAINT_OPTIONS=hardening=+all dpkg-buildflags --get "$1"
}
if [ -z "${SOURCE_DATE_EPOCH:-}" ]; then # the time of what is packed, not that of packing it
    SOURCE_DATE_EPOCH=$(git log -1 --format=%ct 2>/dev/null) || SOURCE_DATE_EPOCH=$(date -r CHANGELOG.md +%s)
fi
export SOURCE_DATE_EPOCH
mkdir -p "$tree"
cmake -S . -B "$tree" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX=/usr \
    -DCMAKE_INSTALL_LIBDIR="lib/$(dpkg-architecture -q DEB_HOST_MULTIARCH)" -DBUILD_SHARED_LIBS=ON \
    -DCMAKE_SKIP_INSTALL_RPATH=ON -DHSDM_DEBIAN=ON -DHSDM_BUILD_TESTS=OFF -DHSDM_UNITY=ON \
    -DCMAKE_CXX_FLAGS="$(flags CPPFLAGS) $(flags CXXFLAGS)" \
    -DCMAKE_EXE_LINKER_FLAGS="$(flags LDFLAGS)" -DCMAKE_SHARED_LINKER_FLAGS="$(flags LDFLAGS)" \
    -DCMAKE_MODULE_LINKER_FLAGS="$(flags LDFLAGS)" "$@" >"$tree/configure.log" 2>&1 || {
    cat "$tree/configure.log" >&2
    exit 1
}
cmake --build "$tree"
rm -rf "$tree/packages"
(cd "$tree" && cpack >cpack.log 2>&1) || {
    cat "$tree/cpack.log" >&2
    exit 1
}
# CPack writes scripts that call ldconfig, which the trigger in the package does as well.
for library in "$tree"/packages/libhsdm[0-9]*.deb; do
    rm -rf "$tree/library"
    dpkg-deb -R "$library" "$tree/library"
    rm -f "$tree/library/DEBIAN/postinst" "$tree/library/DEBIAN/postrm"
    dpkg-deb --root-owner-group -b "$tree/library" "$library" >/dev/null
done
rm -rf "$tree/packages/_CPack_Packages" "$tree/library"
ls "$tree"/packages/*.deb

#!/bin/sh
# sh cmake/check_layers.sh: no folder of libhsdm includes from one that stands after it in hsdm/CMakeLists.txt. The
# headers beside that file are the ground that all stand on, but for those of the roof, which belong to the last folder.
set -eu
cd "$(dirname "$0")/../libhsdm/hsdm"
order=$(sed -nE 's/^add_subdirectory\((.*)\)$/\1/p' CMakeLists.txt)
find . -name '*.hh' -o -name '*.cc' | sort | xargs awk -v order="$(echo $order)" '
    BEGIN {
        last = split(order, folders, " ")
        for (i = 1; i <= last; ++i) level[folders[i]] = i
        split("hsdm.hh reconstruct.hh report.hh ReconstructorT.hh ReconstructorT_impl.hh", roof, " ")
        for (i in roof) is_roof[roof[i]] = 1
    }
    # PATH without hsdm/: the level that it stands on
    function level_of(path, parts) {
        if (split(path, parts, "/") == 1) return path in is_roof ? last : 0
        if (!(parts[1] in level)) { print path ": its folder is not in CMakeLists.txt"; wrong = 1 }
        return level[parts[1]]
    }
    /^#include "hsdm\// {
        split($0, quoted, "\"")
        from = substr(FILENAME, 3)
        to = substr(quoted[2], 6)
        if (level_of(to) > level_of(from)) { print FILENAME ":" FNR ": includes " to ", which stands above it"; wrong = 1 }
    }
    END { exit wrong }'

#!/bin/sh
# shown_blocks.sh PAGE EXAMPLE...: fails unless every block of C++ in the page stands in one of the examples, which are
# built and run, line by line but for indentation, blank lines and comments at the ends of lines.
set -eu
awk '
    function bare(line) {
        sub(/ *\/\/.*$/, "", line)
        gsub(/^ +| +$/, "", line)
        return line
    }
    FNR == 1 { ++file }
    file == 1 && /^```cpp$/ { in_block = 1; block = "\n"; at = FNR; next }
    file == 1 && /^```$/ && in_block { in_block = 0; blocks[at] = block; next }
    file == 1 && in_block && bare($0) != "" { block = block bare($0) "\n" }
    file > 1 && FNR == 1 { text[file] = "\n" }
    file > 1 && bare($0) != "" { text[file] = text[file] bare($0) "\n" }
    END {
        for (at in blocks) {
            found = 0
            for (i in text) found = found || index(text[i], blocks[at]) > 0
            if (!found) { print ARGV[1] ":" at ": this block stands in no example"; wrong = 1 }
            ++count
        }
        print count + 0 " blocks of " ARGV[1]
        exit wrong || count == 0
    }' "$@"

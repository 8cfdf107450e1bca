#!/bin/sh
# sh help_page.sh PROGRAM DESCRIPTION PAGE: writes a page of man(1) that shows what PROGRAM --help prints.
set -eu
name=$(basename "$1")
help=$("$1" --help)
{
    printf '.TH %s 1 "" "" "User Commands"\n.SH NAME\n%s \\- %s\n.SH SYNOPSIS\n.nf\n' "$name" "$name" "$2"
    printf '\\fB%s\\fR [ARGUMENT...]\n.fi\n.SH DESCRIPTION\n.nf\n' "$name"
    printf '%s\n' "$help" | sed -e 's/\\/\\e/g' -e "s/'/\\\\(aq/g" -e 's/`/\\(ga/g' -e 's/-/\\-/g' -e 's/^\./\\\&./'
    printf '.fi\n.SH SEE ALSO\n\\fBhsdm\\fR(1)\n'
} >"$3.new"
mv "$3.new" "$3"

#!/bin/sh
# sh cmake/check_system.sh: what is asked of the operating system beyond the standard library stands in core/system.cc
# alone (docs/portability.md); and every variable of the environment that is read is told in docs/command.md and in the
# manual pages. <link.h> in modules/plugin_record.cc is a file format and no call: the structures of ELF, in which the
# system's header says how the record in a module lies. Files are read there as everywhere.
set -eu
cd "$(dirname "$0")/.."
allowed='^(libhsdm/hsdm/core/system\.cc:|libhsdm/hsdm/modules/plugin_record\.cc:[0-9]+:#include <link\.h>$)'
headers='(sys/[a-z]+|unistd|fcntl|dirent|dlfcn|link|elf|poll|pthread|sched|signal|termios|pwd|grp|spawn|ucontext|execinfo|libgen|glob|fnmatch|netdb|syslog|semaphore|aio|ftw|stdlib)\.h'
functions='(secure_getenv|setenv|unsetenv|putenv|mkstemps?|mkdtemp|realpath|popen|pclose|fileno|fdopen|ftrylockfile|flockfile|localtime_r|gmtime_r|strerror_r|nanosleep|clock_gettime|posix_[a-z_]+)'
found=$(grep -rnE "^ *# *include <($headers|csignal)>|(^|[^a-zA-Z0-9_.>])(::)?$functions *\(" --include='*.cc' --include='*.hh' \
    libhsdm apps plugins | grep -vE "$allowed" || true)
status=0
if [ -n "$found" ]; then
    printf '%s\n' "$found"
    echo "stands outside of core/system.cc: put it there, in words of core/system.hh or core/system_process.hh"
    status=1
fi
for variable in $(grep -rhoE '(trusted_variable|getenv)\("[A-Z_]+"\)' --include='*.cc' --include='*.hh' libhsdm apps plugins |
    sed -E 's/.*"(.*)".*/\1/' | sort -u); do
    for told in docs/command.md apps/hsdm/option_table.cc; do
        grep -q "$variable" "$told" || {
            echo "$variable is read from the environment, and $told does not say so"
            status=1
        }
    done
done
exit "$status"

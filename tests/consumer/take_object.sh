#!/bin/sh
# sh take_object.sh OTHER-TREE TREE COMPILER ARGUMENT...: a compiler launcher. What the compiler would write to is copied from
# the same place in the other build tree if it is there; only the rest is compiled, and what knows where hsdm is installed.
other=$1 tree=$2
shift 2
output='' last=''
for argument; do
    [ "$last" != -o ] || output=$argument
    last=$argument
    case $argument in -DHSDM_PLUGIN_FOLDER=*) exec "$@" ;; esac
done
case $output in
/*) ;;
*) output=$PWD/$output ;;
esac
object=$other/${output#"$tree"/}
if [ "$object" != "$other/$output" ] && [ -f "$object" ]; then
    exec cp "$object" "$output"
fi
exec "$@"

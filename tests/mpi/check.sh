#!/bin/sh
# sh check.sh HSDM HSDM-MPI GENERATE MPIRUN: the file that several processes write is that of one, and whatever
# goes wrong in one of them ends all, soon, with a message and nothing left behind.
set -eu
hsdm=$1 hsdm_mpi=$2 generate=$3 mpirun=$4
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
mkdir scratch
export OMPI_MCA_rmaps_base_oversubscribe=1 OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
export OMP_NUM_THREADS=1 OMPI_MCA_btl_vader_single_copy_mechanism=none

fail() {
    echo "FAILED: $1"
    cat out err 2>/dev/null || true
    exit 1
}

# by COUNT ARGUMENT...: what that many processes make of the scan; at most a minute
by() {
    count=$1
    shift
    timeout 60 "$mpirun" -n "$count" "$hsdm_mpi" reconstruct "$@" >out 2>err
}

"$generate" part --points 30000 -o scan.ply
"$hsdm" reconstruct scan.ply --depth 6 -o one.ply --features one.txt --quiet
for count in 1 2 3; do
    by $count scan.ply --depth 6 -o ranks.ply --features ranks.txt --scratch scratch --threads 1 --report report.json ||
        fail "$count processes: status $?"
    cmp one.ply ranks.ply || fail "$count processes write another mesh"
    cmp one.txt ranks.txt || fail "$count processes write other features"
    [ "$(grep -c '"seconds_waited"' report.json)" -eq $count ] && grep -q '"imbalance"' report.json ||
        fail "the report does not tell of $count ranks"
    grep -q "^ranks     $count: " out || fail "the summary does not tell of $count ranks"
done

# The voxel follows from the points.
"$hsdm" reconstruct scan.ply -o one-chosen.ply --quiet
by 3 scan.ply -o ranks.ply --scratch scratch --threads 1 || fail "no depth: status $?"
cmp one-chosen.ply ranks.ply || fail "3 processes choose another voxel"

# All write their part of the file.
for how in "mesh.ply" "mesh.ply --ascii" "mesh.ply --plain" "mesh.off" "mesh.stl" "mesh.stl --ascii"; do
    set -- $how
    "$hsdm" reconstruct scan.ply --depth 6 -o one-$1 ${2-} --quiet
    for count in 1 2 3 5; do
        by $count scan.ply --depth 6 -o $1 ${2-} --scratch scratch --threads 1 --report report.json ||
            fail "$how by $count: status $?"
        cmp one-$1 $1 || fail "$how is another by $count"
        [ $count -eq 1 ] || grep -q '"by_all_ranks": true' report.json || fail "$how was not written by all $count"
    done
    rm $1
done

# Several scans of one thing, binary and text: part of the points in each, and in a folder.
mkdir scans
"$generate" part --points 20000 --seed 2 -o scans/a.ply
"$generate" part --points 20000 --seed 3 -o scans/b.ply
"$generate" part --points 10000 --seed 4 -o c.ply
tail -c 480000 c.ply | od -An -v -w48 -t f8 >scans/c.xyz
rm c.ply
"$hsdm" reconstruct --join scans --depth 6 -o one-of-all.ply --quiet
"$hsdm" reconstruct scans/c.xyz scans/a.ply scans/b.ply --join --depth 6 -o ranks.ply --quiet
cmp one-of-all.ply ranks.ply || fail "files in another order give another mesh"
for count in 1 2 3; do
    by $count --join scans --depth 6 -o ranks.ply --scratch scratch --threads 1 ||
        fail "$count processes, several files: status $?"
    cmp one-of-all.ply ranks.ply || fail "$count processes write another mesh of several files"
done

# A scalar goes to the vertices.
printf 'ply\nformat binary_little_endian 1.0\nelement vertex 30000\n' >scalar.ply
for name in x y z nx ny height; do printf 'property double %s\n' $name >>scalar.ply; done
printf 'end_header\n' >>scalar.ply
tail -c 1440000 scan.ply >>scalar.ply
"$hsdm" reconstruct scalar.ply --depth 6 -o one-scalar.ply --quiet
by 3 scalar.ply --depth 6 -o ranks.ply --scratch scratch --threads 1 || fail "3 processes, a scalar: status $?"
cmp one-scalar.ply ranks.ply || fail "3 processes write another mesh of a scan with a scalar"
grep -q "^ranks     the first one alone" out && fail "the first process did a scan with a scalar alone"
rm scalar.ply

# What tiles cannot do the first process does alone.
tail -c 1440000 scan.ply | od -An -v -w48 -t f8 | awk '{ print $1 * 1e15, $2 * 1e15, $3 * 1e15, $4, $5, $6 }' >huge.xyz
"$hsdm" reconstruct huge.xyz --depth 6 -o one-huge.ply --quiet
by 3 huge.xyz --depth 6 -o ranks.ply --scratch scratch --threads 1 --resume --report report.json ||
    fail "3 processes, of extreme size: status $?"
cmp one-huge.ply ranks.ply || fail "the first process alone writes another mesh"
grep -q '"tiles": "none, by the first rank alone: the cloud is of extreme size"' report.json &&
    grep -q "^ranks     the first one alone, in one piece: the cloud is" out || fail "that it did is not told"
[ -z "$(ls -A scratch)" ] || fail "scratch is left of what was given up"
rm huge.xyz
"$hsdm" reconstruct scan.ply --max-error 1% -o one-adaptive.ply --quiet
by 3 scan.ply --max-error 1% -o ranks.ply --scratch scratch --threads 1 || fail "3 processes, --max-error: status $?"
cmp one-adaptive.ply ranks.ply || fail "the first process alone writes another adaptive mesh"
grep -q "^ranks     the first one alone, in one piece: it cannot come with --max-error yet" out || fail "that it did is not told"

# Different arguments, and a standard stream that is closed, which MPI must not take for a connection of its own.
status=0
timeout 60 "$mpirun" -n 1 "$hsdm_mpi" reconstruct scan.ply --depth 6 -o ranks.ply : \
    -n 1 "$hsdm_mpi" reconstruct scan.ply --depth 5 -o ranks.ply >out 2>err || status=$?
[ $status -ne 0 ] && [ $status -ne 124 ] || fail "different arguments: status $status"
[ "$(grep -c "^hsdm: the processes have different arguments" err)" -eq 1 ] || fail "different arguments: not told once"
expected=0
"$hsdm" reconstruct scan.ply --depth 6 -o ranks.ply >&- 2>out || expected=$?
status=0
timeout 60 "$hsdm_mpi" reconstruct scan.ply --depth 6 -o ranks.ply >&- 2>err || status=$?
[ $status -eq $expected ] || fail "standard output is closed: status $status, not $expected"
grep "^hsdm:" out >expected.txt || true
grep "^hsdm:" err | cmp - expected.txt || fail "standard output is closed: another message"
rm expected.txt

# refused WHAT TEXT ARGUMENT...: status, message, told once, and no file
refused() {
    what=$1 text=$2
    shift 2
    rm -f ranks.ply
    status=0
    by 3 "$@" || status=$?
    [ $status -ne 0 ] && [ $status -ne 124 ] || fail "$what: status $status"
    [ "$(grep -c "^hsdm: .*$text" err)" -eq 1 ] || fail "$what: not told once"
    [ ! -e ranks.ply ] || fail "$what: a file was written"
}
refused "no such file" "none.ply" none.ply --depth 6 -o ranks.ply
refused "an option that ranks do not have" "--levels" scan.ply --levels 4:5 -o ranks.ply
refused "several inputs" "one input" scan.ply scan.ply --depth 6 --out-dir .
refused "standard output" "names of files" scan.ply --depth 6 -o - --format off
refused "no folder for scratch" "/no/such" scan.ply --depth 6 -o ranks.ply --scratch /no/such
head -c 400000 scan.ply >short.ply
refused "a truncated file" "short.ply" short.ply --depth 6 -o ranks.ply

# What is done stays where the mesh has no place, and as many go on with it.
status=0
by 3 scan.ply --depth 6 -o /dev/full --format ply --scratch scratch --resume --threads 1 || status=$?
[ $status -eq 1 ] || fail "a full disk: status $status"
[ "$(ls scratch | tr '\n' ' ')" = "hsdm-resume-0 hsdm-resume-1 hsdm-resume-2 " ] || fail "a full disk: nothing was kept"
[ "$(grep -c 'what is done stays in scratch/hsdm-resume-0 and those beside it' err)" -eq 1 ] || fail "what stays is not told"
status=0
by 2 scan.ply --depth 6 -o ranks.ply --scratch scratch --resume --threads 1 || status=$?
[ $status -ne 0 ] && grep -q "number of processes: 3, and not 2" err || fail "fewer processes went on: status $status"
mv scratch/hsdm-resume-1 away
for turn in 1 2; do # the second time there is a folder, with nothing in it
    status=0
    by 3 scan.ply --depth 6 -o ranks.ply --scratch scratch --resume --threads 1 || status=$?
    [ $status -ne 0 ] && grep -q "rank 1 finds nothing in its hsdm-resume-1" err || fail "a rank lost its folder: status $status"
done
rm -r scratch/hsdm-resume-1
mv away scratch/hsdm-resume-1
by 3 scan.ply --depth 6 -o ranks.ply --scratch scratch --resume --threads 1 --report report.json ||
    fail "going on: status $?"
cmp one.ply ranks.ply || fail "going on gives another mesh"
kept=$(sed -n 's/.*"resume": "\([0-9]*\) tiles were kept".*/\1/p' report.json)
[ "$kept" -ge 3 ] || fail "of three ranks $kept tiles were gone on with"
[ -z "$(ls -A scratch)" ] || fail "scratch is left once the mesh is written"

# Scratch of its own for each, as on machines of their own: those that come back in another order begin nothing anew.
mkdir a b a/s b/s
# apart FIRST SECOND FILE: by two processes in these folders
apart() {
    of_one="reconstruct $folder/scan.ply --depth 6 -o $3 --format ply --scratch s --resume --threads 1"
    timeout 60 "$mpirun" -n 1 --wdir "$folder/$1" "$hsdm_mpi" $of_one : -n 1 --wdir "$folder/$2" "$hsdm_mpi" $of_one \
        >out 2>err
}
status=0
apart a b /dev/full || status=$?
[ $status -eq 1 ] && [ -d a/s/hsdm-resume-0 ] && [ -d b/s/hsdm-resume-1 ] || fail "scratch of its own: status $status"
status=0
apart b a "$folder/ranks.ply" || status=$?
[ $status -eq 1 ] && [ "$(grep -c 'has no hsdm-resume-0, which rank 1 on' err)" -eq 1 ] || fail "machines in another order: status $status"
apart a b apart.ply || fail "machines in the same order: status $?"
cmp one.ply a/apart.ply || fail "machines that do not see one folder write another mesh"
[ -z "$(ls -A a/s)$(ls -A b/s)" ] && [ "$(ls b)" = s ] || fail "files are left on a machine"
rm -r a b

# A rank that is killed, or asked to end, at any time.
"$generate" part --points 300000 -o long.ply
cat >rank.sh <<'END'
echo $$ >pid.tmp.$OMPI_COMM_WORLD_RANK
mv pid.tmp.$OMPI_COMM_WORLD_RANK pid.$OMPI_COMM_WORLD_RANK
exec env --default-signal=INT,TERM "$@"
END
for signal in KILL TERM INT; do
    for delay in 0.1 0.4 0.8; do
        what="a rank was ended by $signal after $delay s"
        rm -f ranks.ply pid.*
        "$mpirun" -n 3 sh rank.sh "$hsdm_mpi" reconstruct long.ply --depth 9 -o ranks.ply --scratch scratch \
            --threads 1 >out 2>err &
        job=$!
        while [ ! -e pid.1 ]; do sleep 0.05; done
        sleep $delay
        kill -s $signal "$(cat pid.1)" 2>/dev/null || fail "$what: it had ended"
        (sleep 30 && touch late && kill -s KILL $job) 2>/dev/null &
        watch=$!
        status=0
        wait $job || status=$?
        kill $watch 2>/dev/null || true
        if [ -e late ] && [ $signal = KILL ]; then
            # Open MPI's launcher may wait for ever for a rank that is gone before it has joined; the others do not.
            for rank in 0 2; do
                ! readlink "/proc/$(cat pid.$rank)/exe" | grep -F "$hsdm_mpi" || fail "$what: the others did not end"
            done
            rm late
        else
            [ ! -e late ] || fail "$what: the others did not end within half a minute"
            [ -s err ] || fail "$what: no message"
        fi
        [ $status -ne 0 ] || fail "$what: status 0"
        [ ! -e ranks.ply ] || fail "$what: a file was written"
        [ -z "$(ls -A scratch)" ] || fail "$what: scratch is left"
    done
done
rm -f pid.* rank.sh
rm -r scans report.json
ls | grep -v -e '^scan.ply$' -e '^long.ply$' -e '^short.ply$' -e '^one' -e '^ranks.txt$' -e '^scratch$' -e '^out$' -e '^err$' &&
    fail "files are left behind"
echo "several processes: the bits of one"

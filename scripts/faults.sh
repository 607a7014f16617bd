#!/usr/bin/env bash
# Breaks the program's surroundings, call by call, and holds every end against what is promised: a file
# is absent, old or complete, the exit code is a documented one, exit 0 means the right bytes, and no
# temporary file stays but of what kill -9 ended, which the next run removes. docs/reliability.md
# holds results. One row a kind; exit status 1 where a row has failures.
set -euo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/setup.sh"

usage() {
    cat <<'TEXT'
usage: scripts/faults.sh [flag]...
  --quick          up to 6 numbers of each call, in under 2 minutes of processor time
  --full           every number of every call (else up to 100)
  --program=FILE   the program (build/native/nuvo, built if none is given)
  -h               this list
TEXT
}

most=100 moments=100 nuvo=
while [ $# -gt 0 ]; do
    case $1 in
        --quick) most=6 moments=20 ;;
        --full) most=1000000000 ;;
        --program=*) nuvo=$(realpath -- "${1#*=}") ;;
        -h | --help) usage; exit 0 ;;
        *) usage >&2; echo "faults.sh: unknown flag $1" >&2; exit 2 ;;
    esac
    shift
done
if [ -z "$nuvo" ]; then
    nuvo_install "${nuvo_packages[@]}"
    nuvo_build native nuvo
    nuvo=$nuvo_root/build/native/nuvo
fi

ulimit -c 0
work=$(mktemp -d)
trap 'umount "$work/disk" 2>/dev/null || true; rm -rf "$work"' EXIT
gcc -O1 -shared -fPIC -o "$work/shim.so" "$nuvo_root/tests/faults/shim.c" -ldl
mkdir "$work/run" "$work/right"
cd "$work/run"
cat >scene.x3d <<'TEXT'
<X3D version="3.3"><Scene><Viewpoint position="0 0 8"/><PointLight location="3 4 5"/>
<Inline url='"part.x3d"'/>
<Shape><Appearance><Material/></Appearance><Sphere radius="1.5"/></Shape>
<Transform translation="1 1 1"><Shape><Appearance><Material/></Appearance><Box/></Shape></Transform>
</Scene></X3D>
TEXT
cat >part.x3d <<'TEXT'
<X3D version="3.3"><Scene><Transform translation="-2 0 1"><Shape><Appearance><Material/></Appearance>
<Sphere/></Shape></Transform></Scene></X3D>
TEXT
printf '0 0 8 0 0 -1\n-2 0 8 0 0 -1\n9 9 9 0 1 0\n' >rays.txt

declare -A flags=(
    [render]="scene.x3d --rep=1 --res=8,6 --quiet --out=out.png"
    [fast]="scene.x3d --rep=1 --res=8,6 --profile=fast --threads=2 --quiet --out=out.bmp"
    [compare]="scene.x3d -compare --rep=1 --res=8,6 --quiet --out=out.bmp"
    [rays]="scene.x3d --rays=rays.txt --quiet --out=out.txt"
    [piped]="scene.x3d --rays=- --quiet --out=out.txt"
    [study]="scene.x3d --study=out.json --rep=1 --res=2,2 --quiet"
    [describe]="scene.x3d --describe"
    [octree]="scene.x3d -showoctree --rep=1 --res=2,2 --max-objects=1 --quiet")
commands=(render fast compare rays piped study describe octree)

# Times differ from run to run, and so does which combination of a study is the fastest.
same() {
    case $1 in
        *.json) [ "$(tail -c 2 "$1")" = "}" ] ;;
        *) cmp -s "$1" "$2" ;;
    esac
}

without_time() { sed 's/, read in .*//' "$1"; }

# The command's files, standard output and exit code when nothing fails.
declare -A outputs
prepare() {
    local name=$1 file
    mkdir -p "$work/right/$name"
    "$nuvo" ${flags[$name]} <rays.txt >"$work/right/$name.stdout" 2>/dev/null
    outputs[$name]=
    for file in out*; do
        [ -e "$file" ] || continue
        mv "$file" "$work/right/$name/"
        outputs[$name]+=" $file"
    done
}

declare -A codes
runs=0 failures=0 all_failures=0
begin_row() { row=$1 runs=0 failures=0 codes=(); }
end_row() {
    local code told=
    for code in "${!codes[@]}"; do told+=" $code:${codes[$code]}"; done
    printf '%-44s %6d runs  %4d failures  exit codes%s\n' "$row" $runs $failures "$told"
    all_failures=$((all_failures + failures))
}
complain() {
    failures=$((failures + 1))
    if [ $failures -le 5 ]; then echo "  $1" >&2; fi
}

# Makes the files as they are before a run: with an even number old ones, else none.
set_stage() {
    local file
    rm -f .nuvo-* out*
    is_old=$(($2 % 2 == 0))
    if [ $is_old = 1 ]; then for file in ${outputs[$1]}; do printf old >"$file"; done; fi
}

# judge COMMAND WHAT CODE ALLOWED [leaves]: ALLOWED is a list of exit codes besides 0, e.g. "3 4".
judge() {
    local name=$1 what=$2 code=$3 allowed=" $4 " leaves=${5:-} file
    runs=$((runs + 1))
    codes[$code]=$((${codes[$code]:-0} + 1))
    [ "$code" = 0 ] || [[ $allowed == *" $code "* ]] || complain "$name, $what: exit code $code: $(head -c 200 "$work/stderr")"
    for file in ${outputs[$name]}; do
        if [ -e "$file" ]; then
            same "$file" "$work/right/$name/$file" && continue
            [ "$code" != 0 ] && [ $is_old = 1 ] && [ "$(tr -d '\0' <"$file")" = old ] && continue
            complain "$name, $what: exit code $code and $file is neither old nor complete"
        elif [ "$code" = 0 ] || [ $is_old = 1 ]; then
            complain "$name, $what: exit code $code and $file is missing"
        fi
    done
    if [ "$code" = 0 ] && [ -z "${outputs[$name]}" ] &&
        ! cmp -s <(without_time "$work/stdout") <(without_time "$work/right/$name.stdout"); then
        complain "$name, $what: exit code 0 and another standard output"
    fi
    if [ -z "$leaves" ] && compgen -G '.nuvo-*' >/dev/null; then
        complain "$name, $what: exit code $code and a temporary file stays"
    fi
}

# run COMMAND FAULT: the exit code is in $code.
run() {
    code=0
    NUVO_FAULT=$2 LD_PRELOAD=$work/shim.so "$nuvo" ${flags[$1]} <rays.txt >"$work/stdout" 2>"$work/stderr" || code=$?
}

# The numbers from 1 to $1, or $most of them spread evenly.
numbers() {
    if [ "$1" -le "$most" ]; then seq 1 "$1"; else
        seq 0 $((most - 1)) | awk -v n="$1" -v m="$most" '{ print 1 + int($1 * (n - 1) / (m - 1)) }'
    fi
}
count_of() {
    rm -f .nuvo-* out*
    NUVO_FAULT=$2:0:0 NUVO_FAULT_COUNT=$work/count LD_PRELOAD=$work/shim.so "$nuvo" ${flags[$1]} \
        <rays.txt >/dev/null 2>&1 || true
    count=$(<"$work/count")
}

# fail_calls KIND WHAT...: the n-th call of the kind fails so, in every command.
fail_calls() {
    local kind=$1 what name n
    shift
    begin_row "$kind fails ($*)${NUVO_FAULT_ONLY:+ of temporaries}"
    for name in "${commands[@]}"; do
        count_of "$name" "$kind"
        for n in $(numbers "$count"); do
            for what in "$@"; do
                set_stage "$name" "$n"
                run "$name" "$kind:$n:$what"
                # A temporary that cannot be removed stays.
                judge "$name" "$kind $n $what" "$code" "3 4" "$([ "$kind" != unlink ] || echo leaves)"
            done
        done
    done
    end_row
}

# end_by_signals NUMBER NAME: before and after each call, and at moments of the clock.
end_by_signals() {
    local signal=$1 name n when leaves= process
    begin_row "SIG$2"
    [ "$signal" != 9 ] || leaves=leaves
    for name in "${commands[@]}"; do
        count_of "$name" any
        for n in $(numbers "$count"); do
            for when in before after; do
                set_stage "$name" "$n"
                { run "$name" "any:$n:$when-$signal"; } 2>/dev/null
                judge "$name" "SIG$2 $when call $n" "$code" $((128 + signal)) $leaves
                [ "$signal" = 9 ] || continue
                run "$name" ""
                judge "$name" "the run after kill -9 $when call $n" "$code" ""
            done
        done
    done
    for ((n = 0; n < moments; ++n)); do
        name=${commands[n % ${#commands[@]}]}
        set_stage "$name" "$n"
        # Started here, not by a shell in between, which would get the signal.
        "$nuvo" ${flags[$name]} <rays.txt >"$work/stdout" 2>"$work/stderr" &
        process=$!
        sleep "0.0$((RANDOM % 60 + 10))"
        kill -"$signal" "$process" 2>/dev/null || true
        code=0
        { wait "$process" || code=$?; } 2>/dev/null
        judge "$name" "SIG$2 at a moment" "$code" $((128 + signal)) $leaves
    done
    end_row
}

# limit FLAG VALUES...: ulimit -FLAG VALUE.
limit() {
    local flag=$1 value name n=0
    shift
    begin_row "ulimit -$flag ($*)"
    for value in "$@"; do
        for name in "${commands[@]}"; do
            set_stage "$name" $((n += 1))
            code=0
            # Its files are opened before the limit holds.
            { (ulimit -"$flag" "$value"; exec "$nuvo" ${flags[$name]}) || code=$?; } \
                <rays.txt >"$work/stdout" 2>"$work/stderr"
            # Below its own size the program does not start at all: the system's doing, 127.
            judge "$name" "ulimit -$flag $value" "$code" "3 4 127"
        done
    done
    end_row
}

# outside ROW ALLOWED COMMAND...: a whole command line in the run's folder, e.g. with another target.
outside() {
    local name=$1 what=$2 allowed=$3
    shift 3
    set_stage "$name" 0
    code=0
    "$@" <rays.txt 2>"$work/stderr" || code=$?
    is_old=1 runs=$((runs + 1)) codes[$code]=$((${codes[$code]:-0} + 1))
    [[ " $allowed " == *" $code "* ]] || complain "$name, $what: exit code $code: $(head -c 200 "$work/stderr")"
    if compgen -G '.nuvo-*' >/dev/null; then complain "$name, $what: a temporary file stays"; fi
}

into_closed_pipe() {
    local status
    (trap - PIPE; set +o pipefail; "$nuvo" ${flags[$1]% --out=*} --out=- 2>"$work/stderr"; echo $? >"$work/code") | :
    status=$(<"$work/code")
    return "$status"
}

for name in "${commands[@]}"; do prepare "$name"; done

fail_calls alloc 12
# An Inline that is not there or not allowed is left out with a warning, by design: not tried.
fail_calls open 5 12 23 24
export NUVO_FAULT_ONLY=.nuvo-
fail_calls open 2 13 17 28 30
unset NUVO_FAULT_ONLY
fail_calls read 4 5 part
# Of a pipe nothing can tell an early end from the end.
commands=(render fast compare rays study describe octree)
fail_calls read zero
commands+=(piped)
fail_calls write 4 5 28 part
fail_calls close 4 5 28
fail_calls fsync 5 28
fail_calls rename 5 13 28
fail_calls unlink 5 13

end_by_signals 2 INT
end_by_signals 15 TERM
end_by_signals 1 HUP
end_by_signals 3 QUIT
end_by_signals 9 KILL

limit v 10000 40000 80000 120000 200000 400000
limit s 128 256 1024
limit n 3 4 5 6 8
limit f 0 1

begin_row "no room, no right, no reader"
for name in "${commands[@]}"; do
    outside "$name" "/dev/full" 4 bash -c 'exec "$@" >/dev/full' - "$nuvo" ${flags[$name]/--quiet/}
    outside "$name" "standard output closed" 4 bash -c 'exec "$@" >&-' - "$nuvo" ${flags[$name]/--quiet/}
done
for name in render fast compare rays; do
    outside "$name" "--out=/dev/full" 4 "$nuvo" ${flags[$name]% --out=*} --out=/dev/full
    # The two pictures of -compare are refused there.
    [ "$name" = compare ] ||
        outside "$name" "--out=- into /dev/full" 4 bash -c 'exec "$@" >/dev/full' - "$nuvo" ${flags[$name]% --out=*} --out=-
    outside "$name" "no such folder" 4 "$nuvo" ${flags[$name]% --out=*} --out=none/out.bmp
done
outside render "a pipe without a reader" 4 into_closed_pipe render
end_row

if mkdir "$work/disk" && mount -t tmpfs -o size=16k tmpfs "$work/disk" 2>/dev/null; then
    begin_row "full and read-only disk (tmpfs)"
    for name in render fast compare rays; do
        rm -f "$work/disk"/* "$work/disk"/.nuvo-*
        printf old >"$work/disk/out.bmp"
        head -c 100000 /dev/zero >"$work/disk/filler" 2>/dev/null || true
        outside "$name" "full disk" 4 "$nuvo" ${flags[$name]% --out=*} --out="$work/disk/out.bmp"
        [ "$(<"$work/disk/out.bmp")" = old ] || complain "$name, full disk: the old file is lost"
        if compgen -G "$work/disk/.nuvo-*" >/dev/null; then complain "$name, full disk: a temporary file stays"; fi
    done
    mount -o remount,ro "$work/disk"
    for name in render fast compare rays; do
        outside "$name" "read-only disk" 4 "$nuvo" ${flags[$name]% --out=*} --out="$work/disk/out.bmp"
    done
    end_row
else
    echo "full and read-only disk: left out, no tmpfs can be mounted here"
fi

begin_row "two runs on one target"
for ((n = 0; n < moments; ++n)); do
    name=${commands[n % 5]}
    set_stage "$name" "$n"
    processes=()
    for _ in 1 2 3; do
        "$nuvo" ${flags[$name]} <rays.txt >/dev/null 2>"$work/stderr" &
        processes+=($!)
    done
    for process in "${processes[@]}"; do
        code=0
        wait "$process" || code=$?
        [ $code = 0 ] || complain "$name: exit code $code: $(head -c 200 "$work/stderr")"
    done
    judge "$name" "three runs at a time" 0 ""
done
end_row

times >"$work/times"
echo "processor time of the runs: $(tail -1 "$work/times")"
[ $all_failures = 0 ]

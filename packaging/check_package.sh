#!/usr/bin/env bash
# Installs a build into a folder and holds what a user of the package does against what the program
# does: packaging/check_package.sh BUILD. The example must give the program's bytes; the manual page
# and the completion must know every flag.
set -euo pipefail
source_dir=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd)
build=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() {
    echo "check_package.sh: $1" >&2
    exit 1
}
quietly() { "$@" >"$work/log" 2>&1 || { cat "$work/log" >&2; fail "failed: $*"; }; }

quietly cmake --install "$build" --prefix "$work/prefix"
quietly cmake -S "$source_dir/examples/embed" -B "$work/embed" -G Ninja \
    "-DCMAKE_PREFIX_PATH=$work/prefix" -DCMAKE_BUILD_TYPE=Release
quietly cmake --build "$work/embed"
scene=$source_dir/testfiles/showcase.x3d
nuvo=$work/prefix/bin/nuvo
"$work/embed/embed" "$scene" "$work/embed.bmp" >"$work/said"
grep -q "shapes; the ray along -z" "$work/said" || fail "the example says nothing of its ray"
"$nuvo" "--file=$scene" --profile=fast --rep=1 --res=640,360 "--out=$work/nuvo.bmp" --quiet
cmp "$work/embed.bmp" "$work/nuvo.bmp"

# The flags as -h lists them, each without its value.
flags=$("$nuvo" -h | sed -n 's/^  \(-[^ ]*\).*/\1/p' | sed 's/[=,[].*//')
[ "$(wc -l <<<"$flags")" -gt 20 ] || fail "-h lists no flags"
manual=$(sed 's/\\-/-/g' "$work/prefix/share/man/man1/nuvo.1")
source "$work/prefix/share/bash-completion/completions/nuvo"
complete_word() {
    COMP_LINE="nuvo $1" COMP_POINT=$((5 + ${#1})) COMPREPLY=()
    _nuvo
    echo "${COMPREPLY[*]}"
}
for flag in $flags; do
    grep -q -- "^\.B $flag" <<<"$manual" || fail "nuvo.1 lacks $flag"
    [[ " $(complete_word "$flag") " == *" $flag"[\ =]* ]] || fail "completion lacks $flag"
done
[ "$(complete_word --profile=f)" = fast ] || fail "completion of --profile=f: $(complete_word --profile=f)"
if command -v man >/dev/null; then
    troubles=$(LC_ALL=C.UTF-8 MANROFFSEQ='' man --warnings -E UTF-8 -l -Tutf8 -Z \
        "$work/prefix/share/man/man1/nuvo.1" 2>&1 >/dev/null) || true
    [ -z "$troubles" ] || fail "man: $troubles"
fi

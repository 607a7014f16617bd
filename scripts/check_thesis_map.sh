#!/usr/bin/env bash
# Checks that every file and every test that docs/thesis-map.md names exists:
# scripts/check_thesis_map.sh [root of the project]
set -euo pipefail
cd -- "${1:-$(dirname -- "${BASH_SOURCE[0]}")/..}"

map=docs/thesis-map.md
faults=0

fault() {
    echo "$map: $1"
    faults=$((faults + 1))
}

# Every test as Suite.Name.
tests=$(find tests study -name '*_test.cpp' -exec cat {} + | tr '\n' ' ' |
    grep -oE 'TEST(_F|_P)?\( *[A-Za-z0-9_]+, *[A-Za-z0-9_]+ *\)' |
    sed -E 's/TEST(_F|_P)?\( *([A-Za-z0-9_]+), *([A-Za-z0-9_]+) *\)/\2.\3/')
# Fixtures under another name: using Program = ProgramTest.
known_test() {
    case $1 in
        *.\*) grep -q "^${1%\*}" <<<"$tests" ;;
        *) grep -qxF "$1" <<<"$tests" ;;
    esac
}

# A path from the root, from the public headers or from the map's own folder.
known_file() {
    compgen -G "$1" >/dev/null || compgen -G "include/nuvo/$1" >/dev/null ||
        compgen -G "docs/$1" >/dev/null
}

# Here-strings, as process substitution asks for /proc.
tokens=$(grep -oE '`[^`]+`' "$map" | tr -d '`' | sort -u)
links=$(grep -oE '\]\([^)#]+' "$map" | sed 's/^](//' | grep -v '^https\?:' | sort -u)
names=0
while IFS= read -r token; do
    if [[ $token =~ ^([A-Za-z0-9]+/)?([A-Z][A-Za-z0-9]+\.([A-Z][A-Za-z0-9]*|\*))$ ]]; then
        names=$((names + 1))
        [ "$token" = Suite.Name ] || known_test "${BASH_REMATCH[2]}" || fault "no test is called $token"
    elif [[ $token =~ ^[A-Za-z0-9_./*-]+$ && ($token == */* || $token =~ \.(h|cpp|sh|py|x3d|txt)$) ]]; then
        names=$((names + 1))
        known_file "$token" || fault "there is no file $token"
    fi
done <<<"$tokens"
while IFS= read -r link; do
    names=$((names + 1))
    known_file "$link" || fault "there is no file $link"
done <<<"$links"

[ $names -ge 50 ] || fault "only $names names were found in it: is it read as it should be?"
[ $faults -eq 0 ]

#!/usr/bin/env bash
# Makes the page of a tiny sweep twice and holds it against results.json, in Chromium where it and
# puppeteer-core are: scripts/report/check_report.sh NUVO. Ends with 77 where Python lacks what the page
# needs.
set -euo pipefail
here=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
root=$(cd -- "$here/../.." && pwd)
nuvo=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() {
    echo "check_report.sh: $1" >&2
    exit 1
}

# Three against three: one of 20 orders is as far apart on each side.
(cd "$here" && PYTHONDONTWRITEBYTECODE=1 python3 - <<'P'
import pairs
assert pairs.mann_whitney([1, 2, 3], [4, 5, 6]) == 0.1
assert pairs.mann_whitney([1, 2, 3], [1, 2, 3]) == 1.0
assert pairs.ratio([2, 4, 6], [1, 2, 3]) == {"median": 2, "interval": [2, 2], "pairs": 3}
assert pairs.same_against_same([1, 2, 3, 4, 5]) == [[1, 2], [4, 3]]
P
) || fail "pairs.py"

mkdir -p "$work/raw" "$work/look"
for type in uniform nonuniform; do
    flags=("--file=$root/testfiles/both" "--type=$type" --quiet)
    for round in 0 1 2; do
        "$nuvo" "${flags[@]}" --profile=thesis --rep=2 --res=96,54 --error --out=/dev/null \
            --json="$work/raw/thesis-both-$type-$round.json"
    done
    name=$work/look/both-$type
    "$nuvo" "${flags[@]}" --res=96,54 --rep=1 --planes="$name" --octree="$name-octree.json" \
        --out="$name.bmp" --json="$name.json"
    PYTHONDONTWRITEBYTECODE=1 python3 "$here/trace_rays.py" 20 "$name" "$work/look/rays/both-$type.json" \
        "$nuvo" "${flags[@]}" --res=96,54
    "$nuvo" "${flags[@]}" --res=96,54 --rep=1 --profile=thesis --out="$name-thesis.bmp" --error \
        --json="$work/error-$type.json"
    "$nuvo" "${flags[@]}" --res=96,54 --rep=1 --defaults=thesis --back-faces=draw --out="$name-right.bmp"
done
"$nuvo" "--file=$root/testfiles/both" --res=48,27 --rep=1 --quiet "--study=$work/study-both.json"
PYTHONDONTWRITEBYTECODE=1 python3 "$here/tables.py" "$work" --commit test >"$work/tables.txt" ||
    fail "tables.py"
# A baseline that was ten times as fast, one as it is, and one of another processor.
python3 - "$work" <<'P'
import json, pathlib, sys
folder = pathlib.Path(sys.argv[1])
def forge(name, change):
    document = json.loads((folder / "results.json").read_text())
    change(document)
    (folder / name).write_text(json.dumps(document))
def fast(document):
    for row in document["results"]:
        for run in row["runs"]:
            for key in ("build_seconds", "trace_seconds"):
                run[key] = [t / 10 for t in run[key]]
forge("fast.json", fast)
forge("same.json", lambda document: None)
forge("other.json", lambda document: document["environment"].update(processor="another"))
P

export PYTHONDONTWRITEBYTECODE=1
status=0
"$root/scripts/report.sh" "$work" >"$work/log" 2>&1 || status=$?
if [ $status -eq 3 ]; then
    cat "$work/log"
    exit 77
fi
[ $status -eq 0 ] || { cat "$work/log" >&2; fail "report.sh"; }
cp "$work/index.html" "$work/first.html"
"$root/scripts/report.sh" "$work" >/dev/null
cmp "$work/first.html" "$work/index.html"
# Wrong pixels as the program itself counts them, each with its crop.
for type in uniform nonuniform; do
    wrong=$(python3 -c 'import json, sys; print(json.load(open(sys.argv[1]))["error"]["differing_pixels"])' \
        "$work/error-$type.json")
    [ "$wrong" -gt 0 ] || fail "no wrong pixel to show"
    grep -q "both-$type: $wrong wrong pixels of 96 x 54" "$work/index.html" || fail "not $wrong wrong pixels, $type"
done
count() { grep -o "<td>$1</td></tr>" "$work/index.html" | wc -l; }
"$root/scripts/report.sh" "$work" "--baseline=$work/fast.json" >/dev/null
[ "$(count slower)" -eq 2 ] || fail "a baseline ten times as fast: $(count slower) of 2 rows flagged"
"$root/scripts/report.sh" "$work" "--baseline=$work/same.json" >/dev/null
[ "$(count same)" -eq 2 ] || fail "the run itself as baseline: $(count same) of 2 rows the same"
"$root/scripts/report.sh" "$work" "--baseline=$work/other.json" >/dev/null
grep -q "Refused: measured on another" "$work/index.html" || fail "another processor is not refused"

if command -v "${CHROMIUM:-chromium}" >/dev/null && node -e 'require("puppeteer-core")' 2>/dev/null; then
    node "$here/check_page.mjs" "$work"
else
    echo "not looked at in Chromium: needs chromium, node and npm install puppeteer-core in this folder"
fi

#!/usr/bin/env bash
# One page to look at and to send, index.html, from a folder that scripts/alltests.sh left:
# scripts/report.sh RESULTS [--baseline=results.json] [--date=TEXT]
set -euo pipefail
root=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd)
if [ $# -lt 1 ] || [ "$1" = -h ] || [ "$1" = --help ]; then
    sed -n '2,3s/^# //p' "${BASH_SOURCE[0]}"
    exit 2
fi
# The first python3 that has all of them: another one may stand before Debian's in PATH.
for python in python3 /usr/bin/python3; do
    "$python" -c 'import jinja2, matplotlib, numpy, pandas' 2>/dev/null &&
        exec "$python" "$root/scripts/report/page.py" "$@"
done
echo "report.sh: index.html needs apt-get install python3-jinja2 python3-matplotlib python3-pandas" >&2
exit 3

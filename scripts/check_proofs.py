#!/usr/bin/env python3
"""Checks that each error bound in the code has its proof, or a sentence why not, in
proofs/bounds.txt: scripts/check_proofs.py [root of the project]. Needs no Gappa."""
import pathlib
import re
import sys

FOLDERS = (
    "include/nuvo/geometry",
    "include/nuvo/octree",
    "src/geometry",
    "src/octree",
    "src/render",
)
# gamma(9), gamma_of<T>(9), roundings(8), 8 * kUnitRoundoff, 2 * ...::epsilon()
BOUND = re.compile(
    r"(?:gamma(?:_of<\w+>)?|roundings)\([^()]+\)"
    r"|[\w.]+ \* (?:k(?:Unit|Float)Roundoff\b|std::numeric_limits<(?:double|float)>::epsilon\(\))"
)
CONSTANT = re.compile(r"^[a-z_]+ = \d+;  # constant, step -?1: .+$", re.M)


def bounds_in_code(root):
    found = set()
    for folder in FOLDERS:
        for path in sorted((root / folder).rglob("*")):
            if path.suffix not in (".h", ".cpp"):
                continue
            for line in path.read_text().splitlines():
                code = line.split("//")[0]
                for bound in BOUND.findall(code):
                    found.add((path.relative_to(root).as_posix(), bound))
    return found


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parents[1])
    faults = []
    table = {}
    used = set()
    for number, line in enumerate((root / "proofs/bounds.txt").read_text().splitlines(), 1):
        if not line or line.startswith("#"):
            continue
        parts = [part.strip() for part in line.split("|")]
        if len(parts) != 3:
            faults.append(f"proofs/bounds.txt:{number}: not file | bound | proofs")
            continue
        table[parts[0], parts[1]] = parts[2]
        if parts[2].startswith("none: "):
            if len(parts[2]) < 30:
                faults.append(f"proofs/bounds.txt:{number}: no sentence why there is no proof")
        else:
            used.update(parts[2].split())
    code = bounds_in_code(root)
    for path, bound in sorted(code - set(table)):
        faults.append(f"{path}: {bound} has no line in proofs/bounds.txt")
    for path, bound in sorted(set(table) - code):
        faults.append(f"proofs/bounds.txt: {path} has no {bound}")
    numerics = (root / "docs/numerics.md").read_text()
    sections = {title.split(" (")[0].lower() for title in re.findall(r"^##+ (.+)$", numerics, re.M)}
    proofs = {path.stem: path.read_text() for path in (root / "proofs").glob("*.g")}
    for name in sorted(used - set(proofs)):
        faults.append(f"proofs/bounds.txt: there is no proofs/{name}.g")
    for name, text in sorted(proofs.items()):
        section = re.match(r"# \[numerics: ([^\]]+)\]", text)
        if not section or section[1] not in sections:
            faults.append(f"proofs/{name}.g: its first line names no section of docs/numerics.md")
        if not CONSTANT.search(text):
            faults.append(f"proofs/{name}.g: marks no constant")
        if name not in used:
            faults.append(f"proofs/{name}.g: proofs/bounds.txt does not name it")
        if f"proofs/{name}.g" not in numerics:
            faults.append(f"proofs/{name}.g: docs/numerics.md does not name it")
    print("\n".join(faults) if faults else f"{len(code)} bounds, {len(proofs)} proofs")
    return 1 if faults or len(code) < 100 else 0


if __name__ == "__main__":
    sys.exit(main())

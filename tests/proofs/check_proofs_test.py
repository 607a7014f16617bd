#!/usr/bin/env python3
"""scripts/check_proofs.py on copies of the project, each with one fault."""
import pathlib
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
FAULTS = [  # file, text, replacement, what the check says
    ("src/render/leaf_boxes.h", "gamma(6)", "gamma(5)", "leaf_boxes.h: gamma(5) has no line"),
    ("src/render/leaf_boxes.h", "gamma(6)", "0.5", "leaf_boxes.h has no gamma(6)"),
    ("proofs/slabs.g", "n = 6;  #", "n = 6; #", "slabs.g: marks no constant"),
    ("proofs/slabs.g", "[numerics: crowds]", "[numerics: x]", "slabs.g: its first line"),
    ("proofs/bounds.txt", "| slabs", "| slap", "there is no proofs/slap.g"),
    ("proofs/bounds.txt", "| slabs", "| none: no", "no sentence"),
    ("docs/numerics.md", "proofs/slabs.g", "proofs", "docs/numerics.md does not name it"),
]

failed = False
for file, old, new, message in FAULTS:
    with tempfile.TemporaryDirectory() as folder:
        copy = pathlib.Path(folder)
        for part in ("include", "src", "proofs"):
            shutil.copytree(ROOT / part, copy / part)
        (copy / "docs").mkdir()
        shutil.copy(ROOT / "docs/numerics.md", copy / "docs")
        path = copy / file
        text = path.read_text()
        assert old in text, (file, old)
        path.write_text(text.replace(old, new))
        run = subprocess.run(
            [sys.executable, ROOT / "scripts/check_proofs.py", copy], capture_output=True, text=True
        )
        if run.returncode != 1 or message not in run.stdout:
            print(f"{file}: {old} -> {new}: {run.returncode} {run.stdout}{run.stderr}")
            failed = True
sys.exit(failed)

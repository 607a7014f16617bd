"""What nuvo --pixel tells of a picture's dearest pixels, for the page of scripts/report.sh:

trace_rays.py NUMBER PREFIX RAYS.json NUVO [flag]...

The picture is cut into NUMBER fields, as many high as wide or one more; the pixel of each with the
largest value of PREFIX-tests.npy is asked about. PREFIX-ray.json takes all of the dearest one's
ray, RAYS.json of each ray what a picture of it needs.
"""

import array
import ast
import json
import math
import pathlib
import subprocess
import sys

STAGES = ("cheap", "wider", "exact")


def plane(path):
    """Shape and values of a .npy file of version 1 with uint32."""
    data = pathlib.Path(path).read_bytes()
    size = int.from_bytes(data[8:10], "little")
    header = ast.literal_eval(data[10:10 + size].decode("ascii"))
    if header["descr"] != "<u4" or array.array("I").itemsize != 4:
        sys.exit(f"{path}: {header['descr']} where <u4 was expected")
    return header["shape"], array.array("I", data[10 + size:])


def dearest(shape, values, number):
    """A pixel a field as (value, x, y), the dearest first."""
    height, width = shape
    rows = max(1, math.isqrt(number))
    columns = max(1, number // rows)
    found = []
    for row in range(rows):
        for column in range(columns):
            field = [(values[y * width + x], -y, -x)
                     for y in range(row * height // rows, (row + 1) * height // rows)
                     for x in range(column * width // columns, (column + 1) * width // columns)]
            if field:
                value, y, x = max(field)
                found.append((value, -x, -y))
    return sorted(found, key=lambda pixel: (-pixel[0], pixel[2], pixel[1]))


def shortened(story):
    """Of a ray: where it is, and what it cost."""
    ray = story["ray"]
    ends = [t for t in [ray["t_end"]] + [v["t_out"] for v in reversed(ray["voxels"])]
            if t is not None]
    tests = [test for voxel in ray["voxels"] for test in voxel["tests"]]
    return {"pixel": story["pixel"], "origin": ray["origin"], "direction": ray["direction"],
            "end": ends[0] if ends else None, "hit": story.get("hit", True) is not None,
            "tests": ray["intersection_tests"], "searches": ray["voxel_searches"],
            "stages": {s: sum(test["stage"] == s for test in tests) for s in STAGES},
            "voxels": [voxel["name"] for voxel in ray["voxels"]]}


def main():
    number, prefix, path, nuvo, *flags = sys.argv[1:]
    pixels = dearest(*plane(f"{prefix}-tests.npy"), int(number))
    rays = []
    for _, x, y in pixels:
        told = subprocess.run([nuvo, *flags, f"--pixel={x},{y}", "--json=-"], check=True,
                              capture_output=True, text=True).stdout
        if not rays:
            pathlib.Path(f"{prefix}-ray.json").write_text(told, encoding="utf-8")
        rays.append(shortened(json.loads(told)))
    pathlib.Path(path).parent.mkdir(exist_ok=True)
    pathlib.Path(path).write_text(json.dumps(rays) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()

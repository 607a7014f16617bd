"""The thesis' tables from the reports of scripts/alltests.sh: ours beside the published figures.

Reads DIR/raw/SETTING-SCENE-TYPE-ROUND.json, prints the tables and writes DIR/results.json and
DIR/results.csv. Standard library only.
"""

import argparse
import csv
import json
import pathlib
import platform
import statistics
import sys

import pairs

TYPES = ("uniform", "nonuniform")

# Thesis 5.8, i5-2500K at 1920 x 1080: depth, voxels, intersection tests, voxel searches, seconds.
PUBLISHED = {
    "teapot": {"uniform": (1, 1, 529548, 284970, 213.763),
               "nonuniform": (1, 1, 529548, 284970, 213.912)},
    "trianglemesh": {"uniform": (9, 8653, 21843910, 27018572, 10.379),
              "nonuniform": (6, 5552, 21789021, 26713679, 9.899)},
    "both": {"uniform": (9, 9381, 17183358, 46117742, 13.850),
              "nonuniform": (8, 7064, 11235896, 45362845, 12.533)},
    "concentric": {"uniform": (8, 9178, 33225320, 25603151, 8.607),
              "nonuniform": (8, 8422, 24876977, 25089438, 8.382)},
    "clumped": {"uniform": (9, 22807, 5954439, 23818331, 21.539),
              "nonuniform": (9, 15401, 6190599, 21231578, 14.386)},
}
PUBLISHED_RAYS = 1920 * 1080
# Shadow rays of one picture, and how far ours may be from them: where float decides whether a ray
# hits, the published program's own rounding counts.
PUBLISHED_SHADOW_RAYS = {"trianglemesh": (334824, 0), "both": (406862, 0),
                         "concentric": (312862, 100), "clumped": (174298, 10)}
PUBLISHED_SHAPES = {"teapot": 1, "trianglemesh": 728, "both": 1000, "concentric": 5985,
                    "clumped": 3200}

TITLES = {"teapot": "Base test: Utah teapot", "trianglemesh": "Test 1: uniform diamonds",
          "both": "Test 2: random diamonds", "concentric": "Test 3: concentric spheres",
          "clumped": "Test 4: clumped diamonds"}
SETTINGS = {
    "thesis": "thesis profile: the published program (--profile=thesis)",
    "exact": "exact profile (--profile=exact)",
}

# Row title, key, format. Only "time taken" has no exact value.
ROWS = (
    ("tree depth", "depth", "{:,.0f}"),
    ("voxels", "voxels", "{:,.0f}"),
    ("voxels per shape", "voxels_per_shape", "{:,.2f}"),
    ("intersection tests", "tests", "{:,.0f}"),
    ("intersections per ray", "tests_per_ray", "{:,.2f}"),
    ("voxel searches", "searches", "{:,.0f}"),
    ("searches per ray", "searches_per_ray", "{:,.2f}"),
    ("time taken (s)", "seconds", "{:,.3f}"),
    ("  of it building (s)", "build_seconds", "{:,.4f}"),
    ("  of it tracing (s)", "trace_seconds", "{:,.4f}"),
    ("wrong pixels", "wrong_pixels", "{:,.0f}"),
    ("RMS of 255", "rms", "{:.4f}"),
    ("PSNR (dB)", "psnr_db", "{:.2f}"),
)
# What nothing is better than 0: their change in percent says nothing.
ERROR_KEYS = {"wrong_pixels", "rms", "psnr_db"}


def published_figures(scene, octree_type):
    depth, voxels, tests, searches, seconds = PUBLISHED[scene][octree_type]
    return {"depth": depth, "voxels": voxels, "tests": tests, "searches": searches,
            "seconds": seconds, "voxels_per_shape": voxels / PUBLISHED_SHAPES[scene],
            "tests_per_ray": tests / PUBLISHED_RAYS, "searches_per_ray": searches / PUBLISHED_RAYS}


def error_figures(reports):
    """How far the picture is from the exact one; PSNR of equal pictures is null."""
    error = next((report["error"] for report in reports if "error" in report), None)
    if error is None:
        return {"wrong_pixels": None, "rms": None, "psnr_db": None}
    return {"wrong_pixels": error["differing_pixels"], "rms": error["rms"],
            "psnr_db": error["psnr_db"]}


def our_figures(reports):
    """One row of results from the reports of all rounds of one setting, scene and type."""
    first = reports[0]
    for report in reports[1:]:
        for exact in ("tree", "counts", "scene"):  # the error is told once
            if report[exact] != first[exact]:
                sys.exit(f"tables.py: {report['file']}: {exact} differs from one run to the next")
    build = [seconds for report in reports for seconds in report["build_seconds"]]
    trace = [seconds for report in reports for seconds in report["trace_seconds"]]
    frames = [b + t for b, t in zip(build, trace)]
    counts, tree = first["counts"], first["tree"]
    rays = counts["primary_rays"]
    return {
        "depth": tree["depth"], "voxels": tree["voxels"], "references": tree["references"],
        "memory_bytes": tree["memory_bytes"],
        "voxels_per_shape": tree["voxels"] / max(1, first["scene"]["objects"]),
        "tests": counts["intersection_tests"], "searches": counts["voxel_searches"],
        "shadow_rays": counts["shadow_rays"],
        "tests_per_ray": counts["intersection_tests"] / rays,
        "searches_per_ray": counts["voxel_searches"] / rays,
        "repetitions": len(frames),
        "seconds": statistics.fmean(frames), "seconds_median": statistics.median(frames),
        "seconds_least": min(frames), "seconds_most": max(frames),
        "build_seconds": statistics.fmean(build), "trace_seconds": statistics.fmean(trace),
        "user_clock_seconds": sum(report["user_seconds"] for report in reports) / len(frames),
        **error_figures(reports),
    }


def change(before, after):
    """Change in percent; None where there is nothing to compare."""
    if before is None or after is None:
        return None
    if before == 0:
        return 0.0 if after == 0 else None
    return 100 * (after - before) / before


def percent(value):
    return "" if value is None else f"{value:+.2f} %"


def load(folder):
    """{(setting, scene, type): [report, ...]} in the order of the rounds."""
    groups = {}
    for path in sorted((folder / "raw").glob("*.json")):
        setting_and_scene, octree_type, _ = path.stem.rsplit("-", 2)
        setting, scene = setting_and_scene.rsplit("-", 1)
        report = json.loads(path.read_text(encoding="utf-8"))
        groups.setdefault((setting, scene, octree_type), []).append(report)
    return groups


# What depends on the number of pixels and is compared at the published size only.
PIXEL_KEYS = {"tests", "searches", "seconds"}


def print_table(scene, ours, is_published_size):
    published = {t: published_figures(scene, t) for t in TYPES}
    print(f"\n{TITLES[scene]}")
    print(f"{'':22}| {'published':^39} | {'ours':^39} | ours against published")
    print(f"{'':22}| {'uniform':>13} {'non-uniform':>13} {'change':>11} "
          f"| {'uniform':>13} {'non-uniform':>13} {'change':>11} | {'uniform':>11} "
          f"{'non-uniform':>11}")
    for title, key, shape in ROWS:
        cells = []
        for figures in (published, ours):
            values = [figures[t].get(key) for t in TYPES]
            texts = ["" if v is None else shape.format(v) for v in values]
            if key in ERROR_KEYS and figures is ours:
                texts = [text or ("inf" if key == "psnr_db" and figures[t]["rms"] == 0 else "-")
                         for text, t in zip(texts, TYPES)]
            changed = "" if key in ERROR_KEYS else percent(change(*values))
            cells.append(f"{texts[0]:>13} {texts[1]:>13} {changed:>11}")
        comparable = key not in ERROR_KEYS and (is_published_size or key not in PIXEL_KEYS)
        against = [percent(change(published[t].get(key), ours[t][key])) if comparable else ""
                   for t in TYPES]
        print(f"{title:22}| {cells[0]} | {cells[1]} | {against[0]:>11} {against[1]:>11}".rstrip())


def checks(scene, ours, is_published_size):
    """What the published program restated is held to: (claim, holds, figures)."""
    published = {t: published_figures(scene, t) for t in TYPES}
    for t in TYPES:
        bound = 0 if t == "uniform" else 0.5
        off = change(published[t]["voxels"], ours[t]["voxels"])
        yield (f"{t}: voxels within {bound} %", abs(off) <= bound, percent(off))
        off = ours[t]["depth"] - published[t]["depth"]
        yield (f"{t}: depth", off == 0, f"{off:+d}")
    if not is_published_size or scene == "teapot":
        return
    theirs, slack = PUBLISHED_SHADOW_RAYS[scene]
    mine = ours["uniform"]["shadow_rays"]
    yield (f"shadow rays within {slack} of {theirs:,}", abs(mine - theirs) <= slack, f"{mine:,}")
    for key, name in (("tests", "intersection tests"), ("searches", "voxel searches")):
        for t in TYPES:
            off = change(published[t][key], ours[t][key])
            yield (f"{t}: {name} within 1.7 %", abs(off) <= 1.7, percent(off))
        theirs = change(published["uniform"][key], published["nonuniform"][key])
        mine = change(ours["uniform"][key], ours["nonuniform"][key])
        yield (f"change of {name} within 1.2 points", abs(mine - theirs) <= 1.2,
               f"{percent(mine)} against {percent(theirs)}")
    for t in TYPES:
        yield (f"{t}: a frame in less than the published time",
               ours[t]["seconds"] < published[t]["seconds"],
               f"{ours[t]['seconds']:.3f} s against {published[t]['seconds']:.3f} s")


def frame_times(reports):
    """Build and trace, in the order of measurement."""
    return [b + t for report in reports
            for b, t in zip(report["build_seconds"], report["trace_seconds"])]


def analysis(groups):
    """Speed-ups by pairs, and the same against the same, whose interval must hold 1."""
    speedups, twins = [], []
    for (setting, scene, octree_type), reports in groups.items():
        times = frame_times(reports)
        twins += pairs.same_against_same(times)
        if octree_type != "uniform" or (setting, scene, "nonuniform") not in groups:
            continue
        row = {"setting": setting, "scene": scene,
               **pairs.ratio(times, frame_times(groups[setting, scene, "nonuniform"]))}
        published = {t: published_figures(scene, t)["seconds"] for t in TYPES}
        row["published"] = published["uniform"] / published["nonuniform"]
        speedups.append(row)
    same = pairs.ratio(*zip(*twins)) if twins else None
    return {"speedups": speedups, "same_against_same": same}


def looks(folder):
    """Reports of the planes, octrees and single rays in DIR/look, by the name of their file."""
    return {path.stem: json.loads(path.read_text(encoding="utf-8"))
            for path in sorted((folder / "look").glob("*.json"))
            if not path.stem.endswith("-octree")}


def rays(folder):
    """What trace_rays.py left, by picture."""
    return {path.stem: json.loads(path.read_text(encoding="utf-8"))
            for path in sorted((folder / "look" / "rays").glob("*.json"))}


def studies(folder):
    return {path.stem.removeprefix("study-"): json.loads(path.read_text(encoding="utf-8"))
            for path in sorted(folder.glob("study-*.json"))}


def write_results(folder, results, groups, environment):
    columns = ["setting", "scene", "type"]
    columns += list(next(iter(results.values())))
    with open(folder / "results.csv", "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(columns)
        for key, figures in results.items():
            writer.writerow([*key, *figures.values()])
    document = {
        "environment": environment,
        "published": {s: {t: published_figures(s, t) for t in TYPES} for s in PUBLISHED},
        "results": [{"setting": key[0], "scene": key[1], "type": key[2], **figures,
                     "runs": groups[key]} for key, figures in results.items()],
        "analysis": analysis(groups),
        "looks": looks(folder),
        "rays": rays(folder),
        "studies": studies(folder),
    }
    text = json.dumps(document, indent=1, allow_nan=False) + "\n"
    (folder / "results.json").write_text(text, encoding="utf-8")


def processor_name():
    try:
        for line in pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                return line.split(":", 1)[1].strip()
    except OSError:
        pass
    return platform.processor() or platform.machine()


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--commit", default="unknown")
    parser.add_argument("--compiler", default="unknown")
    parser.add_argument("--priority", default="default")
    arguments = parser.parse_args()

    groups = load(arguments.folder)
    if not groups:
        sys.exit(f"tables.py: {arguments.folder / 'raw'}: no reports")
    results = {key: our_figures(reports) for key, reports in groups.items()}
    any_report = next(iter(groups.values()))[0]
    size = any_report["resolution"]
    environment = {"nuvo": any_report["nuvo"], "commit": arguments.commit,
                   "compiler": arguments.compiler, "processor": processor_name(),
                   "system": platform.platform(), "priority": arguments.priority,
                   "resolution": size}

    print(f"Ours: {environment['processor']}, {environment['compiler']}, "
          f"{size['width']} x {size['height']}. Published: i5-2500K, 1920 x 1080.")
    print("Times: mean of build and trace by the fine clock; every raw time is in results.json.")
    is_published_size = size == {"width": 1920, "height": 1080}
    if not is_published_size:
        print("The published totals and times are of 1920 x 1080 and not compared here.")
    for setting, title in SETTINGS.items():
        scenes = [s for s in PUBLISHED if all((setting, s, t) in results for t in TYPES)]
        if not scenes:
            continue
        print(f"\n=== {title}")
        for scene in scenes:
            ours = {t: results[setting, scene, t] for t in TYPES}
            print_table(scene, ours, is_published_size)
        if setting == "exact":
            continue
        print("\nAgainst the published figures")
        for scene in scenes:
            ours = {t: results[setting, scene, t] for t in TYPES}
            for claim, holds, figures in checks(scene, ours, is_published_size):
                print(f"  {'yes' if holds else 'NO ':3} {scene} {claim}: {figures}")
    write_results(arguments.folder, results, groups, environment)
    print(f"\nresults: {arguments.folder / 'results.json'}, {arguments.folder / 'results.csv'}")


if __name__ == "__main__":
    main()

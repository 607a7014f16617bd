#!/usr/bin/env python3
"""Tables and plots of the study of midpoints: midpoints.py RESULTS [--docs DOCS].

Reads RESULTS/runs/SCENE.SETTING.json (nuvo_study), writes RESULTS/tables.md, cost.svg and sah.svg;
with --docs also the marked tables of DOCS/midpoint-study.md and DOCS/images/midpoint-*.svg.
Standard library only."""
import argparse
import json
import math
import random
import re
import statistics
import sys
from pathlib import Path

CHOSEN_ON = ["trianglemesh", "both", "concentric", "clumped", "teapot"]
FAMILIES = ["aisles", "drift", "stadium", "sticks", "sizes", "floor", "meshes"]
OTHERS = ["grid", "kd-tree", "bvh"]
MESHES = ["terrain", "assembly"]
FRAME_PIXELS = 1920 * 1080
RESAMPLES = 2000


def family_of(scene):
    if scene in CHOSEN_ON:
        return "chosen on"
    if scene in MESHES:
        return "meshes"
    return scene.rsplit("-", 1)[0]


def load(folder):
    runs = {}
    for path in sorted((folder / "runs").glob("*.json")):
        scene, setting = path.stem.rsplit(".", 1)
        runs[scene, setting] = json.loads(path.read_text())
    return runs


def octrees(run):
    return [row for row in run["rows"] if row["kind"] == "octree"]


def by_name(run):
    return {row["name"]: row for row in run["rows"]}


def interval(values, statistic=statistics.median, seed=1):
    """The statistic and the percentile bootstrap's 95 % interval of it."""
    chance = random.Random(seed)
    found = sorted(
        statistic([chance.choice(values) for _ in values]) for _ in range(RESAMPLES))
    cut = int(0.025 * RESAMPLES)
    return statistic(values), found[cut], found[-1 - cut]


def shown(triple, digits=2):
    return "{:.{d}f} ({:.{d}f} .. {:.{d}f})".format(*triple, d=digits)


def table(header, rows):
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    lines += ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows]
    return "\n".join(lines)


class Costs:
    """Seconds of a test and of a leaf entered: least squares over all octrees, each scene with a
    constant of its own (shading, ray set-up), weighted by the scene's time."""

    def __init__(self, runs):
        xx = xy = yy = xt = yt = 0.0
        points = []
        for (_, setting), run in runs.items():
            rows = [r for r in octrees(run) if r["trace_seconds"]]
            if setting != "program" or len(rows) < 2:
                continue
            times = [min(r["trace_seconds"]) for r in rows]
            weight = 1 / statistics.mean(times)
            tests = [r["camera"]["tests"] * weight for r in rows]
            leaves = [r["camera"]["leaves"] * weight for r in rows]
            times = [t * weight for t in times]
            centred = [[v - statistics.mean(column) for v in column]
                       for column in (tests, leaves, times)]
            points += zip(*centred)
        for x, y, t in points:
            xx += x * x
            xy += x * y
            yy += y * y
            xt += x * t
            yt += y * t
        determinant = xx * yy - xy * xy
        self.test = (xt * yy - yt * xy) / determinant
        self.leaf = (yt * xx - xt * xy) / determinant
        unexplained = sum((t - self.test * x - self.leaf * y)**2 for x, y, t in points)
        self.explained = 1 - unexplained / sum(t * t for _, _, t in points)
        self.points = len(points)

    def work(self, row, rays="camera"):
        return self.test * row[rays]["tests"] + self.leaf * row[rays]["leaves"]


def ratios(runs, costs, name, base, family, what):
    found = []
    for (scene, setting), run in runs.items():
        rows = by_name(run)
        if setting != "program" or name not in rows:
            continue
        if family != "all held out" and family_of(scene) != family:
            continue
        if family == "all held out" and family_of(scene) == "chosen on":
            continue
        found.append(what(rows[name]) / what(rows[base]))
    return found


def methods_of(runs, setting):
    for (_, s), run in runs.items():
        if s == setting:
            return [row["name"] for row in octrees(run)]
    return []


def cost_table(runs, costs, what, seed=1):
    columns = ["chosen on"] + FAMILIES + ["all held out"]
    rows = []
    for name in methods_of(runs, "program"):
        cells = [name]
        for family in columns:
            found = ratios(runs, costs, name, "spatial", family, what)
            cells.append(shown(interval(found, seed=seed)) if found else "-")
        rows.append(cells)
    return table(["method"] + columns, rows)


def counts_table(runs, setting, scenes, what="tests"):
    rows = []
    for name in methods_of(runs, setting):
        cells = [name]
        for scene in scenes:
            run = runs.get((scene, setting))
            row = by_name(run)[name] if run else None
            cells.append("-" if row is None else "{:.2f} / {:.1f} / {:.0f}".format(
                row["camera"]["tests"] / run["pixels"], row["camera"]["leaves"] / run["pixels"],
                row["sah"]))
        rows.append(cells)
    return table(["method"] + scenes, rows)


def gap_table(runs, objective):
    rows = []
    gaps = {}
    for (_, setting), run in runs.items():
        if setting == "alone":
            for gap in run["gaps"]:
                if gap["objective"] == objective:
                    gaps.setdefault(gap["name"], []).append(gap)
    for name, found in gaps.items():
        voxels = sum(g["voxels"] for g in found)
        bounded = sum(g["voxels"] - g["unbounded"] for g in found)
        if voxels == 0 or bounded == 0:
            continue
        exact = sum(g["exact"] for g in found) / voxels
        mean = sum(g["mean"] * (g["voxels"] - g["unbounded"]) for g in found) / bounded
        scenes = [g["mean"] for g in found if g["voxels"] > g["unbounded"]]
        asked = sum(g["evaluations"] * (g["voxels"] + g["without"]) for g in found)
        rows.append([
            name, f"{voxels:,}", f"{100 * exact:.0f} %", f"{100 * mean:.1f} %",
            shown([100 * v for v in interval(scenes)], 1) + " %",
            "x {:.3g}".format(1 + max(g["worst"] for g in found)),
            sum(g["unbounded"] for g in found),
            "{:.0f}".format(asked / max(1, sum(g["voxels"] + g["without"] for g in found)))
        ])
    return table(["method", "voxels", "exact", "above, mean", "median of scenes", "worst",
                  "optimum 0 missed", "evaluations a voxel"], rows)


def break_even(runs, costs, name):
    """Frames of 1920 x 1080 after which the build is paid back, by scene: build seconds resampled
    over rounds, seconds saved from counts. None: never."""
    found = []
    for (scene, setting), run in runs.items():
        rows = by_name(run)
        if setting != "program" or name not in rows or not rows[name]["build_seconds"]:
            continue
        scale = FRAME_PIXELS / run["pixels"]
        saved = (costs.work(rows["spatial"]) - costs.work(rows[name])) * scale
        pairs = list(zip(rows[name]["build_seconds"], rows["spatial"]["build_seconds"]))
        extra = min(a for a, _ in pairs) - min(b for _, b in pairs)
        found.append((scene, extra, saved, pairs))
    return found


def frames(extra, saved):
    if extra <= 0 and saved >= 0:
        return 0.0
    return extra / saved if saved > 0 and extra > 0 else math.inf if extra > 0 else 0.0


def shown_frames(value):
    return "never" if math.isinf(value) else f"{value:.2f}"


def break_even_table(runs, costs):
    rows = []
    for name in methods_of(runs, "program"):
        if name == "spatial":
            continue
        cells = [name]
        for group in ("chosen on", "held out"):
            scenes = [s for s in break_even(runs, costs, name)
                      if (family_of(s[0]) == "chosen on") == (group == "chosen on")]
            if not scenes:
                cells += ["-", "-"]
                continue
            chance = random.Random(1)
            medians = []
            for _ in range(RESAMPLES):
                sample = []
                for _ in scenes:
                    _, _, saved, pairs = chance.choice(scenes)
                    drawn = [chance.choice(pairs) for _ in pairs]
                    sample.append(frames(min(a for a, _ in drawn) - min(b for _, b in drawn), saved))
                medians.append(statistics.median_high(sample))
            medians.sort()
            middle = statistics.median_high([frames(e, s) for _, e, s, _ in scenes])
            cut = int(0.025 * RESAMPLES)
            cells.append(f"{shown_frames(middle)} ({shown_frames(medians[cut])} .. "
                         f"{shown_frames(medians[-1 - cut])})")
            cells.append("{} of {}".format(sum(s > 0 for _, _, s, _ in scenes), len(scenes)))
        rows.append(cells)
    return table(["method", "frames, chosen on", "traces faster", "frames, held out",
                  "traces faster"], rows)


def others_table(runs, costs):
    rows = []
    for name in ["spatial", "sweep"] + OTHERS:
        tests, steps, times, builds, random_tests = [], [], [], [], []
        for (_, setting), run in runs.items():
            found = by_name(run)
            if setting != "program" or name not in found or "bvh" not in found:
                continue
            row, base = found[name], found["sweep"]
            tests.append(row["camera"]["tests"] / run["pixels"])
            random_tests.append(row["random"]["tests"] / row["random"]["rays"])
            steps.append((row["camera"]["leaves"] + row["camera"]["nodes"]) / run["pixels"])
            times.append(min(row["trace_seconds"]) / min(base["trace_seconds"]))
            builds.append(min(row["build_seconds"]) / min(base["build_seconds"]))
        rows.append([name, shown(interval(tests)), shown(interval(steps)),
                     shown(interval(random_tests)), shown(interval(times)),
                     shown(interval(builds))])
    return table(["structure", "tests a pixel", "nodes and leaves a pixel",
                  "tests of a random ray", "processor time, sweep = 1", "build, sweep = 1"], rows)


def stadium_table(runs, costs):
    rows = []
    for (scene, setting), run in sorted(runs.items()):
        if setting != "program" or family_of(scene) not in ("stadium", "floor"):
            continue
        rows_of = by_name(run)
        base = rows_of["spatial"]
        rows.append([scene] + [
            "{:.3f} / {:.3f}".format(
                costs.work(rows_of[name]) / costs.work(base),
                costs.work(rows_of[name], "random") / costs.work(base, "random"))
            for name in methods_of(runs, "program")[1:]])
    return table(["scene"] + methods_of(runs, "program")[1:], rows)


def sah_points(runs):
    points = []
    for (scene, setting), run in runs.items():
        rows = by_name(run)
        if setting != "program":
            continue
        base = rows["spatial"]
        for row in octrees(run):
            if row is not base and row["trace_seconds"]:
                points.append((row["sah"] / base["sah"],
                               min(row["trace_seconds"]) / min(base["trace_seconds"]), row, base))
    return points


def correlation(pairs):
    xs, ys = [math.log(x) for x, _ in pairs], [math.log(y) for _, y in pairs]
    mx, my = statistics.mean(xs), statistics.mean(ys)
    top = sum((x - mx) * (y - my) for x, y in zip(xs, ys))
    return top / math.sqrt(sum((x - mx)**2 for x in xs) * sum((y - my)**2 for y in ys))


def predict_table(runs, costs):
    points = sah_points(runs)
    rows = [["final SAH", "processor time", correlation([(s, t) for s, t, _, _ in points])],
            ["final SAH", "counted work, camera",
             correlation([(s, costs.work(r) / costs.work(b)) for s, _, r, b in points])],
            ["final SAH", "counted work, random rays",
             correlation([(s, costs.work(r, "random") / costs.work(b, "random"))
                          for s, _, r, b in points])],
            ["counted work, camera", "processor time",
             correlation([(costs.work(r) / costs.work(b), t) for _, t, r, b in points])]]
    return table(["ratio to spatial of", "against that of", "correlation of logarithms"],
                 [[a, b, f"{c:.2f}"] for a, b, c in rows])


def summary(runs, costs):
    """One screen of the study, for the page of scripts/report.sh: medians of the scenes held out
    with their intervals, the uniform octree's = 1."""
    def held_out(name, what):
        found = ratios(runs, costs, name, "spatial", "all held out", what)
        return [round(value, 4) for value in interval(found)]
    scenes = [s for s, setting in runs if setting == "program" and family_of(s) != "chosen on"]
    total, wrong = identity(runs)
    octree_methods = methods_of(runs, "program")
    return {"scenes": len(scenes), "traced": total, "wrong": wrong,
            "rows": [{"method": name,
                      "work": held_out(name, costs.work) if name in octree_methods else None,
                      "time": held_out(name, lambda row: min(row["trace_seconds"])),
                      "build": held_out(name, lambda row: min(row["build_seconds"]))}
                     for name in octree_methods + OTHERS]}


def identity(runs):
    rows = [row for run in runs.values() for row in run["rows"]]
    wrong = [row for row in rows if not (row["same_picture"] and row["same_as_brute_force"])]
    return len(rows), len(wrong)


def svg(width, height, body):
    return (f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
            f'viewBox="0 0 {width} {height}" font-family="sans-serif" font-size="12">\n'
            f'<rect width="100%" height="100%" fill="white"/>\n{body}</svg>\n')


def text(x, y, words, anchor="start"):
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}">{words}</text>\n'


def cost_plot(runs, costs):
    names = [n for n in methods_of(runs, "program") if n != "spatial"]
    families = ["chosen on"] + FAMILIES
    left, row_height, low, high = 130, 16, 0.5, 1.4
    width, group = 760, row_height * len(names) + 26
    scale = lambda v: left + (min(max(v, low), high) - low) / (high - low) * (width - left - 20)
    body, y = text(left, 14, "counted work / that of the uniform octree: median, 95 % interval"), 26
    for family in families:
        body += f'<line x1="{scale(1):.1f}" x2="{scale(1):.1f}" y1="{y}" y2="{y + group - 14}" stroke="#999"/>\n'
        body += text(6, y + 12, f"<tspan font-weight='bold'>{family}</tspan>")
        for i, name in enumerate(names):
            found = ratios(runs, costs, name, "spatial", family, costs.work)
            at = y + 24 + i * row_height
            body += text(left - 6, at + 4, name, "end")
            if not found:
                continue
            middle, a, b = interval(found)
            color = "#1a7a3c" if middle < 1 else "#b03020"
            body += (f'<line x1="{scale(a):.1f}" x2="{scale(b):.1f}" y1="{at}" y2="{at}" '
                     f'stroke="{color}" stroke-width="2"/>\n'
                     f'<circle cx="{scale(middle):.1f}" cy="{at}" r="4" fill="{color}"/>\n')
        y += group
    for tick in (0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.2, 1.3, 1.4):
        body += text(scale(tick), y + 4, f"{tick:.1f}", "middle")
    return svg(width, y + 14, body)


def sah_plot(runs):
    points = sah_points(runs)
    size, low, high = 460, 0.4, 1.6
    scale = lambda v: 50 + (min(max(v, low), high) - low) / (high - low) * (size - 70)
    body = text(50, 16, "final SAH (across) and processor time (up), each / the uniform octree's")
    for tick in (0.4, 0.6, 0.8, 1.0, 1.2, 1.4, 1.6):
        body += text(scale(tick), size - 8, f"{tick:.1f}", "middle")
        body += text(44, size - scale(tick) + 20, f"{tick:.1f}", "end")
    body += (f'<line x1="{scale(low)}" y1="{size - scale(low) + 16}" x2="{scale(high)}" '
             f'y2="{size - scale(high) + 16}" stroke="#999"/>\n')
    for s, t, _, _ in points:
        body += (f'<circle cx="{scale(s):.1f}" cy="{size - scale(t) + 16:.1f}" r="3" '
                 'fill="#2050a0" fill-opacity="0.5"/>\n')
    return svg(size, size, body)


def tables(runs, costs):
    total, wrong = identity(runs)
    seconds = lambda row: min(row["trace_seconds"])
    return {
        "identity": f"{total:,} octrees and other structures were traced; {wrong} of their "
                    "pictures differ from brute force's or from each other's.",
        "calibration": "A test {:.1f} ns, a leaf entered {:.0f} ns (a leaf is {:.1f} tests); {:.0f} % of "
                       "the variation within scenes explained, {} octrees.".format(
                           1e9 * costs.test, 1e9 * costs.leaf, costs.leaf / costs.test,
                           100 * costs.explained, costs.points),
        "alone": counts_table(runs, "alone", CHOSEN_ON),
        "thesis": counts_table(runs, "thesis", CHOSEN_ON[:4]),
        "shapes": counts_table(runs, "shapes", CHOSEN_ON[:4]),
        "gap": gap_table(runs, "eq19-medians"),
        "gap-area": gap_table(runs, "area-voxel"),
        "cost": cost_table(runs, costs, costs.work),
        "random": cost_table(runs, costs, lambda row: costs.work(row, "random")),
        "time": cost_table(runs, costs, seconds),
        "build": cost_table(runs, costs, lambda row: min(row["build_seconds"])),
        "stadium": stadium_table(runs, costs),
        "break-even": break_even_table(runs, costs),
        "others": others_table(runs, costs),
        "predict": predict_table(runs, costs),
    }


def put_into(document, found):
    words = document.read_text()
    for name, content in found.items():
        pattern = rf"(<!-- table {name} -->\n).*?(<!-- end -->)"
        words = re.sub(pattern, lambda m: m[1] + content + "\n" + m[2], words, flags=re.S)
    document.write_text(words)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("results", type=Path)
    parser.add_argument("--docs", type=Path)
    arguments = parser.parse_args()
    runs = load(arguments.results)
    if not any(setting == "program" for _, setting in runs):
        sys.exit(f"midpoints.py: {arguments.results}/runs: no SCENE.program.json")
    costs = Costs(runs)
    found = tables(runs, costs)
    (arguments.results / "tables.md").write_text(
        "\n\n".join(f"## {name}\n\n{content}" for name, content in found.items()) + "\n")
    plots = {"cost": cost_plot(runs, costs), "sah": sah_plot(runs)}
    for name, content in plots.items():
        (arguments.results / f"{name}.svg").write_text(content)
    screen = json.dumps(summary(runs, costs)) + "\n"
    (arguments.results / "summary.json").write_text(screen)
    if arguments.docs:
        (arguments.docs / "midpoint-summary.json").write_text(screen)
        put_into(arguments.docs / "midpoint-study.md", found)
        for name, content in plots.items():
            (arguments.docs / "images" / f"midpoint-{name}.svg").write_text(content)
    print(found["identity"])
    print(found["calibration"])


if __name__ == "__main__":
    main()

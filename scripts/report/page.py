"""index.html from the folder of scripts/alltests.sh: one file, without a request, the same bytes for
the same results. It only shows what results.json says. Needs jinja2, matplotlib, numpy, pandas."""

import argparse
import base64
import io
import json
import math
import pathlib
import re
import struct
import zlib

import jinja2
import markupsafe
import matplotlib
import numpy
import pandas

import pairs
import tables

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402 (the backend comes first)

HERE = pathlib.Path(__file__).parent / "page"
COLORS = {"uniform": "#3b76c4", "nonuniform": "#d1701f"}
MIDPOINTS = pathlib.Path(__file__).parents[2] / "docs/midpoint-summary.json"
CROP = 16  # pixels a side of the worst part of a picture
CHANGED = 0.02  # medians closer than this are the same whatever their p


def svg(figure, name):
    """A figure as inline SVG with the page's own text color, the same bytes each time."""
    with matplotlib.rc_context({"svg.hashsalt": name}):
        text = io.StringIO()
        figure.savefig(text, format="svg", transparent=True, bbox_inches="tight",
                       metadata={"Date": None, "Creator": None})
    pyplot.close(figure)
    body = text.getvalue()
    body = body[body.index("<svg"):].replace("#000000", "currentColor")
    body = re.sub(r'id="([^"]+)"', rf'id="{name}-\1"', body)
    body = re.sub(r'(url\(#|href="#)', rf"\g<1>{name}-", body)
    return re.sub(r'(<svg[^>]*?) width="[^"]+"', r"\1", re.sub(
        r'(<svg[^>]*?) height="[^"]+"', r"\1", body, count=1), count=1)


def axes(width=7.0, height=3.0, columns=1):
    matplotlib.rcParams.update({"svg.fonttype": "none", "font.size": 9,
                                "font.family": "sans-serif", "axes.spines.top": False,
                                "axes.spines.right": False})
    return pyplot.subplots(1, columns, figsize=(width, height), squeeze=False)


def forest(analysis):
    rows = analysis["speedups"]
    figure, [[plot]] = axes(height=0.6 + 0.3 * len(rows))
    for y, row in enumerate(reversed(rows)):
        if row["interval"]:
            plot.plot(row["interval"], [y, y], color=COLORS["nonuniform"], linewidth=2)
        plot.plot(row["median"], y, "o", color=COLORS["nonuniform"])
        if row["setting"] == "thesis":
            plot.plot(row["published"], y, "o", markerfacecolor="none", color="#808080")
    plot.axvline(1, color="#808080", linewidth=0.8)
    plot.set_yticks(range(len(rows)), [f"{r['scene']}, {r['setting']}" for r in reversed(rows)])
    plot.set_xlabel("uniform / non-uniform, times as fast")
    return svg(figure, "forest")


def midpoint_forest(study):
    """Counted work of each way to choose a midpoint, the uniform octree's = 1."""
    rows = [r for r in study["rows"] if r["work"] and r["method"] != "spatial"]
    figure, [[plot]] = axes(height=0.6 + 0.22 * len(rows))
    for y, row in enumerate(reversed(rows)):
        plot.plot(row["work"][1:], [y, y], color=COLORS["nonuniform"], linewidth=2)
        plot.plot(row["work"][0], y, "o", color=COLORS["nonuniform"])
    plot.axvline(1, color="#808080", linewidth=0.8)
    plot.set_yticks(range(len(rows)), [r["method"] for r in reversed(rows)])
    plot.set_xlabel("counted work / that of the uniform octree")
    return svg(figure, "midpoints")


def raw_times(results):
    scenes = list(dict.fromkeys((r["setting"], r["scene"]) for r in results))
    figure, [plots] = axes(width=max(7.0, 2.1 * len(scenes)), height=2.2, columns=len(scenes))
    for plot, (setting, scene) in zip(plots, scenes):
        for row in results:
            if (row["setting"], row["scene"]) == (setting, scene):
                plot.plot(tables.frame_times(row["runs"]), ".", color=COLORS[row["type"]])
        plot.set_title(f"{scene}, {setting}", fontsize=8)
        plot.set_ylim(bottom=0)
    plots[0].set_ylabel("seconds a frame")
    figure.tight_layout()
    return svg(figure, "times")


def split(results):
    """Build and trace of a frame, reading and writing of a run."""
    figure, [[plot]] = axes(height=0.8 + 0.28 * len(results))
    names = [f"{r['scene']}, {r['setting']}, {r['type']}" for r in results]
    left = numpy.zeros(len(results))
    parts = {"read": lambda r: r["runs"][0]["parse_seconds"], "build": lambda r: r["build_seconds"],
             "trace": lambda r: r["trace_seconds"], "write": lambda r: r["runs"][0]["write_seconds"]}
    for (part, seconds), color in zip(parts.items(), ("#7a7a7a", "#3b76c4", "#d1701f", "#4a9a5a")):
        widths = numpy.array([seconds(r) for r in results])
        plot.barh(names, widths, left=left, color=color, label=part)
        left += widths
    plot.invert_yaxis()
    plot.set_xlabel("seconds")
    plot.legend(frameon=False, ncols=4, loc="lower right", bbox_to_anchor=(1, 1))
    return svg(figure, "split")


def histograms(octrees):
    if not octrees:
        return ""
    scenes = list(dict.fromkeys(o["scene"] for o in octrees))
    figure, grid = pyplot.subplots(2, len(scenes), figsize=(max(7.0, 2.1 * len(scenes)), 4), squeeze=False)
    for column, scene in enumerate(scenes):
        for i, octree in enumerate(o for o in octrees if o["scene"] == scene):
            depths, items = octree["leaves"][:, 6], octree["leaves"][:, 7]
            most = int(min(items.max(initial=1), 40))
            for plot, values, top in ((grid[0][column], depths, int(depths.max())),
                                      (grid[1][column], numpy.minimum(items, most), most)):
                counts = numpy.bincount(values.astype(int), minlength=top + 1)
                plot.bar(numpy.arange(len(counts)) + 0.4 * i, counts, width=0.4,
                         color=COLORS[octree["type"]], label=octree["type"])
        grid[0][column].set_title(f"{scene}: depth of leaves", fontsize=8)
        grid[1][column].set_title("items a leaf", fontsize=8)
        grid[1][column].set_yscale("log")
    grid[0][0].legend(frameon=False, fontsize=7)
    figure.tight_layout()
    return svg(figure, "histograms")


def study_points(study):
    """Points of speed against error in a box of 640 x 300, errors of 0 in a column of their own."""
    rows = [r for r in study["rows"] if r["trace_seconds_median"] > 0]
    errors = [r["rms"] for r in rows if r["rms"] > 0]
    low, high = (math.log10(min(errors)), math.log10(max(errors))) if errors else (0, 1)
    times = [math.log10(r["trace_seconds_median"]) for r in rows]
    bottom, top = min(times), max(times)
    points = []
    for row in rows:
        share = (math.log10(row["rms"]) - low) / max(high - low, 1e-9) if row["rms"] > 0 else -0.15
        height = (math.log10(row["trace_seconds_median"]) - bottom) / max(top - bottom, 1e-9)
        points.append({"x": round(170 + 440 * share if row["rms"] > 0 else 90, 1),
                       "y": round(270 - 240 * height, 1), "row": row,
                       "index": study["rows"].index(row),
                       "flags": f"--profile={row['profile']['name']} {row['change']}".strip()})
    frontier = sorted((p for p in points if p["row"]["frontier"]), key=lambda p: (p["x"], p["y"]))
    return {"points": points, "frontier": " ".join(f"{p['x']},{p['y']}" for p in frontier),
            "least": 10 ** low, "most": 10 ** high, "fastest": 10 ** bottom, "slowest": 10 ** top}


def png(values):
    """Whole numbers below 2^24 as the red, green and blue of a PNG, which a canvas reads back."""
    return rgb_png(numpy.stack([values >> 16, values >> 8, values], axis=2).astype(numpy.uint8))


def rgb_png(bytes_):
    height, width, _ = bytes_.shape
    lines = numpy.concatenate([numpy.zeros((height, 1), numpy.uint8),
                               bytes_.reshape(height, 3 * width)], axis=1)

    def chunk(kind, data):
        return (struct.pack(">I", len(data)) + kind + data
                + struct.pack(">I", zlib.crc32(kind + data)))
    data = (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(lines.tobytes(), 9)) + chunk(b"IEND", b""))
    return base64.b64encode(data).decode("ascii")


def costs(folder, looks):
    """The planes of each scene, both octrees."""
    scenes = list(dict.fromkeys(name.rsplit("-", 1)[0] for name in looks if not name.endswith("-ray")))
    out = []
    for scene in scenes:
        for quantity, counter in (("tests", "intersection_tests"), ("searches", "voxel_searches")):
            names = {t: f"{scene}-{t}" for t in tables.TYPES}
            paths = {t: folder / "look" / f"{names[t]}-{quantity}.npy" for t in names}
            if not all(path.exists() for path in paths.values()):
                continue
            planes = {t: numpy.load(paths[t]) for t in paths}
            for t, plane in planes.items():
                if int(plane.sum()) != looks[names[t]]["counts"][counter]:
                    raise SystemExit(f"page.py: {paths[t]}: its sum is not {counter}")
            out.append({"scene": scene, "quantity": quantity, "counter": counter, "names": names,
                        "max": max(int(p.max()) for p in planes.values()),
                        "width": planes["uniform"].shape[1], "height": planes["uniform"].shape[0],
                        "png": {t: png(p.astype(numpy.uint32)) for t, p in planes.items()}})
    return out


def bmp(path):
    """The pixels of a BMP file of nuvo, the top row first, as red, green and blue."""
    data = path.read_bytes()
    first, = struct.unpack_from("<I", data, 10)
    width, height, _, bits = struct.unpack_from("<iiHH", data, 18)
    if data[:2] != b"BM" or bits != 24 or height <= 0:
        raise SystemExit(f"page.py: {path}: not a BMP file of 24 bits")
    stride = (3 * width + 3) // 4 * 4
    rows = numpy.frombuffer(data, numpy.uint8, stride * height, first).reshape(height, stride)
    return rows[::-1, :3 * width].reshape(height, width, 3)[:, :, ::-1]


def wrong_pixels(folder, looks):
    """Of each picture of the thesis profile how many pixels are wrong, and its worst part."""
    out = []
    for name in looks:
        paths = [folder / "look" / f"{name}-{kind}.bmp" for kind in ("right", "thesis")]
        if not all(path.exists() for path in paths):
            continue
        right, thesis = (bmp(path) for path in paths)
        apart = numpy.abs(right.astype(int) - thesis.astype(int))
        wrong = apart.max(axis=2)
        sums = numpy.pad(wrong.cumsum(0).cumsum(1), ((1, 0), (1, 0)))
        high, wide = (min(CROP, side) for side in wrong.shape)
        inside = sums[high:, wide:] - sums[:-high, wide:] - sums[high:, :-wide] + sums[:-high, :-wide]
        y, x = numpy.unravel_index(inside.argmax(), inside.shape)
        part = numpy.s_[y:y + high, x:x + wide]
        scale = 255 / max(1, int(apart[part].max()))
        out.append({"name": name, "count": int((wrong > 0).sum()), "most": int(wrong.max()),
                    "width": wrong.shape[1], "height": wrong.shape[0], "x": int(x), "y": int(y),
                    "pictures": {"right": rgb_png(right[part]), "thesis profile": rgb_png(thesis[part]),
                                 "difference": rgb_png((apart[part] * scale).astype(numpy.uint8))}})
    return out


def packed(data):
    return base64.b64encode(zlib.compress(data, 9)).decode("ascii")


def read_octrees(folder, looks):
    out = []
    for name in looks:
        path = folder / "look" / f"{name}-octree.json"
        if not path.exists():
            continue
        document = json.loads(path.read_text(encoding="utf-8"))
        scene, octree_type = name.rsplit("-", 1)
        leaves = numpy.array([[*v["min"], *v["max"], v["depth"], v["items"]]
                              for v in document["leaves"]], dtype="<f4")
        shown = leaves[:, 7] > 0
        names = [str(v["name"]) for v, s in zip(document["leaves"], shown) if s]
        out.append({"name": name, "scene": scene, "type": octree_type, "leaves": leaves,
                    "voxels": document["voxels"], "shown": int(shown.sum()),
                    "bounds": [*leaves[:, 0:3].min(0).tolist(), *leaves[:, 3:6].max(0).tolist()],
                    "data": packed(leaves[shown].tobytes()), "names": packed(" ".join(names).encode())})
    return sorted(out, key=lambda o: (o["scene"], tables.TYPES.index(o["type"])))


def compare_with(baseline, document):
    """Rows of both runs: how much longer we took, or why that is not said."""
    mine = document["environment"]["processor"]
    theirs = baseline["environment"]["processor"]
    if mine != theirs:
        return {"refused": f"measured on {theirs}, this run on {mine}: times are not compared"}
    old = {(r["setting"], r["scene"], r["type"]): r for r in baseline["results"]}
    rows = []
    for row in document["results"]:
        key = (row["setting"], row["scene"], row["type"])
        if key not in old:
            continue
        ours, before = tables.frame_times(row["runs"]), tables.frame_times(old[key]["runs"])
        ratio = float(numpy.median(ours) / numpy.median(before))
        p = pairs.mann_whitney(ours, before)
        apart = max(ours) < min(before) or min(ours) > max(before)
        changed = abs(ratio - 1) > CHANGED and (p < 0.05 or (apart and abs(ratio - 1) > 0.1))
        rows.append({"name": ", ".join(key), "ratio": ratio, "p": p, "runs": len(ours),
                     "verdict": "same" if not changed else "slower" if ratio > 1 else "faster"})
    return {"rows": rows}


def verdicts(document):
    same = document["analysis"]["same_against_same"]
    holds = same is not None and same["interval"] and same["interval"][0] <= 1 <= same["interval"][1]
    exact = [r for r in document["results"] if r["setting"] == "exact" and r["wrong_pixels"] is not None]
    wrong = sum(r["wrong_pixels"] for r in exact)
    return {"same": same, "holds": holds, "comparisons": len(exact), "wrong": wrong}


def lookup(document, path):
    for part in path.split("."):
        document = document[int(part)] if isinstance(document, list) else document[part]
    return document


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--baseline", type=pathlib.Path, help="results.json of an earlier run")
    parser.add_argument("--midpoints", type=pathlib.Path, default=MIDPOINTS,
                        help="summary.json of scripts/study_midpoints.sh (the documented run)")
    parser.add_argument("--date", default="", help="said on the page; none: not said")
    arguments = parser.parse_args()
    folder = arguments.folder
    document = json.loads((folder / "results.json").read_text(encoding="utf-8"))
    looks = document["looks"]
    octrees = read_octrees(folder, looks)
    frame = pandas.DataFrame(document["results"]).drop(columns="runs")
    baseline = None
    if arguments.baseline:
        baseline = compare_with(json.loads(arguments.baseline.read_text(encoding="utf-8")), document)

    midpoints = json.loads(arguments.midpoints.read_text(encoding="utf-8"))
    environment = jinja2.Environment(loader=jinja2.FileSystemLoader(HERE), trim_blocks=True,
                                     lstrip_blocks=True, undefined=jinja2.StrictUndefined,
                                     autoescape=True)

    def value(path, shape="{:,}"):
        """A number of results.json: its text for people, and its path and own text for the test."""
        number = lookup(document, path)
        text = "-" if number is None else shape.format(number)
        return markupsafe.Markup(
            f'<data value="{json.dumps(number)}" data-value="{path}">{text}</data>')
    environment.globals.update(value=value, percent=tables.percent, change=tables.change)
    environment.filters["script"] = lambda data: markupsafe.Markup(
        json.dumps(data, allow_nan=False, separators=(",", ":")).replace("</", "<\\/"))
    viridis = "".join("%02x%02x%02x" % tuple(round(255 * c) for c in color[:3])
                      for color in matplotlib.colormaps["viridis"].colors)
    html = environment.get_template("template.html.j2").render(
        document=document, everything=dict(document, midpoints=midpoints), date=arguments.date, titles=tables.TITLES, settings=tables.SETTINGS,
        published=document["published"], rows=tables.ROWS, error_keys=tables.ERROR_KEYS,
        places={(r["setting"], r["scene"], r["type"]): i for i, r in enumerate(document["results"])},
        scenes=list(dict.fromkeys(frame["scene"])), verdict=verdicts(document),
        forest=forest(document["analysis"]), times=raw_times(document["results"]),
        split=split(document["results"]), midpoints=midpoints,
        midpoint_forest=midpoint_forest(midpoints), histograms=histograms(octrees),
        studies={name: study_points(s) for name, s in document["studies"].items()},
        costs=costs(folder, looks), wrong=wrong_pixels(folder, looks), baseline=baseline, viridis=viridis, csv=frame.to_csv(index=False),
        rays=[name for name in looks if name.endswith("-ray")],
        octrees=[{k: v for k, v in o.items() if k != "leaves"} for o in octrees],
        css=(HERE / "page.css").read_text(encoding="utf-8"),
        js=(HERE / "page.js").read_text(encoding="utf-8"),
        three=(HERE / "three.bundle.js").read_text(encoding="utf-8") if octrees else "")
    path = folder / "index.html"
    path.write_text(html, encoding="utf-8")
    print(f"page: {path} ({path.stat().st_size / 1e6:.2f} MB)")


if __name__ == "__main__":
    main()

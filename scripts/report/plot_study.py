#!/usr/bin/env python3
"""Draws speed against error from the reports of nuvo --study. Needs matplotlib."""

import argparse
import itertools
import json
import math
import pathlib
import sys

try:
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot, ticker
    from matplotlib.lines import Line2D
except ImportError:
    sys.exit("plot_study.py: matplotlib is not installed (apt-get install python3-matplotlib)")

PROFILES = {"exact": "tab:blue", "thesis": "tab:orange", "fast": "tab:red"}
PRECISIONS = {"exact": "o", "double": "s", "float": "^"}


def label(row):
    return (row["profile"]["name"] + " " + row["change"].replace("--", "")).strip()


def least_error(studies):
    """Where error 0 is drawn: a power of ten clearly below the least other error."""
    errors = [row["rms"] for study in studies for row in study["rows"] if row["rms"] > 0]
    return 10 ** math.floor(math.log10(min(errors, default=1) / 3))


def draw(axes, study, floor):
    rows = study["rows"]
    for row in rows:
        seconds = row["trace_seconds_median"]
        low, high = row["trace_seconds_interval"]
        axes.errorbar(seconds, max(row["rms"], floor),
                      xerr=[[seconds - low], [high - seconds]], linestyle="none",
                      marker=PRECISIONS[row["profile"]["precision"]], markersize=6,
                      color=PROFILES[row["profile"]["name"]], elinewidth=0.8, alpha=0.75,
                      markeredgecolor="black" if row["frontier"] else "none")
    frontier = sorted((row for row in rows if row["frontier"]),
                      key=lambda row: row["trace_seconds_median"])
    points = [(row["trace_seconds_median"], max(row["rms"], floor)) for row in frontier]
    # A staircase: to the right of a point nothing better is known until the next.
    axes.step([x for x, _ in points] + [max(row["trace_seconds_median"] for row in rows)],
              [y for _, y in points] + [points[-1][1]],
              where="post", color="tab:green", linewidth=1, zorder=0)
    # Names for those with an error, once a place; what is right is told apart in the table.
    named = [(row["trace_seconds_median"], row["rms"], label(row)) for row in rows
             if row["rms"] > 0 or row["frontier"]]
    places = {}
    for seconds, error, name in sorted(named, key=lambda entry: -entry[1]):
        places.setdefault(f"{max(error, floor):.2g}", []).append((seconds, error, name))
    for offset, group in zip(itertools.cycle((4, -9)), places.values()):
        seconds, error, name = min(group, key=lambda entry: len(entry[2]))
        more = f" and {len(group) - 1} more" if len(group) > 1 else ""
        axes.annotate(name + more, (seconds, max(error, floor)), xytext=(6, offset),
                      textcoords="offset points", fontsize=6.5)
    axes.axhline(floor, color="grey", linewidth=0.6, linestyle=":")
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.margins(x=0.25)
    axes.xaxis.set_major_formatter(ticker.StrMethodFormatter("{x:g}"))
    times = [row["trace_seconds_median"] for row in study["rows"]]
    crowded = max(times) > 10 * min(times)  # the ticks between powers of ten would overlap
    axes.xaxis.set_minor_formatter(ticker.NullFormatter() if crowded
                                   else ticker.StrMethodFormatter("{x:g}"))
    size = study["resolution"]
    axes.set_title(f"{pathlib.Path(study['file']).stem}, {size['width']} x {size['height']}")
    axes.set_xlabel("processor seconds to trace a frame (median of "
                    f"{study['rounds']}, 95 % interval)")
    axes.grid(True, which="major", linewidth=0.3)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("studies", nargs="+", type=pathlib.Path, help="JSON of nuvo --study")
    parser.add_argument("--out", type=pathlib.Path, required=True, help="PNG or SVG")
    arguments = parser.parse_args()

    studies = [json.loads(path.read_text(encoding="utf-8")) for path in arguments.studies]
    floor = least_error(studies)
    figure, all_axes = pyplot.subplots(1, len(studies), squeeze=False, sharey=True,
                                       figsize=(8 * len(studies), 5.5))
    for axes, study in zip(all_axes[0], studies):
        draw(axes, study, floor)
    first = all_axes[0][0]
    first.set_ylabel("RMS error of a channel, of 255")
    figure.canvas.draw()  # settles the ticks
    ticks = [tick for tick in first.get_yticks() if floor < tick <= 255]
    first.set_yticks([floor] + ticks, ["0"] + [f"{tick:g}" for tick in ticks])
    first.set_ylim(bottom=floor / 3)
    marks = [Line2D([], [], marker="o", linestyle="none", color=color, label=f"{name} profile")
             for name, color in PROFILES.items()]
    marks += [Line2D([], [], marker=marker, linestyle="none", color="grey", label=f"{name} tests")
              for name, marker in PRECISIONS.items()]
    marks.append(Line2D([], [], color="tab:green", label="frontier"))
    first.legend(handles=marks, fontsize=7, loc="upper left")
    figure.tight_layout()
    arguments.out.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(arguments.out, dpi=130)
    print(arguments.out)


if __name__ == "__main__":
    main()

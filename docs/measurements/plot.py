#!/usr/bin/env python3
"""Plots what `coppice bench --csv` wrote.

    plot.py OUT_PREFIX FILE.csv...

writes OUT_PREFIX-sort.svg and OUT_PREFIX-scan.svg (rate by size) and, for each builder, OUT_PREFIX-BUILDER.svg (time
of each kernel by the number of triangles), as far as the files have such rows. Needs matplotlib (Debian:
apt-get install python3-matplotlib, and then /usr/bin/python3 plot.py ...).
"""
import csv
import math
import sys

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt

plt.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": "coppice", "font.size": 9, "axes.grid": True,
                     "grid.alpha": 0.3, "lines.markersize": 3, "legend.fontsize": 7, "figure.figsize": (6.4, 4.4)})


def rows_of(files):
    rows = []
    for file in files:
        with open(file, newline="") as lines:
            rows += list(csv.DictReader(lines))
    for row in rows:
        row["size"] = int(row["size"])
    return sorted(rows, key=lambda row: row["size"])


def finish(figure, axes, rows, path, xlabel, ylabel):
    origin = rows[0]
    axes.set(xscale="log", xlabel=xlabel, ylabel=ylabel)
    axes.set_title(f"{origin['device']}, {origin['driver']}, {origin['date']}", fontsize=8)
    axes.legend(ncols=2)
    figure.tight_layout()
    figure.savefig(path, metadata={"Date": None})
    plt.close(figure)
    print(path)


def plot_sort(rows, path):
    rows = [row for row in rows if row["name"].startswith("sort_")]
    if not rows:
        return
    figure, axes = plt.subplots()
    for name in sorted({row["name"] for row in rows}):
        for preset, style in (("random", "o-"), ("all-equal", "x:")):
            line = [row for row in rows if row["name"] == name and row["input"] == preset]
            if line:
                colour = f"C{['sort_keys_32', 'sort_pairs_32', 'sort_keys_64', 'sort_pairs_64'].index(name)}"
                axes.plot([row["size"] for row in line], [float(row["millions_per_s"]) for row in line], style,
                          color=colour, label=f"{name[5:].replace('_', ', ')} bits, {preset}")
    axes.set_ylim(bottom=0)
    finish(figure, axes, rows, path, "keys", "million keys a second")


def plot_scan(rows, path):
    rows = [row for row in rows if row["name"] == "scan"]
    if not rows:
        return
    figure, axes = plt.subplots()
    sizes = [row["size"] for row in rows]
    axes.plot(sizes, [float(row["millions_per_s"]) for row in rows], "o-", label="prefix_scan")
    axes.plot(sizes, [row["size"] / float(row["std_exclusive_scan_ms"]) / 1000 for row in rows], "x:",
              label="std::exclusive_scan, one thread")
    axes.set_ylim(bottom=0)
    finish(figure, axes, rows, path, "words", "million words a second")


def plot_build(rows, builder, path):
    rows = [row for row in rows if row["name"] == builder]
    if not rows:
        return
    figure, axes = plt.subplots(figsize=(6.4, 5.4))
    sizes = [row["size"] for row in rows]
    kernels = [column[:-3] for column in rows[0] if column.endswith("_ms") and column != "timed_ms"]
    for index, kernel in enumerate(kernels):
        line = [(row["size"], float(row[kernel + "_ms"])) for row in rows if row.get(kernel + "_ms")]
        if line:
            axes.plot(*zip(*line), "o-", color=f"C{index % 10}", label=kernel)
    axes.plot(sizes, [float(row["ms"]) for row in rows], "ks-", linewidth=2, label="whole build, untimed")
    # Guides through the whole build's last point.
    n, t = sizes[-1], float(rows[-1]["ms"])
    axes.plot(sizes, [t * size / n for size in sizes], "k--", linewidth=0.8, label="n")
    axes.plot(sizes, [t * size * math.log(size) / (n * math.log(n)) for size in sizes], "k:", linewidth=0.8,
              label="n log n")
    axes.set_yscale("log")
    finish(figure, axes, rows, path, "triangles", f"{builder}: ms")


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    prefix, rows = sys.argv[1], rows_of(sys.argv[2:])
    plot_sort(rows, prefix + "-sort.svg")
    plot_scan(rows, prefix + "-scan.svg")
    for builder in sorted({row["name"] for row in rows if row["name"].startswith("gpu-")}):
        plot_build(rows, builder, f"{prefix}-{builder}.svg")


if __name__ == "__main__":
    main()

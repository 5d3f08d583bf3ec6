#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws what bench/run measured: plot.py [--paper] DIR.

Of DIR/results.json plots of each workload and of its studies; with --paper, of DIR/paper.json the
figures, paper-table1.csv, paper-counts.csv and paper.html, which holds its plots and pictures.
"""

import base64
import csv
import html
import json
import pathlib
import sys

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as pyplot

OURS, FCL = "#2a6f97", "#c1121f"
SHADES = ["#61a5c2", OURS, "#f4a261", FCL]


class Plot:
    """A plot that is written as SVG and PNG at the end of its block."""

    def __init__(self, path, title, x="", y="", log=""):
        self.path = path
        self.figure, self.axes = pyplot.subplots(figsize=(9, 5.2))
        self.axes.set(title=title, xlabel=x, ylabel=y)
        if "x" in log:
            self.axes.set_xscale("log")
        if "y" in log:
            self.axes.set_yscale("log")
        self.axes.grid(color="#d8d8d8")
        self.axes.set_axisbelow(True)

    def line(self, xs, ys, label, color=None, style="-", marker="."):
        self.axes.plot(xs, ys, style, label=label, color=color, marker=marker)

    def __enter__(self):
        return self

    def __exit__(self, *error):
        if self.axes.get_legend_handles_labels()[0]:
            self.axes.legend(fontsize=8)
        self.figure.tight_layout()
        for kind in ("svg", "png"):
            self.figure.savefig(self.path.with_suffix("." + kind))
        pyplot.close(self.figure)


def column(rows, key):
    return [row[key] for row in rows]


def plot_workload(workload, folder):
    name = workload["name"]

    def at(what):
        return folder / f"{name}-{what}.svg"

    methods = workload["methods"]
    ratios = [method["counters"]["times_fcl_mesh_obbrss"] for method in methods]
    with Plot(at("ratios"), f"{name}: speed of a check against fcl-mesh-obbrss", "", "times faster",
              "y") as plot:
        bars = plot.axes.bar(column(methods, "name"), ratios, color=OURS)
        plot.axes.bar_label(bars, fmt="%.3g")
        plot.axes.tick_params(axis="x", labelrotation=70)
    with Plot(at("percentiles"), f"{name}: time of a single check", "nanoseconds",
              "share of the checks, %", "x") as plot:
        for method in methods:
            plot.line(method["percentiles_ns"], range(101), method["name"], marker="")
    parts = workload["parts"]
    with Plot(at("spheres"), f"{name}: triangles and spheres of each part", "", "count") as plot:
        for shift, key, color in ((-0.2, "triangles", "#bcbcbc"), (0.2, "spheres", OURS)):
            places = [i + shift for i in range(len(parts))]
            plot.axes.bar(places, column(parts, key), 0.4, label=key, color=color)
        plot.axes.set_xticks(range(len(parts)), column(parts, "name"), rotation=20)
    if not workload.get("studies"):
        return
    sizes = workload["studies"]["sizes"]
    with Plot(at("sizes"), f"{name}: time of a check with more spheres over the same meshes",
              "spheres of all parts together", "nanoseconds a check", "x") as plot:
        for key, label, color, style in (
                ("shuffled_ns", "one a call, random order", FCL, "-"),
                ("single_ns", "one a call", OURS, "-"),
                ("free_ns", "one a call, free ones", OURS, "--"),
                ("batch_ns", "many a call", SHADES[0], "-")):
            plot.line(column(sizes, "spheres"), column(sizes, key), label, color, style)
    small = workload["studies"]["small_environments"]
    with Plot(at("small"), f"{name}: the robot among few spheres", "obstacles",
              "times as fast as the flat scan", "y") as plot:
        kinds = dict.fromkeys((row["robot_spheres"], row["order"]) for row in small)
        for color, kind in zip(SHADES, kinds):
            rows = [row for row in small if (row["robot_spheres"], row["order"]) == kind]
            for key, label, style in (("single_ns", "one a call", "-"), ("batch_ns", "many", "--")):
                plot.line(column(rows, "obstacles"),
                          [row["flat_scan_ns"] / row[key] for row in rows],
                          f"{kind[0]} spheres, {kind[1]}, {label}", color, style)
        plot.axes.axhline(1, color="#404040")
    distances = workload["studies"]["distances"]
    with Plot(at("distances"), f"{name}: torch and workpiece at a distance, median of a query",
              "distance / size", "nanoseconds", "xy") as plot:
        for key, label, color, style in (
                ("fcl_distance_ns", "FCL: distance", FCL, "-"),
                ("distance_ns", "spherule: distance", OURS, "-"),
                ("fcl_collide_ns", "FCL: collide", FCL, "--"),
                ("fcl_boxed_collide_ns", "FCL: behind boxes", SHADES[2], ":"),
                ("confirmed_ns", "spherule: confirmed", SHADES[0], ":"),
                ("collides_ns", "spherule: collides", OURS, "--")):
            plot.line(column(distances, "relative"), column(distances, key), label, color, style)


def plot_paper(paper, folder):
    figure = paper["figures"]["3"]
    diameters = [1e3 * row["min_external_diameter"] for row in figure]
    with Plot(folder / "paper-figure3.svg", "Figure 3: the box of a pipe with a bore of 40 mm",
              "minimum diameter D of the external spheres, mm",
              "not covered by external spheres, %") as plot:
        for key, label, color in (("uncovered_reachable", "reachable (ours)", OURS),
                                  ("uncovered_random", "random (the paper)", FCL)):
            plot.line(diameters, [100 * row[key] for row in figure], label, color)
        plot.axes.axvline(40, color="#a0a0a0", linestyle="--")
    for number, title, unit, scale in (
            ("6", "greatest distance from a point of the surface to the spheres", "mm", 1e3),
            ("7", "share of the solid that the spheres cover", "%", 100),
            ("8", "volume of the spheres outside of the solid, of its own", "%", 100)):
        with Plot(folder / f"paper-figure{number}.svg", f"Figure {number}: {title}", "spheres",
                  unit, "y" if number == "6" else "") as plot:
            for color, (method, steps) in zip((OURS, FCL), paper["figures"][number].items()):
                for key, style in (("before_inflation", "-"), ("after_inflation", "--")):
                    values = [scale * step[key] for step in steps]
                    if number != "6" or any(values):
                        plot.line(column(steps, "spheres"), values,
                                  f"{method}, {key.replace('_', ' ')}", color, style, "")


HEAD = """<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>The paper's comparisons, made again</title>
<style>
body { font: 16px/1.5 sans-serif; color: #222; max-width: 1100px; margin: 2em auto; padding: 0 1em }
table { border-collapse: collapse; margin: 1em 0; font-size: 14px }
th, td { padding: .25em .8em; text-align: right; border-bottom: 1px solid #ddd }
th:first-child, td:first-child { text-align: left }
figure { margin: 1.5em 0 } figure img { max-width: 100% } figcaption { color: #555 }
.pictures { display: grid; grid-template-columns: repeat(auto-fill, minmax(320px, 1fr)); gap: 1em }
</style></head><body>
<h1>The paper's comparisons, made again</h1>
<p>Larkin, Short, Pan and van Duin, <i>Bounding Sphere CAD Model Simplification for Efficient
Collision Detection in Offline Programming</i>: its table, its figures and what it says without one,
computed anew. In brackets: the paper's own numbers.</p>
"""


def table(head, rows):
    lines = [(head, "th")] + [(row, "td") for row in rows]
    return "<table>" + "".join(
        "<tr>" + "".join(f"<{tag}>{html.escape(str(cell))}</{tag}>" for cell in cells) + "</tr>\n"
        for cells, tag in lines) + "</table>\n"


def image(path, caption):
    kind = "svg+xml" if path.suffix == ".svg" else "png"
    data = base64.b64encode(path.read_bytes()).decode()
    caption = html.escape(caption)
    return (f'<figure><img src="data:image/{kind};base64,{data}" alt="{caption}">'
            f"<figcaption>{caption}</figcaption></figure>\n")


def table1(rows):
    def with_paper(row, text, key):
        return f"{text} ({row['paper'][key]})" if "paper" in row else text

    first = rows[0].get("paper", {}).get("seconds", 0)
    cells = []
    for row in rows:
        seams = row["critical_section"]
        ratio = f"{row['ratio']:.1f}"
        if "paper" in row:
            ratio += f" ({first / row['paper']['seconds']:.1f})"
        cells.append([row["method"], with_paper(row, row["complexity"], "complexity"),
                      with_paper(row, row["collisions"], "collisions"), row["missed"], row["extra"],
                      f"{1e3 * row['seconds']:.2f}", ratio, seams["collisions"], seams["missed"],
                      seams["extra"], f"{seams['ratio']:.1f}"])
    return table(["method", "complexity", "collisions", "missed", "extra", "ms", "ratio",
                  "at the seams: collisions", "missed", "extra", "ratio"], cells)


def pictures(folder, captions):
    return ('<div class="pictures">' + "".join(
        image(folder / f"paper-{name}.png", caption) for name, caption in captions) + "</div>\n")


def page(paper, folder):
    rows = paper["table1"]
    out = [HEAD, f"<h2>Table I</h2>\n<p>{rows[0]['queries']} configurations of a weld program; "
           "missed and extra are against the original solids. Up to the decomposition FCL queries; "
           "then "
           "robot and torch are meshes and the pipes are spheres; at last all is in spheres. The "
           "ratio is of times, to the first row.</p>\n", table1(rows)]
    figure2 = paper["figures"]["2"]
    out += ["<h2>Figure 2: a concave part at equal error</h2>\n<p>A block with slots; max error "
            f"{1e3 * figure2['max_error']:.0f} mm, minimum external diameter "
            f"{1e3 * figure2['min_external_diameter']:.0f} mm. The paper: 33 spheres packed, 11 "
            "bounding.</p>\n",
            pictures(folder, [("figure2-mesh", "the part")] + [
                (f"figure2-{fit['method']}", f"{fit['method']}: {fit['spheres']} spheres, "
                 f"protrusion {1e3 * fit['protrusion']:.1f} mm") for fit in figure2["methods"]])]
    out += ["<h2>Figure 3</h2>\n", image(folder / "paper-figure3.svg",
                                         "share of the box that external spheres leave")]
    courses = [(f"figure4-{method}", f"{method}: {steps[-1]['spheres']} spheres, inflated")
               for method, steps in paper["figures"]["6"].items()]
    out += ["<h2>Figures 4, 5 and 9: a pipe in each representation, the robot, the work cell</h2>",
            pictures(folder, [("figure4-mesh", "original mesh"), ("figure4-hull", "convex hull"),
                              ("figure4-voxels", "voxels of 5 mm"), *courses,
                              ("figure5", "robot and torch in spheres"),
                              ("figure9", "the work cell"),
                              ("figure9-spheres", "the work cell in spheres")])]
    out.append("<h2>Figures 6 to 8: the pipe as spheres are added</h2>\n")
    for number, caption in (("6", "max error"), ("7", "covered share of the solid"),
                            ("8", "volume outside of the solid")):
        out.append(image(folder / f"paper-figure{number}.svg", f"figure {number}: {caption}"))
    out += ["<h2>What the paper says without a figure</h2>\n<p>Spheres with stage 1 and with a "
            "size so small that nothing vanishes; and how much faster than FCL on the meshes they "
            "are "
            "queried with a rod nearby.</p>\n",
            table(["shape", "holes", "triangles", "with stage 1", "without",
                   "FCL's time over ours"],
                  [[row["shape"], row["holes"], row["triangles"], row["spheres_with_stage1"],
                    row["spheres_without_stage1"], f"{row['fcl_over_spheres']:.1f}"]
                   for row in paper["claims"]])]
    counts = paper["counts"]
    if counts:
        share = 100 * counts[0]["max_protrusion"] / counts[0]["diagonal"]
        out += ["<h2>Spheres at equal certified protrusion</h2>\n<p>The fewest that provably hold "
                f"the part and protrude from it by at most {share:.0f} % of its diagonal, "
                "whatever setting the method needs for that.</p>\n",
                table(["part", "triangles", *column(counts[0]["methods"], "method")],
                      [[row["part"], row["triangles"], *(entry["spheres"] or "none found"
                                                         for entry in row["methods"])]
                       for row in counts])]
    out += ["<h2>Trees for the same traversal</h2>\n<p>The pipe, queried with a rod in random "
            "places nearby: the tree as its method has it, and ours over the same leaves.</p>\n",
            table(["method", "leaves", "nodes", "node tests", "ns", "ours: nodes", "node tests",
                   "ns"],
                  [[row["method"], row["leaves"],
                    *(cell for tree in (row["own"], row["ours"])
                      for cell in (tree["nodes"], f"{tree['node_tests']:.1f}",
                                   f"{tree['ns']:.0f}"))]
                   for row in paper["trees"]]),
            "<h2>Machine and versions</h2>\n", table(["", ""], paper["machine"].items()),
            "</body></html>\n"]
    (folder / "paper.html").write_text("".join(out), encoding="utf-8")


def write_csv(path, head, rows):
    with path.open("w", newline="", encoding="utf-8") as file:
        csv.writer(file).writerows([head, *rows])


def tables_of_paper(paper, folder):
    keys = ["queries", "collisions", "missed", "extra", "seconds", "ratio"]
    write_csv(folder / "paper-table1.csv", ["method", "complexity", "section", *keys],
              [[row["method"], row["complexity"], section, *(cells[key] for key in keys)]
               for row in paper["table1"]
               for section, cells in (("whole", row), ("critical", row["critical_section"]))])
    keys = ["method", "spheres", "protrusion", "growth", "setting", "seconds"]
    write_csv(folder / "paper-counts.csv", ["part", "triangles", "max_protrusion", *keys],
              [[row["part"], row["triangles"], row["max_protrusion"], *(entry[key] for key in keys)]
               for row in paper["counts"] for entry in row["methods"]])


def main():
    if len(sys.argv) not in (2, 3) or sys.argv[1] == "--paper" and len(sys.argv) != 3:
        sys.exit("Usage: plot.py [--paper] DIR")
    folder = pathlib.Path(sys.argv[-1])
    if sys.argv[1] == "--paper":
        paper = json.loads((folder / "paper.json").read_text())
        plot_paper(paper, folder)
        tables_of_paper(paper, folder)
        page(paper, folder)
        return
    for workload in json.loads((folder / "results.json").read_text())["workloads"]:
        plot_workload(workload, folder)


main()

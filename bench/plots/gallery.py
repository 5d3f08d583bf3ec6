#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The pages of bench/gallery, which builds what this needs: see there."""

import argparse
import html
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

# What may be put on the web again with its notice. Sources and licences are those of SOURCES.md.
LICENCES = ("Apache-2.0", "MIT", "BSD-3-Clause", "CC0")

# Name, title, model and published spheres, in the folder of models.
ROBOTS = [
    ("panda-curobo", "Franka Panda, spheres of cuRobo",
     "robots/franka_panda/franka_panda.urdf", "robots/franka_panda/peer_spheres/curobo_franka.yml"),
    ("panda-vamp", "Franka Panda, spheres of VAMP",
     "robots/franka_panda_vamp/panda_collision.urdf",
     "robots/franka_panda/peer_spheres/vamp_panda_spherized.urdf"),
    ("panda-robometrics", "Franka Panda, spheres of robometrics",
     "robots/franka_panda/franka_panda.urdf",
     "robots/franka_panda/peer_spheres/robometrics_franka_spheres.yml"),
    ("panda-morphit", "Franka Panda, spheres of MorphIt",
     "robots/franka_panda/franka_panda.urdf",
     "robots/franka_panda/peer_spheres/morphit_franka.yml"),
    ("fr3-cricket", "Franka Research 3, spheres of Cricket",
     "robots/franka_fr3/fr3_collision.urdf",
     "robots/franka_fr3/peer_spheres/cricket_fr3_spherized.urdf"),
]
# Name, title, mesh and how many spheres the medial axis (AMAA) may take.
PARTS = [
    ("gear", "Spur gear", "parts/spur_gear_m2_z24.stl", 128),
    ("riser", "Bracket", "parts/idler_riser.STL", 96),
    ("mug", "Mug, scanned", "organic/morphit_mug.obj", 96),
]
# Of the project's own cell.
OWN_PARTS = [
    ("torch", "Weld torch", "torch.stl", 128),
    ("workpiece", "Three pipes", "workpiece.stl", 128),
    ("forearm", "A robot's forearm", "link_3.stl", 48),
]
MILLIMETRES = 1000.0
EFFORT = ["--effort", "5"]


class Gallery:
    def __init__(self, arguments, work):
        self.arguments = arguments
        self.out = pathlib.Path(arguments.out)
        self.work = work
        self.cards = []

    def wanted(self, name):
        return self.arguments.only in name

    def run(self, *words, codes=(0, 1), program=None):
        """Runs the command, in the folder of the work; what it prints."""
        done = subprocess.run([os.path.abspath(program or self.arguments.spherule), *map(str, words)],
                              cwd=self.work, capture_output=True, text=True)
        if done.returncode not in codes:
            sys.exit(f"bench/gallery: {' '.join(map(str, words))}\n{done.stderr}")
        return done.stdout

    def finest(self, goal, low, high, fit):
        """fit(E) gives spheres that protrude by at most E, and how many; that with the least E of
        those with no more than `goal` spheres. None of them: the coarsest."""
        best = None
        for _ in range(7):
            middle = (low * high) ** 0.5
            made = fit(middle)
            if made["count"] <= goal:
                best, high = made, middle
            else:
                low = middle
        return best or fit(4 * high)

    def robot(self, name, title, urdf, published, notes):
        spheres = self.work / f"{name}{pathlib.Path(published).suffix}"
        shutil.copy(published, spheres)
        audit = json.loads(self.run("audit-robot", urdf, spheres, "--json"))
        leaks = [link["certificate"]["uncovered_depth"] for link in audit["links"]
                 if link.get("certificate")]
        goal = sum(link.get("sphere_count", 0) for link in audit["links"])
        deepest = max((depth[0] for depth in leaks if isinstance(depth[0], (int, float))), default=0)
        out = max((link["certificate"]["protrusion_over_mesh_max"] or 0 for link in audit["links"]
                   if link.get("certificate")), default=0)

        def fit(error):
            folder = self.work / f"{name}-ours"
            shutil.rmtree(folder, ignore_errors=True)
            total = json.loads(self.run("robot", urdf, "-o", folder, "--max-error", error, *EFFORT,
                                        "--proofs", "none", "--format", "json", "--json"))["total"]
            made = self.work / f"{name}-ours-{total['sphere_count']}.json"
            shutil.copy(next(folder.glob("*.spheres.json")), made)
            return {"count": total["sphere_count"], "covered": total["covered"], "error": error,
                    "protrusion": total["protrusion_over_mesh_max"], "file": made}

        ours = self.finest(goal, 0.002, 0.25, fit)
        page = self.page(name, [urdf, spheres, ours["file"], "--leaks"])
        covered = sum(bool(link["certificate"]["covered"]) for link in audit["links"]
                      if link.get("certificate"))
        self.card(page, title, [
            f"Published: {goal} spheres, {covered} of {len(leaks)} links covered, leaks up to "
            f"{deepest * MILLIMETRES:.3g} mm (proved), protruding by at most "
            f"{out * MILLIMETRES:.3g} mm.",
            self.tell_ours(ours, MILLIMETRES, " mm")], notes)

    @staticmethod
    def tell_ours(ours, scale, unit):
        proof = "covered (proved)" if ours["covered"] else "not proved to cover"
        return (f"spherule: {ours['count']} spheres, {proof}, protruding by at most "
                f"{ours['protrusion'] * scale:.3g}{unit}.")

    def part(self, name, title, mesh, count, notes):
        medial = self.work / f"{name}-medial.json"
        made = json.loads(self.run("medial", mesh, "--spheres", count, "-o", medial,
                                   program=self.arguments.baseline))
        certificate = made["certificate"]
        size = self.diagonal(mesh)

        def fit(error):
            spheres = self.work / f"{name}-ours.json"
            self.run("fit", mesh, "-o", spheres, "--max-error", error, *EFFORT)
            stored = json.loads(spheres.read_text())
            number = len(stored["spheres"])
            kept = self.work / f"{name}-ours-{number}.json"
            spheres.replace(kept)
            return {"count": number, "error": error, "file": kept,
                    "covered": stored["certificate"]["covered"],
                    "protrusion": stored["certificate"]["protrusion_over_mesh_max"]}

        ours = self.finest(made["sphere_count"], 0.0005 * size, 0.15 * size, fit)
        page = self.page(name, [mesh, medial, ours["file"], "--leaks"])
        scale, unit = (100.0 / size, " % of its diagonal")
        self.card(page, title, [
            f"Medial axis (AMAA): {made['sphere_count']} spheres, leaks up to "
            f"{certificate['uncovered_depth'][0] * scale:.3g}{unit} (proved), protruding by at most "
            f"{certificate['protrusion_over_mesh_max'] * scale:.3g}{unit}.",
            self.tell_ours(ours, scale, unit)], notes)

    def diagonal(self, mesh):
        size = self.run("info", mesh).split(" size ")[1].split(",")[0].split(" x ")
        return sum(float(length) ** 2 for length in size) ** 0.5

    def weld(self, cell, notes):
        page = self.out / "weld.html"
        printed = self.run("check", cell / "robot.urdf", cell / "cell.json", cell / "path.csv",
                           "--edges", "--max-error", "0.02", *EFFORT, "--view", page)
        self.card(page, "A torch comes to its weld",
                  [printed.splitlines()[0] + ": every motion is proved, not sampled."], notes,
                  "at=20&")

    def page(self, name, words):
        page = self.out / f"{name}.html"
        self.run("view", *words, "-o", page)
        return page

    def card(self, page, title, lines, notes, state=""):
        picture = page.with_suffix(".png")
        profile = tempfile.mkdtemp(dir=self.work)
        subprocess.run(
            ["chromium", "--headless", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader",
             "--enable-unsafe-swiftshader", "--hide-scrollbars", "--no-first-run",
             f"--user-data-dir={profile}", "--window-size=1200,640", "--virtual-time-budget=5000",
             f"--screenshot={picture}", f"{page.as_uri()}#{state}theme=light&panel=none"],
            env={**os.environ, "HOME": profile}, stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL, check=True)
        self.cards.append((page.name, picture.name, title, lines, notes))
        print(f"{page.name}: {' '.join(lines)}", flush=True)

    def write_index(self):
        cards = "\n".join(
            f'<article><a href="{page}"><img src="{picture}" alt="{html.escape(title)}" '
            f'width="1200" height="640" loading="lazy"></a><h2><a href="{page}">'
            f"{html.escape(title)}</a></h2>"
            + "".join(f"<p>{html.escape(line)}</p>" for line in lines)
            + f'<p class="notes">{notes}</p></article>'
            for page, picture, title, lines, notes in self.cards)
        (self.out / "index.html").write_text(INDEX.replace("CARDS", cards), encoding="utf-8")
        print(f"gallery: {self.out / 'index.html'}")


INDEX = """<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>spherule: gallery</title>
<meta name="viewport" content="width=device-width, initial-scale=1">
<style>
:root { color-scheme: light dark; --ground: #f3f5f8; --card: #fff; --ink: #1b2230; --quiet: #5a6474;
  --line: #dfe3ea; --link: #2f6fd6; }
@media (prefers-color-scheme: dark) { :root { --ground: #12151a; --card: #1b1f26; --ink: #e8ebf0;
  --quiet: #9ba5b4; --line: #333a45; --link: #6aa2ff; } }
body { margin: 0 auto; max-width: 1180px; padding: 24px 16px; background: var(--ground);
  color: var(--ink); font: 15px/1.5 system-ui, "DejaVu Sans", sans-serif; }
main { display: grid; gap: 18px; grid-template-columns: repeat(auto-fill, minmax(min(100%, 340px), 1fr)); }
article { background: var(--card); border: 1px solid var(--line); border-radius: 10px; overflow: hidden; }
article > * { margin: 8px 14px; }
article > a { margin: 0; display: block; }
img { width: 100%; height: auto; display: block; }
h2 { font-size: 16px; } a { color: var(--link); } h2 a { text-decoration: none; }
.notes { color: var(--quiet); font-size: 12px; overflow-wrap: anywhere; }
</style></head><body>
<h1>spherule: gallery</h1>
<p>Spheres that others published or made, beside spheres of spherule: at most as many, and proved to
cover. What of a mesh sticks out of the spheres is coloured by its depth, yellow to red, by one scale
for each page. Each page opens in a browser without a network: drag to turn, scroll to zoom.</p>
<main>
CARDS
</main></body></html>
"""


def read_sources(models):
    """What SOURCES.md says of each file: where it is from, and its licence."""
    sources = {}
    for line in (models / "SOURCES.md").read_text(encoding="utf-8").splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if len(cells) > 10 and "/" in cells[0]:
            sources[cells[0]] = (cells[-3], cells[-2])
    return sources


def notes_of(sources, files):
    """Source and licence of files, for a page; None where one may not be put on the web."""
    notes = []
    for file in files:
        source, licence = sources.get(file, ("", ""))
        if not licence.startswith(LICENCES):
            print(f"left out: {file}: licence {licence or 'unknown'}")
            return None
        owner = source.split(" @")[0].replace("`", "")
        notes.append(f"{html.escape(pathlib.Path(file).name)}: {html.escape(owner)}, "
                     f"{html.escape(licence)}")
    return "; ".join(notes) + '. <a href="licences/">Licences</a>'


def add_models(gallery, models):
    sources = read_sources(models)
    for name, title, urdf, published in ROBOTS:
        notes = gallery.wanted(name) and notes_of(sources, [urdf, published])
        if notes:
            gallery.robot(name, title, models / urdf, models / published, notes)
    for name, title, mesh, count in PARTS:
        notes = gallery.wanted(name) and notes_of(sources, [mesh])
        if notes:
            gallery.part(name, title, models / mesh, count, notes)
    licences = gallery.out / "licences"
    licences.mkdir(exist_ok=True)
    for text in (models / "LICENSES").glob("*.txt"):
        shutil.copy(text, licences)
    for text in models.glob("*/**/LICENSE*"):
        if text.is_file():
            shutil.copy(text, licences / f"{text.parent.name}-{text.name}.txt")
    names = sorted(text.name for text in licences.glob("*.txt"))
    (licences / "index.html").write_text(
        "<!DOCTYPE html><meta charset=\"utf-8\"><title>Licences</title><ul>"
        + "".join(f'<li><a href="{name}">{name}</a></li>' for name in names) + "</ul>")


def main():
    parser = argparse.ArgumentParser()
    for option in ("--spherule", "--baseline", "--cell-files", "--models", "--only", "--out"):
        parser.add_argument(option, required=True)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        gallery = Gallery(arguments, work)
        cell = work / "cell"
        subprocess.run([os.path.abspath(arguments.cell_files), cell], check=True)
        own = "made by the project's code, BSD-3-Clause"
        if arguments.models:
            add_models(gallery, pathlib.Path(arguments.models))
        if gallery.wanted("weld"):
            gallery.weld(cell, own)
        for name, title, mesh, count in OWN_PARTS:
            if gallery.wanted(name):
                gallery.part(name, title, cell / mesh, count, own)
        gallery.write_index()


if __name__ == "__main__":
    main()

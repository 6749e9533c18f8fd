"""Geometry made from organs: what each generator reaches and takes, beside what is aimed at and what others reach.

--organs FOLDER: closed meshes in millimetres (.off, .stl, .obj), by their names; without it, shapes made here. Sections are
functions that yield rows, one for each generator; SECTIONS lists them."""
import json
import math
import pathlib
import resource
import subprocess

import shapes
from table import row

organs = None  # set by bench.py

# Aims by kind of organ and number of spheres: not covered, outside (of the volume), two-sided mean distance (% of the
# diagonal), depth error (of the largest depth).
AIMS = {
    ("compact", 32): (0.05, 0.06, 0.6, 0.065),
    ("compact", 110): (0.015, 0.02, 0.20, 0.03),
    ("folded", 110): (0.035, 0.035, 0.35, 0.05),
    ("tubular", 110): (0.08, 0.08, 0.25, 0.065),
    ("any", 500): (0.025, 0.02, 0.12, 0.025),
}
MOST_SECONDS = 5
KINDS = (("liver", "compact"), ("spleen", "compact"), ("stomach", "compact"), ("ovary", "compact"), ("uterus", "folded"),
         ("kidney", "folded"), ("colon", "tubular"), ("tube", "tubular"))
MEASURES = (("not covered", "of it"), ("outside", "of it"), ("two-sided", "%"), ("depth error", "of it"))


def procedural(work):
    """A knobbly solid and a slab, 100 mm large."""
    vertices, triangles = shapes.sphere(radius=50, rings=60, sectors=72)
    solids = {"bumpy": [(x * (1 + 0.2 * math.sin(y / 8)), y, z * (1 + 0.2 * math.cos(x / 9))) for x, y, z in vertices],
              "slab": [(x, 0.2 * y, z) for x, y, z in vertices]}
    for name, points in solids.items():
        path = work / f"{name}.off"
        path.write_bytes(shapes.off(points, triangles))
        yield name, "compact" if name == "bumpy" else "thin", path


def meshes(work):
    """(name, kind, path) of each solid."""
    if organs is None:
        yield from procedural(work)
        return
    for path in sorted(p for p in pathlib.Path(organs).iterdir() if p.suffix in (".off", ".stl", ".obj")):
        yield path.stem, next((kind for name, kind in KINDS if name in path.stem), "folded"), path


def cpu_seconds():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def run(build, *arguments):
    """The answer of a command and the processor time it took; the answer is None where it refused, with the message."""
    before = cpu_seconds()
    done = subprocess.run([build / "app/spore", *map(str, arguments), "--json"], capture_output=True, text=True)
    return (json.loads(done.stdout) if done.returncode == 0 else None), cpu_seconds() - before, done.stderr.strip()


def sphere_figures(answer):
    return 1 - answer["coverage"], answer["outside"], 100 * answer["distance"]["mean"], answer["depth_error"]


def aimed(case, ours, unit, aim):
    """A row with the aim as its peer: a ratio below 1 misses it, and is marked."""
    return row("authoring", case, ours, unit, peer_name="aim" if aim is not None else None, peer=aim,
               least=1 if aim is not None and ours else None)


def balanced_spheres(build, work):
    """Spheres that fit the depth: four errors and the time, beside the aims of the kind of organ."""
    for name, kind, path in meshes(work):
        for count in (32, 110, 500):
            answer, seconds, fault = run(build, "spheres", path, "--unit", "mm", "--count", count)
            if answer is None:
                yield row("authoring", f"{name}, {count} spheres REFUSED: {fault}", math.nan, "")
                continue
            aims = AIMS.get((kind, count)) or AIMS.get(("any", count)) or (None,) * 4
            for (measure, unit), ours, aim in zip(MEASURES, sphere_figures(answer), aims):
                yield aimed(f"{name}, {count} spheres: {measure}", ours, unit, aim)
            yield aimed(f"{name}, {count} spheres: processor time", seconds, "s", MOST_SECONDS)


SECTIONS = [balanced_spheres]


def bench_authoring(build, work):
    """Everything, section by section. A row over its aim is marked as over its floor."""
    for section in SECTIONS:
        yield from section(build, work)


BENCHES = {"authoring": bench_authoring}

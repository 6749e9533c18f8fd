"""Geometry made from organs: what each generator reaches and takes, beside what is aimed at and what others reach.

--organs FOLDER: meshes (.off, .stl, .obj, .glb), by their names, NAME_centreline.json with the known middle line of NAME
beside it; without it, shapes made here. All are read as millimetres; but for that line no figure depends on the size.
Sections are functions that yield rows, one for each generator; SECTIONS lists them."""
import json
import math
import os
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

# What others reach on the reference solids (liver, uterus, colon, spleen): the measures above and the seconds they took.
# Inscribed spheres taken greedily; spheretree's medial method; a prototype of the fit in Python.
PEERS = {
    ("liver", 32): {"inscribed": (0.269, 0, 1.68, 0.123, 4), "spheretree": (0, 0.500, 2.41, 0.153, 55), "prototype": (0.061, 0.079, 0.74, 0.074, 8)},
    ("liver", 110): {"inscribed": (0.116, 0, 0.67, 0.068, 4), "spheretree": (0, 0.183, 0.94, 0.062, 133), "prototype": (0.022, 0.029, 0.27, 0.037, 10)},
    ("liver", 500): {"inscribed": (0.043, 0, 0.28, 0.035, 4), "prototype": (0.006, 0.009, 0.09, 0.012, 22)},
    ("uterus", 32): {"inscribed": (0.442, 0, 1.95, 0.204, 3), "spheretree": (0, 0.272, 1.60, 0.261, 95), "prototype": (0.124, 0.078, 0.83, 0.123, 6)},
    ("uterus", 110): {"inscribed": (0.210, 0, 0.85, 0.137, 4), "spheretree": (0, 0.160, 1.09, 0.202, 393), "prototype": (0.036, 0.044, 0.34, 0.069, 8)},
    ("uterus", 500): {"inscribed": (0.061, 0, 0.30, 0.068, 4), "prototype": (0.008, 0.012, 0.10, 0.026, 12)},
    ("colon", 32): {"inscribed": (0.673, 0, 2.48, 0.180, 7), "spheretree": (0, 2.13, 2.35, 0.629, 143), "prototype": (0.343, 0.148, 0.80, 0.139, 3)},
    ("colon", 110): {"inscribed": (0.461, 0, 0.79, 0.138, 8), "spheretree": (0, 0.988, 1.20, 0.323, 360), "prototype": (0.110, 0.102, 0.28, 0.076, 5)},
    ("colon", 500): {"inscribed": (0.219, 0, 0.32, 0.089, 8), "prototype": (0.035, 0.037, 0.10, 0.035, 10)},
    ("spleen", 110): {"inscribed": (0.069, 0, 0.45, 0.061, math.nan), "prototype": (0.009, 0.013, 0.15, 0.027, 5)},
}


def procedural(work):
    """A knobbly solid and a slab, 100 mm large."""
    vertices, triangles = shapes.sphere(radius=50, rings=60, sectors=72)
    solids = {"bumpy": [(x * (1 + 0.2 * math.sin(y / 8)), y, z * (1 + 0.2 * math.cos(x / 9))) for x, y, z in vertices],
              "slab": [(x, 0.2 * y, z) for x, y, z in vertices]}
    for name, points in solids.items():
        path = work / f"{name}.off"
        path.write_bytes(shapes.off(points, triangles))
        yield name, "compact" if name == "bumpy" else "thin", path


def peers_of(name, count):
    """What others reach: {method: figures}, none for a shape that they were not measured on."""
    return next((methods for (organ, n), methods in PEERS.items() if organ in name and n == count), {})


def meshes(work):
    """(name, kind, path) of each solid."""
    if organs is None:
        yield from procedural(work)
        return
    for path in sorted(p for p in pathlib.Path(organs).iterdir() if p.suffix in (".off", ".stl", ".obj", ".glb")):
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
            figures = (*sphere_figures(answer), seconds)
            for (measure, unit), ours, aim in zip((*MEASURES, ("processor time", "s")), figures, (*aims, MOST_SECONDS)):
                yield aimed(f"{name}, {count} spheres: {measure}", ours, unit, aim)
            for method, theirs in peers_of(name, count).items():
                for (measure, unit), ours, peer in zip((*MEASURES, ("time", "s")), figures, theirs):
                    yield row("authoring", f"{name}, {count} spheres: {measure}", ours, unit, peer_name=method, peer=peer)


def tubes(work):
    """(name, path, points of the published or exact middle line in mm): NAME_centreline.json beside NAME.stl or .off."""
    if organs is None:
        vertices, triangles = shapes.tube(radius=10, length=300, rings=120, sectors=32)
        bend = lambda x, y: ((80 + y) * math.cos(x / 80), (80 + y) * math.sin(x / 80))
        path = work / "bent.off"
        path.write_bytes(shapes.off([(*bend(x, y), z) for x, y, z in vertices], triangles))
        yield "bent tube", path, [(*bend(3 * i, 0), 0) for i in range(101)]
        return
    for known in sorted(pathlib.Path(organs).glob("*_centreline.json")):
        for path in sorted(pathlib.Path(organs).glob(known.name.removesuffix("_centreline.json") + ".*")):
            yield path.stem, path, json.loads(known.read_text())["points"]


def compare_lines(build, path, known, line):
    """How a line follows a known one, by tests/bench/bench_line."""
    done = subprocess.run([build / "tests/bench/bench_line", path, known, line], capture_output=True, text=True, check=True,
                          env={**os.environ, "SPORE_HELPERS": str(build / "app")})
    return json.loads(done.stdout)


def centrelines(build, work):
    """Middle lines beside published ones, found alone, and between the published ends: length, share of the published line
    within the local radius, offset from the published line once that is centred, and how far it was off itself; share of the
    surface that is said to be followed."""
    for name, path, known in tubes(work):
        ends = [",".join(str(x / 1000) for x in known[i]) for i in (0, -1)]
        published = work / "published.curve"
        published.write_text("".join(f"{x / 1000} {y / 1000} {z / 1000} 0.001\n" for x, y, z in known))
        for how, options in (("ends found", ()), ("ends given", ("--first-place", ends[0], "--last-place", ends[1]))):
            answer, seconds, fault = run(build, "centreline", path, "--unit", "mm", "-o", work / "line.curve", *options)
            if answer is None:
                yield row("authoring", f"{name}, line, {how} REFUSED: {fault}", math.nan, "")
                continue
            fit = compare_lines(build, path, published, work / "line.curve")
            yield row("authoring", f"{name}, line, {how}: length", 1000 * fit["length"], "mm", peer_name="published", peer=1000 * fit["known"])
            yield aimed(f"{name}, line, {how}: length off by", abs(fit["length"] / fit["known"] - 1), "of it", 0.03)
            yield aimed(f"{name}, line, {how}: not within the local radius", 1 - fit["within"], "of it", 0.02)
            yield aimed(f"{name}, line, {how}: offset", fit["offset"], "radii", 0.15)
            yield row("authoring", f"{name}, line, {how}: offset of the published line", fit["published_offset"], "radii")
            yield row("authoring", f"{name}, line, {how}: followed", answer["cover"], "of the surface")
            yield aimed(f"{name}, line, {how}: processor time", seconds, "s", MOST_SECONDS)


def bounding_spheres(build, work):
    """Spheres that cover all of a solid: volume outside, beside spheretree's where it is known; whether that is proven."""
    for name, _, path in meshes(work):
        for count in (32, 110):
            answer, seconds, fault = run(build, "spheres", path, "--unit", "mm", "--method", "bounding", "--count", count)
            if answer is None:
                yield row("authoring", f"{name}, {count} bounding spheres REFUSED: {fault}", math.nan, "")
                continue
            peer = peers_of(name, count).get("spheretree", (None, None))[1]
            proven = "" if answer["certified"] else " (NOT PROVEN)"
            yield row("authoring", f"{name}, {count} bounding spheres: outside{proven}", answer["outside"], "of it",
                      peer_name="spheretree" if peer else None, peer=peer, least=1 if peer else None)
            yield aimed(f"{name}, {count} bounding spheres: processor time", seconds, "s", MOST_SECONDS)


# Depth error aimed at, by kind of organ and number of spheres.
WEIGHTED_AIMS = {("compact", 32): 0.04, ("compact", 110): 0.02, ("folded", 110): 0.035, ("tubular", 110): 0.05}


def weighted_spheres(build, work):
    """Spheres whose weighted sum is the depth: its error, and where it is felt just outside."""
    for name, kind, path in meshes(work):
        for count in (32, 110):
            answer, seconds, fault = run(build, "spheres", path, "--unit", "mm", "--method", "weighted", "--count", count)
            if answer is None:
                yield row("authoring", f"{name}, {count} weighted spheres REFUSED: {fault}", math.nan, "")
                continue
            case = f"{name}, {count} weighted spheres"
            yield aimed(f"{case}: depth error", answer["weighted_depth_error"], "of it", WEIGHTED_AIMS.get((kind, count)))
            yield row("authoring", f"{case}: felt outside", answer["felt_outside"], "of places")
            yield aimed(f"{case}: processor time", seconds, "s", MOST_SECONDS)


def tetrahedra(build, work):
    """5,000 cells by the chain, and by the lattice alone: distance, angle, number and time beside their aims."""
    for name, _, path in meshes(work):
        for options in ((), ("--method", "voxels")):
            answer, seconds, fault = run(build, "tetrahedra", path, "--unit", "mm", "--cells", 5000, *options)
            if answer is None:
                yield row("authoring", f"{name}, 5000 cells {' '.join(options)} REFUSED: {fault}", math.nan, "")
                continue
            case = f"{name}, 5000 cells {answer['method']}"
            yield aimed(f"{case}: distance", 100 * answer["hausdorff"], "%", 1)
            yield aimed(f"{case}: 10 degrees over the least angle", 10 / answer["min_dihedral_deg"], "", 1)
            yield aimed(f"{case}: number off by", abs(answer["tetrahedra"] / 5000 - 1), "of it", 0.1)
            yield aimed(f"{case}: volume off by", abs(answer["volume_change"]), "of it", None)
            yield aimed(f"{case}: processor time", seconds, "s", 30)


def spheres_of_tetrahedra(build, work):
    """Spheres of 500 cells, the peer a sphere round each (the paper): as many that fit, an eighth as many that cover."""
    cells = work / "cells.mesh"
    for name, _, path in meshes(work):
        made, _, fault = run(build, "tetrahedra", path, "--unit", "mm", "--cells", 500, "-o", cells)
        if made is None:
            yield row("authoring", f"{name}, spheres of 500 cells REFUSED: {fault}", math.nan, "")
            continue
        peer = json.loads(subprocess.run([build / "tests/bench/bench_cell_spheres", cells], capture_output=True, text=True, check=True).stdout)
        for mode, count in (("balanced", peer["count"]), ("bounding", peer["count"] // 8)):
            answer, _, _ = run(build, "spheres", cells, "--method", mode, "--count", count)
            for (measure, unit), ours, theirs in zip(MEASURES, sphere_figures(answer), sphere_figures(peer)):
                if measure != "not covered":
                    yield row("authoring", f"{name}, {peer['count']} cells, {count} {mode} spheres: {measure}", ours, unit,
                              peer_name="a sphere a cell", peer=theirs, least=1)
            yield row("authoring", f"{name}, {peer['count']} cells, {count} {mode} spheres: not covered", 1 - answer["coverage"], "of it")


SECTIONS = [balanced_spheres, bounding_spheres, weighted_spheres, centrelines, tetrahedra, spheres_of_tetrahedra]


def bench_authoring(build, work):
    """Everything, section by section. A row over its aim is marked as over its floor."""
    for section in SECTIONS:
        yield from section(build, work)


BENCHES = {"authoring": bench_authoring}

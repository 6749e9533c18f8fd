"""Geometry made from organs: what each generator reaches and takes, beside what is aimed at and what others reach.

--organs FOLDER: closed meshes in millimetres (.off, .stl, .obj), by their names, NAME_centreline.json with the known middle
line of NAME beside it; without it, shapes made here. Sections are
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


def to_polyline(point, line):
    """Distance (in the unit of both) to a polyline, and the radius there."""
    best = (math.inf, 0)
    for (ax, ay, az, ar), (bx, by, bz, br) in zip(line, line[1:]):
        d = (bx - ax, by - ay, bz - az)
        square = sum(x * x for x in d)
        t = min(max(sum((p - a) * x for p, a, x in zip(point, (ax, ay, az), d)) / square, 0), 1) if square else 0
        best = min(best, (math.dist(point, (ax + t * d[0], ay + t * d[1], az + t * d[2])), ar + t * (br - ar)))
    return best


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


def centrelines(build, work):
    """Middle lines beside known ones: offset in radii, difference of length, time; found alone, and between the known ends."""
    for name, path, known in tubes(work):
        ends = [",".join(str(x / 1000) for x in known[i]) for i in (0, -1)]
        for how, options in (("ends found", ()), ("ends given", ("--ends", *ends))):
            answer, seconds, fault = run(build, "centreline", path, "--unit", "mm", "-o", work / "line.curve", *options)
            if answer is None:
                yield row("authoring", f"{name}, line, {how} REFUSED: {fault}", math.nan, "")
                continue
            line = [[1000 * float(x) for x in text.split()] for text in (work / "line.curve").read_text().splitlines() if text[0] != "#"]
            near = [to_polyline(point, line) for point in known]
            length = sum(math.dist(a, b) for a, b in zip(known, known[1:]))
            yield aimed(f"{name}, line, {how}: offset", sum(d for d, _ in near) / sum(r for _, r in near), "radii", 0.35)
            yield aimed(f"{name}, line, {how}: length off by", abs(1000 * answer["length"] / length - 1), "of it", 0.03)
            yield aimed(f"{name}, line, {how}: processor time", seconds, "s", MOST_SECONDS)


# Volume outside of sets that cover all, by spheretree's medial method, on the reference solids.
BOUNDING_PEER = {("liver", 32): 0.500, ("liver", 110): 0.183, ("uterus", 32): 0.272, ("uterus", 110): 0.160, ("colon", 32): 2.13,
                 ("colon", 110): 0.988}


def bounding_spheres(build, work):
    """Spheres that cover all of a solid: volume outside, beside spheretree's where it is known; whether that is proven."""
    for name, _, path in meshes(work):
        for count in (32, 110):
            answer, seconds, fault = run(build, "spheres", path, "--unit", "mm", "--mode", "bounding", "--count", count)
            if answer is None:
                yield row("authoring", f"{name}, {count} bounding spheres REFUSED: {fault}", math.nan, "")
                continue
            peer = next((outside for (organ, n), outside in BOUNDING_PEER.items() if organ in name and n == count), None)
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
            answer, seconds, fault = run(build, "spheres", path, "--unit", "mm", "--mode", "weighted", "--count", count)
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


SECTIONS = [balanced_spheres, bounding_spheres, weighted_spheres, centrelines, tetrahedra]


def bench_authoring(build, work):
    """Everything, section by section. A row over its aim is marked as over its floor."""
    for section in SECTIONS:
        yield from section(build, work)


BENCHES = {"authoring": bench_authoring}

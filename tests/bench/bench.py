#!/usr/bin/python3
"""bench.py --build DIR [NAME...] [--json F]: measures, prints a table of ours, peer or floor, and their ratio. Nothing here
asserts a time: what is slower than its floor is marked, and the exit status stays 0."""
import argparse
import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "e2e"))
import shapes

HERE = pathlib.Path(__file__).resolve().parent
REPEATS = 5


def row(bench, case, ours, unit, floor=None, peer_name=None, peer=None, error_ours=None, error_peer=None):
    reference = peer if peer is not None else None
    return {"bench": bench, "case": case, "ours": ours, "peer_name": peer_name, "peer": peer, "unit": unit,
            "ratio": reference / ours if reference and ours else None, "error_ours": error_ours, "error_peer": error_peer,
            "floor": floor}


def run_scene(build, scene, *options):
    """Best median of several runs: the figure least disturbed by other work on the machine."""
    reports = []
    for _ in range(REPEATS):
        done = subprocess.run([build / "app/spore", "run", scene, "--json", *options], capture_output=True, text=True, check=True)
        reports.append(json.loads(done.stdout))
    return min(reports, key=lambda r: r["step_us"]["median"])


def net_mesh(n, side=1.0):
    step = side / (n - 1)
    vertices = [(x * step - side / 2, 0.0, z * step - side / 2) for z in range(n) for x in range(n)]
    triangles = []
    for z in range(n - 1):
        for x in range(n - 1):
            a = z * n + x
            triangles += [(a, a + n, a + 1), (a + 1, a + n, a + n + 1)]
    return vertices, triangles


def bench_net(build, work):
    """A 20x20 net with 400 spheres, pinned at two corners, swinging."""
    vertices, triangles = net_mesh(20)
    (work / "net.off").write_bytes(shapes.off(vertices, triangles))
    (work / "net.spheres").write_text("".join("%.9g %.9g %.9g 0.02\n" % v for v in vertices))
    (work / "net.spore").write_text("""<?xml version="1.0" encoding="UTF-8"?>
<spore version="1.0">
  <environment gravity="0 -9.81 0"/>
  <solver time_step="0.001" integrator="symplectic_euler"/>
  <assets>
    <mesh name="net" file="net.off"/>
    <spheres name="net-spheres" file="net.spheres"/>
  </assets>
  <bodies>
    <body name="net" role="passive">
      <mechanical geometry="net">
        <mass_spring_net/>
      </mechanical>
      <collision spheres="net-spheres" self="true"/>
    </body>
  </bodies>
  <links>
    <pin name="left" body="net" point="-0.5 0 -0.5" radius="0.01"/>
    <pin name="right" body="net" point="0.5 0 -0.5" radius="0.01"/>
  </links>
</spore>
""")
    for integrator, floor in (("symplectic_euler", 60), ("implicit_euler", None)):
        report = run_scene(build, work / "net.spore", "--steps", "2000", "--integrator", integrator)
        yield row("net", f"20x20, 400 spheres, self-collision, {integrator}", report["step_us"]["median"], "us", floor)


def bench_scenes(build, work):
    """The shipped scenes."""
    for scene in sorted((HERE.parent.parent / "resources/scenes").glob("*.spore")):
        report = run_scene(build, scene, "--steps", "1000")
        yield row("scenes", f"{scene.stem}: {report['dof']} dof, {report['spheres']} spheres", report["step_us"]["median"], "us")


def bench_import(build, work):
    """A mesh of 40,000 triangles, from the command's start to the saved scene."""
    ball = shapes.sphere(rings=101, sectors=200)
    (work / "forty.stl").write_bytes(shapes.stl(*ball))
    times = []
    for _ in range(REPEATS):
        start = time.monotonic()
        subprocess.run([build / "app/spore", "import", work / "forty.stl", "--unit", "m", "-o", work / "forty/forty.spore", "--quiet"],
                       check=True)
        times.append(time.monotonic() - start)
    yield row("import", f"{len(ball[1])} triangles, STL", min(times), "s", 1)


def bench_spheres(build, work):
    """Sphere sets of a knobbly solid."""
    vertices, triangles = shapes.sphere(rings=60, sectors=72)
    bumpy = [(x * (1 + 8 * y), y * 1.5, z * (1 + 200 * x * x)) for x, y, z in vertices]
    (work / "bumpy.off").write_bytes(shapes.off(bumpy, triangles))
    for count in (32, 110, 500):
        done = subprocess.run([build / "app/spore", "spheres", work / "bumpy.off", "--count", str(count), "--json"],
                              capture_output=True, text=True, check=True)
        report = json.loads(done.stdout)
        yield row("spheres", f"{count} spheres, {len(triangles)} triangles", report["seconds"], "s", 5, error_ours=report["depth_error"])


def bench_interrupt(build, work):
    """From Ctrl-C to the end of long work."""
    (work / "fine.off").write_bytes(shapes.off(*shapes.sphere(rings=60, sectors=120)))
    scene = HERE.parent.parent / "resources/scenes/laparoscopy.spore"
    for case, arguments in (("run", ["run", scene, "--steps", "1000000000"]),
                            ("spheres", ["spheres", work / "fine.off", "--count", "3000"]),
                            ("tetrahedra", ["tetrahedra", work / "fine.off", "--cells", "1000000"])):
        worst = 0
        for wait in (0.2, 0.6, 1.0):
            process = subprocess.Popen([build / "app/spore", *arguments], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            time.sleep(wait)
            process.send_signal(signal.SIGINT)
            start = time.monotonic()
            process.wait()
            worst = max(worst, time.monotonic() - start)
        yield row("interrupt", f"{case}, worst of 3", worst, "s", 0.5)


def bench_render(build, work):
    """A frame of an organ with 500 spheres at 1280x720, read back."""
    program = build / "tests/bench/bench_render"
    if program.exists():
        done = subprocess.run([program], capture_output=True, text=True, check=True)
        for case, milliseconds in re.findall(r"^(.+): ([0-9.]+) ms$", done.stdout, re.M):
            yield row("render", case, float(milliseconds), "ms", 1000 / 30)


def bench_start(build, work):
    """The editor from its start to its first drawn frame."""
    program = build / "app/spore-editor"
    if program.exists():
        done = subprocess.run([sys.executable, HERE / "editor_start.py", program], capture_output=True, text=True, check=True)
        yield row("start", "editor to first frame, llvmpipe", float(done.stdout), "s", 1)


BENCHES = {"net": bench_net, "scenes": bench_scenes, "import": bench_import, "spheres": bench_spheres,
           "interrupt": bench_interrupt, "render": bench_render, "start": bench_start}


def show(rows):
    print("%-8s %-48s %12s %-4s %12s %10s" % ("bench", "case", "ours", "", "peer", "floor"))
    for r in rows:
        peer = "%.4g" % r["peer"] if r["peer"] is not None else "-"
        floor = "%.4g" % r["floor"] if r["floor"] is not None else "-"
        missed = r["floor"] is not None and r["ours"] > r["floor"]
        print("%-8s %-48s %12.4g %-4s %12s %10s%s" % (r["bench"], r["case"], r["ours"], r["unit"], peer, floor, "  over its floor" if missed else ""))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*", choices=[[], *BENCHES])
    parser.add_argument("--build", required=True, type=lambda p: pathlib.Path(p).resolve())
    parser.add_argument("--json")
    options = parser.parse_args()
    rows = []
    with tempfile.TemporaryDirectory(prefix="spore-bench-") as folder:
        for name in options.names or BENCHES:
            rows += BENCHES[name](options.build, pathlib.Path(folder))
    show(rows)
    if options.json:
        pathlib.Path(options.json).write_text(json.dumps(rows, indent=1) + "\n")


main()

"""The kernel alone: scenes that `spore run` times."""
import json
import pathlib
import re
import subprocess

import shapes
from table import row

SCENES = pathlib.Path(__file__).resolve().parent.parent.parent / "resources/scenes"
REPEATS = 5


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
    for scene in sorted(SCENES.glob("*.spore")):
        report = run_scene(build, scene, "--steps", "1000")
        yield row("scenes", f"{scene.stem}: {report['dof']} dof, {report['spheres']} spheres", report["step_us"]["median"], "us")


def bench_step(build, work):
    """What a step costs beside physics, by bench_step."""
    floors = {"empty world": 2}
    done = subprocess.run([build / "tests/bench/bench_step"], capture_output=True, text=True, check=True)
    for case, us in re.findall(r"^(.+): ([0-9.]+) us$", done.stdout, re.M):
        yield row("step", case, float(us), "us", floors.get(case))


MONITORED = {"minimal": 20000, "table1-rigid": 2000, "table1-mass-spring": 1000, "table1-deformable": 300, "table1-fluid": 300, "table1-spline-1d": 1000,
             "table1-spline-2d": 1000}


def bench_monitor(build, work):
    """What measuring a run adds to a step: the median of 20 ratios, less 1, with the interval of that median; of short steps the time."""
    for scene, steps in MONITORED.items():
        done = subprocess.run([build / "tests/bench/bench_monitor", SCENES / f"{scene}.spore", str(steps)], capture_output=True, text=True, check=True)
        for way, *figures in re.findall(r"^(\w+): (\S+) us, ratio (\S+) from (\S+) to (\S+), more (\S+) us", done.stdout, re.M):
            step, ratio, low, high, more = map(float, figures)
            case = f"{scene}, {way}, {step:.3g} us a step, {100 * (low - 1):.1f} to {100 * (high - 1):.1f} %"
            yield row("monitor", case, 100 * (ratio - 1), "%", 2) if step >= 20 else row("monitor", case, more, "us", 0.4)


BENCHES = {"net": bench_net, "scenes": bench_scenes, "step": bench_step, "monitor": bench_monitor}

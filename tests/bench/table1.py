"""The paper's Table 1: a body of each kind with the womb, two instruments and the camera. A loop of the kernel with all
collisions, in the paper (Meseure et al. 2003; a Pentium III of 1 GHz) and here: the median step of a whole run of the
recorded input, on one core."""
from kernel import SCENES, run_scene
from table import row

# Scene, the paper's milliseconds a loop.
PAPER = (("rigid", 1), ("fluid", 2), ("mass-spring", 4), ("deformable", 2), ("spline-1d", 8), ("spline-2d", 16))
TARGET_MS, DEMO_MS = 0.1, 1
TRACK_S = 4


def loop(build, scene):
    report = run_scene(build, SCENES / (scene + ".spore"), "--time", str(TRACK_S), "--threads", "1")
    step_ms, ours_ms = report["time_s"] / report["steps"] * 1000, report["step_us"]["median"] / 1000
    case = (f"{report['steps']} steps of {step_ms:.3g} ms ({step_ms / ours_ms:.2g}x real time), {report['dof']} dof, "
            f"{report['spheres']} spheres, {report['contacts']['max']} contacts")
    return case, ours_ms


def bench_table1(build, _):
    for scene, paper_ms in PAPER:
        case, ours = loop(build, "table1-" + scene)
        yield row("table1", f"{scene}: {case}", ours, "ms", TARGET_MS, "paper (2003)", paper_ms)
    case, ours = loop(build, "laparoscopy")
    yield row("table1", f"laparoscopy: {case}", ours, "ms", DEMO_MS)


BENCHES = {"table1": bench_table1}

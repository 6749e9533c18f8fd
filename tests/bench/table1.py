"""The paper's Table 1: a body of each kind with the womb, two instruments and the camera. A loop of the kernel with all
collisions, in the paper (Meseure et al. 2003; a Pentium III of 1 GHz) and here: the median step of a whole run of the
recorded input, on one core; and how far the bodies stray from the same scene computed finely (bench_scene_error.c)."""
import json
import subprocess

from kernel import SCENES, run_scene
from table import row

# Scene, the paper's milliseconds a loop, how many times as fine the reference is.
PAPER = (("rigid", 1, 32), ("fluid", 2, 4), ("mass-spring", 4, 4), ("deformable", 2, 16), ("spline-1d", 8, 16), ("spline-2d", 16, 16))
TARGET_MS, DEMO_MS, DEMO_FINER = 0.1, 1, 4
TRACK_S = 4


def loop(build, scene):
    report = run_scene(build, SCENES / (scene + ".spore"), "--time", str(TRACK_S), "--threads", "1")
    step_ms, ours_ms = report["time_s"] / report["steps"] * 1000, report["step_us"]["median"] / 1000
    case = (f"{report['steps']} steps of {step_ms:.3g} ms ({step_ms / ours_ms:.2g}x real time), {report['dof']} dof, "
            f"{report['spheres']} spheres, {report['contacts']['max']} contacts")
    return case, ours_ms


def strayed(build, scene, finer):
    """Of the worst body that is compared sphere by sphere, else by its middle: in words, and the largest error."""
    done = subprocess.run([build / "tests/bench/bench_scene_error", SCENES / (scene + ".spore"), str(TRACK_S), str(finer)],
                          capture_output=True, text=True, check=True)
    bodies = json.loads(done.stdout)
    resolved = [b for b in bodies if b["compared"] == "spheres"]
    worst = max(resolved or bodies, key=lambda b: b["max"])
    about = f"error of {worst['body']}" + ("" if resolved else "'s middle")
    return f"{about} {worst['final']:.2g} at the end, reference's own {worst['reference']:.1g}", worst["max"]


def bench_table1(build, _):
    for scene, paper_ms, finer in PAPER:
        (case, ours), (words, error) = loop(build, "table1-" + scene), strayed(build, "table1-" + scene, finer)
        yield row("table1", f"{scene}: {case}; {words}", ours, "ms", TARGET_MS, "paper (2003)", paper_ms, error_ours=error)
    (case, ours), (words, error) = loop(build, "laparoscopy"), strayed(build, "laparoscopy", DEMO_FINER)
    yield row("table1", f"laparoscopy: {case}; {words}", ours, "ms", DEMO_MS, error_ours=error)


BENCHES = {"table1": bench_table1}

#!/usr/bin/python3
"""Many runs: planned, run beside each other, killed and taken up again, collected. test_sweep.py SPORE"""
import csv
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree as ElementTree

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
from tap import Skip, check, long_run, main

SPORE = os.path.abspath(sys.argv[1])
FOLDER = pathlib.Path(tempfile.mkdtemp(prefix="spore-sweep-"))
STIFFNESS = "bodies/ball/collision/stiffness"
CUBE = "OFF\n8 12 0\n" + "".join(f"{x} {y} {z}\n" for x in (-0.05, 0.05) for y in (-0.05, 0.05) for z in (-0.05, 0.05)) + """\
3 0 1 3\n3 0 3 2\n3 4 6 7\n3 4 7 5\n3 0 4 5\n3 0 5 1\n3 2 3 7\n3 2 7 6\n3 0 2 6\n3 0 6 4\n3 1 5 7\n3 1 7 3
"""
SCENE = """<?xml version="1.0" encoding="UTF-8"?>
<spore version="1.0">
  <solver time_step="0.002"/>
  <assets><mesh name="cube" file="cube.off"/><spheres name="one" file="one.spheres"/></assets>
  <bodies>
    <body name="floor" role="unmovable" position="0 -0.1 0"><collision spheres="one" stiffness="500"/></body>
    <body name="ball" position="0 0.11 0">
      <mechanical geometry="cube"><rigid_body density="1000"/></mechanical>
      <collision spheres="one" stiffness="500"/>
    </body>
  </bodies>
</spore>
"""


def folder(name):
    """With two scenes."""
    here = FOLDER / name
    here.mkdir()
    (here / "one.spheres").write_text("0 0 0 0.1\n")
    (here / "cube.off").write_text(CUBE)
    (here / "a.spore").write_text(SCENE)
    (here / "b.spore").write_text(SCENE.replace("1000", "1200"))
    return here


def sweep(here, *arguments, status=0):
    done = subprocess.run([SPORE, "sweep", *map(str, arguments)], cwd=here, capture_output=True, text=True, timeout=250)
    assert done.returncode == status, (arguments, done.returncode, done.stdout, done.stderr)
    return done.stdout if status != 2 else done.stderr


def results(here, name="s.sweep"):
    return sorted((here / (name + ".results")).glob("*.json"))


def children_of(parent):
    """Processes that another one has started, as texts."""
    found = []
    for stat in pathlib.Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = stat.read_text().rsplit(") ", 1)[1].split()
        except OSError:  # it went while we looked
            continue
        if int(fields[1]) == parent:
            found.append(stat.parent.name)
    return found


def lives(process):
    """Whether it still works: one that nobody has asked about since its end does not."""
    try:
        return pathlib.Path("/proc", process, "stat").read_text().rsplit(") ", 1)[1].split()[0] not in "ZX"
    except OSError:
        return False


@check
def every_combination_is_a_case(*_):
    """Every combination is a case, and its result is what the command prints"""
    here = folder("plan")
    plan = json.loads(sweep(here, "plan", "a.spore", "b.spore", "-o", "s.sweep", "--vary", STIFFNESS + "=100..400:4", "--integrators",
                            "implicit_euler,bdf2", "--command", "run --steps 100", "--json"))
    assert len(plan["cases"]) == 2 * 4 * 2
    assert {case[STIFFNESS] for case in plan["cases"]} == {"100", "200", "300", "400"}
    assert len({case["hash"] for case in plan["cases"]}) == 16
    assert json.loads(sweep(here, "run", "s.sweep", "--json"))["run"] == 16
    again = json.loads(sweep(here, "run", "s.sweep", "--json"))
    assert again["run"] == 0 and again["kept"] == 16
    one = next(case for case in plan["cases"] if case["scene"] == "b.spore" and case[STIFFNESS] == "300" and case["integrator"] == "bdf2")
    alone = subprocess.run([SPORE, "run", "b.spore", "-n", "100", "--set", STIFFNESS + "=300", "--integrator", "bdf2", "--json"], cwd=here,
                           capture_output=True, text=True)
    kept = json.loads((here / "s.sweep.results" / (one["hash"] + ".json")).read_text())
    assert kept["result"]["state_hash"] == json.loads(alone.stdout)["state_hash"]
    assert kept["host"] and kept["status"] == alone.returncode


@check
@long_run
def killed_and_taken_up_again(*_):
    """A sweep of 200 cases that is killed five times loses nothing and repeats nothing"""
    here = folder("killed")
    sweep(here, "plan", "a.spore", "-o", "s.sweep", "--vary", STIFFNESS + "=100..1000:200", "--command", "run --steps 20")
    kept = {}
    for kill in range(1, 6):
        process = subprocess.Popen([SPORE, "sweep", "run", "s.sweep", "--quiet"], cwd=here)
        while process.poll() is None and len(results(here)) < 30 * kill:
            time.sleep(0.001)
        process.send_signal(signal.SIGKILL)
        process.wait()
        for file, before in kept.items():
            assert file.stat().st_ino == before, "a case was repeated"
        kept = {file: file.stat().st_ino for file in results(here)}
        for file in kept:
            json.loads(file.read_text())
    assert len(kept) >= 150
    sweep(here, "run", "s.sweep")
    assert len(results(here)) == 200
    assert all(file.stat().st_ino == before for file, before in kept.items())
    report = json.loads(sweep(here, "collect", "s.sweep", "--json"))
    assert len(report["cases"]) == 200 and not report["missing"] and not report["failed"]


@check
def two_at_once(*_):
    """Two runs of one sweep share its cases"""
    here = folder("shared")
    sweep(here, "plan", "a.spore", "-o", "s.sweep", "--vary", STIFFNESS + "=100..1000:60", "--command", "run --steps 100")
    both = [subprocess.Popen([SPORE, "sweep", "run", "s.sweep", "--json", "-j", "1"], cwd=here, stdout=subprocess.PIPE, text=True)
            for _ in range(2)]
    reports = [json.loads(one.communicate(timeout=250)[0]) for one in both]
    assert sum(report["run"] for report in reports) >= 60
    assert len(results(here)) == 60
    seen = [json.loads(file.read_text())["case"] for file in results(here)]
    assert sorted(seen) == list(range(60))


@check
def a_case_that_fails_is_listed(*_):
    """A case that fails is listed with its reason; the others are kept"""
    here = folder("failed")
    sweep(here, "plan", "a.spore", "-o", "s.sweep", "--vary", "solver/time_step=0.001,0.002", "--command", "run --time 1e300")
    assert "status 2" in sweep(here, "run", "s.sweep", status=1)
    sweep(here, "plan", "a.spore", "-o", "t.sweep", "--vary", "solver/time_step=0.001,0.002", "--command", "run -n 10")
    sweep(here, "run", "t.sweep", "--case", "1")
    report = json.loads(sweep(here, "collect", "t.sweep", "--json", status=1))
    assert [case["case"] for case in report["cases"]] == [1] and report["missing"] == [0]
    report = json.loads(sweep(here, "collect", "s.sweep", "--json", status=1))
    assert len(report["failed"]) == 2 and "1e300" in report["failed"][0]["said"] and not report["missing"]


@check
def a_case_that_was_killed_runs_again(*_):
    """What a signal ended runs again the next time"""
    here = folder("signal")
    sweep(here, "plan", "a.spore", "-o", "s.sweep", "--vary", "solver/time_step=0.001,0.002", "--command", "run -n 10")
    sweep(here, "run", "s.sweep")
    file = results(here)[0]
    result = json.loads(file.read_text())
    result.update(status=137, result=None)
    file.write_text(json.dumps(result))
    assert len(json.loads(sweep(here, "collect", "s.sweep", "--json", status=1))["failed"]) == 1
    assert json.loads(sweep(here, "run", "s.sweep", "--json"))["run"] == 1
    assert not json.loads(sweep(here, "collect", "s.sweep", "--json"))["failed"]


@check
def a_changed_scene_is_told(*_):
    """A scene, or a file of it, that changed since the plan is told; results that hold are kept by a new plan"""
    here = folder("changed")
    plan = ["plan", "a.spore", "b.spore", "-o", "s.sweep", "--command", "run -n 10", "--repeats", "2"]
    sweep(here, *plan)
    sweep(here, "run", "s.sweep")
    (here / "b.spore").write_text((here / "b.spore").read_text().replace("0.11", "0.12"))
    assert json.loads(sweep(here, "run", "s.sweep", "--json"))["kept"] == 4  # all is there: nothing runs
    for file in results(here):
        if json.loads(file.read_text())["case"] == 3:
            file.unlink()
    assert "has changed" in sweep(here, "run", "s.sweep", status=2)
    sweep(here, *plan)
    assert json.loads(sweep(here, "run", "s.sweep", "--json"))["run"] == 2
    (here / "one.spheres").write_text("0 0 0 0.2\n")
    sweep(here, *plan)
    assert json.loads(sweep(here, "run", "s.sweep", "--json"))["run"] == 4


@check
def an_interrupt_keeps_results(*_):
    """Ctrl-C ends a sweep and its cases; what is done is kept"""
    here = folder("interrupt")
    sweep(here, "plan", "a.spore", "-o", "s.sweep", "--vary", STIFFNESS + "=100..1000:8", "--command", "run -n 100000000")
    process = subprocess.Popen([SPORE, "sweep", "run", "s.sweep"], cwd=here, stderr=subprocess.PIPE, text=True)
    cases = []
    while process.poll() is None and not cases:
        cases = children_of(process.pid)
        time.sleep(0.01)
    process.send_signal(signal.SIGINT)
    said = process.communicate(timeout=60)[1]
    assert process.returncode == 130, process.returncode
    assert "interrupted" in said or not said
    deadline = time.monotonic() + 60
    while any(lives(case) for case in cases):
        assert time.monotonic() < deadline, "a case outlives its sweep"
        time.sleep(0.01)
    assert not results(here)


@check
def tables_pages_plots(*_):
    """Tables, pages, curves with their spread, maps"""
    here = folder("collect")
    sweep(here, "plan", "a.spore", "b.spore", "-o", "s.sweep", "--vary", STIFFNESS + "=100..1000:3:log", "--integrators",
          "implicit_euler,implicit_midpoint", "--command", "run -n 200")
    sweep(here, "run", "s.sweep")
    sweep(here, "collect", "s.sweep", "-o", "s.csv", "--quantities", "contacts.force_max_N")
    rows = list(csv.DictReader((here / "s.csv").open()))
    assert len(rows) == 12
    sweep(here, "collect", "s.sweep", "--svg", "c.svg", "--quantities", "contacts.force_max_N", "--over", STIFFNESS)
    bars = [line for line in ElementTree.parse(here / "c.svg").iter("{http://www.w3.org/2000/svg}line") if line.get("stroke") == "#444444"]
    assert len(bars) == 2 + 3 * 3, len(bars)  # the frame, and three bars with their ends
    sweep(here, "collect", "s.sweep", "--svg", "m.svg", "--quantities", "contacts.force_max_N", "--over", STIFFNESS + ",integrator")
    texts = ["".join(text.itertext()) for text in ElementTree.parse(here / "m.svg").iter("{http://www.w3.org/2000/svg}text")]
    means = [float(row["contacts.force_max_N"]) for row in rows
             if row[STIFFNESS] == "1000" and row["integrator"] == "implicit_euler"]
    mean = sum(means) / len(means)
    assert any(abs(float(text) - mean) < 1e-3 * mean for text in texts if text.replace(".", "").isdigit()), (mean, texts)
    sweep(here, "collect", "s.sweep", "-o", "s.html", "--quantities", "contacts.force_max_N,step_us.median")
    page = (here / "s.html").read_text()
    assert page.count("<svg") == 2 and "http://" not in page.replace("http://www.w3.org/2000/svg", "") and "<script" not in page


@check
def bad_input(*_):
    """Bad input: one line, and nothing is written"""
    here = folder("bad")
    plan = ["plan", "a.spore", "-o", "s.sweep"]
    for more, word in [(["--vary", "bodies/gone/position=1,2"], "bodies/gone"), (["--vary", STIFFNESS], "PATH=VALUES"),
                       (["--vary", STIFFNESS + "=1,,2"], "empty"), (["--vary", STIFFNESS + "=1,1"], "twice"),
                       (["--vary", STIFFNESS + "=5,-5"], STIFFNESS.split("/")[-1]), (["--integrators", "nope"], "nope"),
                       (["--inputs", "gone.track"], "gone.track"), (["--repeats", "0"], "--repeats"),
                       (["--command", "run --output f.csv"], "--output"), (["--command", "render"], "render"),
                       (["--command", "run 'x"], "--command"),
                       (["--vary", STIFFNESS + "=1..9:9999", "--repeats", "9999"], "cases")]:
        said = sweep(here, *plan, *more, status=2)
        assert word in said and said.count("\n") == 1, (more, said)
    assert not (here / "s.sweep").exists()
    assert "gone.spore" in sweep(here, "plan", "gone.spore", "-o", "s.sweep", status=2)
    assert "expected a sweep's manifest" in sweep(here, "run", "gone.sweep", status=2)
    (here / "bad.sweep").write_text('{"spore_sweep":1,"cases":3,"axes":["scene"]}\n{"case":0}\n')
    assert "bad.sweep:2" in sweep(here, "run", "bad.sweep", status=2)
    (here / "huge.sweep").write_text('{"spore_sweep":1,"cases":99999999999,"axes":[]}\n')
    assert "huge.sweep:1" in sweep(here, "run", "huge.sweep", status=2)
    sweep(here, *plan, "--command", "run -n 5")
    text = (here / "s.sweep").read_text()
    (here / "evil.sweep").write_text(text.replace(json.loads(text.splitlines()[1])["hash"], "../../../../x/x/x"))
    assert "evil.sweep:2" in sweep(here, "run", "evil.sweep", status=2)
    assert "0 to 0" in sweep(here, "run", "s.sweep", "--case", "1", status=2)
    sweep(here, "run", "s.sweep")
    assert "no_such" in sweep(here, "collect", "s.sweep", "--quantities", "no_such", status=2)
    assert "no axis" in sweep(here, "collect", "s.sweep", "--svg", "f.svg", "--quantities", "steps", "--over", "nope", status=2)
    results(here)[0].write_text("{")
    assert "no result of case 0" in sweep(here, "collect", "s.sweep", status=2)
    assert not (here / "f.svg").exists()


@check
def gnu_parallel(*_):
    """The script for GNU parallel runs every case"""
    if not shutil.which("parallel"):
        raise Skip("GNU parallel is not installed")
    here = folder("parallel")
    sweep(here, "plan", "a.spore", "-o", "s.sweep", "--vary", STIFFNESS + "=100..1000:6", "--command", "run -n 10", "--parallel", "p.sh")
    subprocess.run(["sh", "p.sh"], cwd=here, check=True, timeout=250)
    assert len(results(here)) == 6


@check
def a_job_array(*_):
    """The script for Slurm is a job array; each task of it runs one case"""
    here = folder("array")
    sweep(here, "plan", "a.spore", "-o", "s.sweep", "--vary", STIFFNESS + "=100..1000:6", "--command", "run -n 10", "--slurm", "j.sh")
    assert "#SBATCH --array=0-5" in (here / "j.sh").read_text()
    for task in (4, 2):
        subprocess.run(["./j.sh"], cwd=here, check=True, timeout=250, env=dict(os.environ, SLURM_ARRAY_TASK_ID=str(task)))
    assert sorted(json.loads(file.read_text())["case"] for file in results(here)) == [2, 4]


@check
def slurm(*_):
    """Slurm runs every case of a job array"""
    if not shutil.which("sbatch") or subprocess.run(["sinfo", "--noheader"], capture_output=True).returncode != 0:
        raise Skip("no Slurm answers here")
    here = folder("slurm")
    sweep(here, "plan", "a.spore", "-o", "s.sweep", "--vary", STIFFNESS + "=100..1000:6", "--command", "run -n 10", "--slurm", "j.sh")
    subprocess.run(["sbatch", "--wait", "j.sh"], cwd=here, check=True, timeout=250)
    assert len(results(here)) == 6


try:
    main()
finally:
    shutil.rmtree(FOLDER, ignore_errors=True)

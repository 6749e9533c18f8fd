#!/usr/bin/python3
"""test_reports.py BUILD: the reports of ./dev bench still run, hold together, and say of a method what its points say."""
import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent), str(HERE.parent / "e2e")]
import accuracy
import scaling
from tap import check, main

BUILD = pathlib.Path(sys.argv[1]).resolve()
WORK = pathlib.Path(tempfile.mkdtemp(prefix="spore-reports-"))
for part in ("app", "tests"):  # so that nobody's own report is replaced
    (WORK / part).symlink_to(BUILD / part)
ROW = {"bench", "case", "ours", "peer_name", "peer", "unit", "ratio", "error_ours", "error_peer", "floor"}


def bench(*arguments):
    done = subprocess.run([sys.executable, HERE / "bench.py", "--build", WORK, *arguments], capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done
    return done


@check
def accuracy_makes_one_page():
    """Page, plots and rows of a scene; nothing on the page lies elsewhere."""
    bench("accuracy", "--scenes", "table1-rigid", "--seconds", "1", "--json", str(WORK / "rows.json"))
    page = (WORK / "bench/accuracy/index.html").read_text()
    assert re.findall(r'(?:src|href)="(?!data:|#)', page) == [] and "data:image/svg+xml" in page and "Not yet measured" not in page
    rows = json.loads((WORK / "rows.json").read_text())
    assert all(ROW <= set(row) for row in rows) and {row["bench"] for row in rows} == {"accuracy", "stability"}, rows
    assert (WORK / "bench/accuracy/table1-rigid.svg").read_text().startswith("<?xml")


@check
def interruption_leaves_whole_files_alone():
    rows = WORK / "never.json"
    process = subprocess.Popen([sys.executable, HERE / "bench.py", "--build", WORK, "accuracy", "--scenes", "laparoscopy", "--json", rows],
                               stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    assert "laparoscopy" in process.stderr.readline()
    process.send_signal(signal.SIGTERM)
    _, said = process.communicate(timeout=60)
    assert process.returncode == 130 and "interrupted" in said, (process.returncode, said)
    assert not rows.exists() and not [file for file in os.listdir(WORK / "bench/accuracy") if file.startswith(("laparoscopy", "."))]


def study_of(name, floor=1e-4, **points):
    """A study with points method=(error, cost)."""
    study = accuracy.Study(pathlib.Path(name + ".spore"))
    study.accuracy = {"resolution": {"floor": floor}, "points": [{"method": method, "dt_s": 0.004, "error": error, "cpu_s": cost, "stable": True, "sound": True}
                                                                   for method, (error, cost) in points.items()]}
    return study


@check
def losers_are_named_where_they_lose():
    studies = [study_of("near", euler=(5e-3, 1), rk4=(1e-3, 3)), study_of("far", euler=(5e-2, 1), rk4=(1e-3, 3)),
               study_of("rough", floor=0.5, euler=(5e-3, 9), rk4=(1e-3, 3))]
    said = " / ".join(accuracy.losses(studies)[1e-2])
    assert "euler is the cheapest, or within 10 % of it, in 1 of 2 (near); does not get there in far" in said, said
    assert "rk4 is the cheapest, or within 10 % of it, in 1 of 2 (far); loses to euler 3x in near" in said and "rough" not in said, said


@check
def scaling_draws_its_curves():
    said = bench("scaling", "--families", "threads,particles", "--seconds", "0.002").stderr
    assert "left out" in said and "<svg" in (WORK / "bench/scaling/time.svg").read_text()


def sizes(power):
    made = []
    for dof in (1000, 3000, 10000):
        size = object.__new__(scaling.Size)
        size.dof, size.step_s = dof, 1e-6 * dof ** power
        made.append(size)
    return made


@check
def growth_is_told():
    assert abs(scaling.exponent(sizes(1.5), scaling.MEASURES["step"]) - 1.5) < 1e-9
    assert scaling.worse_than_linear("nets", sizes(1.5)).startswith("nets grows worse than linear: 1000 to 3000 dof n^1.50")
    assert scaling.worse_than_linear("nets", sizes(1)) == "nets grows no worse than linear"


if __name__ == "__main__":
    main()

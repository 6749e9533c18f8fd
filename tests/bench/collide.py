"""Collision detection alone, by bench_collide in CPU time of its thread; its share of what a step may take of the piles."""
import re
import subprocess

from table import row

FLOORS = {"settled pile of 500": 15, "settled pile of 2000": 60}  # us


def bench_collide(build, work):
    """A detection, mean over steps in which the spheres move."""
    done = subprocess.run([build / "tests/bench/bench_collide"], capture_output=True, text=True, check=True)
    for case, us in re.findall(r"^(.+): (\S+) us$", done.stdout, re.M):
        yield row("collide", case, float(us), "us", FLOORS.get(case.split(" on ")[0]))


BENCHES = {"collide": bench_collide}

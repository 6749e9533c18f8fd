"""Vector kernels, by bench_kernels in CPU time of its thread: the best level of this machine, and the floors of peers.md."""
import re
import subprocess

from table import row

FLOORS = {"net 20x20, 1121 springs, force": 1, "1920 corotational tetrahedra force": 7}


def bench_kernels(build, work):
    """The best level comes last in the program's output."""
    done = subprocess.run([build / "tests/bench/bench_kernels"], capture_output=True, text=True, check=True)
    best = {}
    for kernel, level, us in re.findall(r"^(.+), (\w+): ([0-9.]+) us$", done.stdout, re.M):
        best[kernel] = level, float(us)
    for kernel, (level, us) in best.items():
        yield row("kernels", f"{kernel}, {level}", us, "us", FLOORS.get(kernel))


BENCHES = {"kernels": bench_kernels}

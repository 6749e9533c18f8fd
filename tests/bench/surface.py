"""What a ball feels that slides over a body, as one depth field against its spheres one by one: how far the force is from the
true normal, how far its depth is from the true one, how unsteady it is, and what a step costs, by bench_surface."""
import pathlib
import re
import subprocess

from table import row

ORGANS = pathlib.Path(__file__).resolve().parents[2] / "resources/scenes/organs"
MEASURES = (("normal", "deg"), ("depth", "of it"), ("unsteady", "of it"), ("cost", "us"))


def bench_surface(build, work):
    """Two lines a case: spheres, then depth field."""
    done = subprocess.run([build / "tests/bench/bench_surface", ORGANS], capture_output=True, text=True, check=True)
    found = {}
    for case, surface, rest in re.findall(r"^(.+), (spheres|depth_field): (.+)$", done.stdout, re.M):
        found.setdefault(case, {})[surface] = {name: float(re.search(name + r" (\S+)", rest).group(1).rstrip(",")) for name, _ in MEASURES}
    for case, felt in found.items():
        for name, unit in MEASURES:
            yield row("surface", f"{case}: {name}", felt["depth_field"][name], unit, peer_name="spheres one by one", peer=felt["spheres"][name])


BENCHES = {"surface": bench_surface}

"""Other programs and we on the same case, in one run: peer, us, peer, us, ... on one core, CPU time, medians. Where a case has
a reference the step is chosen so that our error is no larger than the peer's. What is the same for all lies in peers/case.h."""
import array
import json
import math
import pathlib
import statistics
import subprocess
import sys

from table import row

HERE = pathlib.Path(__file__).resolve().parent / "peers"
REPEATS = 5


class Refused(Exception):
    """A program did not run a case as it was told to."""


class Program:
    """A program of the cases, run with options."""

    def __init__(self, name, path, work):
        self.name, self.path, self.work = name, path, work

    def run(self, case, **options):
        words = [f"{key}={value}" for key, value in options.items()]
        done = subprocess.run([self.path, case, *words], capture_output=True, text=True, stdin=subprocess.DEVNULL, cwd=self.work)
        if done.returncode:
            raise Refused(f"{self.name} {case} {' '.join(words)}: status {done.returncode}: {done.stderr.strip()}")
        return json.loads(done.stdout)

    def trajectory(self, case, **options):
        """Positions at even times, one flat array, and the answer."""
        file = self.work / "trajectory"
        answer = self.run(case, trajectory=file, **options)
        return array.array("d", file.read_bytes()), answer


def compile_peer(name, source, work, packages=(), libraries=(), suffix=""):
    """The program, or None with a word on stderr where the peer is not installed."""
    flags = subprocess.run(["pkg-config", "--cflags", "--libs", *packages], capture_output=True, text=True) if packages else None
    if flags and flags.returncode:
        print(f"bench: {name} is not installed: its cases are left out", file=sys.stderr)
        return None
    path = work / (pathlib.Path(source).stem + suffix)
    compiler = ["g++", "-std=gnu++17"] if source.endswith(".cpp") else ["gcc", "-std=gnu17"]
    done = subprocess.run([*compiler, "-O2", "-w", HERE / source, "-o", path, *(flags.stdout.split() if flags else ()), *libraries],
                          capture_output=True, text=True)
    if done.returncode:
        print(f"bench: {name} is not installed or has changed: its cases are left out\n{done.stderr[:500]}", file=sys.stderr)
        return None
    return Program(name, path, work)


def distance(a, b, length):
    """Root mean square of the distances of nodes over all frames, over a length."""
    if len(a) != len(b):
        raise ValueError(f"{len(a)} and {len(b)} coordinates cannot be compared")
    return math.sqrt(3 * math.fsum((x - y) ** 2 for x, y in zip(a, b)) / len(a)) / length


class Reference:
    """Converged positions of a case: by an integrator of order p at N and 2 N steps, extrapolated after Richardson.
    `own` is the size of the last correction."""

    def __init__(self, ours, case, length, steps, order, **options):
        coarse, _ = ours.trajectory(case, steps=steps, **options)
        fine, _ = ours.trajectory(case, steps=2 * steps, **options)
        weight = 1 / (2 ** order - 1)
        self.positions = array.array("d", (f + weight * (f - c) for c, f in zip(coarse, fine)))
        self.length, self.own = length, weight * distance(coarse, fine, length)

    def error(self, positions):
        return distance(positions, self.positions, self.length)


def cheapest(ours, case, reference, error, candidates, **options):
    """Our cheapest run whose error is no larger, as CPU seconds, options and error: for each of `candidates` (dictionaries of
    options) the smallest number of steps on a ladder of ratio 2^(1/4) that begins at its `first`. None: there is none."""
    found = []
    for candidate in candidates:
        run = {**options, **candidate}
        first = run.pop("first")
        for k in range(60):
            run["steps"] = round(first * 2 ** (k / 4))
            try:
                positions, answer = ours.trajectory(case, **run)
            except Refused:  # too large a step for its integrator
                continue
            reached = reference.error(positions)
            if reached <= error:
                found.append((answer["cpu_s"], run, reached))
                break
    return min(found, key=lambda f: f[0], default=None)


class Field:
    """Ourselves, the peers that are installed, and the machine, made once."""

    def __init__(self, build, work):
        self.ours = Program("ours", build / "tests/bench/bench_peers", work)
        self.bullet = [peer for peer in (compile_peer("Bullet", "bullet.cpp", work, ["bullet"], suffix="-float"),
                                         compile_peer("Bullet double", "bullet.cpp", work, ["bullet-float64"], suffix="-double")) if peer]
        self.mujoco = compile_peer("MuJoCo", "mujoco.c", work, libraries=["-lmujoco", "-lm"])
        self.machine = self.ours.run("machine")

    def seconds(self, flops, bytes_moved=0):
        """The least time that counted work can take on one core here."""
        return max(flops / self.machine["gflops"], bytes_moved / self.machine["gbytes"]) * 1e-9


_field = None


def field(build, work):
    global _field
    _field = _field or Field(build, work)
    return _field


def race(case, ours, our_options, peer, peer_options, repeats=REPEATS, peer_case=None):
    """Medians of the CPU time of a step's run of both, in turn; and the last answers."""
    times = {"ours": [], "peer": []}
    for _ in range(repeats):
        theirs = peer.run(peer_case or case, **peer_options)
        mine = ours.run(case, **our_options)
        times["peer"].append(theirs["cpu_s"] / theirs["time_s"])
        times["ours"].append(mine["cpu_s"] / mine["time_s"])
    return statistics.median(times["ours"]), statistics.median(times["peer"]), mine, theirs


# Operations of one force: of a spring, with its root and quotient; of moving a node.
SPRING_FLOPS, NODE_FLOPS = 45, 12
CLOTH_SPRINGS, CLOTH_NODES, ROPE_NODES = 1121, 400, 64


def at_equal_error(f, bench, case, label, reference, peer, peer_options, candidates, least, floor, **options):
    """A row: the peer as it is told to run, ours as cheap as its error allows."""
    positions, _ = peer.trajectory(case, **peer_options)
    allowed = reference.error(positions)
    best = cheapest(f.ours, case, reference, allowed, candidates, **options)
    if best is None:
        raise Refused(f"{case}: nothing of ours is as near to the reference as {peer.name} ({allowed:.2g})")
    _, chosen, error = best
    ours, theirs, _, _ = race(case, f.ours, chosen, peer, peer_options)
    how = f"{label}: {chosen['steps']} steps of {chosen['integrator']} against {peer_options['steps']}"
    return row(bench, how, 1e3 * ours, "ms/s", floor=1e3 * floor(chosen["steps"]), peer_name=peer.name, peer=1e3 * theirs, error_ours=error,
               error_peer=allowed, least=least)


def bench_cloth(build, work):
    """A cloth of 20 x 20 against Bullet, explicit and implicit, and MuJoCo."""
    f = field(build, work)

    def floor(steps):
        return steps * f.seconds(CLOTH_SPRINGS * SPRING_FLOPS + CLOTH_NODES * NODE_FLOPS)

    for stiffness, steps, reference_steps in ((1e2, 500, 8000), (1e4, 4000, 40000)):
        reference = Reference(f.ours, "cloth", 1, reference_steps, 1, integrator="symplectic_euler", stiffness=stiffness)
        for peer in f.bullet:
            yield at_equal_error(f, "cloth", "cloth", f"explicit, k {stiffness:g}", reference, peer, {"steps": steps, "stiffness": stiffness},
                                 [{"integrator": "symplectic_euler", "first": steps / 4}], 10, floor, stiffness=stiffness)
        for peer in f.bullet:
            yield at_equal_error(f, "cloth", "cloth", f"implicit, k {stiffness:g}", reference, peer,
                                 {"steps": 240, "stiffness": stiffness, "implicit": 1},
                                 [{"integrator": "implicit_euler", "newton": 1, "first": 30}], 5, floor, stiffness=stiffness)


BENCHES = {"cloth": bench_cloth}

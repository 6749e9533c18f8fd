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
FRAMES = 10  # even times at which positions are compared; every run's steps are a multiple


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
    """What a case converges to: `coarse` and `fine` are options of two of our runs whose difference is by theory 1/(1 - weight)
    of the coarse one's error, extrapolated after Richardson. `own` is the size of the correction."""

    def __init__(self, ours, case, length, coarse, fine, weight):
        less, _ = ours.trajectory(case, **coarse)
        more, _ = ours.trajectory(case, **fine)
        self.positions = array.array("d", (m + weight * (m - l) for l, m in zip(less, more)))
        self.length, self.own = length, weight * distance(less, more, length)

    def error(self, positions):
        return distance(positions, self.positions, self.length)


def by_rk4(ours, case, length, steps, **options):
    """Fourth order at a step and at half of it."""
    common = {"integrator": "rk4", **options}
    return Reference(ours, case, length, {"steps": steps, **common}, {"steps": 2 * steps, **common}, 1 / 15)


def ladder(first):
    """Numbers of steps, about 2^(1/4) apart, that end on the frames."""
    return sorted({FRAMES * max(1, round(first * 2 ** (k / 4) / FRAMES)) for k in range(40)})


def cheapest(ours, case, reference, error, candidates):
    """Our cheapest run whose error is no larger, as CPU seconds, options and error: for each of `candidates` (dictionaries of
    options) the smallest number of steps on a ladder that begins at its `first`. None: there is none."""
    best = None
    for candidate in candidates:
        run = dict(candidate)
        for steps in ladder(run.pop("first")):
            run["steps"] = steps
            try:
                positions, answer = ours.trajectory(case, **run)
            except Refused:  # too large a step for its integrator
                continue
            if best and answer["cpu_s"] > best[0]:
                break
            reached = reference.error(positions)
            if reached <= error and not answer["mended"]:
                best = answer["cpu_s"], dict(run), reached
                break
    return best


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
CLOTH_SPRINGS, CLOTH_NODES, ROPE_NODES, BAR_ELEMENTS, BAR_NODES = 1121, 400, 64, 1920, 525


def at_equal_error(f, case, label, reference, peer, peer_options, candidates, least, floor):
    """A row: the peer as it is told to run, ours as cheap as its error allows."""
    positions, _ = peer.trajectory(case, **peer_options)
    allowed = reference.error(positions)
    if reference.own > allowed / 100:
        print(f"bench: {case}, {label}: the reference is known to {reference.own:.1g} only, {peer.name} errs by {allowed:.1g}", file=sys.stderr)
    best = cheapest(f.ours, case, reference, allowed, candidates)
    if best is None:
        raise Refused(f"{case}, {label}: no run of ours is as near to the reference as {peer.name} ({allowed:.2g})")
    _, chosen, error = best
    ours, theirs, answer, _ = race(case, f.ours, chosen, peer, peer_options)
    steps = chosen["steps"] * chosen.get("substeps", 1)
    newton = f", {answer['newton']:.2g} Newton" if answer["newton"] else ""
    how = f"{label}: {steps} {chosen['integrator']}{newton} to {peer_options['steps']}"
    return row(case, how, 1e3 * ours, "ms/s", floor=1e3 * floor(steps), peer_name=peer.name, peer=1e3 * theirs, error_ours=error,
               error_peer=allowed, least=least)


def explicit(first, **options):
    """Explicit candidates that begin at about `first` steps in all, four of them at a time."""
    return [{"integrator": name, "substeps": 4, "first": first / 4 / stages, **options}
            for name, stages in (("symplectic_euler", 1), ("verlet", 1), ("rk4", 4))]


def one_newton(**options):
    """As the peer does it: one Newton iteration a step, more only where that does not do."""
    return [{"integrator": "implicit_euler", "nonlinear": "newton", "tolerance": 0.1, "first": FRAMES, **options}]


def implicit(first, **options):
    """Implicit candidates, each with what solves its equations by itself and with a factor that is kept."""
    solvers = ({}, {"nonlinear": "broyden", "linear": "cholesky"})
    return [{"integrator": name, "tolerance": tolerance, "first": first, **solver, **options}
            for name in ("implicit_euler", "implicit_midpoint") for solver in solvers for tolerance in (0.1, 0.01)]


def bench_cloth(build, work):
    """A cloth of 20 x 20 against Bullet, explicit and implicit, and MuJoCo."""
    f = field(build, work)

    def floor(steps):
        return steps * f.seconds(CLOTH_SPRINGS * SPRING_FLOPS + CLOTH_NODES * NODE_FLOPS)

    for stiffness, steps, reference_steps in ((1e2, 500, 4000), (1e4, 4000, 20000)):
        reference = by_rk4(f.ours, "cloth", 1, reference_steps, stiffness=stiffness)
        for peer in f.bullet:
            options = {"steps": steps, "stiffness": stiffness}
            yield at_equal_error(f, "cloth", f"explicit, k {stiffness:g}", reference, peer, options,
                                 explicit(steps / 2, stiffness=stiffness), 10, floor)
        for peer in f.bullet:
            options = {"steps": 240, "stiffness": stiffness, "implicit": 1}
            yield at_equal_error(f, "cloth", f"implicit, k {stiffness:g}", reference, peer, options, one_newton(stiffness=stiffness), 5, floor)
        yield at_equal_error(f, "cloth", f"implicit of any kind, k {stiffness:g}", reference, f.bullet[0], options,
                             implicit(FRAMES, stiffness=stiffness), 5, floor)
    if f.mujoco:
        mine = {"integrator": "symplectic_euler", "stiffness": 100, "steps": 500}
        ours, theirs, _, _ = race("cloth", f.ours, mine, f.mujoco, {"steps": 50, "time": 0.1, "stack": "3e7"})
        yield row("cloth", "its 2D grid of 20 x 20, 500 steps each", 1e3 * ours, "ms/s", floor=1e3 * floor(500), peer_name="MuJoCo",
                  peer=1e3 * theirs)


def bench_rope(build, work):
    """A rope of 64 nodes that cannot be stretched, against Bullet's position-based one: the springs of ours may be as soft as
    its error allows."""
    f = field(build, work)
    common = {"integrator": "rk4", "substeps": 100}
    reference = Reference(f.ours, "rope", 1, {"stiffness": 2e5, "steps": 1000, **common}, {"stiffness": 4e5, "steps": 1000, **common}, 1)

    def floor(steps):
        return steps * f.seconds(ROPE_NODES * (SPRING_FLOPS + NODE_FLOPS))

    for peer in f.bullet:
        for iterations in (4, 10):
            candidates = [c for k in (500, 700, 1000, 1400, 2000) for c in explicit(400, stiffness=k)[:2]]
            yield at_equal_error(f, "rope", f"{iterations} iterations", reference, peer, {"steps": 240, "iterations": iterations}, candidates,
                                 2, floor)
    if f.mujoco:
        for case in ("rope", "string"):
            mine = {"integrator": "symplectic_euler", "stiffness": 1000, "steps": 100, "substeps": 10}
            ours, theirs, _, _ = race("rope", f.ours, mine, f.mujoco, {"steps": 100, "time": 0.2}, peer_case=case)
            yield row("rope", f"its {case}, 2 ms; ours 1 ms", 1e3 * ours, "ms/s", floor=1e3 * floor(1000), peer_name="MuJoCo", peer=1e3 * theirs)


def bench_bar(build, work):
    """A bar of 1920 corotational tetrahedra that falls under its own weight, against Bullet's implicit one."""
    f = field(build, work)
    reference = by_rk4(f.ours, "bar", 1, 20000)

    def floor(steps):
        """One linearisation of the elements, and one solve with a factor of 525 rows of blocks, 25 wide, that is read twice."""
        return steps * (f.seconds(BAR_ELEMENTS * 1500) + f.seconds(0, 2 * BAR_NODES * 25 * 72))

    for peer in f.bullet:
        options = {"steps": 50, "implicit": 1}
        yield at_equal_error(f, "bar", "1920 tetrahedra", reference, peer, options, implicit(FRAMES), 40, floor)
        yield at_equal_error(f, "bar", "1920 tetrahedra, no larger steps", reference, peer, options, implicit(50), None, floor)


# Ways to hold the pile up: contacts that give no more than MuJoCo's do.
PILE_CANDIDATES = ({"integrator": "symplectic_euler", "substeps": 6}, {"integrator": "implicit_euler", "tolerance": 0.0001})
PILE_DEPTH = 0.0125  # of the radius


def bench_pile(build, work):
    """500 spheres at rest in a box, 2 ms a step, all from the same place; errors are the mean depth of a contact over the
    radius."""
    f = field(build, work)
    if not f.bullet:
        return
    settled = work / "settled"
    f.bullet[0].run("pile", time=0.2, steps=100, settle=2000, trajectory=settled)
    common = {"time": 0.2, "steps": 100, "start": settled, "settle": 50}
    mine = {**common, "stiffness": 2e5, "damping": 20, "settle": 500}
    found = [(f.ours.run("pile", **mine, **candidate), candidate) for candidate in PILE_CANDIDATES]
    _, candidate = min((a["cpu_s"], i) for i, (a, _) in enumerate(found) if a["depth"] < PILE_DEPTH)
    mine |= PILE_CANDIDATES[candidate]
    peers = [(peer, {}, 5) for peer in f.bullet]
    if f.mujoco:
        peers.append((f.mujoco, {"solver": "PGS", "iterations": 10, "stack": "1.2e8"}, None))
    for peer, options, least in peers:
        ours, others, answer, other = race("pile", f.ours, mine, peer, {**common, **options})
        label = f"{mine['integrator']}, {answer['contacts']} contacts, its {other['contacts']}"
        yield row("pile", label, 1e6 * ours * 0.002, "us", floor=1e6 * f.seconds(1400 * 150 + 500 * 200), peer_name=peer.name,
                  peer=1e6 * others * 0.002, error_ours=answer["depth"], error_peer=other["depth"], least=least)
    falling = {"time": 0.2, "steps": 100, "settle": 100}
    mine = {**falling, "stiffness": 2e5, "damping": 20, "integrator": "implicit_euler", "tolerance": 0.1}
    for peer in f.bullet:
        ours, others, answer, other = race("pile", f.ours, mine, peer, falling)
        label = f"while it falls, {mine['integrator']}, {answer['contacts']} contacts, its {other['contacts']}"
        yield row("pile", label, 1e6 * ours * 0.002, "us", peer_name=peer.name, peer=1e6 * others * 0.002, error_ours=answer["depth"],
                  error_peer=other["depth"])


BENCHES = {"cloth": bench_cloth, "rope": bench_rope, "bar": bench_bar, "pile": bench_pile}

"""Work and precision: the methods that the field uses today (field/), CVODE and Bullet beside ours on the same system from the
same start; CPU seconds of one core for a simulated second to come within 1e-1, 1e-2, 1e-3 and 1e-4 of a common reference.
Errors are roots of the mean square over nodes and FRAMES even times, over the length of the body (1 m in all cases). Each
program runs with as many steps as it needs, found to a factor of sqrt(2), and with whichever of its settings is cheapest."""
import math
import subprocess
import sys

import peers
from peers import FRAMES, Program, Reference, Refused
from table import row

TARGETS = (1e-1, 1e-2, 1e-3, 1e-4)
REPEATS = 2  # more, of those that are reported; the least counts, as other work on the machine only adds

# Settings of the methods: what their papers use and what lies beside it.
XPBD = [{"method": "xpbd", "iterations": n} for n in (1, 4)]
VBD = [{"method": "vbd", "iterations": n} for n in (1, 3, 12)] + [{"method": "vbd", "iterations": 12, "radius": 0.9}]
PD = [{"method": "pd", "iterations": n} for n in (1, 3, 12)]
EXPLICIT = [{"integrator": name, "substeps": 5} for name in ("symplectic_euler", "verlet", "rk4")]
SWEPT = [{"integrator": "position_based", "substeps": n} for n in (1, 4, 16)]
IMPLICIT = [{"integrator": name, "tolerance": tolerance} for name, tolerance in
            (("implicit_euler", 0.1), ("implicit_euler", 0.01), ("implicit_midpoint", 0.01), ("tr_bdf2", 0.01))]
BROYDEN = [{"integrator": "implicit_midpoint", "tolerance": 0.01, "nonlinear": "broyden", "linear": "cholesky"}]
IN_CONTACT = [{**c, "substeps": 1} for c in EXPLICIT]  # contacts are found once a step

# Operations, counted by hand: of one force of an element; of what a method does with an element in a sweep. XPBD: force,
# gradients and two projections; VBD: force and matrix at each corner; PD: force, and two passes through a factor.
SPRING = {"force": 45, "xpbd": 70, "vbd": 2 * 75, "pd": 45}
SOLID = {"force": 210, "xpbd": 360, "vbd": 4 * 300, "pd": 650}


class Case:
    """What is run; `options` go to all programs, `own` to ours alone; longer runs than most_cpu_s are not tried."""

    def __init__(self, name, label, options, elements, flops, factor, reference_steps, most_cpu_s, rivals, ours, time_s=1, own=()):
        self.name, self.label, self.time_s, self.options, self.own = name, label, time_s, options, dict(own)
        self.elements, self.flops, self.factor = elements, flops, factor
        self.reference_steps, self.most_cpu_s, self.rivals, self.ours = reference_steps, most_cpu_s, rivals, ours


MUJOCO = [{"springs": 1, "stack": "3e7", "integrator": name} for name in ("Euler", "RK4")]
EVERY = {"XPBD": XPBD, "VBD": VBD, "PD": PD, "CVODE": [{"method": "adams"}, {"method": "bdf"}], "Bullet": [{}, {"implicit": 1}], "MuJoCo": MUJOCO}
# The order of a chain's springs matters to XPBD; Bullet's rope is position-based.
OF_ROPE = {**EVERY, "XPBD": XPBD + [{**s, "order": "given"} for s in XPBD], "Bullet": [{"iterations": n} for n in (4, 20)]}
IN_CONTACT_TOO = {name: EVERY[name] for name in ("XPBD", "VBD", "PD", "CVODE")}
OF_SOLIDS = {name: EVERY[name] for name in ("XPBD", "VBD", "CVODE")}
CLOTH_FACTOR = 400 * 21  # numbers in a factor, a row for each node


def bar(parts, law, ratio, rivals):
    elements, factor, steps, most_cpu_s = {1: (1920, 12000, 1000, 0.25), 2: (15360, 282000, 1000, 1.2)}[parts]
    return Case("bar", f"{elements} tetrahedra, {law.replace('_', '-')}, nu {ratio:g}", {"law": law, "poisson_ratio": ratio, "parts": parts},
                elements, SOLID, factor, steps, most_cpu_s, rivals, EXPLICIT + SWEPT[:1] + IMPLICIT[1:], time_s=0.5, own={"viscosity": 0})


def cases():
    """PD's matrix holds the corotational law without a volume term alone: that is a case of its own, with a reference of its own."""
    for stiffness, steps, most_cpu_s in ((1e2, 1000, 0.15), (1e4, 5000, 0.25), (1e6, 40000, 0.8)):
        yield Case("cloth", f"cloth, k {stiffness:g}", {"stiffness": stiffness}, 1121, SPRING, CLOTH_FACTOR, steps, most_cpu_s, EVERY,
                   EXPLICIT + SWEPT + IMPLICIT + BROYDEN)
    yield Case("rope", "rope 64, k 2e+05", {"stiffness": 2e5}, 63, SPRING, 126, 50000, 0.3, OF_ROPE, EXPLICIT + SWEPT + IMPLICIT + BROYDEN)
    yield Case("net", "net on spheres", {}, 1121, SPRING, CLOTH_FACTOR, 4000, 0.25, IN_CONTACT_TOO, IN_CONTACT + SWEPT[:1] + IMPLICIT, time_s=0.5)
    for parts in (1, 2):
        yield bar(parts, "neo_hookean", 0.3, OF_SOLIDS)
        yield bar(parts, "neo_hookean", 0.45, OF_SOLIDS)
        yield bar(parts, "corotational", 0, {"PD": PD})


class Ladder:
    """A program that is told the number of steps; the substeps of a setting are counted as steps."""

    longest_s = math.inf  # a run is broken off there
    refuses_work = False  # what it refuses is too large a step: more of them may do
    patience = 0.5        # of the longest run that is tried: after a longer one the number of steps is not doubled again

    def __init__(self, program):
        self.program = program

    def rung(self, setting, quarters):
        """Steps after so many quarters of a doubling; they end on the frames."""
        unit = FRAMES * setting.get("substeps", 1)
        return unit * max(1, round(2 ** (quarters / 4)))

    def options(self, setting, steps):
        return {**setting, "steps": steps // setting.get("substeps", 1)}


class Tolerances(Ladder):
    """CVODE chooses its steps itself: a rung is one over its tolerance."""

    longest_s = 2
    refuses_work = True
    patience = 4  # its work hardly grows with what is asked of it

    def rung(self, setting, quarters):
        return 10 * 2 ** quarters  # a method of fifth order: 16 times as near for twice the steps

    def options(self, setting, rung):
        return {**setting, "steps": FRAMES, "tolerance": 1 / rung, "limit": self.longest_s}


class Patient(Ladder):
    """Of a program whose steps cost so much that it would be given up before its step is small enough."""

    patience = 4


class Runs:
    """A program's runs of a case, each made once: CPU seconds and error by setting and rung."""

    def __init__(self, case, ladder, reference, settings, own=()):
        self.case, self.ladder, self.reference, self.settings = case, ladder, reference, settings
        self.common = {"time": case.time_s, **case.options, **dict(own)}
        self.made = {}

    def run(self, index, rung):
        key = index, rung
        if key in self.made:
            return self.made[key]
        try:
            options = self.ladder.options(self.settings[index], rung)
            positions, answer = self.ladder.program.trajectory(self.case.name, **self.common, **options)
            error = self.reference.error(positions)
            fair = math.isfinite(error) and not answer.get("mended")
            self.made[key] = answer["cpu_s"], error if fair else math.inf, answer
        except Refused:  # too large a step, or too much work
            self.made[key] = math.inf, math.inf, {}
        return self.made[key]

    def climb(self, index):
        """Doubles the steps until the last target is reached or the time is up."""
        for doubling in range(24):
            cpu_s, error, _ = self.run(index, self.ladder.rung(self.settings[index], 4 * doubling))
            long = cpu_s > self.ladder.patience * self.case.most_cpu_s
            if error <= TARGETS[-1] or (long and (cpu_s < math.inf or self.ladder.refuses_work)):
                return

    def refine(self, target):
        """Tries less than a doubling back from what reached the target, where that may become the best."""
        found = self.best(target)
        for index, setting in enumerate(self.settings) if found else ():
            doublings = range(24)
            reached = [d for d in doublings if self.made.get((index, self.ladder.rung(setting, 4 * d)), (0, math.inf))[1] <= target]
            if not reached or self.made[index, self.ladder.rung(setting, 4 * reached[0])][0] > 2 * found[0]:
                continue
            if reached[0]:
                self.run(index, self.ladder.rung(setting, 4 * reached[0] - 2))

    def best(self, target):
        """CPU seconds, error, setting's index, rung and answer of the cheapest run that is near enough; or None."""
        near = [(cpu_s, error, *key, answer) for key, (cpu_s, error, answer) in self.made.items() if error <= target]
        return min(near, key=lambda run: run[0]) if near else None

    def measure(self):
        """The best for each target."""
        for index in range(len(self.settings)):
            self.climb(index)
        for target in TARGETS:
            self.refine(target)
        return [self.best(target) for target in TARGETS]

    def again(self, best):
        """CPU seconds once more."""
        _, _, index, rung, _ = best
        return self.ladder.program.run(self.case.name, **self.common, **self.ladder.options(self.settings[index], rung))["cpu_s"]

    def words(self, best):
        _, _, index, rung, answer = best
        setting = self.settings[index]
        if isinstance(self.ladder, Tolerances):
            return f"{setting['method']}, {answer['evaluations']} evaluations"
        extra = {"iterations": " x {}", "integrator": " {}", "nonlinear": " {}", "radius": " Chebyshev {}", "order": " in order", "tolerance": " {:g}",
                 "implicit": " implicit"}
        return f"{rung}" + "".join(text.format(setting[key]) for key, text in extra.items() if key in setting)


def compile_cvode(work):
    """CVODE on field/system.c, or None where SUNDIALS is not installed."""
    path, folder = work / "bench_cvode", peers.HERE.parent / "field"
    sources = [folder / name for name in ("cvode.c", "cases.c", "system.c", "xpbd.c", "vbd.c", "projective.c", "runge_kutta.c")]
    done = subprocess.run(["gcc", "-std=gnu17", "-D_GNU_SOURCE", "-O3", "-march=native", "-fno-math-errno", "-w", f"-I{folder.parent.parent.parent}",
                           *sources, "-o", path, "-lsundials_cvode", "-lsundials_nvecserial", "-lm"], capture_output=True, text=True)
    if done.returncode:
        print("bench: SUNDIALS is not installed or has changed: its cases are left out", file=sys.stderr)
        return None
    return Program("CVODE", path, work)


class Precision:
    """All programs, made once. The rivals prove themselves first: what fails there is not measured."""

    def __init__(self, build, work):
        self.field = peers.field(build, work)
        self.rivals = Program("field", build / "tests/bench/bench_field", work)
        self.cvode = compile_cvode(work)
        proof = subprocess.run([build / "tests/bench/test_bench_field"], capture_output=True, text=True)
        if proof.returncode:
            raise SystemExit(f"bench precision: a rival does not do what its paper says:\n{proof.stdout}{proof.stderr}")

    def reference(self, case):
        """RK4 at a step and half of it; of ours, which finds contacts once a step only, where there are none."""
        options = {"time": case.time_s, **case.options}
        if case.name == "net":
            options["method"], program = "rk4", self.rivals
        else:
            options |= {**case.own, "integrator": "rk4"}
            program = self.field.ours
        coarse, fine = ({"steps": n * case.reference_steps, **options} for n in (1, 2))
        return Reference(program, case.name, 1, coarse, fine, 1 / 15)

    def program(self, name):
        """Ladder of a rival and its settings beyond the case's own; None: not installed."""
        if name == "CVODE":
            return self.cvode and Tolerances(self.cvode)
        if name == "Bullet":
            return Ladder(self.field.bullet[-1]) if self.field.bullet else None
        if name == "MuJoCo":
            return self.field.mujoco and Patient(self.field.mujoco)
        return Ladder(self.rivals)

    def floor_s(self, case, name, best, setting):
        """The least time for the operations of a run, s; of ours by evaluations and, if implicit, by matrices and solutions."""
        _, _, _, rung, answer = best
        seconds, one = self.field.seconds, case.elements * case.flops["force"]
        if name == "ours":
            if setting["integrator"] == "position_based":
                way = "pd" if case.options.get("law") == "corotational" else "xpbd"
                return rung * (seconds(case.elements * case.flops[way]) + (seconds(12 * case.factor, 16 * case.factor) if way == "pd" else 0))
            if not answer["newton"]:
                return seconds(rung * one * (4 if setting["integrator"] == "rk4" else 1))
            return rung * answer["newton"] * (seconds(3 * one) + seconds(36 * case.factor, 144 * case.factor))
        if name == "CVODE":
            return seconds(answer["evaluations"] * one)
        kind = setting.get("method")
        if kind is None:  # forces alone; what else an implicit step of Bullet does is not known
            stages = 4 if setting.get("integrator") == "RK4" else setting.get("iterations", 1)
            return None if setting.get("implicit") else seconds(rung * stages * one)
        solve = seconds(12 * case.factor, 16 * case.factor) if kind == "pd" else 0
        return rung * setting["iterations"] * (seconds(case.elements * case.flops[kind]) + solve)


def compare(p, case, target, ours, theirs, mine, other, name):
    """A row: both runs timed again in turn, the least of each."""
    seconds = [(mine[0], other[0])] + [(ours.again(mine), theirs.again(other)) for _ in range(REPEATS)]
    our_s, peer_s = (min(s[k] for s in seconds) / case.time_s for k in (0, 1))
    floors = [p.floor_s(case, who, best, runs.settings[best[2]]) for who, best, runs in (("ours", mine, ours), (name, other, theirs))]
    over = f", {peer_s * case.time_s / floors[1]:.1f} of its floor" if floors[1] else ""
    return row("precision", f"{case.label}, to {target:g}: {ours.words(mine)}; its {theirs.words(other)}{over}", 1e3 * our_s, "ms/s",
               floor=1e3 * floors[0] / case.time_s, peer_name=name, peer=1e3 * peer_s, error_ours=mine[1], error_peer=other[1],
               least=5 if target <= 1e-3 else 1)


def absent(name, case, best, ladder):
    if not best:
        return f"{name} gets there, ours does not"
    tried_s = min(ladder.longest_s, case.most_cpu_s * max(1, ladder.patience))
    return f"{name} does not get there in {tried_s / case.time_s:g} s of work a second; ours in {best[0] / case.time_s:.2g}"


def rows_of(p, case):
    reference = p.reference(case)
    if reference.own > TARGETS[-1] / 10:
        print(f"bench: {case.label}: the reference is known to {reference.own:.1g} only", file=sys.stderr)
    ours = Runs(case, Ladder(p.field.ours), reference, case.ours, case.own)
    mine = ours.measure()
    for name, settings in case.rivals.items():
        ladder = p.program(name)
        if not ladder:
            continue
        theirs = Runs(case, ladder, reference, settings)
        for target, best, other in zip(TARGETS, mine, theirs.measure()):
            if best and other:
                yield compare(p, case, target, ours, theirs, best, other, name)
            elif best or other:
                print(f"bench: {case.label}, to {target:g}: {absent(name, case, best, ladder)}", file=sys.stderr)


def in_words(rows):
    """Where a peer wins, and by how much."""
    won = [r for r in rows if r["ratio"] < 1]
    print(f"bench precision: ours is faster in {len(rows) - len(won)} of {len(rows)} rows" + ("; slower in:" if won else ""), file=sys.stderr)
    for r in won:
        print(f"  {r['case']}: {r['peer_name']} is {1 / r['ratio']:.2g} times as fast ({r['peer']:.3g} to {r['ours']:.3g} ms/s)", file=sys.stderr)


NO_KNOT = ("bench precision: a knot pulled tight is not among the cases: not even 10 % of it can be told, as a start moved by 1e-8 drifts apart "
           "(./dev bench accuracy --scenes knot), so that there is no reference for all")


def bench_precision(build, work):
    p = Precision(build, work)
    rows = []
    for case in cases():
        for r in rows_of(p, case):
            rows.append(r)
            yield r
    in_words(rows)
    print(NO_KNOT, file=sys.stderr)


BENCHES = {"precision": bench_precision}

"""The curve of cost against size: time of a step, iterations, memory and time to put together from 100 to 100,000 degrees of
freedom, with the exponents that follow and those of theory. Times are on the processor."""
import json
import math
import subprocess

from running import run, say, write_whole
from scaling_scenes import FAMILIES
from table import row

SIZES = (100, 300, 1000, 3000, 10000, 30000, 100000)
STEPS = 20    # from the start, of every size
LARGE = 700   # degrees of freedom from which exponents are taken
WORSE = 1.15  # an exponent above is more than linear

families = None  # names; None: all
seconds = 4.0    # on the processor for the runs of a size, which end after one of them at least; ten times that is not begun


class Size:
    """What one size of a family took: time of a step, and to put the scene together, s on the processor; memory, bytes."""

    def __init__(self, build, scene):
        done = run([build / "tests/bench/bench_scale", scene, STEPS, seconds])
        if done.returncode:
            raise ValueError(done.stderr.strip() or f"status {done.returncode}")
        report = json.loads(done.stdout)
        self.dof, self.step_s, self.made_s, self.bytes = (report[name] for name in ("dof", "step_s", "made_s", "bytes"))
        self.newton, self.linear, self.contacts, self.unsolved = (report[name] for name in ("newton", "linear", "contacts", "unsolved"))

    def words(self):
        iterations = f"{self.newton:.3g} Newton, {self.linear:.3g} linear, " if self.newton else ""
        contacts = f"{self.contacts:.0f} contacts, " if self.contacts else ""
        unsolved = f", NOT SOLVED: {self.unsolved}" if self.unsolved else ""
        return f"{self.dof} dof: {iterations}{contacts}{1e-6 * self.bytes:.0f} MB, put together in {self.made_s:.2g} s{unsolved}"


def exponent(sizes, value):
    """Slope of log value over log size, by least squares over the large ones; None: fewer than three."""
    points = [(math.log(size.dof), math.log(value(size))) for size in sizes if size.dof >= LARGE and value(size) > 0]
    if len(points) < 3:
        return None
    mean_x, mean_y = (sum(p[k] for p in points) / len(points) for k in (0, 1))
    return sum((x - mean_x) * (y - mean_y) for x, y in points) / sum((x - mean_x) ** 2 for x, _ in points)


MEASURES = {"step": lambda size: size.step_s, "put together": lambda size: size.made_s, "memory": lambda size: size.bytes,
            "linear iterations": lambda size: size.linear}


def sentence_of(name, family, sizes):
    """Exponents of a family beside theory's."""
    found = {what: exponent(sizes, value) for what, value in MEASURES.items()}
    words = ", ".join(f"{what} n^{value:.2f}" for what, value in found.items() if value is not None)
    return f"{name}: {words}; theory, a step: n^{family.exponent:.2f} ({family.why})"


def worse_than_linear(name, sizes):
    """Where the time of a step grows faster than the size, from one size to the next."""
    parts = []
    for a, b in zip(sizes, sizes[1:]):
        slope = math.log(b.step_s / a.step_s) / math.log(b.dof / a.dof)
        if slope > WORSE:
            parts.append(f"{a.dof} to {b.dof} dof n^{slope:.2f}")
    return f"{name} grows worse than linear: {', '.join(parts)}" if parts else f"{name} grows no worse than linear"


def measure(build, work, name, family):
    """Sizes of a family, while they can be had."""
    sizes = []
    for wanted in SIZES:
        last = sizes[-1] if sizes else None
        guess_s = last.step_s * (wanted / last.dof) ** family.exponent if last else 0
        if guess_s * STEPS > 10 * seconds:
            say(f"bench scaling: {name}: {wanted} degrees of freedom and more are left out: a step takes about {guess_s:.2g} s")
            break
        try:
            size = Size(build, family.make(work, wanted))
        except ValueError as refusal:
            say(f"bench scaling: {name}, {wanted}: {refusal}")
            continue
        if not last or size.dof > last.dof:
            sizes.append(size)
            yield size


def plot(build, measured, panels):
    """SVG of a panel a measure: (its label, its name)."""
    lines = ["title\tCost against size"]
    for label, what in panels:
        lines.append(f"panel\tdegrees of freedom\t{label}")
        for name, sizes in measured.items():
            lines.append(f"line\t{name}")
            lines += [f"point\t{size.dof}\t{MEASURES[what](size):.9g}" for size in sizes]
    done = subprocess.run([build / "tests/bench/bench_plot"], input="\n".join(lines) + "\n", capture_output=True, text=True, check=True)
    return done.stdout


def bench_scaling(build, work):
    for name in families or ():
        if name not in FAMILIES:
            raise SystemExit(f"bench: there is no family {name}; expected one of {', '.join(FAMILIES)}")
    folder, measured = build / "bench/scaling", {}
    for name in families or FAMILIES:
        measured[name] = []
        say(f"bench scaling: {name}")
        for size in measure(build, work, name, FAMILIES[name]):
            measured[name].append(size)
            yield row("scaling", f"{name}, {size.words()}", 1e6 * size.step_s, "us")
    folder.mkdir(parents=True, exist_ok=True)
    write_whole(folder / "time.svg", plot(build, measured, [("time of a step on the processor (s)", "step"), ("linear iterations a step", "linear iterations")]))
    write_whole(folder / "room.svg", plot(build, measured, [("time to put together (s)", "put together"), ("memory (bytes)", "memory")]))
    for name, sizes in measured.items():
        say(sentence_of(name, FAMILIES[name], sizes))
        say(worse_than_linear(name, sizes))
    say(f"bench scaling: {folder / 'time.svg'}, {folder / 'room.svg'}")


BENCHES = {"scaling": bench_scaling}

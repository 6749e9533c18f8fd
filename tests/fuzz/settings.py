#!/usr/bin/python3
"""Random settings of the shipped scenes (stability case 46): what ends with status 0 must have been solved as written.

Each run takes a scene, some settings from the schema's ranges, an integrator and a step, all from a seed, which is
printed with every fault. Checked: no signal and no fault of ours; status 0 means that nothing is unsolved, that the
residual is within the tolerance and that no energy came from nothing; status 1 names body, cause and remedy; status 2
says what is wrong in a line; the result does not depend on the number of threads; memory and work a step are bounded.

  settings.py SPORE SCENES [--runs N] [--seed S] [--seconds S]   the long run: --runs 10000, sanitized, a few hours
"""
import argparse
import json
import pathlib
import random
import re
import resource
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ET

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
import tap  # noqa: E402

RNG = "{http://relaxng.org/ns/structure/1.0}"
INTEGRATORS = ("explicit_euler", "symplectic_euler", "verlet", "rk4", "position_based", "implicit_euler", "implicit_midpoint", "bdf2",
               "tr_bdf2", "static")
SECTIONS = ("environment", "solver", "bodies", "links", "tools")
COUNT_MOST = 24        # of what is generated: control points, substeps; larger ones only take longer
ITERATIONS_MOST = 60   # of Newton's method, as far as settings may raise it
MEMORY_BYTES = 6 << 30
STEPS = 25
NUMBERS = pathlib.Path(tempfile.mkdtemp(prefix="spore-settings-")) / "energy.json"  # of the last run, at every step
SMALLEST_STEP_S = 2e-6  # of the schema, and a little more: a step that is refused is taken within its limit


def attributes(schema):
    """(element, attribute) -> (lowest, highest, whole) of numbers, or a list of choices."""
    found = {}
    for element in schema.iter(RNG + "element"):
        for attribute in element.iter(RNG + "attribute"):
            data, values = attribute.find(RNG + "data"), attribute.find(RNG + "choice")
            key = element.get("name"), attribute.get("name")
            if values is not None:
                found.setdefault(key, [v.text for v in values.findall(RNG + "value")])
            elif data is not None and data.get("type") != "string":
                ends = {p.get("name"): float(p.text) for p in data.findall(RNG + "param") if p.get("name") != "pattern"}
                lowest, highest = ends.get("minInclusive", ends.get("minExclusive")), ends.get("maxInclusive")
                found.setdefault(key, (lowest, highest, data.get("type") != "double"))
    return found


def places(scene, known):
    """Paths of all settings that the scene's elements may have, with what is known of each."""
    found = []

    def visit(element, path):
        found.extend((f"{path}/{name}", known[tag, name], element.get(name))
                     for tag, name in known if tag == element.tag)
        for child in element:
            visit(child, f"{path}/{child.get('name') or child.tag}")

    for section in scene:
        if section.tag in SECTIONS:
            visit(section, section.tag)
    return found


def value(known, now, random_):
    """A value within the range: near the present one or far from it."""
    if isinstance(known, list):
        return random_.choice(known)
    lowest, highest, whole = known
    lowest, highest = -1e9 if lowest is None else lowest, 1e9 if highest is None else highest
    if whole:
        return str(random_.randint(int(lowest), int(min(highest, max(COUNT_MOST, lowest)))))
    try:
        start = float(now) or 1.0
    except (TypeError, ValueError):
        start = 10 ** random_.uniform(-4, 4)
    number = random_.choice((start * 10 ** random_.uniform(-6, 6), start * 10 ** random_.uniform(-1, 1), lowest, highest,
                             lowest + (highest - lowest) * random_.random()))
    return repr(min(max(number, lowest), highest))


def settings(scene, known, random_):
    """Arguments of one run."""
    chosen = random_.sample(places(scene, known), k=random_.choice((0, 1, 1, 2, 3, 6)))
    arguments = []
    for path, kind, now in chosen:
        text = value(kind, now, random_)
        if path.endswith("newton_iterations"):
            text = str(random_.randint(1, ITERATIONS_MOST))
        arguments += ["--set", f"{path}={text}"]
    if random_.random() < 0.5:
        arguments += ["--integrator", random_.choice(INTEGRATORS)]
    if random_.random() < 0.5:
        arguments += ["--dt", repr(10 ** random_.uniform(-5, -1))]
    return arguments


def run(spore, scene, arguments, seconds, threads=1):
    def limit():
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY_BYTES, MEMORY_BYTES))

    NUMBERS.unlink(missing_ok=True)
    command = [spore, "run", str(scene), "--json", "--steps", str(STEPS), "--threads", str(threads), "--output", str(NUMBERS),
               "--quantities", "energy", *arguments]
    return subprocess.run(command, capture_output=True, text=True, errors="replace", timeout=seconds, check=False,
                          preexec_fn=None if tap.is_sanitized(spore) else limit)


def run_within(spore, scene, arguments, seconds):
    """Runs; where the step is refused with its limit, once more within that. Returns the arguments that were used, too."""
    done = run(spore, scene, arguments, seconds)
    limit = re.search(r"at most ([0-9.e+-]+) s", done.stderr) if done.returncode == 2 else None
    if limit and float(limit.group(1)) >= SMALLEST_STEP_S:
        arguments = arguments + ["--dt", repr(0.9 * float(limit.group(1)))]
        done = run(spore, scene, arguments, seconds)
    return done, arguments


def not_finite(answer, path=""):
    """Places of numbers that are not finite: they come as null."""
    if isinstance(answer, dict):
        return [p for k, v in answer.items() for p in not_finite(v, f"{path}/{k}")]
    if isinstance(answer, list):
        return [p for v in answer for p in not_finite(v, path + "[]")]
    return [path] if answer is None and not path.endswith(("/worst", "/local_error/body")) else []


def faults(done, scene):
    """What is wrong with a run."""
    if done.returncode not in (0, 1, 2):
        return [f"status {done.returncode}: {done.stderr.strip()[-300:]}"]
    if done.returncode == 2:
        text = done.stderr.strip()
        return [] if 10 < len(text) < 2000 else [f"status 2 says {text[:300]!r}"]
    if not done.stdout:
        return [f"status {done.returncode} without a report: {done.stderr.strip()[:300]}"]
    answer = json.loads(done.stdout)
    unsolved = answer["monitor"]["unsolved"]
    if done.returncode == 1:
        named = unsolved and all(e["body"] and e["cause"] and e["remedy"] and e["steps"] > 0 for e in unsolved)
        return [] if named else ["status 1 without a named cause"]
    found = [f"not finite: {place}" for place in not_finite(answer)]
    found += ["status 0 with unsolved steps"] if unsolved else []
    found += gains(answer, scene)
    return found


def gains(answer, scene):
    """Energy from nothing, where nothing but physics moves bodies: all that there is comes from the start.
    The program itself judges more strictly, but from the 64th step on."""
    if any(body.get("role") == "active" for body in scene.iter("body")) or scene.find("effects") is not None:
        return []
    energy = answer["energy"]
    table = json.loads(NUMBERS.read_text())
    total = [column["name"] for column in table["columns"]].index("energy.total")
    if any(row[total] is None for row in table["rows"]):
        return ["the energy of a step is not finite"]
    drift = max(abs(row[total] - energy["start"]) for row in table["rows"])
    # A hundredth; and explicit Euler makes h/t of what falls in t, which is more in the first hundred steps.
    allowed = max(0.01, 1 / STEPS) * max(drift, abs(energy["start"])) + 1e-9
    gained = energy["end"] - energy["start"]
    return [f"energy {energy['start']} to {energy['end']} J"] if gained > allowed else []


def try_settings(options, file, known, seeds, statuses):
    """Runs a scene once a seed; fails with all that was wrong."""
    scene = ET.parse(file).getroot()
    wrong = []
    for seed in seeds:
        random_ = random.Random(seed)
        arguments = settings(scene, known, random_)
        try:
            done, arguments = run_within(options.spore, file, arguments, options.seconds)
            found = faults(done, scene)
            if not found and done.returncode < 2 and random_.random() < 0.1:
                again = json.loads(run(options.spore, file, arguments, options.seconds, threads=2).stdout)
                if again["state_hash"] != json.loads(done.stdout)["state_hash"]:
                    found = ["another result with 2 threads"]
            statuses[done.returncode] = statuses.get(done.returncode, 0) + 1
        except subprocess.TimeoutExpired:
            found = [f"no end after {options.seconds:g} s"]
        wrong += [f"seed {seed}: {fault}: {' '.join(arguments)}" for fault in found]
    if wrong:
        raise AssertionError("\n" + "\n".join(wrong))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("spore")
    parser.add_argument("scenes", type=pathlib.Path)
    parser.add_argument("--runs", type=int, help="200; 46 of a sanitized program")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--seconds", type=float, default=600, help="after which a run counts as hanging")
    options = parser.parse_args()
    options.runs = options.runs or (46 if tap.is_sanitized(options.spore) else 200)
    schema = subprocess.run([options.spore, "schema"], capture_output=True, text=True, check=True).stdout
    known = attributes(ET.fromstring(schema))
    files = sorted(options.scenes.glob("*.spore"))
    statuses = {}
    for i, file in enumerate(files):
        seeds = range(options.seed + i, options.seed + options.runs, len(files))

        def one(file=file, seeds=seeds):
            try_settings(options, file, known, seeds, statuses)
        one.__doc__ = f"{file.stem}, {len(seeds)} runs"
        tap.check(one)
    try:
        tap.main()
    finally:
        print("# " + ", ".join(f"status {s}: {n}" for s, n in sorted(statuses.items())))


main()

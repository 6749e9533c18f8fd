"""The product's own report: error against run time of every shipped scene (`spore accuracy`) and what each bears (`spore
stability --quick`), as one page with the plots in it, and which of our methods lose where."""
import base64
import html
import json
import math

from kernel import SCENES
from running import load, run, say, write_whole
from table import row

TARGETS = (1e-1, 1e-2, 1e-3)  # of a body's length
EVEN = 1.1                    # times the cheapest cost: no difference that a repeat would show again
WORST = 3                     # losses that are named
scenes = None                 # names; None: all
seconds = None                # on the processor for the accuracy of a scene; None: what the command takes


def wanted_scenes():
    known = {scene.stem: scene for scene in sorted(SCENES.glob("*.spore"))}
    for name in scenes or ():
        if name not in known:
            raise SystemExit(f"bench: there is no scene {name}; expected one of {', '.join(known)}")
    return [known[name] for name in scenes] if scenes else list(known.values())


class Study:
    """What was found of a scene. A part that the program refused is None, and `refusals` says why."""

    def __init__(self, scene):
        self.name, self.path, self.refusals = scene.stem, scene, []
        self.accuracy = self.stability = self.svg = None

    def take(self, done, what, statuses):
        if done.returncode in statuses:
            return json.loads(done.stdout)
        self.refusals.append(f"{what}: {done.stderr.strip() or f'status {done.returncode}'}")
        return None

    def measure(self, build, folder):
        spore, svg, png, csv = build / "app/spore", *(folder / f"{self.name}.{end}" for end in ("svg", "png", "csv"))
        limit = ("--seconds", seconds) if seconds else ()
        command = [spore, "accuracy", self.path, "--json", *limit, "--svg", svg, "--csv", csv]
        done = run([*command, "--png", png])
        if done.stderr.startswith("--png"):  # this machine draws none
            done = run(command)
        self.accuracy = self.take(done, "accuracy", (0,))
        self.svg = svg.read_text() if self.accuracy else None
        self.stability = self.take(run([spore, "stability", self.path, "--quick", "--json"]), "stability", (0, 1))

    def reached(self, target):
        """The cheapest sound point of each method that is surely near enough: {method: point}. None: nothing so small can
        be told."""
        if not self.accuracy or self.accuracy["resolution"]["floor"] > target:
            return None
        found = {}
        for point in self.accuracy["points"]:
            near = point["sound"] and point["error"] is not None and point["error"] <= target
            if near and point["cpu_s"] < found.get(point["method"], {"cpu_s": math.inf})["cpu_s"]:
                found[point["method"]] = point
        return found

    def narrowest(self):
        """The body whose own method's largest safe step is the smallest multiple of its step."""
        limits = [limit for limit in (self.stability or {"dt_limit_s": []})["dt_limit_s"] if limit["own"] and limit["safe_s"] is not None]
        return min(limits, key=lambda limit: limit["safe_s"] / limit["step_s"], default=None)

    def verdicts(self):
        cases = self.stability["cases"] if self.stability else []
        return {verdict: [case["name"] for case in cases if case["verdict"] == verdict] for verdict in ("stable", "recovered", "failed")}


def name_of(point):
    return f"{point['method']} at {1e3 * point['dt_s']:.3g} ms"


def own_method(study):
    """The method that the scene names, by the sentence's first words; the report's sentence is about it."""
    return study.accuracy["sentence"].partition(" ")[0]


def accuracy_rows(study):
    """The cheapest of ours against what the scene uses."""
    for target in TARGETS:
        found = study.reached(target)
        if not found:
            continue
        best = min(found.values(), key=lambda point: point["cpu_s"])
        own = found.get(own_method(study))
        yield row("accuracy", f"{study.name}, to {target:g}: {name_of(best)}", 1e3 * best["cpu_s"], "ms/s",
                  peer_name=f"its {own_method(study)}", peer=own and 1e3 * own["cpu_s"], error_ours=best["error"],
                  error_peer=own and own["error"])


def stability_row(study):
    verdicts, limit = study.verdicts(), study.narrowest()
    words = ", ".join(f"{len(names)} {verdict}" for verdict, names in verdicts.items())
    if limit:
        words += f"; {limit['body']} by {limit['method']} bears {limit['safe_s'] / limit['step_s']:.3g} of its steps"
    return row("stability", f"{study.name}: {words}", len(verdicts["failed"]), "", floor=0)


# Who loses where.

def unreached(studies, target):
    """Scenes where so small an error can be told, and no method gets there."""
    return [study.name for study in studies if study.reached(target) == {}]


def standing(studies, target):
    """{method: [(factor over the cheapest, scene, the cheapest's name)]}; infinite: it does not get there."""
    found = {}
    for study in studies:
        reached = study.reached(target)
        if not reached:
            continue
        best = min(reached.values(), key=lambda point: point["cpu_s"])
        for method in {point["method"] for point in study.accuracy["points"]}:
            cost = reached[method]["cpu_s"] if method in reached else math.inf
            found.setdefault(method, []).append((cost / best["cpu_s"], study.name, best["method"]))
    return found


def sentence_of(method, places):
    won = [scene for factor, scene, _ in places if factor <= EVEN]
    lost = sorted((place for place in places if EVEN < place[0] < math.inf), reverse=True)
    never = [scene for factor, scene, _ in places if factor == math.inf]
    words = [f"{method} is the cheapest, or within {100 * (EVEN - 1):.0f} % of it, in {len(won)} of {len(places)}" + (f" ({', '.join(won)})" if won else "")]
    if lost:
        more = f" and in {len(lost) - WORST} more" if len(lost) > WORST else ""
        words.append("loses to " + ", ".join(f"{winner} {factor:.2g}x in {scene}" for factor, scene, winner in lost[:WORST]) + more)
    if never:
        words.append(f"does not get there in {', '.join(never)}")
    return "; ".join(words)


def losses(studies):
    """Sentences, a list for each target."""
    said = {}
    for target in TARGETS:
        places = standing(studies, target)
        order = sorted(places, key=lambda m: -sum(factor <= EVEN for factor, _, _ in places[m]))
        said[target] = [sentence_of(method, places[method]) for method in order]
        missed = unreached(studies, target)
        said[target] += [f"no method gets there in {', '.join(missed)}"] if missed else []
    return said


# The page.

STYLE = """body { font-family: sans-serif; margin: 2em; max-width: 80em; }
img { max-width: 100%; } table { border-collapse: collapse; }
td, th { padding: .2em .8em; text-align: right; border-bottom: 1px solid #ccc; }
td:first-child, th:first-child { text-align: left; } .bad { font-weight: bold; }"""


def table_of(heads, rows):
    cells = "".join(f"<tr>{''.join(f'<td>{html.escape(str(cell))}</td>' for cell in r)}</tr>\n" for r in rows)
    return f"<table>\n<tr>{''.join(f'<th>{html.escape(h)}</th>' for h in heads)}</tr>\n{cells}</table>\n"


def factors(studies, target):
    """A row a scene: the cheapest, and how many times as much each other method takes."""
    methods = sorted({point["method"] for study in studies if study.accuracy for point in study.accuracy["points"]})
    rows = []
    for study in studies:
        found = study.reached(target)
        if found is None:
            rows.append([study.name, "cannot be told", *[""] * len(methods)])
            continue
        least = min((point["cpu_s"] for point in found.values()), default=None)
        tried = {point["method"] for point in study.accuracy["points"]}
        cells = [f"{found[m]['cpu_s'] / least:.3g}" if m in found else "-" if m in tried else "" for m in methods]
        rows.append([study.name, f"{1e3 * least:.3g}" if least else "-", *cells])
    return table_of(["scene", "cheapest, ms for a second", *methods], rows)


def stability_table(studies):
    rows = []
    for study in studies:
        verdicts, limit = study.verdicts(), study.narrowest()
        narrow = [""] * 5
        if limit:
            predicted = limit["predicted_s"]
            narrow = [limit["body"], limit["method"], f"{1e3 * limit['step_s']:.3g}", f"{1e3 * predicted:.3g}" if predicted else "any",
                      f"{1e3 * limit['safe_s']:.3g}"]
        rows.append([study.name, *(len(names) for names in verdicts.values()), ", ".join(verdicts["failed"]), *narrow])
    return table_of(["scene", "stable", "recovered", "failed", "which", "narrowest", "method", "step ms", "by theory", "bears ms"], rows)


def section_of(study):
    parts = [f"<h2 id=\"{study.name}\">{study.name}</h2>\n"]
    if study.accuracy:
        data = base64.b64encode(study.svg.encode()).decode()
        parts.append(f"<p>{html.escape(study.accuracy['sentence'])}</p>\n<img alt=\"error against step and cost\" src=\"data:image/svg+xml;base64,{data}\">\n")
        parts += [f"<p>cut: {html.escape(cut)}</p>\n" for cut in study.accuracy["cut"]]
    return "".join(parts + [f"<p class=\"bad\">{html.escape(refusal)}</p>\n" for refusal in study.refusals])


def page_of(studies, left):
    busy = max(study.load for study in studies)
    said = "".join(f"<h3>To {100 * target:g} % of a body's length</h3>\n{factors(studies, target)}<ul>{''.join(f'<li>{html.escape(s)}</li>' for s in sentences)}</ul>\n"
                   for target, sentences in losses(studies).items())
    missing = f"<p class=\"bad\">Not yet measured: {', '.join(left)}.</p>\n" if left else ""
    return (f"<!DOCTYPE html>\n<html>\n<head>\n<meta charset=\"utf-8\">\n<title>Error against run time</title>\n<style>{STYLE}</style>\n</head>\n<body>\n"
            f"<h1>Error against run time of the shipped scenes</h1>\n<p>Made by ./dev bench accuracy; costs are time on the processor. Load of the machine: {busy:.1f} at most.</p>\n{missing}"
            f"<h2>Which method loses where</h2>\n<p>Factors over the cheapest method; - does not get there.</p>\n{said}"
            f"<h2>What each scene bears</h2>\n{stability_table(studies)}{''.join(section_of(study) for study in studies)}</body>\n</html>\n")


def bench_accuracy(build, work):
    """The page grows with every scene, so that what was done is kept when the run is interrupted."""
    folder, paths, studies = build / "bench/accuracy", wanted_scenes(), []
    folder.mkdir(parents=True, exist_ok=True)
    for number, path in enumerate(paths, 1):
        say(f"bench accuracy: {path.stem}, {number} of {len(paths)}")
        study = Study(path)
        study.measure(build, folder)
        study.load = load()
        studies.append(study)
        write_whole(folder / "index.html", page_of(studies, [left.stem for left in paths[number:]]))
        yield from accuracy_rows(study) if study.accuracy else ()
        if study.stability:
            yield stability_row(study)
        for refusal in study.refusals:
            say(f"bench accuracy: {study.name}: {refusal}")
    for target, sentences in losses(studies).items():
        for sentence in sentences:
            say(f"to {target:g}: {sentence}")
    say(f"bench accuracy: {folder / 'index.html'}")


BENCHES = {"accuracy": bench_accuracy}

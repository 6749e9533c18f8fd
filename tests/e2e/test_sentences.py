#!/usr/bin/python3
"""Every sentence of check, plan and the register of unsolved steps is printed where it is true and not where it is
false. test_sentences.py SPORE. The table is in sentences.py; the sentences are found in the sources."""
import os
import pathlib
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
import sentences
from tap import check, main

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
SPORE = os.path.abspath(sys.argv[1])
WORK = pathlib.Path(tempfile.mkdtemp(prefix="spore-sentences-"))
CONVERSION = re.compile(r"%%|%[-+0 #]*\d*(?:\.\d+)?(?:ll|l|z|h)?([a-zA-Z])")
MARKED = re.compile(r'\b(N?_)\(\s*((?:"(?:[^"\\]|\\.)*"\s*)+)\)')
said = {}  # of each command, what it printed
known = {}  # what stands for what in the scenes


def strings(path, mark=None):
    """The texts of a C source that are marked for translation; mark: only those marked like that."""
    found = MARKED.findall((ROOT / path).read_text())
    texts = ["".join(re.findall(r'"((?:[^"\\]|\\.)*)"', parts)) for kind, parts in found if mark in (None, kind)]
    return [text.replace('\\"', '"').replace("\\n", "\n") for text in texts]


def doubts(path):
    """What a model says that it computes badly: the texts of its function of that name."""
    body = re.search(r"^(?:static )?const char \*\w*doubt\(.*?^}", (ROOT / path).read_text(), re.M | re.S)
    return [] if not body else ["".join(re.findall(r'"((?:[^"\\]|\\.)*)"', parts)).replace('\\"', '"')
                                for _, parts in MARKED.findall(body.group())]


def sources():
    """Every sentence that may be printed, with the file that holds it."""
    found = [(path, text) for pattern in ("core/scene/check*.c", "core/scene/work_estimate.c", "core/scene/length_unit.c",
                                          "core/sim/step.c", "core/sim/state/unsolved.c")
             for path in sorted(ROOT.glob(pattern)) for text in strings(path)]
    found += [(path, text) for path in sorted(ROOT.glob("models/*/*.c")) for text in doubts(path)]
    # In the commands N_ marks help; what is printed is marked by _, but for the names of who chose a method.
    found += [(path, text) for path in sorted(ROOT.glob("app/cli/plan*.c")) for text in strings(path, "_")]
    return found + [(path, text.rstrip("\n")) for path in [ROOT / "app/cli/run_loops.c"] for text in strings(path, "_")]


def pattern(text):
    """A regular expression for what the format prints."""
    parts, at = [], 0
    for match in CONVERSION.finditer(text):
        parts += [re.escape(text[at:match.start()]),
                  "%" if match.group() == "%%" else ".+" if match.group(1) == "s" else r"[-+0-9.einf]+"]
        at = match.end()
    return "".join(parts) + re.escape(text[at:])


def printed(command, case):
    """What the command prints for the scene."""
    text, options = case if isinstance(case, tuple) else (case, [])
    key = (command, text, *options)
    if key not in said:
        shipped = ROOT / "resources" / "scenes" / f"{text}.spore"
        path = shipped if "<" not in text else WORK / "scene.spore"
        if path != shipped:
            path.write_text(text.replace("{cube}", known["{cube}"]))
        done = subprocess.run([SPORE, *command.split(), str(path), *options], capture_output=True, text=True, timeout=120, cwd=WORK)
        assert done.returncode in (0, 1), f"{command} {options}: status {done.returncode}\n{done.stderr}\n{text}"
        said[key] = done.stdout
    return said[key]


def lines_with(message, output):
    """Lines that hold the sentence, which a longer one does not continue."""
    end = r"(?!\w| \w)" if message[-1].isalnum() else ""
    return [line for line in (output + "\n").splitlines(True) if re.search(pattern(message) + end, line)]


def wrong_rows(command, rows):
    """Rows whose sentence is not printed where it should be, or is where it must not be. A line has one sentence, with
    all the parts of its row."""
    wrong = []
    for message, parts, where, elsewhere in rows:
        lines = lines_with(message, printed(command, where))
        if not any(all(lines_with(part, line) for part in parts) for line in lines):
            wrong.append(f"not printed: {message!r} {parts} by {where}\n{printed(command, where)}")
        if elsewhere and lines_with(message, printed(command, elsewhere)):
            wrong.append(f"printed: {message!r} by {elsewhere}\n{printed(command, elsewhere)}")
    return wrong


def hash_of(mesh):
    """What a generated asset keeps of its source: read off an asset that the program makes."""
    scene = WORK / "made.spore"
    scene.write_text(sentences.scene(sentences.stone(sentences.STONE, '<visual mesh="cube"/>'), assets=f'<mesh name="cube" file="{mesh}"/>'))
    subprocess.run([SPORE, "spheres", str(scene), "--body", "stone", "--count", "2"], check=True, capture_output=True, cwd=WORK)
    return re.search(r'source_hash="(\w+)"', scene.read_text()).group(1)


def prepare():
    for name, content in sentences.FILES.items():
        (WORK / name).write_text(content)
    known["{cube}"] = hash_of("cube.off")


@check
def every_sentence_has_a_row():
    """The table holds every sentence that the sources do."""
    held = {text for rows in (sentences.CHECK, sentences.PLAN, sentences.MEASURED, sentences.RUN) for message, remedies, *_ in rows
            for text in (message, *remedies)} | sentences.TITLES | set(sentences.HELD_ELSEWHERE)
    missing = [f"{path.relative_to(ROOT)}: {text!r}" for path, text in sources() if text not in held]
    assert not missing, "not in sentences.py:\n" + "\n".join(missing)
    for text, program in sentences.HELD_ELSEWHERE.items():
        assert (ROOT / program).exists(), (text, program)


@check
def check_says_what_is_true():
    """Each sentence of check."""
    wrong = wrong_rows("check", sentences.CHECK)
    assert not wrong, "\n".join(wrong)


@check
def plan_says_what_is_true():
    """Each sentence of plan, also of what it measures."""
    wrong = wrong_rows("plan", sentences.PLAN) + wrong_rows("plan --measure", sentences.MEASURED)
    assert not wrong, "\n".join(wrong)


@check
def the_register_says_what_is_true():
    """Each cause of an unsolved step, and what a run says of loops."""
    wrong = wrong_rows("run", sentences.RUN)
    assert not wrong, "\n".join(wrong)


prepare()
main()

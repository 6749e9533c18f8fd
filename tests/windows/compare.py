#!/usr/bin/python3
"""compare.py BUILD WINDOWS_BUILD [--steps N] [SCENE...]: runs scenes by the player of each build, that for Windows under wine, and
compares the hashes of their states. Where they differ: the first step after which they do. The exit status is 1 then. Scenes: those that
ship, by their names."""
import json
import os
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
SCENES = ROOT / "resources" / "scenes"
STEPS = 400


class Player:
    def __init__(self, *command):
        self.command = [str(word) for word in command]
        self.known = {}

    def state(self, file, steps):
        if (file, steps) not in self.known:
            done = subprocess.run([*self.command, str(file), "--steps", str(steps), "--json"], capture_output=True, text=True, check=False,
                                  env={**os.environ, "WINEDEBUG": "-all"})
            if done.returncode not in (0, 1):
                sys.exit(f"{self.command[-1]} {file}: status {done.returncode}: {done.stderr}")
            self.known[file, steps] = json.loads(done.stdout)["state_hash"]
        return self.known[file, steps]


def first_difference(here, there, file, steps):
    """The first step after which the states differ, where they differ after `steps`: what differs stays so."""
    same, other = -1, steps
    while other - same > 1:
        middle = (same + other) // 2
        if here.state(file, middle) == there.state(file, middle):
            same = middle
        else:
            other = middle
    return other


def compare(here, there, spore, name, steps, folder):
    file = folder / f"{name}.run"
    subprocess.run([spore, "export", SCENES / f"{name}.spore", "--format", "runtime", "-o", file], check=True, stdout=subprocess.DEVNULL)
    equal = here.state(file, steps) == there.state(file, steps)
    said = "the same" if equal else f"differ, first after step {first_difference(here, there, file, steps)}"
    print(f"{name:32} {here.state(file, steps)} {there.state(file, steps)} {said}", flush=True)
    return equal


def main(words):
    steps = STEPS
    if "--steps" in words:
        at = words.index("--steps")
        steps, words = int(words[at + 1]), words[:at] + words[at + 2:]
    build, windows, *names = words
    names = names or sorted(path.stem for path in SCENES.glob("*.spore"))
    here = Player(pathlib.Path(build) / "app" / "spore-player")
    there = Player("wine", pathlib.Path(windows) / "app" / "spore-player.exe")
    with tempfile.TemporaryDirectory(prefix="spore-windows-") as folder:
        same = [compare(here, there, pathlib.Path(build) / "app" / "spore", name, steps, pathlib.Path(folder)) for name in names]
    print(f"{sum(same)} of {len(same)} scenes come to the same bits after {steps} steps")
    return 0 if all(same) else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

"""The editor: its start and its frames."""
import pathlib
import re
import subprocess
import sys

from table import row

HERE = pathlib.Path(__file__).resolve().parent


def bench_render(build, work):
    """A frame of organs and of scenes at 1280x720, read back; then what it takes of the processors, of which there may be
    several."""
    program = build / "tests/bench/bench_render"
    scenes = [HERE.parents[1] / "resources/scenes" / name for name in ("laparoscopy.spore", "table1-fluid.spore")]
    if program.exists():
        done = subprocess.run([program, *scenes], capture_output=True, text=True, check=True)
        for case, milliseconds in re.findall(r"^(.+): ([0-9.]+) ms$", done.stdout, re.M):
            yield row("render", case, float(milliseconds), "ms", 1000 / 30)


def bench_start(build, work):
    """The editor from its start to its first drawn frame."""
    program = build / "app/spore-editor"
    if program.exists():
        done = subprocess.run([sys.executable, HERE / "editor_start.py", program], capture_output=True, text=True, check=True)
        yield row("start", "editor to first frame, llvmpipe", float(done.stdout), "s", 1)


BENCHES = {"render": bench_render, "start": bench_start}

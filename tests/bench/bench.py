#!/usr/bin/python3
"""bench.py --build DIR [NAME...] [--json F]: measures, prints a table of ours, peer and floor, and their ratio. Nothing here
asserts a time: what is behind its promise is marked, and the exit status stays 0."""
import argparse
import json
import pathlib
import signal
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "e2e"))
import accuracy
import authoring
import collide
import commands
import editor
import fluid
import fold
import kernel
import sofa
import kernels
import peers
import precision
import running
import scaling
import solids
import solvers
import surface
import table
import table1

BENCHES = {**kernel.BENCHES, **sofa.BENCHES, **kernels.BENCHES, **collide.BENCHES, **surface.BENCHES, **fold.BENCHES, **solvers.BENCHES, **solids.BENCHES, **peers.BENCHES, **precision.BENCHES, **fluid.BENCHES, **table1.BENCHES, **commands.BENCHES, **authoring.BENCHES, **editor.BENCHES, **accuracy.BENCHES, **scaling.BENCHES}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*", choices=[[], *BENCHES])
    parser.add_argument("--build", required=True, type=lambda p: pathlib.Path(p).resolve())
    parser.add_argument("--json")
    parser.add_argument("--organs", metavar="FOLDER", help="meshes in millimetres for the bench `authoring`; without it, shapes of its own")
    parser.add_argument("--scenes", type=lambda names: names.split(","), metavar="A,B", help="of the bench `accuracy`: these alone")
    parser.add_argument("--families", type=lambda names: names.split(","), metavar="A,B", help="of the bench `scaling`: these alone")
    parser.add_argument("--seconds", type=float, metavar="S", help="of the benches `accuracy` and `scaling`: on the processor, for a scene or a size")
    options = parser.parse_args()
    authoring.organs = options.organs
    accuracy.scenes, accuracy.seconds = options.scenes, options.seconds
    scaling.families, scaling.seconds = options.families, options.seconds or scaling.seconds
    rows = []
    table.show_head()
    with tempfile.TemporaryDirectory(prefix="spore-bench-") as folder:
        for name in options.names or BENCHES:
            for r in BENCHES[name](options.build, pathlib.Path(folder)):
                table.show(r)
                rows.append(r)
    if options.json:
        running.write_whole(options.json, json.dumps(rows, indent=1) + "\n")


def interrupt(*_):
    raise KeyboardInterrupt


if __name__ == "__main__":
    signal.signal(signal.SIGTERM, interrupt)
    try:
        main()
    except KeyboardInterrupt:
        running.say("bench: interrupted")
        sys.exit(130)

#!/usr/bin/python3
"""test_cases.py BENCH_PEERS: a few steps of every case, so that the benchmark's own program cannot rot."""
import array
import json
import math
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent.parent))
from tap import check, main


def run(program, case, nodes, *options):
    """The answer and the frames of a case, each frame a list of heights."""
    with tempfile.NamedTemporaryFile() as file:
        done = subprocess.run([program, case, "frames=2", f"trajectory={file.name}", *options], capture_output=True, text=True, check=True)
        positions = array.array("d", pathlib.Path(file.name).read_bytes())
    assert len(positions) == 2 * 3 * nodes, len(positions)
    assert all(math.isfinite(x) for x in positions)
    heights = positions[1::3]
    return json.loads(done.stdout), (heights[:nodes], heights[nodes:])


def falls(program, case, nodes, *options):
    answer, frames = run(program, case, nodes, *options)
    assert answer["steps"] == 4 and answer["mended"] == 0, answer
    assert sum(frames[1]) < sum(frames[0]), "nothing fell"


@check
def cloth(program):
    """the cloth falls, by every kind of step"""
    for integrator in ("symplectic_euler", "implicit_euler"):
        falls(program, "cloth", 400, "steps=4", "time=0.004", f"integrator={integrator}")


@check
def net(program):
    """the net falls towards its balls"""
    falls(program, "net", 400, "steps=4", "time=0.004")


@check
def rope(program):
    """the rope falls"""
    falls(program, "rope", 64, "steps=4", "time=0.001")


@check
def bar(program):
    """the bar sags"""
    falls(program, "bar", 525, "steps=4", "time=0.04")


@check
def pile(program):
    """the pile falls"""
    falls(program, "pile", 500, "steps=4", "time=0.008", "settle=1")


@check
def fluid(program):
    """the liquid flows, and keeps its energy"""
    answer, _ = run(program, "fluid", 256, "cells=4", "steps=20", "time=0.1")
    assert answer["mended"] == 0 and answer["astray"] / 256 < 0.01, answer


main(sys.argv[1])

"""Models of solids on one bar: the error of its sag beside the cost of a step; peers are our linear tetrahedra of as many cells."""
import json
import subprocess

from table import row


def bench_solids(build, work):
    """Tetrahedra and finite differences on one bar: the error beside the cost."""
    done = subprocess.run([build / "tests/bench/bench_solids"], capture_output=True, text=True, check=True)
    reports = [json.loads(line) for line in done.stdout.splitlines()]
    linear = {r["along"]: r for r in reports if r["model"] == "linear tetrahedra"}
    for r in reports:
        peer = linear[r["along"]] if r["model"] != "linear tetrahedra" else None
        for way in ("explicit", "implicit"):
            case = f"{r['model']} {r['along']} x {r['across']}^2, {r['nodes']} nodes, {way} step"
            yield row("solids", case, r[f"{way}_us"], "us", peer_name="linear tetrahedra" if peer else None,
                      peer=peer[f"{way}_us"] if peer else None, error_ours=r["error"], error_peer=peer["error"] if peer else None)


BENCHES = {"solids": bench_solids}

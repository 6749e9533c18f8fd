"""The sparse factor against CHOLMOD's on the same matrices, and an implicit step solved to a residual of 1e-6."""
import json
import subprocess

from table import row

FLOORS_US = {"net 20x20": 50, "net 40x40": 250, "525 nodes, 1920 tetrahedra": 245, "3321 nodes, 15360 tetrahedra": 4000, "rod of 101": 20}


def rows_of(report):
    case = report["case"]
    if report["bench"] == "factor":
        for part in ("factor", "solve"):
            peer = report.get(f"cholmod_{part}_us")
            yield row("solvers", f"{case}: {part}, {report['layout']}", report[f"{part}_us"], "us", peer_name="CHOLMOD" if peer else None, peer=peer)
        return
    name = f"{case}: step, {report['newton']:.3g} iterations, residual {report['residual']:.0e}"
    if report["not_converged"]:
        name += f", {report['not_converged']} NOT SOLVED"
    yield row("solvers", name, report["step_us"]["median"], "us", floor=FLOORS_US.get(case))


def bench_solvers(build, work):
    """Factor, solution and implicit steps."""
    with subprocess.Popen([build / "tests/bench/bench_solvers"], stdout=subprocess.PIPE, text=True) as program:
        for line in program.stdout:
            yield from rows_of(json.loads(line))
    if program.returncode:
        raise SystemExit(f"bench_solvers ended with status {program.returncode}")


BENCHES = {"solvers": bench_solvers}

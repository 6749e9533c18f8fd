"""SOFA's cases: its figures are quoted (version 26.12, release, one thread, double, machine of the same kind), ours are
measured, each solved to a relative residual of 1e-6. Its own default stops after 25 iterations of conjugate gradients: the
error of that, from our run of it, stands beside ours, and in a second row ours stopped as soon as its error is no larger."""
import json
import subprocess

from table import row


def case_name(report):
    solved = f"{report['newton']:.3g} Newton, {report['linear']:.4g} CG, residual {report['residual']:.0e}" if report["newton"] else f"{report['evaluations']:.0f} explicit steps"
    if report["unsolved"]:
        solved += f", {report['unsolved']:g} NOT SOLVED"
    contacts = f", {report['contacts']:.0f} contacts" if report["contacts"] else ""
    lowest = f", lowest y {report['lowest_ours']:.3f} m, SOFA's {report['lowest_peer']:.3f} m" if "lowest_ours" in report else ""
    return f"{report['case']}{contacts}: {solved}{lowest}"


def stopped_row(report):
    """Ours stopped at the error that SOFA's iterations have."""
    case = (f"{report['case']}: stopped at its error, tolerance {report['stopped_tolerance']:.2g}, {report['stopped_newton']:.3g} Newton, "
            f"{report['stopped_linear']:.4g} CG")
    return row("sofa", case, report["stopped_ours"], "ms", floor=report["stopped_hardware"], peer_name="SOFA (quoted)", peer=report["peer"],
               error_ours=report["stopped_error"], error_peer=report["error_peer"])


def bench_sofa(build, work):
    """SOFA's cases with the same parameters."""
    with subprocess.Popen([build / "tests/bench/bench_sofa"], stdout=subprocess.PIPE, text=True) as program:
        for line in program.stdout:
            report = json.loads(line)
            required = report["required"]
            yield row("sofa", case_name(report), report["ours"], "ms", floor=report["hardware"], peer_name="SOFA (quoted)",
                      peer=report["peer"], error_ours=report.get("error_ours"), error_peer=report.get("error_peer"),
                      least=report["peer"] / required if required else None)
            if "stopped_ours" in report:
                yield stopped_row(report)
    if program.returncode:
        raise SystemExit(f"bench_sofa ended with status {program.returncode}")


BENCHES = {"sofa": bench_sofa}

"""A few lines of TAP for test programs in Python: each function marked @check counts by itself."""
import functools
import os
import pathlib
import re
import signal
import sys
import time
import traceback

_checks = []


def check(function):
    """Marks a check. Its first docstring line (or name) is what the report says."""
    _checks.append(function)
    return function


def alike(function):
    """Marks a check of code that no build option changes; such checks are programs of the suite `alike`."""
    function.alike = True
    return function


def long_run(function):
    """Marks a check of minutes under sanitizers, of code that other checks run under them: sanitized programs leave it out."""
    function.long_run = True
    return function


class Skip(Exception):
    """Raised by a check that this build or machine cannot make."""


@functools.lru_cache
def is_sanitized(program):
    """A sanitized program reserves more memory than any limit, and is many times slower."""
    return b"__asan_init" in pathlib.Path(program).read_bytes()


def wait_for_work(process, seconds=0.2):
    """Until the process catches Ctrl-C and SIGTERM and has then worked for so much processor time, or is over."""
    folder = pathlib.Path("/proc", str(process.pid))
    awaited = 1 << (signal.SIGINT - 1) | 1 << (signal.SIGTERM - 1)

    def catches():
        return int(re.search(r"SigCgt:\s*(\w+)", (folder / "status").read_text())[1], 16) & awaited == awaited

    def worked_s():
        fields = (folder / "stat").read_text().rsplit(") ", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    begun_s = None
    while process.poll() is None and (begun_s is None or worked_s() < begun_s + seconds):
        if begun_s is None and catches():
            begun_s = worked_s()
        time.sleep(0.01)


def main(*arguments, kind=None, part=0, parts=1):
    """Runs all checks in order, or of one kind ("alike", "options") every parts-th from number `part` on, hands each `arguments`,
    and exits with 1 when one failed. While one works on a check: SPORE_CHECKS is a regular expression for the names of the
    functions to run."""
    failed = 0
    of_kind = [one for one in _checks if kind in (None, "alike" if hasattr(one, "alike") else "options")]
    mine = [one for one in of_kind[int(part)::int(parts)] if re.search(os.environ.get("SPORE_CHECKS", ""), one.__name__)]
    print("TAP version 13")
    print(f"1..{len(mine)}")
    for number, function in enumerate(mine, 1):
        name = (function.__doc__ or function.__name__).splitlines()[0].strip().rstrip(".").replace("#", "")
        began = time.monotonic()
        try:
            if hasattr(function, "long_run") and is_sanitized(sys.argv[1]):
                raise Skip("other checks run the code under sanitizers")
            function(*arguments)
            print(f"ok {number} - {name}", flush=True)
        except Skip as reason:
            print(f"ok {number} - {name} # SKIP {reason}", flush=True)
        except Exception:
            failed += 1
            print(f"not ok {number} - {name}", flush=True)
            for line in traceback.format_exc().splitlines():
                print("#", line, flush=True)
        print(f"# {function.__name__} took {time.monotonic() - began:.1f} s", flush=True)
    sys.exit(1 if failed else 0)

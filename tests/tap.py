"""A few lines of TAP for test programs in Python: each function marked @check counts by itself."""
import functools
import os
import pathlib
import re
import sys
import time
import traceback

_checks = []


def check(function):
    """Marks a check. Its first docstring line (or name) is what the report says."""
    _checks.append(function)
    return function


class Skip(Exception):
    """Raised by a check that this build or machine cannot make."""


@functools.lru_cache
def is_sanitized(program):
    """A sanitized program reserves more memory than any limit, and is many times slower."""
    return b"__asan_init" in pathlib.Path(program).read_bytes()


def main(*arguments, part=0, parts=1):
    """Runs all checks in order, or every parts-th of them from number `part` on, hands each `arguments`, and exits with 1 when one
    failed. While one works on a check: SPORE_CHECKS is a regular expression for the names of the functions to run."""
    failed = 0
    part, parts = int(part), int(parts)
    mine = [one for one in _checks[part::parts] if re.search(os.environ.get("SPORE_CHECKS", ""), one.__name__)]
    print("TAP version 13")
    print(f"1..{len(mine)}")
    for number, function in enumerate(mine, 1):
        name = (function.__doc__ or function.__name__).splitlines()[0].strip().rstrip(".").replace("#", "")
        began = time.monotonic()
        try:
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

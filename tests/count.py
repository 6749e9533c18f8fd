#!/usr/bin/python3
"""count.py BUILD...: adds up the checks of the last `meson test` in each build folder, lists what failed, and ends with
one line `N passed, N failed`. A test program that died before it could report counts as one failure."""
import pathlib
import sys
import xml.etree.ElementTree as xml


def checks(build):
    """Pairs (name, failed?) of every check that was run."""
    report = pathlib.Path(build, "meson-logs", "testlog.junit.xml")
    if not report.exists():
        yield f"{build}: no test report", True
        return
    for suite in xml.parse(report).getroot().iter("testsuite"):
        cases = list(suite.iter("testcase"))
        for case in cases:
            if case.find("skipped") is not None:
                continue
            failed = case.find("failure") is not None or case.find("error") is not None
            yield f"{build}: {suite.get('name')}: {case.get('name')}", failed
        broken = int(suite.get("errors", 0)) > 0 or int(suite.get("failures", 0)) > 0
        if broken and not any(case.find("failure") is not None or case.find("error") is not None for case in cases):
            yield f"{build}: {suite.get('name')}: died", True


def main():
    results = [check for build in sys.argv[1:] for check in checks(build)]
    failures = [name for name, failed in results if failed]
    for name in failures:
        print("failed:", name)
    if failures:
        for build in sys.argv[1:]:
            log = pathlib.Path(build, "test.log")
            if log.exists():
                sys.stdout.write("".join(log.read_text(errors="replace").splitlines(keepends=True)[-150:]))
    print(f"{len(results) - len(failures)} passed, {len(failures)} failed")
    return 1 if failures or not results else 0


sys.exit(main())

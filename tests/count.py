#!/usr/bin/python3
"""count.py BUILD...: adds up the checks of the last `meson test` in each build folder, lists what failed, and ends with
one line `N passed, N failed`. A test program that died before it could report counts as one failure."""
import json
import pathlib
import sys
import xml.etree.ElementTree as xml


# What meson says of a program that did not end well; its report of checks does not always tell.
BROKEN = ("FAIL", "ERROR", "TIMEOUT", "INTERRUPT")


def broken_programs(build):
    """Names, as the report has them, of the programs that did not end well."""
    log = pathlib.Path(build, "meson-logs", "testlog.json")
    programs = [json.loads(line) for line in log.read_text().splitlines()] if log.exists() else []
    return [program["name"] for program in programs if program["result"] in BROKEN]


def checks(build):
    """Pairs (name, failed?) of every check that was run."""
    report = pathlib.Path(build, "meson-logs", "testlog.junit.xml")
    if not report.exists():
        yield f"{build}: no test report", True
        return
    broken = broken_programs(build)
    for suite in xml.parse(report).getroot().iter("testsuite"):
        cases = list(suite.iter("testcase"))
        for case in cases:
            if case.find("skipped") is not None:
                continue
            failed = case.find("failure") is not None or case.find("error") is not None
            yield f"{build}: {suite.get('name')}: {case.get('name')}", failed
        died = any(suite.get("name").endswith(name) for name in broken)
        if died and not any(case.find("failure") is not None or case.find("error") is not None for case in cases):
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

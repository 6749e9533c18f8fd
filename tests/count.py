#!/usr/bin/python3
"""count.py BUILD...: adds up the checks of the last `meson test` in each build folder, lists what failed and what took
longest, and ends with one line `N passed, N failed`. A test program that died before it could report counts as one
failure."""
import json
import pathlib
import sys
import xml.etree.ElementTree as xml


LINES_OF_A_CHECK = 20  # that are printed of a failed check
LAST_LINES = 30  # that are printed of a program that failed
SLOWEST = 10  # programs that are listed with the time they took
# What meson says of a program that did not end well; its report of checks does not always tell.
BROKEN = ("FAIL", "ERROR", "TIMEOUT", "INTERRUPT")


def programs(build):
    """What meson noted of each program: its name as the report has it, result, duration in seconds."""
    log = pathlib.Path(build, "meson-logs", "testlog.json")
    return [json.loads(line) for line in log.read_text().splitlines()] if log.exists() else []


def checks(build):
    """Pairs (name, failed?) of every check that was run."""
    report = pathlib.Path(build, "meson-logs", "testlog.junit.xml")
    if not report.exists():
        yield f"{build}: no test report", True
        return
    broken = [program["name"] for program in programs(build) if program["result"] in BROKEN]
    for suite in xml.parse(report).getroot().iter("testsuite"):
        cases = list(suite.iter("testcase"))
        for case in cases:
            if case.find("skipped") is not None:
                continue
            # A program without checks of its own is a case by its own name.
            failed = case.find("failure") is not None or case.find("error") is not None or case.get("name") in broken
            yield f"{build}: {suite.get('name')}: {case.get('name')}", failed
        died = any(suite.get("name").endswith(name) for name in broken)
        if died and not any(case.find("failure") is not None or case.find("error") is not None for case in cases):
            yield f"{build}: {suite.get('name')}: died", True


def print_slowest(builds):
    """The programs that took longest, of all builds."""
    took = [(program["duration"], build, program["name"]) for build in builds for program in programs(build)]
    print(f"the slowest of {len(took)} programs, which took {sum(seconds for seconds, *_ in took):.0f} s together:")
    for seconds, build, name in sorted(took, reverse=True)[:SLOWEST]:
        print(f"{seconds:7.1f} s  {build}  {name.rsplit(' / ')[-1]}")


def print_broken_logs(builds):
    """What the programs printed that did not end well: each failed check with its trace, and the last lines."""
    for build in builds:
        for program in programs(build):
            if program["result"] not in BROKEN:
                continue
            print(f"{build}: {program['name']}: {program['result']}")
            lines = (program.get("stdout", "") + program.get("stderr", "")).splitlines()
            failed = [i for i, line in enumerate(lines) if line.startswith("not ok")]
            shown = {i for first in failed for i in range(first, first + LINES_OF_A_CHECK)} | set(range(len(lines) - LAST_LINES, len(lines)))
            for i in sorted(shown & set(range(len(lines)))):
                print("   ", lines[i])


def main():
    builds = sys.argv[1:]
    results = [check for build in builds for check in checks(build)]
    failures = [name for name, failed in results if failed]
    print_broken_logs(builds)
    print_slowest(builds)
    for name in failures:
        print("failed:", name)  # last: who sees the end of a long log alone sees the names
    print(f"{len(results) - len(failures)} passed, {len(failures)} failed")
    return 1 if failures or not results else 0


sys.exit(main())

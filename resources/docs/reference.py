#!/usr/bin/python3
"""reference.py BUILD: writes the reference of the installed headers and of the models' parameters to BUILD/docs/html.

The exit status is 1 where a function, type or macro of an installed header has no comment, or doxygen cannot make out
one. Fields and values of enumerations may go without: their names and units tell most."""
import json
import pathlib
import re
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
# What may go without a comment: fields, and values of enumerations.
PLAIN = re.compile(r"\(variable\) of (struct|union) .* is not documented|\(enumvalue\) .* is not documented")


def installed_headers(build):
    """The headers that are installed, as they lie in the source."""
    installed = json.loads((build / "meson-info/intro-installed.json").read_text())
    return sorted(source for source, place in installed.items() if place.endswith(".h"))


def cell(text):
    """Text for a cell of a table."""
    return str(text).replace("|", r"\|").replace("<", "&lt;")


def parameter_row(parameter):
    """The row of the table for one parameter."""
    values = ", ".join(parameter["choices"]) if parameter.get("choices") else ""
    if parameter["minimum"] is not None:
        values = f"{parameter['minimum']:g} to {parameter['maximum']:g}"
    cells = (f"`{parameter['name']}`", parameter["type"], parameter["unit"], values, parameter["default"], parameter["doc"])
    return "| " + " | ".join(cell(text) for text in cells) + " |"


def models_page(build):
    """The models and their parameters, as the program knows them."""
    said = subprocess.run([build / "app/spore", "models", "--json"], check=True, stdout=subprocess.PIPE).stdout
    lines = ["# Models and their parameters {#models}", ""]
    for model in json.loads(said)["models"]:
        lines += [f"## {model['label']}: `{model['name']}`", "", f"{model['doc']} Geometry: {model['geometry']}.", "",
                  "| parameter | type | unit | range | default | meaning |", "|---|---|---|---|---|---|",
                  *[parameter_row(parameter) for parameter in model["parameters"]], ""]
        for preset in model["presets"]:
            lines.append(f"- preset `{preset['name']}`: {', '.join(preset['settings'])} ({preset['source']})")
        lines.append("")
    return "\n".join(lines)


def main(build):
    build = pathlib.Path(build).resolve()
    folder = build / "docs"
    folder.mkdir(exist_ok=True)
    (folder / "models.md").write_text(models_page(build))
    headers = installed_headers(build)
    options = {"INPUT": " ".join(f'"{path}"' for path in [HERE / "index.md", *headers, folder / "models.md"]),
               "FILTER_PATTERNS": f"*.h={HERE / 'comments.py'}", "STRIP_FROM_PATH": f'"{ROOT}"',
               "STRIP_FROM_INC_PATH": f'"{ROOT}"', "OUTPUT_DIRECTORY": f'"{folder}"'}
    settings = (HERE / "Doxyfile").read_text() + "".join(f"{name} = {value}\n" for name, value in options.items())
    done = subprocess.run(["doxygen", "-"], input=settings, text=True, stderr=subprocess.PIPE, check=True, cwd=ROOT)
    warnings = [line.replace(f"{ROOT}/", "") for line in done.stderr.splitlines() if line.strip()]
    faults = sorted({line for line in warnings if not PLAIN.search(line)})
    print("\n".join(faults + [f"{folder / 'html/index.html'}: {len(headers)} headers, {len(faults)} faults"]))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))

#!/usr/bin/python3
"""Checks that translators see every text of the sources: its file is in po/POTFILES, and no macro cuts it short."""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
FOLDERS = ("app", "core", "models", "ui")
MARKS = {suffix: re.compile(r'\bN?_\(\s*"') for suffix in (".c", ".h", ".cpp", ".hpp")}
MARKS[".ui"] = re.compile(r'translatable="(yes|true|1)"')
# xgettext takes literals alone: what follows a macro such as G_GSIZE_FORMAT or PRIu64 is lost.
CUT = re.compile(r'\bN?_\(\s*(?:"(?:[^"\\\n]|\\.)*"\s*)+[A-Za-z]')


def main():
    sources = [p for folder in FOLDERS for p in (ROOT / folder).rglob("*") if p.suffix in MARKS]
    texts = {str(p.relative_to(ROOT)): p.read_text() for p in sources}
    marked = {name for name, text in texts.items() if MARKS[pathlib.Path(name).suffix].search(text)}
    listed = (ROOT / "po/POTFILES").read_text().split()
    found = [f"po/POTFILES lacks {name}; add it" for name in sorted(marked - set(listed))]
    found += [f"po/POTFILES lists {name}, which has no text to translate; remove it"
              for name in listed if name.startswith(FOLDERS) and name not in marked]
    for name, text in texts.items():
        found += [f"{name}:{text.count(chr(10), 0, match.start()) + 1}: a macro cuts a text to translate; write the "
                  "conversion out, as in %zu or %llu" for match in CUT.finditer(text)]
    print("\n".join(found) if found else f"translators see the texts of {len(marked)} files")
    return 1 if found else 0


sys.exit(main())

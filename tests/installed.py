#!/usr/bin/env python3
"""Check an installed manual: no link leads nowhere, and manual pages render without warnings.

    installed.py ROOT [DOC]

ROOT has include and share. DOC is the folder of the pages there, by default share/doc/massspring.
"""
import shutil
import subprocess
import sys
from pathlib import Path

from check_pages import check_links


def warnings_of(pages):
    """What groff and mandoc, as far as they are here, say of manual pages."""
    said = []
    if not pages:
        return said  # they are compressed
    for program in (["groff", "-man", "-Tutf8", "-ww", "-z"], ["mandoc", "-Tlint", "-Wwarning"]):
        if shutil.which(program[0]):
            ran = subprocess.run([*program, *pages], capture_output=True, text=True)
            said += (ran.stdout + ran.stderr).splitlines()
        else:
            print(f"no {program[0]} here")
    return said


def main():
    root = Path(sys.argv[1]).resolve()
    doc = root / (sys.argv[2] if len(sys.argv) > 2 else "share/doc/massspring")
    pages, manual = sorted(doc.rglob("*.md")), sorted((root / "share/man").rglob("*.[37]*"))
    wrong = [line for page in pages for line in check_links(page, page.read_text(encoding="utf-8"))]
    links = sum(page.read_text(encoding="utf-8").count("](") for page in pages)
    named = {page.name.split(".")[0] for page in manual}
    wrong += warnings_of([page for page in manual if not page.is_symlink() and page.suffix != ".gz"])
    exports = (Path(__file__).parent / "abi/exports.txt").read_text(encoding="utf-8").split()
    wrong += [f"no manual page of {name}" for name in exports if name.startswith("mspring_") and name not in named]
    if len(pages) < 20 or "massspring" not in named:
        wrong.append(f"{len(pages)} pages, {len(manual)} manual pages: hardly anything is installed")
    print(f"{len(pages)} pages with {links} links, {len(manual)} manual pages, {len(wrong)} wrong", *wrong, sep="\n")
    return bool(wrong)


if __name__ == "__main__":
    sys.exit(main())

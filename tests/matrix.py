"""Kinds of interaction by services of the library: the cells of this matrix that are written by hand.

    tests/matrix.py SRC

A cell counts if the files of a service name a kind at least three times, comments and includes aside. A file in features/ counts for
the service in its name, as snapshot_areas.c; what else a room holds is the kind's own and counts for none. Tables
(*.def) do not count. So a feature that no other folder knows adds no cell, and one that each solver, query and snapshot
has code for adds a row of them.
"""
import os
import re
import sys

KINDS = {
    "areas": r"\bareas?\b(?!_)|mspringi_area",
    "angles": r"angle",
    "floor": r"->floor\b|mspringi_floor",
    "silt": r"silt",
    "bodies": r"->(pairs|contacts)\b|mspringi_(pairs|bodies|rows|contacts?_)",
    "colliders": r"collider",
    "grips": r"grip",
    "one-way": r"one_way|side_of\(",
    "yield": r"plastic|yield",
    "actuators": r"actuator",
    "ramps": r"ramp",
    "added springs": r"graft|added_springs",
    "bundles": r"herd|bundle",
    "chains": r"CHAIN|chain_",
    "irregular": r"\bweb[._]|WEB\b|\birregular[._]|IRREGULAR\b",
    "groups": r"groups[.\b]|->groups|mspringi_groups",
    "hooks": r"hook",
    "relative": r"fractions|relative",
}
# The services, by folders of this tree and of earlier ones, and by the word in the name of a feature's file.
SERVICES = {
    "kernels": (r"kernels/", "kernel"),
    "explicit": (r"solvers/explicit/", "explicit"),
    "implicit": (r"solvers/(implicit/(?!.*(budget|sums|gain|slack|components))|constraints/)", "implicit"),
    "budget": (r"solvers/implicit/.*(budget|sums|gain|slack|components)", "budget"),
    "direct": (r"solvers/direct/", "direct"),
    "clamped": (r"solvers/clamped/", "clamped"),
    "stability": (r"stability/", "stability"),
    "settle": (r"analysis/settle/", "settle"),
    "tune": (r"analysis/tune/", "reference"),
    "sleep": (r"sleep/", "sleep"),
    "snapshot": (r"snapshot/", "snapshot"),
    "relayout": (r"network/(job|move|left|relayout|survivors)", "relayout"),
    "create": (r"network/(clone|network|settings|into)", "create"),
    "growth": (r"edits/(edit_)?(add|remov)|store/(growth|id_pool)", "growth"),
    "query": (r"query/", "query"),
    "edits": (r"edits/(?!(edit_)?(add|remov))", "edit"),
    "layout": (r"layout/", "layout"),
    "step": (r"step/", "step"),
}
FEWEST_HITS = 3
# Words that mean something else there: the area of a lattice's cell while the layout looks for grids, the turn of a
# tile and of a body, shares of silt and of a ray, the compression of a spring.
MEAN_OTHERWISE = {("areas", "layout"), ("angles", "kernels"), ("angles", "query"), ("relative", "kernels"), ("relative", "query")}


def sources(root):
    """The text of each source below root, by its path, without comments and includes."""
    found = {}
    for folder, _, names in os.walk(root):
        for name in names:
            if name.endswith((".c", ".h")):
                path = os.path.join(folder, name)
                with open(path, encoding="utf-8") as file:
                    found[os.path.relpath(path, root)] = re.sub(r"//[^\n]*|/\*.*?\*/|^ *# *include[^\n]*", "", file.read(), flags=re.S | re.M)
    return found


def serves(path, service):
    folders, word = SERVICES[service]
    if path.startswith("features/"):
        # The room of sleep is a service to all others.
        return word in os.path.basename(path).split(".")[0].split("_") or (
            service == "sleep" and path.startswith("features/sleep/"))
    return re.match(folders, path) is not None


def main():
    texts = sources(sys.argv[1])
    print(f"{'':14}" + " ".join(f"{service[:8]:>8}" for service in SERVICES))
    cells = 0
    for kind, words in KINDS.items():
        row = []
        for service in SERVICES:
            hits = sum(len(re.findall(words, text)) for path, text in texts.items() if serves(path, service))
            counts = hits >= FEWEST_HITS and (kind, service) not in MEAN_OTHERWISE
            cells += counts
            row.append(hits if counts else ".")
        print(f"{kind:14}" + " ".join(f"{hits:>8}" for hits in row))
    print(f"{cells} cells of {len(KINDS) * len(SERVICES)} are written by hand")


if __name__ == "__main__":
    main()

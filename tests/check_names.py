#!/usr/bin/env python3
"""No two types of one name: two definitions of a type that a program links together are undefined
behaviour (the one-definition rule), which no linker tells.

    check_names.py [ROOT]      prints names that stand twice; exit 1 where any does

Reads code as clang-format leaves it: namespaces and the types in them begin in the first column.
Types of anonymous namespaces are their file's own; those of tests/ are their program's.
"""
import collections
import pathlib
import re
import sys

OPENS = re.compile(r"^namespace ?([\w:]*) ?\{")
CLOSES = re.compile(r"^\}  // namespace")
TYPE = re.compile(r"^(?:struct|class|enum|enum class|union) (\w+)(?: final)?\s*(?:\{|:[^:]|$)")


def types_of(text):
    """(namespace, name) of each type with a definition of its own."""
    namespaces = []
    for line in text.split("\n"):
        if opened := OPENS.match(line):
            namespaces.append(opened.group(1))
        elif CLOSES.match(line):
            namespaces.pop()
        elif (found := TYPE.match(line)) and "" not in namespaces and not line.endswith(";"):
            yield "::".join(namespaces), found.group(1)


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parent.parent)
    places = collections.defaultdict(set)
    folders = [folder for folder in root.iterdir()
               if folder.is_dir() and folder.name not in ("build", "tests") and folder.name[0] != "."]
    for folder in folders:
        for file in sorted(folder.rglob("*")):
            if file.suffix in (".h", ".cpp", ".inc"):
                for name in types_of(file.read_text()):
                    places[name].add(str(file.relative_to(root)))
    twice = {name: files for name, files in places.items() if len(files) > 1 and "ISA" not in name[0]}
    for (namespace, name), files in sorted(twice.items()):
        print(f"{namespace}::{name}: {', '.join(sorted(files))}")
    print(f"{len(places)} types, {len(twice)} of them defined twice")
    return bool(twice)


if __name__ == "__main__":
    sys.exit(main())

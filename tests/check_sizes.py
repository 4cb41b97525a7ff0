#!/usr/bin/env python3
"""No source file above 600 lines, no function above 80.

    check_sizes.py [ROOT]      prints what is longer; exit 1 where anything is

Reads code as clang-format leaves it: a function's body opens with a brace in a line of its own, or at
the end of a line that is no table, class or namespace, and closes with a brace in the same column.
Tables (braces behind `=` or `return`, in initialisers and enums) may be of any length. A comment line
`// long: REASON` at the top of a file, or in the comment above a function, makes an exception.
"""
import pathlib
import re
import sys

MOST_FILE_LINES = 600
MOST_FUNCTION_LINES = 80
SUFFIXES = (".h", ".cpp", ".inc", ".frag", ".vert", ".glsl")
EXCEPTION = re.compile(r"^\s*// long: \S")
OPENS_NO_FUNCTION = re.compile(r"^\s*(namespace|struct|class|enum|union|extern)\b|[=({,]\s*\{$|\breturn\b.*\{$")


def functions(lines):
    """(first line, line count, name) of each body that closes in the column where it opens."""
    for opening, line in enumerate(lines):
        if line.rstrip() not in ("{", "    {"):
            continue
        indent = line[: line.index("{")]
        head = opening - 1  # the first line of what stands before the brace
        while head > 0 and lines[head - 1].strip() and not re.search(r"([;{}>]|:|\*/)$|^\s*(//|#|template)",
                                                                     lines[head - 1].rstrip()):
            head -= 1
        if OPENS_NO_FUNCTION.search(lines[head]) or "(" not in "".join(lines[head:opening]):
            continue
        closing = opening + 1
        while closing < len(lines) and lines[closing].rstrip() != indent + "}":
            closing += 1
        comment = head - 1
        excused = False
        while comment >= 0 and lines[comment].lstrip().startswith("//"):
            excused = excused or bool(EXCEPTION.match(lines[comment]))
            comment -= 1
        if not excused:
            yield head + 1, closing - head + 1, lines[head].strip()


def faults(path):
    lines = path.read_text().splitlines()
    if len(lines) > MOST_FILE_LINES and not any(EXCEPTION.match(line) for line in lines[:20]):
        yield f"{len(lines)} lines, at most {MOST_FILE_LINES}"
    for first, count, name in functions(lines):
        if count > MOST_FUNCTION_LINES:
            yield f"line {first}: {count} lines, at most {MOST_FUNCTION_LINES}: {name}"


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parent.parent)
    count = found = 0
    for path in sorted(root.rglob("*")):
        inside = path.relative_to(root)
        if path.suffix not in SUFFIXES or inside.parts[0] in ("build", "out", "data") or not path.is_file():
            continue
        count += 1
        for fault in faults(path):
            print(f"{inside}: {fault}")
            found += 1
    print(f"{count} files, {found} longer than they may be")
    return 1 if found or count == 0 else 0


if __name__ == "__main__":
    sys.exit(main())

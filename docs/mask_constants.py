"""mask_constants.py: tree/masks/constants.inc, the numbers of the mask engine, for scripts."""

import functools
import pathlib
import re

TABLE = pathlib.Path(__file__).resolve().parent.parent / "tree/masks/constants.inc"
LISTS = ("quality", "limit")
ROW = re.compile(r"^SURFELAO_MASK_(CONSTANT|FLAG|QUALITY|LIMIT)\((.*)\)$")


@functools.cache
def read():
    """[(section, [row])]; a row: name, value (as written, without suffix) and its fields by name.
    Rows of the family are named quality, their value is a list: quality, s, r, u, g; those of the
    falloff limit, theirs is distance, weight."""
    sections, fields, last = [], {}, None
    for number, line in enumerate(TABLE.read_text().splitlines(), 1):
        field = re.match(r"^/// (\w+): (.+)$", line)
        more = re.match(r"^///     (.+)$", line)
        section = re.match(r"^// --- (.+) ---$", line)
        row = ROW.match(line)
        if section:
            sections.append((section.group(1), []))
        elif field:
            last = field.group(1)
            fields[last] = field.group(2)
        elif more:
            fields[last] += " " + more.group(1)
        elif row:
            kind, words = row.group(1), [plain(word) for word in row.group(2).split(", ")]
            name = {"CONSTANT": words[1:2], "FLAG": words[:1]}.get(kind, [kind.lower()])[0]
            sections[-1][1].append({**fields, "kind": kind, "name": name,
                                    "value": words if name in LISTS else words[-1]})
            fields = {}
        elif line.startswith("SURFELAO"):
            raise ValueError(f"{TABLE.name}:{number}: a row that is not one line")
    return sections


def plain(word):
    """Of a C++ literal."""
    return re.sub(r"(?<=[\d.])[fu]$", "", word) if not word.startswith("0x") else word.rstrip("u")


def rows(kind="CONSTANT"):
    return [row for _, section in read() for row in section if row["kind"] == kind]


def value_of(name):
    for row in rows():
        if row["name"] == name:
            return float(row["value"])
    raise KeyError(name)


def family():
    """[[quality, s, r, u, g]] as numbers."""
    return numbers_of("QUALITY")


def falloff():
    """[[distance, weight]] as numbers."""
    return numbers_of("LIMIT")


def numbers_of(kind):
    return [[float(word) for word in row["value"]] for row in rows(kind)]

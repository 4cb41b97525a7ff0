#!/usr/bin/env python3
"""report_test.py PROGRAM: a report is one well-formed page that tells machine and run, and what it
offers to save can be read.
"""

import base64
import csv
import io
import os
import pathlib
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as xml

PLOTS = {"a-solve.svg", "a-job.svg"}


def hills(side):
    """A height field as OBJ."""
    lines = [f"v {x} {((x * 7 + y * 5) % 4) / 2} {y}" for y in range(side) for x in range(side)]
    for y in range(side - 1):
        for x in range(side - 1):
            corner = y * side + x + 1
            lines.append(f"f {corner} {corner + side} {corner + side + 1} {corner + 1}")
    return "\n".join(lines) + "\n"


def saved_bytes(link):
    return base64.b64decode(link.get("href").partition(";base64,")[2], validate=True)


def check(page, engines):
    """page: the root element. Returns what its links save, by name."""
    facts = {name.text: value.text for name, value in zip(page.iter("dt"), page.iter("dd"))}
    assert facts["program"].startswith("surfelao "), facts
    assert "compare a.obj" in facts["command"], facts
    assert facts["date"] == "2001-09-09 01:46 UTC", facts
    for name in ("cores", "instructions", "memory", "system", "compiler", "libraries"):
        assert facts[name], facts
    assert facts["program"] in facts["cite as"] and "2001-09-09" in facts["cite as"], facts

    names = {element.get("name") for element in page.iter("meta")}
    assert "viewport" in names, names
    assert all(image.get("alt") for image in page.iter("img")), "a picture without words"
    for element in page.iter():
        for reference in (element.get("src"), element.get("href")):
            assert reference is None or reference.startswith("data:"), reference[:80]
    assert {row.find("td").text for table in page.iter("table") for row in table.iter("tr")
            if row.find("td") is not None} >= engines

    saved = {link.get("download"): saved_bytes(link) for link in page.iter("a")}
    for name in saved:
        if name.endswith(".svg"):
            assert xml.fromstring(saved[name]).tag == "{http://www.w3.org/2000/svg}svg"
        else:
            rows = list(csv.reader(io.StringIO(saved[name].decode())))
            assert len(rows) > 2 and len({len(row) for row in rows}) == 1, rows
    return saved


def report(program, folder, *arguments):
    environment = {**os.environ, "SOURCE_DATE_EPOCH": "1000000000"}
    subprocess.run([program, "compare", "a.obj", "-o", "out", "--rounds", "1", "--no-cache",
                    "--qualities", "draft,good", *arguments],
                   cwd=folder, env=environment, check=True, stdout=subprocess.DEVNULL)
    return xml.fromstring((folder / "out/report.html").read_text())


def main(program):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "a.obj").write_text(hills(12))
        saved = check(report(program, folder, "--reference-rays", "64", "--sample", "300"),
                      {"masks", "disks", "Embree"})
        assert set(saved) == PLOTS | {"surfelao-compare.csv"}, set(saved)
        saved = check(report(program, folder, "--at", "pixels", "--views", "1", "--width", "48",
                             "--height", "36", "--reference-rays", "16", "--engines", "masks,gtao"),
                      {"masks", "gtao"})
        assert set(saved) == {"a-pixels.svg", "surfelao-pixels.csv"}, set(saved)


if __name__ == "__main__":
    main(sys.argv[1])

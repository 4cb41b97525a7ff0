#!/usr/bin/env python3
"""fill_figures.py: writes every measured figure of README.md and docs/*.md from docs/figures/*.json.

    docs/fill_figures.py            fills
    docs/fill_figures.py --check    changes nothing; exit 1 where a text differs from what it would
                                    write, or a measured number has no source
    docs/fill_figures.py --list     names the views

A figure stands between markers, which say what view (figure_views.py) writes it:

    <!-- figures every_model -->                a block: whole lines, mostly a table
    | scene | ...
    <!-- end -->

    an error of <!--=row skull masks good rmse-->0.0051<!--/--> on a scan

Outside of markers a number is refused when it has decimals, an exponent or a unit (ms, %, times,
MiB, degrees ...), unless it stands in code, a link or a formula ($...$), or is a statement that
nobody measures (a definition, a bound of a test): then it is

    - in a phrase of docs/figures/stated.txt, with its reason, or
    - on a line with <!-- stated: REASON -->, or between such a line of its own and <!-- end -->.

A page with the line <!-- history: ... --> keeps its figures as they were written; its markers are
filled all the same. Python 3, standard library only; needs neither the program nor its models.
"""

import pathlib
import re
import sys

sys.dont_write_bytecode = True
import figure_views  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parent.parent
STATED = ROOT / "docs/figures/stated.txt"

BLOCK = re.compile(r"(^<!-- figures ([^\n]+?) -->\n)((?:(?!<!-- ).)*?)(^<!-- end -->$)", re.M | re.S)
INLINE = re.compile(r"(<!--=([^\n]+?)-->)((?:(?!<!--).)*?)(<!--/-->)", re.S)
STATED_BLOCK = re.compile(r"^<!-- stated: [^\n]+ -->\n(?:(?!<!-- end).)*?^<!-- end -->$", re.M | re.S)
HISTORY = re.compile(r"^<!-- history: .+-->$", re.M)

UNITS = (r"(?:[mun]?s|%|times|[KMG]i?B|kB|bytes|degrees?|deg|seconds?|milliseconds?|microseconds?"
         r"|minutes?|hours?)")
MEASURED = re.compile(
    r"(?<![\w.])[-+]?(?:"
    rf"(?:\d[\d,]*)?\.\d+(?:e[-+]?\d+)?(?:\s?{UNITS}(?![\w/]))?"  # 0.0031, .005, 1.5e-4, 4.1 s
    r"|\d+e[-+]?\d+"                                              # 1e-4
    rf"|\d[\d,]*\s?{UNITS}(?![\w/])"                              # 12 ms, 8 %, 37 MiB
    r")(?![\d.]*\.\d)")                        # but no version 1.2.3

# what holds no figures, in the order in which it is taken out
CODE = [re.compile(pattern, re.M | re.S) for pattern in (
    r"^```.*?^```[^\n]*$",
    r"(?<=\n\n)(?:    [^\n]*\n|\n(?=    ))+",
    r"`[^`]+`",
)]
SILENT = [*CODE, STATED_BLOCK, *(re.compile(pattern, re.M | re.S) for pattern in (
    r"^[^\n]+<!-- stated: [^\n]+-->[^\n]*$",
    r"<!--.*?-->",
    r"\$\$.*?\$\$|\$[^$\n]+\$",
    r"!?\[[^\]]*\]\([^)]*\)|https?://\S+",
))]


def pages():
    return [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]


def line_of(text, offset):
    return text.count("\n", 0, offset) + 1


def blank(text, pattern):
    """Takes out what matches, with offsets and lines where they were."""
    return pattern.sub(lambda match: re.sub(r"[^\n]", " ", match.group()), text)


def stated_phrases():
    """[(phrase, line)] of stated.txt: PHRASE # REASON."""
    phrases = []
    for number, line in enumerate(STATED.read_text().splitlines(), 1):
        if not line or line.startswith("#"):
            continue
        phrase, mark, reason = line.partition(" # ")
        if not mark or not reason.strip():
            raise SystemExit(f"{STATED.relative_to(ROOT)}:{number}: a phrase needs its reason behind ' # '")
        phrases.append((phrase.strip(), number))
    return phrases


def first_difference(found, wanted):
    """The first lines of two different texts that differ."""
    found, wanted = found.split("\n") + [""], wanted.split("\n") + [""]
    return next(((a, b) for a, b in zip(found, wanted) if a != b), ("", ""))


def fill(text, figures, complain):
    """The text with every marker's content written anew."""
    def written(match, frame):
        name, *arguments = match.group(2).split()
        try:
            content = frame(figure_views.VIEWS[name](figures, *arguments))
        except KeyError as missing:
            known = name in figure_views.VIEWS
            complain(match.start(), f"{match.group(2)}: " +
                     (f"no such figure: {missing}" if known else "no such view"))
            return match.group()
        except (TypeError, ValueError, OSError) as error:
            complain(match.start(), f"{match.group(2)}: {error}")
            return match.group()
        if content != match.group(3):
            found, wanted = first_difference(match.group(3), content)
            complain(match.start(), f"{match.group(2)}: the text is not what the figures say: "
                                    f"\"{found}\", wanted \"{wanted}\"")
        return match.group(1) + content + match.group(4)

    # right to left, so that the offsets of complaints stay those of the page
    for pattern, frame in ((BLOCK, lambda content: content.rstrip("\n") + "\n"),
                           (INLINE, lambda content: content)):
        for match in reversed(list(pattern.finditer(text))):
            text = text[:match.start()] + written(match, frame) + text[match.end():]
    return text


def without_source(text, phrases, used):
    """[(offset, number)] of the measured numbers that stand outside of markers."""
    for pattern in (BLOCK, INLINE, *SILENT):
        text = blank(text, pattern)
    for phrase, number in phrases:
        pattern = re.compile(r"(?<!\w)" + r"\s+".join(map(re.escape, phrase.split())) + r"(?!\w)")
        if pattern.search(text):
            used.add(number)
            text = blank(text, pattern)
    return [(match.start(), match.group().strip()) for match in MEASURED.finditer(text)]


def stray_markers(text):
    for pattern in (BLOCK, INLINE, STATED_BLOCK, *CODE):
        text = blank(text, pattern)
    return [match.start() for match in
            re.finditer(r"<!-- figures |<!-- end -->|<!--=|<!--/|^<!-- stated:", text, re.M)]


def main(arguments):
    if arguments == ["--list"]:
        for name, view in figure_views.VIEWS.items():
            print(f"{name:18} {' '.join((view.__doc__ or '').split())}")
        return 0
    if arguments not in ([], ["--check"]):
        print(__doc__, file=sys.stderr)
        return 2
    check = arguments == ["--check"]
    figures = figure_views.Figures(ROOT / "docs/figures")
    phrases, used, faults = stated_phrases(), set(), []
    for page in pages():
        old = page.read_text()
        name = page.relative_to(ROOT)
        complaints = []
        new = fill(old, figures, lambda offset, fault: complaints.append((line_of(old, offset), fault)))
        complaints = [fault for fault in complaints if check or "the text is not" not in fault[1]]
        for offset in stray_markers(old):
            complaints.append((line_of(old, offset), "a marker without its other half"))
        if not HISTORY.search(old):
            for offset, number in without_source(new, phrases, used):
                complaints.append((line_of(new, offset), f'"{number}" has no source'))
        faults += [f"{name}:{line}: {fault}" for line, fault in sorted(complaints)]
        if not check and new != old:
            page.write_text(new)
            print(f"filled {name}")
    faults += [f"{STATED.relative_to(ROOT)}:{number}: \"{phrase}\" stands nowhere"
               for phrase, number in phrases if number not in used]
    faults += [f"docs/figures/{name}: no page shows it" for name in figures.unused()]
    for fault in faults:
        print(fault, file=sys.stderr)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

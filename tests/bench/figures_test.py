#!/usr/bin/env python3
"""figures_test.py: docs/fill_figures.py --check lets the pages pass, and no page that was tampered with."""

import pathlib
import shutil
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parent.parent.parent


def complaints(change=lambda readme: readme, stated=""):
    """What the check says of a copy of the pages whose README was changed."""
    with tempfile.TemporaryDirectory() as folder:
        copy = pathlib.Path(folder)
        for path in ROOT.iterdir():
            if path.name not in ("README.md", "docs"):
                (copy / path.name).symlink_to(path)
        shutil.copytree(ROOT / "docs", copy / "docs")
        (copy / "README.md").write_text(change((ROOT / "README.md").read_text()))
        with open(copy / "docs/figures/stated.txt", "a") as file:
            file.write(stated)
        done = subprocess.run([copy / "docs/fill_figures.py", "--check"], capture_output=True, text=True)
        assert done.returncode == (1 if done.stderr else 0), done
        return done.stderr


def refuses(words, change=lambda readme: readme, stated=""):
    said = complaints(change, stated)
    assert words in said, f"wanted '{words}', but the check said: {said or 'nothing'}"


def replaced(old, new):
    def change(readme):
        assert old in readme, f"README.md has no '{old}'"
        return readme.replace(old, new, 1)
    return change


PRESENT = "## How fast, how wrong\n"

assert complaints() == "", complaints()
# a digit of a block, of an inline figure; a marker that is no view, a figure that is none, a lost end
refuses("how_fast: the text is not", replaced("| skull | 1", "| skull | 2"))
refuses("scene bunny triangles: the text is not", replaced("-->69,666<", "-->69,667<"))
refuses("speed_of_light: no such view", replaced(PRESENT, PRESENT + "<!--=speed_of_light-->3<!--/-->\n"))
refuses("scene teapot triangles: no such figure",
        replaced(PRESENT, PRESENT + "<!--=scene teapot triangles-->3<!--/-->\n"))
for half in ("<!-- figures how_fast -->", "<!-- end -->", "<!--/-->", "<!--=scene bunny triangles-->"):
    refuses("a marker without its other half", replaced(half, ""))
# numbers typed by hand
numbers = ("0.0032", "-0.7", ".5", "1e-4", "12 ms", "8 %", "3 times", "37 MiB", "4.1 s")
said = complaints(replaced(PRESENT, PRESENT + "".join(f"It takes {n} here.\n" for n in numbers)))
for number in numbers:
    assert f'"{number}" has no source' in said, number
# ... which a reason, code, a link and a formula allow
allowed = "It is 0.5. <!-- stated: by definition -->\n`0.5` [x](0.5.png) $0.5$\n"
assert complaints(replaced(PRESENT, PRESENT + allowed)) == ""
refuses("stands nowhere", stated="nine lives 0.5 # a reason\n")
refuses("needs its reason", stated="at 0.005\n")

# a median over few of the scenes stands for none
sys.path.insert(0, str(ROOT / "docs"))
import figure_views  # noqa: E402


def some_scenes(reached):
    """Nine scenes, of which so many reach the error."""
    return {"frontier": {"scenes": [
        {"name": str(i), "group": "models",
         "ratios": {"masks": {"at_010": {"ratio": 2.0 + i, "extrapolated": i >= reached}}}}
        for i in range(9)]}}


assert figure_views.VIEWS["ratio_scenes"](some_scenes(6), "010") == "6 of 9"
assert figure_views.VIEWS["ratio_quantile"](some_scenes(6), "0.5", "010") == "4.5"
try:
    figure_views.VIEWS["ratio_quantile"](some_scenes(5), "0.5", "010")
    raise SystemExit("a median over 5 of 9 scenes was written")
except ValueError as refused:
    assert "5 of 9" in str(refused), refused

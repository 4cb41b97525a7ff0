#!/usr/bin/env python3
"""Manual pages and completions against the program's own --help.

    check_manuals.py PROGRAM SHARE     SHARE: the build's folder of what goes below share/

Every option of every command stands in its page and in the completions of three shells; bash is run, and
completes commands, options, values and files.
"""
import pathlib
import re
import subprocess
import sys
import tempfile

PROGRAM, SHARE = sys.argv[1], pathlib.Path(sys.argv[2]).resolve()
BASH = SHARE / "bash-completion/completions/surfelao"

# words of the line, the last to be completed; what is offered
CASES = [
    ("surfelao ba", {"bake"}),
    ("surfelao --v", {"--version"}),
    ("surfelao bake --engine ", {"masks", "disks", "rays"}),
    ("surfelao bake --engine = di", {"disks"}),
    ("surfelao bake in.ply --qu", {"--quality"}),
    ("surfelao bake --green ", {"+y", "-y"}),
    ("surfelao bake --green -", {"-y"}),
    ("surfelao bake --green -y --gro", {"--ground"}),
    ("surfelao compare --devices cpu,", {"cpu,cpu", "cpu,gpu"}),
    ("surfelao view --surface sp", {"splats"}),
    ("surfelao render --mode bent", {"bent-normals"}),
    ("surfelao info ", {"a.ply", "B.PLY", "c d.glb", "sub"}),
    ("surfelao info --columns x ", {"a.ply", "B.PLY", "c d.glb", "sub"}),
    ("surfelao bake --high a.ply ", {"a.ply", "B.PLY", "c d.glb", "e.json", "f.png", "sub"}),
    ("surfelao render a.ply -o ", {"f.png", "sub"}),
    ("surfelao compare a.ply -o ", {"sub"}),
    ("surfelao bake a.ply --rays ", set()),
]


def help_of(*command):
    return subprocess.run([PROGRAM, *command, "--help"], capture_output=True, text=True, check=True).stdout


def options_in(text):
    """The names in the left column of a help text."""
    lines = re.findall(r"^  (-[-a-z0-9,]+)", text, re.M)
    return [name for line in lines for name in line.split(",")]


def completed(lines):
    """What bash offers for each line; words are split at blanks alone."""
    script = f"shopt -u progcomp_alias\nsource '{BASH}'\n"
    for line in lines:
        words = line.split(" ")
        quoted = " ".join(f"'{word}'" for word in words)
        script += (f"COMP_WORDS=({quoted}) COMP_CWORD={len(words) - 1}\n_surfelao\n"
                   "printf '%s\\n' \"${COMPREPLY[@]}\" ''\necho ----\n")
    with tempfile.TemporaryDirectory() as folder:
        for name in ("a.ply", "B.PLY", "c d.glb", "e.json", "f.png"):
            (pathlib.Path(folder) / name).touch()
        (pathlib.Path(folder) / "sub").mkdir()
        shell = subprocess.run(["bash", "--norc", "-u", "-c", script], cwd=folder, capture_output=True, text=True)
    if shell.stderr:
        sys.exit(f"bash says: {shell.stderr}")
    return [set(filter(None, part.split("\n"))) for part in shell.stdout.split("----\n")[:-1]]


def main():
    faults = []
    commands = re.findall(r"^  ([a-z]+) ", help_of().partition("Subcommands:")[2], re.M)
    if len(commands) < 6:
        sys.exit(f"the help lists {commands}")
    offered = dict(zip(commands, completed([f"surfelao {command} -" for command in commands])))
    zsh = (SHARE / "zsh/vendor-completions/_surfelao").read_text()
    fish = (SHARE / "fish/vendor_completions.d/surfelao.fish").read_text()
    count = 0
    for command in commands:
        page = (SHARE / f"man/man1/surfelao-{command}.1").read_text().replace("\\-", "-")
        heads = " ".join(re.findall(r"^\.TP\n(.*)$", page, re.M))
        zsh_part = zsh.partition(f"_surfelao_{command}() {{")[2].partition("\n}")[0]
        fish_part = "\n".join(line for line in fish.splitlines() if f"subcommand_from {command}'" in line)
        options = options_in(help_of(command))
        for name in options:
            count += 1
            flag = f" -l {name[2:]} " if name.startswith("--") else f" -s {name[1:]} "
            for where, there in (("page", f"\\fB{name}\\fR" in heads), ("bash", name in offered[command]),
                                 ("zsh", f"'*{name}[" in zsh_part), ("fish", flag in fish_part)):
                if not there:
                    faults.append(f"{command} {name}: not in {where}")
        if "--help" not in options or offered[command] - set(options):
            faults.append(f"{command}: bash offers {offered[command] - set(options)}, the help does not")
    for (line, wanted), found in zip(CASES, completed([line for line, _ in CASES])):
        if found != wanted:
            faults.append(f"'{line}' is completed by {sorted(found)}, not {sorted(wanted)}")
    print("\n".join(faults) or f"{count} options of {len(commands)} commands, {len(CASES)} completions")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())

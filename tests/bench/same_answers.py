#!/usr/bin/env python3
"""Whether two builds of the program give the same answers, and how their speed compares.

    same_answers.py OLD NEW [--repeats N] MODEL...

Bakes every model with every engine and quality by both programs, in turns, and compares the files
byte for byte (but for the line that names the settings), the JSON of `compare` without its times,
and pictures of `render`. Prints a line for what differs, and per model the median ratio of processor
seconds, new over old, of masks at `good`. Exit code 1 where anything differs.
"""
import argparse
import json
import os
import re
import resource
import statistics
import struct
import subprocess
import sys
import tempfile

BAKES = [
    ("masks", "draft", []), ("masks", "good", []), ("masks", "best", []),
    ("masks", "good", ["--max-distance", "10%", "--falloff", "smooth"]),
    ("disks", "draft", []), ("disks", "good", []), ("disks", "best", []),
    ("rays", None, ["--rays", "16"]),
]
TIMES = ("build_s", "solve_s", "read_s", "fit_s", "us_per_receiver", "seconds", "embree_ratio",
         "embree_ratio_with_builds", "extrapolated", "rounds", "from_cache")


def run(program, arguments):
    """Processor seconds of a run; its output is thrown away, failures end everything."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    done = subprocess.run([program] + arguments, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{program} {' '.join(arguments)}: {done.stderr.strip()}")
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before


def without_settings(data):
    """The bytes of a baked file without what names the settings that made it."""
    if data[:4] == b"glTF":
        length = struct.unpack_from("<I", data, 12)[0]
        document = json.loads(data[20:20 + length])
        return without_extras(document) + data[20 + length:]
    if data.lstrip()[:1] == b"{":
        return without_extras(json.loads(data))
    head, separator, rest = data.partition(b"end_header\n")
    if not separator:
        head, rest = data, b""
    return re.sub(rb"(?m)^(comment|#) surfelao .*\n", b"", head) + separator + rest


def without_extras(document):
    document.get("asset", {}).get("extras", {}).pop("surfelao", None)
    if document.get("asset", {}).get("extras") == {}:
        del document["asset"]["extras"]
    for buffer in document.get("buffers", []):
        buffer.pop("uri", None)
    return json.dumps(document, sort_keys=True).encode()


def without_times(value):
    if isinstance(value, dict):
        return {k: without_times(v) for k, v in value.items() if k not in TIMES}
    if isinstance(value, list):
        return [without_times(v) for v in value]
    return value


def new_folder(folder):
    return tempfile.mkdtemp(dir=folder)


def contents(path):
    with open(path, "rb") as file:
        return file.read()


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("old")
    parser.add_argument("new")
    parser.add_argument("models", nargs="+")
    parser.add_argument("--repeats", type=int, default=5, help="of the timed bake")
    options = parser.parse_args()
    programs = {"old": options.old, "new": options.new}
    different = 0
    with tempfile.TemporaryDirectory() as folder:
        for model in options.models:
            name = os.path.basename(model)
            gltf = name.lower().endswith((".glb", ".gltf"))
            kind = ".glb" if gltf else ".ply"
            failed = []

            def both(what, arguments_for, read):
                results = []
                for key, program in programs.items():
                    target = os.path.join(folder, key + what[0])
                    run(program, arguments_for(target))
                    results.append(read(target))
                if results[0] != results[1]:
                    failed.append(what[1])

            for engine, quality, more in BAKES:
                arguments = ["--engine", engine] + (["--quality", quality] if quality else []) + more
                both((kind, "bake " + " ".join(arguments)),
                     lambda target: ["bake", model, "-o", target] + arguments,
                     lambda target: without_settings(contents(target)))
            both((".json", "compare"),
                 lambda target: ["compare", model, "--engines", "masks", "--sample", "500", "--reference-rays", "256",
                                 "--rounds", "1", "-o", new_folder(folder), "--json", target, "--no-cache"],
                 lambda target: without_times(json.loads(contents(target))))
            both((".png", "render"),
                 lambda target: ["render", model, "-o", target, "--width", "320", "--height", "200",
                                 "--samples", "4", "--context", "osmesa"],
                 contents)
            ratios = []
            for _ in range(options.repeats):
                seconds = [run(program, ["bake", model, "-o", os.path.join(folder, key + kind)])
                           for key, program in programs.items()]
                if seconds[0] > 0:
                    ratios.append(seconds[1] / seconds[0])
            ratio = statistics.median(ratios) if ratios else float("nan")
            print(f"{name}: {'same' if not failed else 'DIFFERENT'}, processor seconds of a bake "
                  f"{ratio:.2f} of before", flush=True)
            for what in failed:
                print("  " + what)
            different += len(failed)
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())

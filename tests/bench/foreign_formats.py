#!/usr/bin/env python3
"""foreign_formats.py BUILD: what becomes of the files that are read through assimp, as JSON.

    files       up to 20 of Debian's assimp-testmodels in each format: what a bake says, or the sentence
    pairs       models in two formats: the largest and the mean difference of occlusion just above their
                faces
    mutants     500 files of them with bytes changed, cut out or put in: how many were read or refused,
                the peak of memory and the longest time

A fault ends with exit 1: another exit code than 0 and 1, a refusal that is not one sentence which
begins with the file's name, a result that cannot be read, a file that is left in the folder for
temporary ones or in that of the result, a difference above .002, a peak above the limit. The peak is
that of surfelao or of its child, whichever is larger (wait4). Needs assimp-testmodels and assimp-utils.
Python 3, standard library only.
"""

import json
import os
import pathlib
import random
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import time
import zipfile

MODELS = pathlib.Path("/usr/share/assimp/models")
FORMATS = {"FBX": (".fbx",), "COLLADA": (".dae", ".zae"), "3DS": (".3ds",), "3MF": (".3mf",),
           "X3D": (".x3d",)}
MOST_FILES = 20
MUTANTS = 500
LIMIT = (512 << 20)  # of the address space of the reader of a small file (import_limits())
TOLERANCE = 0.002
PAIRED = ("OBJ/spider.obj", "OBJ/WusonOBJ.obj", "OBJ/regr01.obj")
faults = 0


def fault(text):
    global faults
    faults += 1
    print(f"foreign_formats.py: {text}", file=sys.stderr)


def run(program, *words, temporary):
    """Exit code, what it said, seconds, peak of memory in bytes."""
    with tempfile.TemporaryFile() as said, tempfile.TemporaryFile() as complained:
        begin = time.monotonic()
        child = subprocess.Popen([program, *map(str, words)], stdout=said, stderr=complained,
                                 env={**os.environ, "TMPDIR": str(temporary)})
        _, status, usage = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
        texts = []
        for file in (said, complained):
            file.seek(0)
            texts.append(file.read().decode(errors="replace"))
        return child.returncode, *texts, time.monotonic() - begin, usage.ru_maxrss * 1024


def check_refusal(path, code, complaint):
    if code != 1:
        fault(f"{path.name}: exit code {code}: {complaint.strip()}")
    elif complaint.count("\n") != 1 or not complaint.startswith(f"surfelao: {path}: "):
        fault(f"{path.name}: not one sentence that names it: {complaint.strip()}")
    return complaint.strip().removeprefix(f"surfelao: {path}: ")


def files_of(extensions):
    found = sorted(path for path in MODELS.rglob("*")
                   if path.suffix.lower() in extensions and path.is_file())
    return found[:MOST_FILES]


def tell(surfelao, path, temporary):
    row = {"file": str(path.relative_to(MODELS))}
    result = temporary / "result.glb"
    words = ("--quality", "draft", "--check", "0")
    code, said, complaint, _, _ = run(surfelao, "bake", path, "-o", result, *words, "--json", "-",
                                      temporary=temporary)
    if code != 0:
        return {**row, "sentence": check_refusal(path, code, complaint)}
    report = json.loads(said)
    code, _, complaint, _, _ = run(surfelao, "bake", result, "-o", temporary / "again.ply", *words,
                                   temporary=temporary)
    if code != 0:
        fault(f"{path.name}: its result is refused: {complaint.strip()}")
    for left in temporary.iterdir():
        left.unlink()
    if not report["notes"][0].startswith("read through assimp"):
        fault(f"{path.name}: nothing says that it came through assimp")
    return {**row, "vertices": report["vertices"], "triangles": report["triangles"],
            "notes": report["notes"][1:]}


# ---- the same model in two formats


def values_of(ply):
    """[(position, occlusion)] of a binary PLY that bake has made."""
    head, _, body = ply.read_bytes().partition(b"end_header\n")
    count = int(re.search(rb"element vertex (\d+)", head).group(1))
    vertex = head.split(b"element vertex")[1].split(b"element")[0]
    names = [line.split()[1:] for line in vertex.splitlines() if line.startswith(b"property")]
    kinds = {b"float": "f", b"double": "d", b"uchar": "B", b"uint": "I", b"int": "i"}
    row = struct.Struct("<" + "".join(kinds[kind] for kind, _ in names))
    at = {name.decode(): i for i, (_, name) in enumerate(names)}
    return [(tuple(values[at[axis]] for axis in "xyz"), values[at["occlusion"]])
            for values in row.iter_unpack(body[:count * row.size])]


def bake(surfelao, path, temporary, *options):
    result = temporary / "values.ply"
    code, _, complaint, _, _ = run(surfelao, "bake", path, "-o", result, "--normals", "flat", "--values",
                                   "point", "--check", "0", *options, temporary=temporary)
    if code != 0:
        fault(f"{path.name}: is not baked: {complaint.strip()}")
        return []
    values = values_of(result)
    result.unlink()
    return values


def read_obj(path):
    places, faces = [], []
    for line in path.read_text("latin-1").splitlines():
        words = line.split()
        if words[:1] == ["v"]:
            places.append(tuple(map(float, words[1:4])))
        elif words[:1] == ["f"]:
            corners = [int(word.split("/")[0]) - 1 for word in words[1:]]
            faces += [(corners[0], corners[i], corners[i + 1]) for i in range(1, len(corners) - 1)]
    return places, faces


def write_obj(path, places, faces):
    path.write_text("".join(f"v {x!r} {y!r} {z!r}\n" for x, y, z in places)
                    + "".join(f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in faces))


def box_of(places):
    low = [min(place[axis] for place in places) for axis in range(3)]
    return low, [max(place[axis] for place in places) - low[axis] for axis in range(3)]


def as_float(number):
    return struct.unpack("f", struct.pack("f", number))[0]


def moved_into(box, places):
    """Where the foreign file has the model, to the last bit, so that nothing but the reading differs: its
    box tells the unit, and whether z is up."""
    for turned in (places, [(x, z, -y) for x, y, z in places]):
        low, size = box_of(turned)
        scale = max(box[1]) / max(size)
        if not all(abs(a * scale - b) < 1e-4 * max(box[1]) for a, b in zip(size, box[1])):
            continue
        if max(abs(b - a * scale) for a, b in zip(low, box[0])) > 1e-6 * max(box[1]):
            continue
        scale = as_float(round(scale, 4))  # 1, or 0.01 for centimetres
        return [tuple(as_float(x) * scale for x in place) for place in turned]
    return None


def probes_of(places, faces):
    """Small triangles above the middles of the faces: what they see does not depend on the seams that
    a format makes."""
    size = max(box_of(places)[1])
    corners, triangles = [], []
    for face in faces[::len(faces) // 400 + 1]:
        a, b, c = (places[corner] for corner in face)
        u, v = ([q - p for p, q in zip(a, other)] for other in (b, c))
        normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
        area, edge = sum(x * x for x in normal) ** 0.5, sum(x * x for x in u) ** 0.5
        if area < 1e-9 * size * size:
            continue
        middle = [sum(p) / 3 + 1e-3 * size * n / area for *p, n in zip(a, b, c, normal)]
        along = [1e-3 * size * x / edge for x in u]
        across = [1e-3 * size * (n * w - m * o) / area for n, w, m, o in
                  ((normal[1], along[2], normal[2], along[1]), (normal[2], along[0], normal[0], along[2]),
                   (normal[0], along[1], normal[1], along[0]))]
        first = len(corners)
        corners += [tuple(middle), tuple(p + q for p, q in zip(middle, along)),
                    tuple(p + q for p, q in zip(middle, across))]
        triangles.append((first, first + 1, first + 2))
    return corners, triangles


def export(obj, places, faces, kind, path):
    """By assimp, but for 3MF, whose coordinates it rounds to six digits; of its FBX it can read the text
    alone."""
    if kind != "3mf":
        subprocess.run(["assimp", "export", str(obj), str(path), *(["-ffbxa"] if kind == "fbx" else [])],
                       stdout=subprocess.DEVNULL, check=True)
        return
    vertices = "".join(f'<vertex x="{x!r}" y="{y!r}" z="{z!r}"/>' for x, y, z in places)
    triangles = "".join(f'<triangle v1="{a}" v2="{b}" v3="{c}"/>' for a, b, c in faces)
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as package:
        package.writestr("[Content_Types].xml", '<Types xmlns="http://schemas.openxmlformats.org/'
                         'package/2006/content-types"><Default Extension="rels" ContentType="application/'
                         'vnd.openxmlformats-package.relationships+xml"/><Default Extension="model" '
                         'ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>')
        package.writestr("_rels/.rels", '<Relationships xmlns="http://schemas.openxmlformats.org/package/'
                         '2006/relationships"><Relationship Id="a" Target="/3D/3dmodel.model" Type="http://'
                         'schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>')
        package.writestr("3D/3dmodel.model", '<model unit="millimeter" xmlns="http://schemas.microsoft.com/'
                         '3dmanufacturing/core/2015/02"><resources><object id="1" type="model"><mesh>'
                         f"<vertices>{vertices}</vertices><triangles>{triangles}</triangles></mesh></object>"
                         '</resources><build><item objectid="1"/></build></model>')


def pair(surfelao, model, kind, temporary, made):
    """An OBJ by our own reader against what assimp writes of it in another format."""
    places, faces = read_obj(model)
    bare, other = made / "bare.obj", made / f"{model.stem}.{kind}"
    write_obj(bare, places, faces)
    export(bare, places, faces, kind, other)
    row = {"model": model.name, "format": kind}
    there = bake(surfelao, other, temporary, "--quality", "draft")
    moved = moved_into(box_of([place for place, _ in there]), places) if there else None
    if not moved:
        fault(f"{other.name} stands otherwise than {model.name}")
        return row
    write_obj(bare, moved, faces)
    probes = made / "probes.obj"
    write_obj(probes, *probes_of(moved, faces))
    own, foreign = (bake(surfelao, probes, temporary, "--occluders", path) for path in (bare, other))
    differences = [abs(a - b) for (_, a), (_, b) in zip(own, foreign)]
    if max(differences) > TOLERANCE:
        fault(f"{model.name} and {other.name} differ by {max(differences):.4f}")
    return {**row, "places": len(differences), "occlusion": sum(value for _, value in own) / len(own),
            "largest": max(differences), "mean": sum(differences) / len(differences)}


# ---- broken files


NUMBER = re.compile(rb"\d+")
HOSTILE_NUMBERS = (b"-1", b"99999999", b"4294967295", b"1e39", b"nan")
HOSTILE_WORDS = (0, 1, 0x10000, 0x7fffffff, 0xffffffff)


def mutate(data, chance):
    """One to three changes: few enough that what is behind the first check is reached as well."""
    data = bytearray(data)
    for _ in range(chance.randint(1, 3)):
        at = chance.randrange(max(len(data), 1))
        kind = chance.randrange(8)
        number = NUMBER.search(data, at)
        if kind < 4 and number and b"\0" not in data:  # a number of a text
            data[number.start():number.end()] = (
                chance.choice(HOSTILE_NUMBERS) if kind == 0 else str(chance.randrange(200)).encode())
        elif kind < 4 and at < len(data):
            data[at] = chance.randrange(256)
        elif kind == 4:
            data[at:at + 4] = struct.pack("<I", chance.choice(HOSTILE_WORDS))
        elif kind == 5:
            del data[at:at + chance.randint(1, 64)]
        elif kind == 6:
            data[at:at] = data[at:at + chance.randint(1, 64)]
        else:
            del data[len(data) - 1 - chance.randrange(len(data) // 8 + 1):]
    return bytes(data)


def mutants(surfelao, files, temporary, folder):
    chance = random.Random(1)
    small = [path for path in files if path.stat().st_size < 300_000]
    result = {"count": MUTANTS, "read": 0, "refused": 0, "crashed": 0, "too_long": 0, "too_large": 0,
              "peak_mib": 0.0, "longest_seconds": 0.0}
    for i in range(MUTANTS):
        original = small[i % len(small)]
        path = folder / f"mutant{original.suffix.lower()}"
        path.write_bytes(mutate(original.read_bytes(), chance))
        output = temporary / "result.glb"
        code, _, complaint, seconds, peak = run(surfelao, "bake", path, "-o", output, "--quality",
                                                "draft", "--check", "0", "--values", "point",
                                                temporary=temporary)
        if code == 0:
            result["read"] += 1
            output.unlink()
        else:
            sentence = check_refusal(path, code, complaint)
            result["crashed"] += "crashed" in sentence
            result["too_long"] += "took" in sentence
            result["too_large"] += "memory" in sentence
            result["refused"] += 1
        if code not in (0, 1):
            shutil.copy(path, folder / f"fault_{i}{path.suffix}")
        left = list(temporary.iterdir())
        if left:
            fault(f"mutant {i} of {original.name} leaves {left[0].name}")
            for file in left:
                file.unlink()
        if peak > LIMIT + 200 * path.stat().st_size:
            fault(f"mutant {i} of {original.name} takes {peak >> 20} MiB")
        result["peak_mib"] = max(result["peak_mib"], peak / (1 << 20))
        result["longest_seconds"] = max(result["longest_seconds"], seconds)
    return result


def main(build):
    surfelao = pathlib.Path(build).resolve() / "bin/surfelao"
    with tempfile.TemporaryDirectory() as name:
        temporary, made = pathlib.Path(name) / "tmp", pathlib.Path(name) / "made"
        temporary.mkdir()
        made.mkdir()
        formats = {kind: files_of(extensions) for kind, extensions in FORMATS.items()}
        files = {kind: [tell(surfelao, path, temporary) for path in paths]
                 for kind, paths in formats.items()}
        pairs = [pair(surfelao, MODELS / model, kind, temporary, made)
                 for model in PAIRED for kind in ("fbx", "dae", "3ds", "x3d", "3mf")]
        every = [path for paths in formats.values() for path in paths]
        print(json.dumps({"files": files, "pairs": pairs,
                          "mutants": mutants(surfelao, every, temporary, made)}, indent=1))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))

#!/usr/bin/python3
"""prove.py: what users see of a result where they open it, without a window and without a GPU.

    prove.py BINARY OUT [--before BINARY]

Bakes two meshes (the scan data/models/bunny.obj and a corner of a room) to .glb, .gltf, .ply and
.obj with default options, opens each in three.js (in chromium) and in Blender, and compares the
mean light of the picture with the mean visibility that the result holds for the same pixels: exit 1
where they differ by more than .01, or where the Khronos validator finds an error. With --before also as another version of the program writes
them. And:

    others     the scan's .glb in Godot and in <model-viewer>, which only lights
    textured   the corner with a texture, before and after: is its colour its own unlit and under
               direct light, does its occlusion show under ambient light?
    bent       --colors bent, and whether three.js has the attribute _bent_normal
    maps       --at texels, over new texture coordinates, in three.js under ambient light alone and
               at Blender's Occlusion socket, against the visibility that a bake of vertices holds

    valid      the Khronos validator on every .glb and .gltf that was baked

Writes OUT/viewers.json, the sheets OUT/*.png, all single pictures in OUT/pictures, and OUT/modules,
what npm installs. A minute. Not part of the tests: needs blender, chromium, godot3, nodejs, npm,
xvfb, python3-numpy, python3-pil, and the network for npm; exit 77 where a program is absent.
"""

import argparse
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys

import numpy as np

sys.dont_write_bytecode = True
import inputs  # noqa: E402
import pictures  # noqa: E402

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent.parent
SIZE = 480
FORMATS = ("glb", "gltf", "ply", "obj")
TOLERANCE = 0.01  # of a mean visibility on the screen
MODULES = ("three", "puppeteer-core", "@google/model-viewer", "gltf-validator")
PROGRAMS = ("blender", "chromium", "godot3", "node", "npm", "xvfb-run")
PAGES = {"three": "three.html", "model-viewer": "model_viewer.html"}


def run(*command, **options):
    words = [str(word) for word in command]
    done = subprocess.run(words, capture_output=True, text=True, **options)
    if done.returncode:
        raise RuntimeError(f"{' '.join(words)}:\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    return done.stdout


def camera_for(positions, azimuth, elevation):
    """Orthographic, y up, the whole model with a margin: unit vectors, center, half the side."""
    azimuth, elevation = np.radians([azimuth, elevation])
    back = np.array([np.sin(azimuth) * np.cos(elevation), np.sin(elevation),
                     np.cos(azimuth) * np.cos(elevation)])
    right = np.array([np.cos(azimuth), 0, -np.sin(azimuth)])
    low, high = positions.min(0), positions.max(0)
    return {"center": ((low + high) / 2).tolist(), "half": float(np.linalg.norm(high - low) * 0.42),
            "right": right.tolist(), "up": np.cross(back, right).tolist(), "back": back.tolist()}


class Proof:
    """Collects jobs, so that each program starts once."""

    def __init__(self, binary, out):
        self.binary, self.out = binary, out
        self.jobs = {"browser": [], "blender": [], "godot": []}
        self.said = {}
        for folder in ("input", "pictures"):
            (out / folder).mkdir(parents=True, exist_ok=True)

    def bake(self, source, target, *options, binary=None):
        target.parent.mkdir(parents=True, exist_ok=True)
        run(binary or self.binary, "bake", source, "-o", target, *options)
        return target

    def draw(self, program, file, show, camera):
        """The path of a picture to be drawn by draw_all()."""
        where = "-".join(file.relative_to(self.out).with_suffix("").parts)
        picture = self.out / "pictures" / f"{where}-{file.suffix[1:]}-{program}-{show}.png"
        page = PAGES.get(program)
        self.jobs["browser" if page else program].append(
            {"page": page, "file": str(file), "show": show, "camera": camera, "size": SIZE,
             "picture": str(picture)})
        return picture

    def draw_all(self):
        answers = [*self.draw_in_browser(), *self.draw_in_blender(), *self.draw_in_godot()]
        self.said = {pathlib.Path(answer["picture"]): answer for answer in answers}

    def draw_in_browser(self):
        modules = self.out / "modules"
        if not all((modules / "node_modules" / name).exists() for name in MODULES):
            modules.mkdir(exist_ok=True)
            run("npm", "install", "--prefix", modules, "--no-audit", "--no-fund", "--legacy-peer-deps",
                *MODULES)
        jobs = self.out / "browser.json"
        jobs.write_text(json.dumps(self.jobs["browser"]))
        return json.loads(run("node", HERE / "browser.mjs", jobs, modules / "node_modules").splitlines()[-1])

    def draw_in_blender(self):
        jobs, said = self.out / "blender.json", self.out / "blender_said.json"
        jobs.write_text(json.dumps(self.jobs["blender"]))
        run("xvfb-run", "-a", "blender", "--background", "--factory-startup", "--python-exit-code", 1,
            "--python", HERE / "blender_view.py", "--", jobs, said,
            env={**os.environ, "PATH": "/usr/bin:" + os.environ["PATH"]})  # its Python is the first there
        return json.loads(said.read_text())

    def draw_in_godot(self):
        """Models become part of a project, which the editor imports and the game shows."""
        project = self.out / "godot"
        shutil.rmtree(project, ignore_errors=True)
        shutil.copytree(HERE / "godot", project)
        jobs = []
        for number, job in enumerate(self.jobs["godot"]):  # each its own: a job changes materials
            name = f"{number}{pathlib.Path(job['file']).suffix}"
            shutil.copyfile(job["file"], project / name)
            jobs.append({**job, "file": name})
        (project / "jobs.json").write_text(json.dumps(jobs))
        command = ["xvfb-run", "-a", "-s", "-screen 0 800x800x24", "godot3", "--audio-driver", "Dummy",
                   "--path", project]
        home = {**os.environ, "HOME": str(project)}
        run(*command, "--editor", "--quit", env=home, timeout=300)
        version = re.search(r"v([\d.]+)\.", run(*command, env=home, timeout=300)).group(1)
        return [{"picture": job["picture"], "program": f"Godot {version}"} for job in jobs]

    def validated(self):
        """[(file, number of errors, the first of them)] of all baked glTF files."""
        files = sorted(file for file in (self.out / "after").iterdir() if file.suffix in (".glb", ".gltf"))
        modules = self.out / "modules/node_modules"
        answers = json.loads(run("node", HERE / "validate.mjs", modules, *files))
        return [{"file": pathlib.Path(answer["file"]).name, "errors": answer["errors"],
                 "first": answer["first"]} for answer in answers]

    def row(self, picture, truth, bare=None, **others):
        return {"program": self.said[picture]["program"], **others,
                **pictures.against(picture, truth, bare)}


# ---- parts: each notes its pictures and returns a function that judges them once they are drawn


def part_formats(proof, name, mesh, camera, before):
    """The same vertices in every format: rows of screen against truth; and the results."""
    sources = {form: proof.out / "input" / f"{name}.{form}" for form in ("obj", "glb", "gltf")}
    inputs.write_obj(sources["obj"], *mesh)
    for form in ("glb", "gltf"):
        inputs.untextured(*mesh).write(sources[form])
    sources["ply"] = sources["obj"]
    results, drawn = {}, {}
    for when, binary in (("before", before), ("after", proof.binary)):
        for form in FORMATS if binary else ():
            result = proof.bake(sources[form], proof.out / when / f"{name}.{form}", binary=binary)
            results[when, form] = result
            for program, show in (("three", "unlit"), ("blender", "attribute")):
                drawn[when, program, form] = proof.draw(program, result, show, camera)

    def judge():
        truths = {when: pictures.visibility(pictures.read_glb(results[when, "glb"]), camera, SIZE)
                  for when in ("before", "after") if (when, "glb") in results}
        wanted = proof.out / f"pictures/{name}-holds.png"
        pictures.save_grey(truths["after"], wanted)
        pictures.sheet(proof.out / f"{name}.png", [
            (f"{when}\n{program}", [*((form, drawn[when, program, form]) for form in FORMATS),
                                    ("what it holds", wanted)])
            for when in truths for program in ("three", "blender")], side=160)
        return {"formats": [proof.row(picture, truths[when], model=name, when=when, format=form)
                            for (when, _, form), picture in drawn.items()]}

    return judge, results["after", "glb"]


def part_others(proof, source, result, camera):
    """Godot as imported and with its switch; <model-viewer>, lit, the source beside the result."""
    bare = proof.draw("godot", source, "imported", camera)
    godot = {show: proof.draw("godot", result, show, camera) for show in ("imported", "albedo")}
    viewer = {name: proof.draw("model-viewer", file, "lit", camera)
              for name, file in (("source", source), ("result", result))}

    def judge():
        truth = pictures.visibility(pictures.read_glb(result), camera, SIZE)
        pictures.sheet(proof.out / "others.png", [("", [
            ("Godot, as imported", godot["imported"]), ("Godot, Use As Albedo", godot["albedo"]),
            ("model-viewer, source", viewer["source"]), ("model-viewer, result", viewer["result"])])])
        return {"others": [*(proof.row(picture, truth, bare, show=show) for show, picture in godot.items()),
                           {"program": proof.said[viewer["result"]]["program"], "show": "lit",
                            "changed": pictures.difference(*viewer.values())}]}

    return judge


def part_textured(proof, scene, camera):
    """The colours of source and result under each light; the occlusion that ambient light shows."""
    source = proof.out / "input/textured.glb"
    inputs.textured(*scene).write(source)
    result = proof.bake(source, proof.out / "after/textured.glb")
    shows = {"three": ("unlit", "direct", "ambient"), "blender": ("texture", "occlusion"),
             "godot": ("imported", "uv2"), "model-viewer": ("lit",)}
    drawn = {(program, show, name): proof.draw(program, file, show, camera)
             for program, of_program in shows.items() for show in of_program
             for name, file in (("source", source), ("result", result))
             if show not in ("occlusion", "uv2") or name == "result"}

    def judge():
        truth = pictures.visibility(pictures.read_glb(result), camera, SIZE)
        rows = []
        for program, show in ((program, show) for program in shows for show in shows[program]):
            picture = drawn[program, show, "result"]
            bare = drawn.get((program, "imported" if show == "uv2" else show, "source"))
            if show in ("occlusion", "ambient", "imported", "uv2"):
                rows.append(proof.row(picture, truth, bare, show=show))
            else:
                rows.append({"program": proof.said[picture]["program"], "show": show,
                             "changed": pictures.difference(picture, bare)})
        pictures.sheet(proof.out / "textured.png", [
            (name, [(f"{program} {show}", drawn.get((program, show, name)))
                    for program, of_program in shows.items() for show in of_program])
            for name in ("source", "result")], side=130)
        return {"textured": rows}

    return judge


def part_bent(proof, name, camera):
    """Bent normals as colours, and which attributes the programs have."""
    drawn = {}
    for origin, form in (("glb", "glb"), ("obj", "ply")):
        result = proof.bake(proof.out / f"input/{name}.{origin}", proof.out / f"after/bent.{form}",
                            "--colors", "bent")
        for program, show in (("three", "unlit"), ("blender", "attribute")):
            drawn[program, form] = proof.draw(program, result, show, camera)

    def judge():
        pictures.sheet(proof.out / "bent.png", [("", [
            (f"{program}, {form}", picture) for (program, form), picture in drawn.items()])])
        return {"bent": [{"program": proof.said[picture]["program"], "format": form,
                          "attributes": sorted(proof.said[picture]["attributes"])}
                         for (_, form), picture in drawn.items()]}

    return judge


def part_maps(proof, name, camera):
    """A map over charts of our own, as .glb and as .gltf with the picture beside it."""
    drawn = {}
    bare = proof.draw("three", proof.out / f"input/{name}.glb", "ambient", camera)  # 2 % is specular
    for form in ("glb", "gltf"):
        result = proof.bake(proof.out / f"input/{name}.{form}", proof.out / f"after/{name}-map.{form}",
                            "--at", "texels", "--uv", "new")
        for program, show in (("three", "ambient"), ("blender", "occlusion")):
            drawn[program, form] = proof.draw(program, result, show, camera)

    def judge():
        truth = pictures.visibility(pictures.read_glb(proof.out / f"after/{name}.glb"), camera, SIZE)
        pictures.sheet(proof.out / f"{name}-map.png", [("", [
            (f"{program}, {form}", picture) for (program, form), picture in drawn.items()])])
        return {"maps": [proof.row(picture, truth, bare if program == "three" else None, model=name,
                                   format=form) for (program, form), picture in drawn.items()]}

    return judge


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("binary", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--before", type=pathlib.Path)
    arguments = parser.parse_args()
    absent = [program for program in PROGRAMS if not shutil.which(program)]
    if absent:
        print(f"prove.py: no {', '.join(absent)}", file=sys.stderr)
        return 77
    before = arguments.before and arguments.before.resolve()
    proof = Proof(arguments.binary.resolve(), arguments.out.resolve())
    bunny = inputs.read_obj(ROOT / "data/models/bunny.obj")
    corner = inputs.corner()
    at_bunny, at_corner = camera_for(bunny[0], 25, 15), camera_for(corner[0], 40, 25)
    judge_bunny, result = part_formats(proof, "bunny", bunny, at_bunny, before)
    judge_corner, _ = part_formats(proof, "corner", corner[:2], at_corner, before)
    judges = [judge_bunny, judge_corner,
              part_others(proof, proof.out / "input/bunny.glb", result, at_bunny),
              part_textured(proof, corner, at_corner), part_bent(proof, "bunny", at_bunny),
              part_maps(proof, "bunny", at_bunny), part_maps(proof, "corner", at_corner)]
    proof.draw_all()
    shown = {}
    for judge in judges:
        for part, rows in judge().items():
            shown.setdefault(part, []).extend(rows)
    shown["valid"] = proof.validated()
    (proof.out / "viewers.json").write_text(json.dumps(shown, indent=1))
    print(json.dumps(shown, indent=1))
    wrong = [row for row in shown["formats"] + shown["maps"]
             if row.get("when") != "before" and abs(row["difference"]) > TOLERANCE]
    for row in wrong:
        print(f"prove.py: {row['model']}.{row['format']} in {row['program']}: {row['screen']:.3f} instead "
              f"of {row['truth']:.3f}", file=sys.stderr)
    invalid = [row for row in shown["valid"] if row["errors"]]
    for row in invalid:
        print(f"prove.py: {row['file']}: {row['errors']} errors, {row['first']}", file=sys.stderr)
    return 1 if wrong or invalid else 0


if __name__ == "__main__":
    sys.exit(main())

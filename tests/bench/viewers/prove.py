#!/usr/bin/python3
"""prove.py: what users see of a result where they open it, without a window and without a GPU.

    prove.py BINARY OUT [MODEL.obj]     about three minutes; default: data/models/bunny.obj

Bakes one model to .glb, .gltf, .ply and .obj with default options, opens each in three.js (in
chromium) and in Blender, and compares the mean light of the picture with the mean visibility that
the result holds for the same pixels. Then a textured scene: is its colour still its own under
direct light, does its occlusion show under ambient light? And bent normals as colours.

Writes OUT/viewers.json and, with all single pictures in OUT, the sheets formats.png, textured.png
and bent.png; and OUT/modules, what npm installs. Not part of the tests: needs blender, chromium,
nodejs, npm, xvfb, python3-numpy, python3-pil, and the network for npm.
"""

import json
import pathlib
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
MODULES = ("three", "puppeteer-core", "@google/model-viewer")
PROGRAMS = ("blender", "chromium", "node", "npm", "xvfb-run")


def run(*command, **options):
    words = [str(word) for word in command]
    done = subprocess.run(words, capture_output=True, text=True, **options)
    if done.returncode:
        raise RuntimeError(f"{' '.join(words)}:\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    return done


def camera_for(positions, azimuth, elevation):
    """Orthographic, y up; the whole model with a margin."""
    azimuth, elevation = np.radians([azimuth, elevation])
    back = np.array([np.sin(azimuth) * np.cos(elevation), np.sin(elevation),
                     np.cos(azimuth) * np.cos(elevation)])
    right = np.array([np.cos(azimuth), 0, -np.sin(azimuth)])
    low, high = positions.min(0), positions.max(0)
    return {"center": ((low + high) / 2).tolist(), "half": float(np.linalg.norm(high - low) * 0.42),
            "right": right.tolist(), "up": np.cross(back, right).tolist(), "back": back.tolist()}


class Proof:
    def __init__(self, binary, out):
        self.binary, self.out = binary, out
        self.jobs = {"browser": [], "blender": []}
        self.said = {}

    def bake(self, source, target, *options):
        target.parent.mkdir(parents=True, exist_ok=True)
        run(self.binary, "bake", source, "-o", target, *options)
        return target

    def draw(self, program, file, show, camera):
        """Notes a picture to be drawn by draw_all(); its path."""
        picture = self.out / f"{program}-{file.parent.name}-{file.suffix[1:]}-{show}.png"
        page = {"three": "page.html", "model-viewer": "model_viewer.html"}.get(program)
        self.jobs["browser" if page else program].append(
            {"page": page, "file": str(file), "show": show, "camera": camera, "size": SIZE,
             "picture": str(picture)})
        return picture

    def draw_all(self):
        for program, jobs in self.jobs.items():
            (self.out / f"{program}.json").write_text(json.dumps(jobs))
        modules = self.out / "modules"
        if not all((modules / "node_modules" / name).exists() for name in MODULES):
            modules.mkdir(exist_ok=True)
            run("npm", "install", "--prefix", modules, "--no-audit", "--no-fund", "--legacy-peer-deps",
                *MODULES)
        done = run("node", HERE / "browser.mjs", self.out / "browser.json", modules / "node_modules")
        answers = json.loads(done.stdout.splitlines()[-1])
        said = self.out / "blender_said.json"
        run("xvfb-run", "-a", "blender", "--background", "--factory-startup", "--python-exit-code", 1,
            "--python", HERE / "blender_view.py", "--", self.out / "blender.json", said)
        answers += json.loads(said.read_text())
        self.said = {pathlib.Path(answer["picture"]): answer for answer in answers}


def main(arguments):
    if len(arguments) not in (2, 3):
        print(__doc__, file=sys.stderr)
        return 2
    absent = [program for program in PROGRAMS if not shutil.which(program)]
    if absent:
        print(f"prove.py: no {', '.join(absent)}", file=sys.stderr)
        return 77
    binary, out = (pathlib.Path(word).resolve() for word in arguments[:2])
    model = pathlib.Path(arguments[2]) if len(arguments) == 3 else ROOT / "data/models/bunny.obj"
    out.mkdir(parents=True, exist_ok=True)
    proof = Proof(binary, out)

    # the same vertices in every format
    positions, triangles = inputs.read_obj(model)
    source = out / "input"
    source.mkdir(exist_ok=True)
    shutil.copyfile(model, source / "model.obj")
    for suffix in (".glb", ".gltf"):
        inputs.untextured(positions, triangles).write(source / f"model{suffix}")
    camera = camera_for(positions, 25, 15)
    origin = {"glb": "model.glb", "gltf": "model.gltf", "ply": "model.obj", "obj": "model.obj"}
    results = {form: proof.bake(source / origin[form], out / "model" / f"model.{form}") for form in FORMATS}
    formats = {(program, form): proof.draw(program, results[form], show, camera) for program, show in
               (("three", "unlit"), ("blender", "attribute")) for form in FORMATS}

    proof.draw_all()
    truth = pictures.visibility(pictures.read_glb(results["glb"]), camera, SIZE)
    pictures.save_grey(truth, out / "truth.png")
    rows = [{"program": proof.said[picture]["program"], "format": form, **pictures.against(picture, truth)}
            for (_, form), picture in formats.items()]
    print(json.dumps(rows, indent=1))
    pictures.sheet(out / "formats.png", [
        (program, [(form, formats[program, form]) for form in FORMATS]) for program in ("three", "blender")])
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

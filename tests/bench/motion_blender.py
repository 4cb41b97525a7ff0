"""motion_blender.py: whether animated glTF files stand as in Blender at the same moment.

    blender --background --factory-startup --python tests/bench/motion_blender.py -- SURFELAO FILE...

Every file's first animation at five moments: the pose that `bake --time` writes beside what Blender's
importer makes of the file at that frame. A line for each: the largest distance of a vertex of either to
the nearest of the other, as a share of the diagonal. Exit 1 above kMost.
"""

import math
import os
import subprocess
import sys
import tempfile

import bpy
import numpy
from mathutils.kdtree import KDTree

numpy.bool = bool  # Debian 12: Blender's glTF importer calls it so, its numpy does not
kMost = 1e-3  # between keys Blender mixes quaternions, glTF turns evenly: .0008 at keys 45 degrees apart
kMoments = 5


def tree_of(points):
    tree = KDTree(len(points))
    for number, point in enumerate(points):
        tree.insert(point, number)
    tree.balance()
    return tree


def largest_distance(points, others):
    tree = tree_of(others)
    return max(tree.find(point)[2] for point in points)


def ours(program, path, seconds):
    with tempfile.TemporaryDirectory() as folder:
        pose = os.path.join(folder, "pose.obj")
        subprocess.run([program, "bake", path, "-o", pose, "--time", str(seconds), "--engine", "rays",
                        "--rays", "2"], check=True, capture_output=True)
        with open(pose) as file:
            return [tuple(map(float, line.split()[1:4])) for line in file if line.startswith("v ")]


def theirs(seconds):
    """Of all meshes, y up again."""
    scene = bpy.context.scene
    frame = seconds * scene.render.fps
    scene.frame_set(math.floor(frame), subframe=frame - math.floor(frame))
    graph = bpy.context.evaluated_depsgraph_get()
    points = []
    for instance in graph.object_instances:
        if instance.object.type != "MESH":
            continue
        for vertex in instance.object.data.vertices:
            x, y, z = instance.matrix_world @ vertex.co
            points.append((x, z, -y))
    return points


def main(program, files):
    worst = 0.0
    for path in files:
        bpy.ops.wm.read_factory_settings(use_empty=True)
        bpy.ops.import_scene.gltf(filepath=path)
        length = max(action.frame_range[1] for action in bpy.data.actions) / bpy.context.scene.render.fps
        for moment in range(kMoments):
            seconds = length * (moment + 0.37) / kMoments
            a, b = ours(program, path, seconds), theirs(seconds)
            low, high = numpy.min(a, axis=0), numpy.max(a, axis=0)
            share = max(largest_distance(a, b), largest_distance(b, a)) / numpy.linalg.norm(high - low)
            worst = max(worst, share)
            print(f"{os.path.basename(path)} at {seconds:.3f} s: {share:.2e} of the diagonal, "
                  f"{len(a)} and {len(b)} vertices")
    return worst <= kMost


words = sys.argv[sys.argv.index("--") + 1:]
sys.exit(0 if main(words[0], words[1:]) else 1)

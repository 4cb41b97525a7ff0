"""blender_bake.py: Cycles bakes ambient occlusion over an OBJ's own coordinates and normals.

    blender -b --factory-startup --python blender_bake.py -- IN.obj OUT.exr SIZE SAMPLES THREADS

Prints "BAKED {JSON}" with the seconds of the bake alone and how far, in degrees, its normals are off
those of the file. Blender 3.4; margins as Blender's users have them by default.
"""

import json
import math
import sys
import time

import bpy


def normals_of(path):
    """The file's normals, corner by corner."""
    normals, corners = [], []
    with open(path) as file:
        for line in file:
            words = line.split()
            if words[:1] == ["vn"]:
                normals.append(tuple(map(float, words[1:])))
            elif words[:1] == ["f"]:
                corners += [int(word.split("/")[2]) - 1 for word in words[1:]]
    return [normals[corner] for corner in corners]


def largest_turn(mesh, normals):
    mesh.calc_normals_split()
    if len(mesh.loops) != len(normals):
        raise SystemExit(f"{len(normals)} corners became {len(mesh.loops)}")
    least = min(sum(a * b for a, b in zip(loop.normal, normal))
                for loop, normal in zip(mesh.loops, normals))
    return math.degrees(math.acos(max(-1.0, min(1.0, least))))


def main(path, out, size, samples, threads):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.wm.obj_import(filepath=path, forward_axis="Y", up_axis="Z", validate_meshes=False)
    body = next(item for item in bpy.context.scene.objects if item.type == "MESH")
    bpy.context.view_layer.objects.active = body
    body.select_set(True)
    body.data.use_auto_smooth = True

    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.render.threads_mode = "FIXED"
    scene.render.threads = threads
    scene.cycles.device = "CPU"
    scene.cycles.samples = samples
    scene.cycles.use_adaptive_sampling = False
    scene.cycles.use_denoising = False
    scene.world = bpy.data.worlds.new("world")
    scene.world.light_settings.distance = 100.0 * max(body.dimensions)

    image = bpy.data.images.new("ao", size, size, float_buffer=True)
    image.colorspace_settings.name = "Non-Color"
    material = bpy.data.materials.new("ao")
    material.use_nodes = True
    node = material.node_tree.nodes.new("ShaderNodeTexImage")
    node.image = image
    material.node_tree.nodes.active = node
    body.data.materials.clear()
    body.data.materials.append(material)

    start = time.monotonic()
    bpy.ops.object.bake(type="AO", margin=16, margin_type="ADJACENT_FACES", use_clear=True)
    seconds = time.monotonic() - start
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.view_settings.view_transform = "Raw"
    image.save_render(out, scene=scene)
    print("BAKED", json.dumps({"seconds": seconds,
                               "turned_deg": largest_turn(body.data, normals_of(path))}))


path, out, size, samples, threads = sys.argv[sys.argv.index("--") + 1:]
main(path, out, int(size), int(samples), int(threads))

"""blender_view.py: draws jobs in Blender's viewport engine, or its node that holds the occlusion.

    xvfb-run blender --background --factory-startup --python blender_view.py -- JOBS.json

Imports as File > Import does, with every option as it stands. `show` of a job:
    attribute   Solid shading, Color: Attribute, Lighting: Flat
    texture     the same with Color: Texture
    occlusion   what the importer has linked to the Occlusion socket of the glTF output, as emission
"""

import json
import sys

import bpy
import numpy
from mathutils import Matrix, Vector

numpy.bool = bool  # Debian 12: Blender's glTF importer calls it so, its numpy does not

IMPORT = {
    "glb": lambda path: bpy.ops.import_scene.gltf(filepath=path),
    "gltf": lambda path: bpy.ops.import_scene.gltf(filepath=path),
    "obj": lambda path: bpy.ops.wm.obj_import(filepath=path),
    "ply": lambda path: bpy.ops.import_mesh.ply(filepath=path),
}
STANDS_UP = Matrix.Rotation(1.5707963267948966, 4, "X")  # y up to z up; PLY is taken as it is


def add_camera(job, suffix):
    view = job["camera"]
    center, right, up, back = (Vector(view[key]) for key in ("center", "right", "up", "back"))
    place = Matrix((right, up, back)).transposed().to_4x4()
    place.translation = center + back * 4 * view["half"]
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.data.type = "ORTHO"
    camera.data.ortho_scale = 2 * view["half"]
    camera.data.clip_end = 8 * view["half"]
    camera.matrix_world = place if suffix == "ply" else STANDS_UP @ place
    bpy.context.collection.objects.link(camera)
    bpy.context.scene.camera = camera


def show_flat(scene, color):
    scene.render.engine = "BLENDER_WORKBENCH"
    scene.display.render_aa = "OFF"
    scene.display.shading.light = "FLAT"
    scene.display.shading.color_type = color
    scene.display.shading.show_object_outline = False


def show_occlusion(scene):
    scene.render.engine = "CYCLES"
    scene.cycles.samples = 1
    scene.cycles.use_denoising = False
    scene.cycles.pixel_filter_type = "BOX"
    scene.cycles.filter_width = 0.01
    for material in bpy.data.materials:
        tree = material.node_tree
        if not tree:
            continue
        emission = tree.nodes.new("ShaderNodeEmission")
        for node in tree.nodes:
            if node.type == "GROUP" and "Occlusion" in node.inputs and node.inputs["Occlusion"].links:
                tree.links.new(node.inputs["Occlusion"].links[0].from_socket, emission.inputs["Color"])
        output = next(node for node in tree.nodes if node.type == "OUTPUT_MATERIAL")
        tree.links.new(emission.outputs[0], output.inputs["Surface"])


def draw(job):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    suffix = job["file"].rsplit(".", 1)[1]
    IMPORT[suffix](job["file"])
    add_camera(job, suffix)
    scene = bpy.context.scene
    if job["show"] == "occlusion":
        show_occlusion(scene)
    else:
        show_flat(scene, {"attribute": "VERTEX", "texture": "TEXTURE"}[job["show"]])
    scene.view_settings.view_transform = "Standard"
    scene.render.film_transparent = True
    scene.render.dither_intensity = 0
    scene.render.resolution_x = scene.render.resolution_y = job["size"]
    scene.render.image_settings.color_mode = "RGBA"
    scene.render.filepath = job["picture"]
    bpy.ops.render.render(write_still=True)
    attributes = {attribute.name for mesh in bpy.data.meshes for attribute in mesh.attributes}
    return {"picture": job["picture"], "attributes": sorted(attributes),
            "program": f"Blender {bpy.app.version_string}"}


jobs, said = sys.argv[sys.argv.index("--") + 1:]
with open(jobs) as file:
    answers = [draw(job) for job in json.load(file)]
with open(said, "w") as file:
    json.dump(answers, file)

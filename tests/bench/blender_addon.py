"""Run by blender_addon.sh inside of Blender: blender --python blender_addon.py -- ADDON PROGRAM FOLDER

The scene: a floor, a turned and mirrored cube, a smooth ball, and a cylinder that is not selected. What
the add-on bakes must be what the program makes of the same triangles, written as OBJ.
"""
import importlib.util
import pathlib
import subprocess
import sys

import bpy
import numpy

addon_file, program, folder = sys.argv[sys.argv.index("--") + 1:]
folder = pathlib.Path(folder)
# colours hold 1 - occlusion in float: half a rounding near 1, and that of the sum
NEAR = 2e-7
# in OBJ v grows the other way: a texel whose centre lies on an edge is asked on the other triangle,
# a rounding of its place away
NEAR_IN_MAPS = 1e-3

spec = importlib.util.spec_from_file_location("surfelao_ambient_occlusion", addon_file)
addon = importlib.util.module_from_spec(spec)
spec.loader.exec_module(addon)
addon.register()


def build_scene():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    add = bpy.ops.mesh
    add.primitive_grid_add(size=6, x_subdivisions=12, y_subdivisions=12)
    floor = bpy.context.object
    add.primitive_cube_add(location=(1, 0, 1), rotation=(0, 0, 0.5))
    cube = bpy.context.object
    cube.scale.x = -1
    add.primitive_uv_sphere_add(segments=24, ring_count=12, location=(-1, 0, 1))
    ball = bpy.context.object
    bpy.ops.object.shade_smooth()
    add.primitive_cylinder_add(location=(0, 1.8, 1), depth=2)
    beside = bpy.context.object
    for each in (floor, cube, ball, beside):
        each.select_set(each is not beside)
    bpy.context.view_layer.update()
    return [floor, cube, ball], beside


def world(thing):
    depsgraph = bpy.context.evaluated_depsgraph_get()
    return addon.world_mesh(thing.evaluated_get(depsgraph), thing.matrix_world)


def write_obj(path, vertices, faces, normals=None, corners=None, uv=None):
    """Numbers to their last digit."""
    lines = ["v %r %r %r" % tuple(map(float, v)) for v in vertices]
    if normals is not None:
        lines += ["vn %.9g %.9g %.9g" % tuple(n) for n in numpy.float32(normals)]
    if uv is not None:
        lines += ["vt %.9g %.9g" % tuple(t) for t in uv]
    for f, face in enumerate(faces + 1):
        words = [str(v) for v in face]
        if corners is not None:
            words = ["%d/%s/%d" % (v, "" if uv is None else c, c) for v, c in zip(face, corners[f] + 1)]
        lines.append("f " + " ".join(words))
    path.write_text("\n".join(lines) + "\n")


def run_program(*arguments):
    subprocess.run([program, "bake", *map(str, arguments)], check=True, stdout=subprocess.DEVNULL)


def occlusion_of(ply):
    head, _, body = ply.read_bytes().partition(b"end_header\n")
    lines = head.split(b"\n")
    types = {b"float": "<f4", b"double": "<f8", b"uchar": "u1"}
    count = next(int(line.split()[2]) for line in lines if line.startswith(b"element vertex"))
    fields = [(line.split()[2].decode(), types[line.split()[1]])
              for line in lines if line.startswith(b"property") and b"list" not in line]
    return numpy.frombuffer(body, numpy.dtype(fields), count)["occlusion"]


def check(what, found, wanted, near):
    off = float(numpy.abs(found - wanted).max())
    print(f"{what}: {found.size} values, at most {off:.1e} from the program's, "
          f"{found.min():.3f} to {found.max():.3f}")
    assert found.size == wanted.size and off <= near, what
    assert found.max() - found.min() > 0.3, f"{what}: nothing is to be seen"


def check_attribute(objects, beside):
    settings = bpy.context.scene.surfelao
    settings.target, settings.max_distance = "ATTRIBUTE", 2.5
    assert bpy.ops.object.surfelao_bake() == {"FINISHED"}
    found = []
    for thing in objects:
        colors = addon.rows(thing.data.color_attributes[settings.attribute].data, "color", 4, "f4")
        assert (colors[:, 3] == 1).all() and (colors[:, 0] == colors[:, 2]).all()
        found.append(colors[:, 0])
    write_obj(folder / "in.obj", *addon.joined([world(thing) for thing in objects]))
    other = world(beside)
    write_obj(folder / "beside.obj", other.vertices, other.faces)
    run_program(folder / "in.obj", "-o", folder / "out.ply", "--occluders", folder / "beside.obj",
                "--max-distance", 2.5)
    check("attribute", numpy.concatenate(found), 1 - occlusion_of(folder / "out.ply"),
          NEAR)


def check_images(objects):
    settings = bpy.context.scene.surfelao
    settings.target, settings.size, settings.occluders = "IMAGE", 128, "SELECTED"
    assert bpy.ops.object.surfelao_bake() == {"FINISHED"}
    for thing in objects:
        image = bpy.data.images[f"{settings.attribute} {thing.name}"]
        found = numpy.empty(len(image.pixels), numpy.float32)
        image.pixels.foreach_get(found)
        mesh = world(thing)
        write_obj(folder / "in.obj", mesh.vertices, mesh.faces, mesh.normals, mesh.corners, mesh.uv)
        others = addon.joined([world(other) for other in objects if other is not thing])
        write_obj(folder / "beside.obj", *others[:2])
        run_program(folder / "in.obj", "-o", folder / "out.exr", "--at", "texels", "--size", 128,
                    "--uv", 0, "--depth", 32, "--occluders", folder / "beside.obj",
                    "--max-distance", 2.5)
        wanted = bpy.data.images.load(str(folder / "out.exr"))
        wanted.colorspace_settings.name = "Non-Color"
        pixels = numpy.empty(len(wanted.pixels), numpy.float32)
        wanted.pixels.foreach_get(pixels)
        check(image.name, found.reshape(-1, 4)[:, 0], pixels.reshape(-1, 4)[:, 0],
              NEAR_IN_MAPS)
        bpy.data.images.remove(wanted)


def check_refusals(cube):
    cube.modifiers.new("finer", "SUBSURF")
    try:
        bpy.ops.object.surfelao_bake()
    except RuntimeError as fault:
        assert "its modifiers change the number of vertices" in str(fault)
        print("refused:", str(fault).strip())
    else:
        raise AssertionError("a modifier that changes vertices was not refused")


selected, lone = build_scene()
check_attribute(selected, lone)
check_images(selected)
check_refusals(selected[1])
addon.unregister()
print("the add-on bakes what the program bakes")

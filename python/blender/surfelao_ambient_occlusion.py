"""Blender add-on: bakes ambient occlusion of the selected objects with the package surfelao.

Edit > Preferences > Add-ons > Install... takes this file. It stands in the sidebar of the 3D view, tab
"Surfelao", and bakes to a colour attribute of the vertices or to an image over the active UV map.
Values are visibility, 1 = open, as a colour in linear light.
"""
import bpy
import numpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, StringProperty

import surfelao

bl_info = {
    "name": "Surfelao Ambient Occlusion",
    "description": "Ambient occlusion with a known error, to colour attributes or images",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "View3D > Sidebar > Surfelao",
    "category": "Object",
}

HAVE_FACES = {"MESH", "CURVE", "SURFACE", "META", "FONT"}


def rows(collection, name, columns, kind):
    """(n, columns) of an attribute of Blender's collections."""
    values = numpy.empty(len(collection) * columns, kind)
    collection.foreach_get(name, values)
    return values.reshape(-1, columns)


class WorldMesh:
    """A mesh of Blender as arrays in world space."""

    def __init__(self, mesh, matrix):
        matrix = numpy.array(matrix)
        mesh.calc_normals_split()
        mesh.calc_loop_triangles()
        self.vertices = (rows(mesh.vertices, "co", 3, numpy.float32).astype(float) @ matrix[:3, :3].T
                         + matrix[:3, 3])
        self.faces = rows(mesh.loop_triangles, "vertices", 3, numpy.int32)
        self.corners = rows(mesh.loop_triangles, "loops", 3, numpy.int32)
        # of normals the cofactors: also where the matrix is flat along an axis
        x, y, z = matrix[:3, :3].T
        cofactors = numpy.stack([numpy.cross(y, z), numpy.cross(z, x), numpy.cross(x, y)], 1)
        mirror = -1 if numpy.linalg.det(matrix[:3, :3]) < 0 else 1
        self.normals = mirror * rows(mesh.loops, "normal", 3, numpy.float32) @ cofactors.T
        if mirror < 0:  # keep the outside outside
            self.faces, self.corners = self.faces[:, ::-1], self.corners[:, ::-1]
        self.uv = None
        if mesh.uv_layers.active:
            self.uv = rows(mesh.uv_layers.active.data, "uv", 2, numpy.float32)

    def normal_arguments(self):
        return {"normals": self.normals, "normal_faces": self.corners}


def joined(meshes):
    """Several as one: vertices, faces, normals, corners."""
    firsts = numpy.cumsum([0] + [len(mesh.vertices) for mesh in meshes])
    loops = numpy.cumsum([0] + [len(mesh.normals) for mesh in meshes])
    return (numpy.concatenate([mesh.vertices for mesh in meshes]),
            numpy.concatenate([mesh.faces + first for mesh, first in zip(meshes, firsts)]),
            numpy.concatenate([mesh.normals for mesh in meshes]),
            numpy.concatenate([mesh.corners + first for mesh, first in zip(meshes, loops)]))


def world_mesh(thing, matrix):
    """Of an evaluated object; None where it has no faces."""
    mesh = thing.to_mesh()
    if mesh is None:
        return None
    try:
        return WorldMesh(mesh, matrix) if len(mesh.polygons) > 0 else None
    finally:
        thing.to_mesh_clear()


def occluding_meshes(depsgraph, others_than):
    """All that is visible, instances too, but for these objects themselves."""
    meshes = []
    for instance in depsgraph.object_instances:
        thing = instance.object
        is_own = not instance.is_instance and thing.original in others_than
        if is_own or not instance.show_self or thing.type not in HAVE_FACES:
            continue
        mesh = world_mesh(thing, instance.matrix_world)
        if mesh is not None:
            meshes.append(mesh)
    return meshes


def occluders_of(meshes):
    return joined(meshes)[:2] if meshes else None


class SurfelaoSettings(bpy.types.PropertyGroup):
    target: EnumProperty(
        name="Target",
        items=[("ATTRIBUTE", "Color Attribute", "A value at each vertex"),
               ("IMAGE", "Image", "A map over the active UV map, one for each object")])
    attribute: StringProperty(name="Name", default="Ambient Occlusion",
                              description="Of the attribute or, with the object's name, the image")
    size: IntProperty(name="Size", default=1024, min=1, max=32768, subtype="PIXEL",
                      description="Texels of a side of the image")
    quality: FloatProperty(name="Quality", default=1.0, min=-1.0, max=4.0,
                           description="0 draft, 1 good, 2 best: time against error")
    max_distance: FloatProperty(name="Distance", default=0.0, min=0.0, unit="LENGTH",
                                description="What is farther away does not occlude; 0: everything does")
    ground: BoolProperty(name="Ground", description="An endless floor below the objects occludes too")
    occluders: EnumProperty(
        name="Occluders",
        items=[("VISIBLE", "All Visible", "Everything that is visible occludes"),
               ("SELECTED", "Selected", "Only the selected objects occlude")])

    def arguments(self):
        return {"quality": self.quality, "max_distance": self.max_distance or None,
                "ground": self.ground, "up": "z"}


class OBJECT_OT_surfelao_bake(bpy.types.Operator):
    """Bake ambient occlusion of the selected objects"""
    bl_idname = "object.surfelao_bake"
    bl_label = "Bake Ambient Occlusion"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return context.mode == "OBJECT" and any(o.type == "MESH" for o in context.selected_objects)

    def execute(self, context):
        objects = [o for o in context.selected_objects if o.type == "MESH"]
        settings = context.scene.surfelao
        window = context.window_manager
        window.progress_begin(0, 100)
        try:
            error = self.bake(context, objects, settings,
                              lambda stage, done: window.progress_update(100 * done))
        except (ValueError, RuntimeError) as fault:
            self.report({"ERROR"}, str(fault))
            return {"CANCELLED"}
        finally:
            window.progress_end()
        self.report({"INFO"}, f"baked {len(objects)} objects, RMS error {error:.4f}")
        return {"FINISHED"}

    def bake(self, context, objects, settings, progress):
        """Raises ValueError. Returns the error of what is displayed, of several maps the largest."""
        depsgraph = context.evaluated_depsgraph_get()
        meshes = [self.mesh_of(o, depsgraph) for o in objects]
        others = occluding_meshes(depsgraph, objects) if settings.occluders == "VISIBLE" else []
        if settings.target == "ATTRIBUTE":
            vertices, faces, normals, corners = joined(meshes)
            baked = surfelao.bake(vertices, faces, normals=normals, normal_faces=corners,
                                  occluders=occluders_of(others), progress=progress,
                                  **settings.arguments())
            first = 0
            for thing, mesh in zip(objects, meshes):
                count = len(mesh.vertices)
                write_attribute(thing.data, settings.attribute, baked.occlusion[first:first + count])
                first += count
            return baked.error["rmse"]
        for thing, mesh in zip(objects, meshes):
            if mesh.uv is None:
                raise ValueError(f"{thing.name}: has no UV map for an image")
        errors = []
        for thing, mesh in zip(objects, meshes):
            beside = others + [other for other in meshes if other is not mesh]
            texture = surfelao.texture(mesh.vertices, mesh.faces, mesh.uv, settings.size,
                                       uv_faces=mesh.corners, occluders=occluders_of(beside),
                                       progress=progress, **mesh.normal_arguments(),
                                       **settings.arguments())
            write_image(f"{settings.attribute} {thing.name}", texture.occlusion)
            errors.append(texture.error["rmse"])
        return max(errors)

    @staticmethod
    def mesh_of(thing, depsgraph):
        """As it is displayed; the vertices must be those of its data, which get the values."""
        mesh = world_mesh(thing.evaluated_get(depsgraph), thing.matrix_world)
        if mesh is None:
            raise ValueError(f"{thing.name}: has no faces")
        if len(mesh.vertices) != len(thing.data.vertices):
            raise ValueError(f"{thing.name}: its modifiers change the number of vertices: apply them")
        return mesh


def write_attribute(mesh, name, occlusion):
    attribute = mesh.color_attributes.get(name)
    if attribute is not None and (attribute.domain, attribute.data_type) != ("POINT", "FLOAT_COLOR"):
        mesh.color_attributes.remove(attribute)
        attribute = None
    if attribute is None:
        attribute = mesh.color_attributes.new(name, "FLOAT_COLOR", "POINT")
    attribute.data.foreach_set("color", colors_of(occlusion))
    mesh.color_attributes.active_color = attribute
    mesh.update()


def write_image(name, occlusion):
    image = bpy.data.images.get(name)
    size = occlusion.shape[0]
    if image is not None and (tuple(image.size) != (size, size) or not image.is_float):
        bpy.data.images.remove(image)
        image = None
    if image is None:
        image = bpy.data.images.new(name, size, size, float_buffer=True, is_data=True)
    image.pixels.foreach_set(colors_of(occlusion))  # Blender's rows grow upward too, as v does
    image.update()
    image.pack()


def colors_of(occlusion):
    """Flat RGBA of visibility."""
    colors = numpy.ones((occlusion.size, 4), numpy.float32)
    colors[:, :3] -= occlusion.reshape(-1, 1)
    return colors.ravel()


class VIEW3D_PT_surfelao(bpy.types.Panel):
    bl_label = "Ambient Occlusion"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Surfelao"

    def draw(self, context):
        settings = context.scene.surfelao
        layout = self.layout
        layout.use_property_split = True
        layout.prop(settings, "target")
        layout.prop(settings, "attribute")
        if settings.target == "IMAGE":
            layout.prop(settings, "size")
        for name in ("quality", "max_distance", "ground", "occluders"):
            layout.prop(settings, name)
        layout.operator(OBJECT_OT_surfelao_bake.bl_idname)


CLASSES = (SurfelaoSettings, OBJECT_OT_surfelao_bake, VIEW3D_PT_surfelao)


def register():
    for each in CLASSES:
        bpy.utils.register_class(each)
    bpy.types.Scene.surfelao = bpy.props.PointerProperty(type=SurfelaoSettings)


def unregister():
    del bpy.types.Scene.surfelao
    for each in reversed(CLASSES):
        bpy.utils.unregister_class(each)

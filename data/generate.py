#!/usr/bin/env python3
"""Makes the generated scenes: data/generate.py FOLDER [DETAIL]

DETAIL 1 (the default) gives the small files that are committed in data/; larger numbers multiply
the tessellation in each direction, for benchmarks (triangles grow with its square). Pure Python,
no packages, equal arguments give equal bytes. data/README.md says what each scene is for.
"""
import math
import os
import random
import struct
import sys


class Mesh:
    """Vertices and polygons; parts are simply appended."""

    def __init__(self):
        self.vertices = []
        self.faces = []

    def add(self, vertices, faces):
        base = len(self.vertices)
        self.vertices += vertices
        self.faces += [[base + i for i in face] for face in faces]

    def triangles(self):
        return [(f[0], f[i], f[i + 1]) for f in self.faces for i in range(1, len(f) - 1)]


def grid(nu, nv, point, wrap_u=False, wrap_v=False):
    """Quads over point(u, v) with u, v in [0, 1]; wrapped directions share their first line."""
    cols = nu if wrap_u else nu + 1
    rows = nv if wrap_v else nv + 1
    vertices = [point(i / nu, j / nv) for j in range(rows) for i in range(cols)]
    faces = []
    for j in range(nv):
        for i in range(nu):
            a, b = j * cols + i, j * cols + (i + 1) % cols
            c, d = ((j + 1) % rows) * cols + (i + 1) % cols, ((j + 1) % rows) * cols + i
            faces.append([a, b, c, d])
    return vertices, faces


def plate(mesh, origin, edge_u, edge_v, nu, nv):
    """A flat rectangle that faces edge_u x edge_v."""
    mesh.add(*grid(nu, nv, lambda u, v: tuple(
        origin[k] + u * edge_u[k] + v * edge_v[k] for k in range(3))))


def box(mesh, low, high, n=1, inward=False):
    """A closed box with split edges; each face n x n quads."""
    x0, y0, z0 = low
    x1, y1, z1 = high
    dx, dy, dz = x1 - x0, y1 - y0, z1 - z0
    sides = [((x0, y0, z1), (dx, 0, 0), (0, dy, 0)), ((x0, y1, z0), (dx, 0, 0), (0, -dy, 0)),
             ((x1, y0, z0), (0, dy, 0), (0, 0, dz)), ((x0, y1, z0), (0, -dy, 0), (0, 0, dz)),
             ((x0, y0, z0), (dx, 0, 0), (0, 0, dz)), ((x1, y1, z0), (-dx, 0, 0), (0, 0, dz))]
    for origin, u, v in sides:
        if inward:
            u, v = v, u
        plate(mesh, origin, u, v, n, n)


def sphere_point(u, v, radius, centre=(0, 0, 0)):
    theta, phi = math.pi * v, 2 * math.pi * u
    return (centre[0] + radius * math.sin(theta) * math.cos(phi),
            centre[1] + radius * math.sin(theta) * math.sin(phi),
            centre[2] + radius * math.cos(theta))


def ball(mesh, nu, nv, radius_of, centre=(0, 0, 0), inward=False):
    """A closed ball with single poles; radius_of(direction) gives its radius."""
    ring = []
    for j in range(1, nv):
        for i in range(nu):
            d = sphere_point(i / nu, j / nv, 1.0)
            ring.append(tuple(centre[k] + radius_of(d) * d[k] for k in range(3)))
    poles = [tuple(centre[k] + radius_of(d) * d[k] for k in range(3))
             for d in ((0, 0, 1), (0, 0, -1))]
    north, south = len(ring), len(ring) + 1
    faces = [[north, i, (i + 1) % nu] for i in range(nu)]
    for j in range(nv - 2):
        for i in range(nu):
            k = (i + 1) % nu
            faces.append([j * nu + i, (j + 1) * nu + i, (j + 1) * nu + k, j * nu + k])
    last = (nv - 2) * nu
    faces += [[last + i, south, last + (i + 1) % nu] for i in range(nu)]
    if inward:
        faces = [face[::-1] for face in faces]
    mesh.add(ring + poles, faces)


def blob(detail):
    """A smooth closed body with folds."""
    def radius(d):
        x, y, z = d
        return (1 + 0.25 * math.sin(4 * x + 1) * math.sin(5 * y) * math.sin(4 * z + 2)
                + 0.08 * math.sin(11 * x) * math.sin(13 * y + 1) * math.sin(12 * z))
    mesh = Mesh()
    ball(mesh, 64 * detail, 32 * detail, radius)
    return mesh


def room(detail):
    """The inside of a room: floor, walls, a window, half a ceiling, fluted columns."""
    n = 10 * detail
    mesh = Mesh()
    plate(mesh, (0, 0, 0), (8, 0, 0), (0, 6, 0), n, n)
    plate(mesh, (0, 0, 0), (0, 6, 0), (0, 0, 3), n, n)
    plate(mesh, (8, 6, 0), (0, -6, 0), (0, 0, 3), n, n)
    plate(mesh, (0, 6, 0), (8, 0, 0), (0, 0, 3), n, n)
    # the wall with the window: four plates around the opening
    plate(mesh, (8, 0, 0), (-8, 0, 0), (0, 0, 1), n, n // 2)
    plate(mesh, (8, 0, 2), (-8, 0, 0), (0, 0, 1), n, n // 2)
    plate(mesh, (8, 0, 1), (-3, 0, 0), (0, 0, 1), n // 2, n // 2)
    plate(mesh, (3, 0, 1), (-3, 0, 0), (0, 0, 1), n // 2, n // 2)
    plate(mesh, (0, 3, 3), (0, 3, 0), (8, 0, 0), n, n)
    for x, y in ((2, 2), (6, 2), (2, 4), (6, 4)):
        def flute(u, v, x=x, y=y):
            r = 0.3 + 0.03 * math.cos(12 * 2 * math.pi * u)
            return (x + r * math.cos(2 * math.pi * u), y + r * math.sin(2 * math.pi * u), 3 * v)
        mesh.add(*grid(24 * detail, 4 * detail, flute, wrap_u=True))
    ball(mesh, 16 * detail, 8 * detail, lambda d: 0.5, (4, 3, 0.5))
    box(mesh, (3.4, 4.4, 0), (4.6, 5.2, 0.9), 3 * detail)
    return mesh


def blocks(detail):
    """An assembly of bricks with studs: parts on, in and against each other, thin gaps."""
    rng = random.Random(7)
    mesh = Mesh()
    for level in range(3 * detail):
        for _ in range(6 * detail):
            w, d = rng.choice(((2, 1), (1, 2), (2, 2), (4, 2)))
            x, y = rng.randrange(0, 6 * detail), rng.randrange(0, 6 * detail)
            z = 1.0 * level
            gap = 0.01
            box(mesh, (x + gap, y + gap, z), (x + w - gap, y + d - gap, z + 1))
            for i in range(w):
                for j in range(d):
                    cx, cy = x + i + 0.5, y + j + 0.5

                    def stud(u, v, cx=cx, cy=cy, z=z):
                        angle = 2 * math.pi * u
                        return (cx + 0.3 * math.cos(angle), cy + 0.3 * math.sin(angle),
                                z + 1 + 0.2 * v)
                    mesh.add(*grid(12, 1, stud, wrap_u=True))
                    base = len(mesh.vertices)
                    mesh.vertices += [stud(k / 12, 1.0) for k in range(12)]
                    mesh.faces.append([base + k for k in range(12)])
    return mesh


def shells(detail):
    """Three nested shells, each with a hole on another side."""
    mesh = Mesh()
    for k, radius in enumerate((1.0, 0.8, 0.6)):
        nu, nv = 36 * detail, 18 * detail

        def place(u, v, radius=radius, k=k):
            x, y, z = sphere_point(u, 0.12 + 0.88 * v, radius)
            for _ in range(k):
                x, y, z = y, z, x
            return (x, y, z)
        vertices, faces = grid(nu, nv, place, wrap_u=True)
        mesh.add(vertices, [face[::-1] for face in faces])
    return mesh


def leaves(detail):
    """Foliage: open double-sided cards around stems over a floor of two triangles."""
    rng = random.Random(11)
    mesh = Mesh()
    plate(mesh, (-40, -40, 0), (80, 0, 0), (0, 80, 0), 1, 1)
    for _ in range(5 * detail * detail):
        sx, sy = rng.uniform(-6, 6), rng.uniform(-6, 6)

        def stem(u, v, sx=sx, sy=sy):
            angle = 2 * math.pi * u
            return (sx + 0.1 * math.cos(angle), sy + 0.1 * math.sin(angle), 4 * v)
        mesh.add(*grid(6, 4, stem, wrap_u=True))
        for _ in range(60):
            angle, height = rng.uniform(0, 2 * math.pi), rng.uniform(1, 4)
            tilt, size = rng.uniform(-0.6, 0.6), rng.uniform(0.4, 0.8)
            c, s = math.cos(angle), math.sin(angle)
            u = (size * c, size * s, size * tilt)
            v = (-0.5 * size * s, 0.5 * size * c, 0.2 * size)
            plate(mesh, (sx + 0.1 * c, sy + 0.1 * s, height), u, v, 2, 1)
    return mesh


def bracket(detail):
    """A machined part: sharp edges, long thin triangles, a bore."""
    mesh = Mesh()
    n = 48 * detail
    circle = [(math.cos(2 * math.pi * k / n), math.sin(2 * math.pi * k / n)) for k in range(n)]

    def square(k):
        x, y = circle[k]
        m = max(abs(x), abs(y))
        return (2 * x / m, 2 * y / m)
    for z, up in ((0.5, True), (0.0, False)):
        vertices = [(x, y, z) for x, y in circle] + [(*square(k), z) for k in range(n)]
        faces = [[k, n + k, n + (k + 1) % n, (k + 1) % n] for k in range(n)]
        mesh.add(vertices, faces if up else [face[::-1] for face in faces])
    for points, outward in ((circle, False), ([square(k) for k in range(n)], True)):
        vertices = [(x, y, 0.0) for x, y in points] + [(x, y, 0.5) for x, y in points]
        faces = [[k, (k + 1) % n, n + (k + 1) % n, n + k] for k in range(n)]
        mesh.add(vertices, faces if outward else [face[::-1] for face in faces])
    for side in (-1, 1):
        low, high = sorted((side * 1.6, side * 1.9))
        box(mesh, (low, -1.8, 0.5), (high, 1.8, 2.0), 4 * detail)
    return mesh


def write_obj(path, mesh):
    with open(path, "w") as out:
        out.write("# made by data/generate.py\n")
        for v in mesh.vertices:
            out.write("v %.9g %.9g %.9g\n" % v)
        for face in mesh.faces:
            out.write("f " + " ".join(str(i + 1) for i in face) + "\n")


def write_ply(path, mesh):
    with open(path, "wb") as out:
        out.write(("ply\nformat binary_little_endian 1.0\ncomment made by data/generate.py\n"
                   "element vertex %d\nproperty float x\nproperty float y\nproperty float z\n"
                   "element face %d\nproperty list uchar int vertex_indices\nend_header\n"
                   % (len(mesh.vertices), len(mesh.faces))).encode())
        for v in mesh.vertices:
            out.write(struct.pack("<3f", *v))
        for face in mesh.faces:
            out.write(struct.pack("<B%di" % len(face), len(face), *face))


def write_off(path, mesh):
    with open(path, "w") as out:
        out.write("OFF\n%d %d 0\n" % (len(mesh.vertices), len(mesh.faces)))
        for v in mesh.vertices:
            out.write("%.9g %.9g %.9g\n" % v)
        for face in mesh.faces:
            out.write("%d " % len(face) + " ".join(map(str, face)) + "\n")


def write_stl(path, mesh):
    triangles = mesh.triangles()
    with open(path, "wb") as out:
        out.write(b"made by data/generate.py".ljust(80, b"\0"))
        out.write(struct.pack("<I", len(triangles)))
        for t in triangles:
            out.write(struct.pack("<3f", 0, 0, 0))
            for i in t:
                out.write(struct.pack("<3f", *mesh.vertices[i]))
            out.write(struct.pack("<H", 0))


def write_glb(path, mesh):
    import json
    triangles = mesh.triangles()
    positions = b"".join(struct.pack("<3f", *v) for v in mesh.vertices)
    indices = b"".join(struct.pack("<3I", *t) for t in triangles)
    low = [min(struct.unpack("<f", struct.pack("<f", v[k]))[0] for v in mesh.vertices)
           for k in range(3)]
    high = [max(struct.unpack("<f", struct.pack("<f", v[k]))[0] for v in mesh.vertices)
            for k in range(3)]
    document = {
        "asset": {"version": "2.0", "generator": "data/generate.py"},
        "scene": 0, "scenes": [{"nodes": [0]}],
        # the mesh is made with z up, glTF has y up
        "nodes": [{"mesh": 0, "rotation": [-math.sqrt(0.5), 0, 0, math.sqrt(0.5)]}],
        "materials": [{"name": "leaf", "doubleSided": True}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
        "buffers": [{"byteLength": len(positions) + len(indices)}],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": len(positions), "target": 34962},
            {"buffer": 0, "byteOffset": len(positions), "byteLength": len(indices),
             "target": 34963}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": len(mesh.vertices), "type": "VEC3",
             "min": low, "max": high},
            {"bufferView": 1, "componentType": 5125, "count": 3 * len(triangles),
             "type": "SCALAR"}]}
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    body = positions + indices
    with open(path, "wb") as out:
        out.write(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(body)))
        out.write(struct.pack("<I4s", len(text), b"JSON") + text)
        out.write(struct.pack("<I4s", len(body), b"BIN\0") + body)


# Parts of the robot, metres: name, of which joint, where the joint lies from its parent's, where the
# part's middle lies from the joint, the part's size. y is up, z forward.
ROBOT = [("pelvis", None, (0, 0.92, 0), (0, 0, 0), (0.30, 0.16, 0.20)),
         ("torso", "pelvis", (0, 0.09, 0), (0, 0.26, 0), (0.40, 0.46, 0.24)),
         ("head", "torso", (0, 0.51, 0), (0, 0.15, 0), (0.20, 0.24, 0.22)),
         ("left upper arm", "torso", (0.27, 0.45, 0), (0, -0.14, 0), (0.11, 0.32, 0.12)),
         ("right upper arm", "torso", (-0.27, 0.45, 0), (0, -0.14, 0), (0.11, 0.32, 0.12)),
         ("left lower arm", "left upper arm", (0, -0.32, 0), (0, -0.15, 0), (0.09, 0.30, 0.10)),
         ("right lower arm", "right upper arm", (0, -0.32, 0), (0, -0.15, 0), (0.09, 0.30, 0.10)),
         ("left thigh", "pelvis", (0.09, -0.09, 0), (0, -0.19, 0), (0.14, 0.38, 0.16)),
         ("right thigh", "pelvis", (-0.09, -0.09, 0), (0, -0.19, 0), (0.14, 0.38, 0.16)),
         ("left shin", "left thigh", (0, -0.40, 0), (0, -0.20, 0), (0.12, 0.40, 0.14)),
         ("right shin", "right thigh", (0, -0.40, 0), (0, -0.20, 0), (0.12, 0.40, 0.14))]
ROBOT_KEYS = 17  # of a walk of one second


def robot_turn(name, phase):
    """Angles about x and y of a joint at a phase of the walk, radians."""
    side = -1 if name.startswith("right") else 1
    swing = side * math.sin(phase)
    part = name.split(" ", 1)[-1]
    return {"thigh": (-0.55 * swing, 0),
            "shin": (0.35 * (1 + side * math.sin(phase + 2.2)), 0),
            "upper arm": (0.5 * swing, 0), "lower arm": (-0.45 + 0.25 * swing, 0),
            "torso": (0.04, 0.12 * math.sin(phase)), "head": (0, -0.25 * math.sin(phase)),
            "pelvis": (0, -0.08 * math.sin(phase))}[part]


def robot(detail):
    """A block with round edges, of which every part is made."""
    mesh = Mesh()

    def rounded(p):
        size = sum(abs(x) ** 8 for x in p) ** 0.125
        return tuple(0.5 * x / size for x in p)
    mesh_of_cube = Mesh()
    box(mesh_of_cube, (-1, -1, -1), (1, 1, 1), 4 * detail)
    mesh.add([rounded(p) for p in mesh_of_cube.vertices], mesh_of_cube.faces)
    return mesh


def write_robot(path, mesh):
    """The robot on a floor, walking: a glTF of 11 moving parts."""
    import json
    triangles = mesh.triangles()
    chunks, views, accessors = [], [], []

    def add(values, form, kind, component, **more):
        data = b"".join(struct.pack(form, *v) for v in values)
        views.append({"buffer": 0, "byteOffset": sum(map(len, chunks)), "byteLength": len(data)})
        chunks.append(data)
        count = len(values) * (3 if kind == "SCALAR" and form == "<3I" else 1)
        accessors.append({"bufferView": len(views) - 1, "componentType": component,
                          "count": count, "type": kind, **more})
        return len(accessors) - 1

    def add_points(points):
        packed = [struct.unpack("<3f", struct.pack("<3f", *p)) for p in points]
        return add(points, "<3f", "VEC3", 5126, min=[min(p[k] for p in packed) for k in range(3)],
                   max=[max(p[k] for p in packed) for k in range(3)])

    def primitive(points, faces):
        return {"primitives": [{"attributes": {"POSITION": add_points(points)},
                                "indices": add(faces, "<3I", "SCALAR", 5125)}]}
    meshes = [primitive(mesh.vertices, triangles),
              primitive([(-1.5, 0, 1.5), (1.5, 0, 1.5), (1.5, 0, -1.5), (-1.5, 0, -1.5)],
                        [(0, 1, 2), (0, 2, 3)])]
    seconds = [(i / (ROBOT_KEYS - 1),) for i in range(ROBOT_KEYS)]
    times = add(seconds, "<f", "SCALAR", 5126, min=[0.0], max=[1.0])
    nodes = [{"name": "floor", "mesh": 1}]
    joints, samplers, channels = {}, [], []

    def animate(node, path, values, form, kind):
        samplers.append({"input": times, "output": add(values, form, kind, 5126)})
        channels.append({"sampler": len(samplers) - 1, "target": {"node": node, "path": path}})
    for name, parent, joint_at, middle, size in ROBOT:
        joint = len(nodes)
        joints[name] = joint
        nodes.append({"name": name + " joint", "translation": list(joint_at), "children":
                      [joint + 1]})
        nodes.append({"name": name, "mesh": 0, "translation": list(middle), "scale": list(size)})
        if parent is not None:
            nodes[joints[parent]]["children"].append(joint)
        turns = []
        for (second,) in seconds:
            x, y = robot_turn(name, 2 * math.pi * second)
            sx, cx, sy, cy = math.sin(x / 2), math.cos(x / 2), math.sin(y / 2), math.cos(y / 2)
            turns.append((cy * sx, sy * cx, -sy * sx, cy * cx))
        animate(joint, "rotation", turns, "<4f", "VEC4")
    animate(joints["pelvis"], "translation",
            [(0, 0.9 + 0.02 * math.cos(4 * math.pi * s), 0) for (s,) in seconds], "<3f", "VEC3")
    body = b"".join(chunks)
    document = {
        "asset": {"version": "2.0", "generator": "data/generate.py"},
        "scene": 0, "scenes": [{"nodes": [0, joints["pelvis"]]}], "nodes": nodes,
        "meshes": meshes, "animations": [{"name": "walk", "samplers": samplers,
                                          "channels": channels}],
        "buffers": [{"byteLength": len(body)}], "bufferViews": views, "accessors": accessors}
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    with open(path, "wb") as out:
        out.write(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(body)))
        out.write(struct.pack("<I4s", len(text), b"JSON") + text)
        out.write(struct.pack("<I4s", len(body), b"BIN\0") + body)


SCENES = [("blob.off", blob, write_off), ("room.obj", room, write_obj),
          ("blocks.ply", blocks, write_ply), ("shells.stl", shells, write_stl),
          ("leaves.glb", leaves, write_glb), ("bracket.obj", bracket, write_obj),
          ("robot.glb", robot, write_robot)]


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    folder = sys.argv[1]
    detail = int(sys.argv[2]) if len(sys.argv) == 3 else 1
    os.makedirs(folder, exist_ok=True)
    for name, make, write in SCENES:
        write(os.path.join(folder, name), make(detail))


main()

"""Our tangent frames against Blender's own (mikktspace.c), run by hand:

    tangent_frames MODEL frames.txt
    blender -b -P tests/bench/blender_tangents.py -- frames.txt

The same triangles and places in the map are given to Blender; what our maps hold is decoded with
the tangents that Mesh.calc_tangents() makes of them. Normals are smooth everywhere and Blender's
own: given ones it keeps in 16 bits, each corner's rounded another way, so that none share a
tangent. Prints the angles between both normals and tangents, by how much decoded directions are
off, and how many signs differ.
"""
import math
import sys

import bpy
from mathutils import Vector


def angle(a, b):
    return math.degrees(math.atan2(a.cross(b).length, a.dot(b)))


def summary(name, values):
    values = sorted(values)
    print(f"{name}: mean {sum(values) / len(values):.4f}, 99 % within "
          f"{values[int(0.99 * (len(values) - 1))]:.4f}, max {values[-1]:.4f} degrees")


def main(path):
    rows = [[float(number) for number in line.split()] for line in open(path)]
    corners = [[row[13 * k:13 * k + 13] for k in range(3)] for row in rows]
    # one vertex per position
    numbers, positions = {}, []
    for corner in (corner for row in corners for corner in row):
        if corner[0] not in numbers:
            numbers[corner[0]] = len(positions)
            positions.append(corner[1:4])
    mesh = bpy.data.meshes.new("frames")
    mesh.from_pydata(positions, [], [[numbers[c[0]] for c in row] for row in corners])
    assert len(mesh.polygons) == len(rows)
    layer = mesh.uv_layers.new()
    loops = [corner for row in corners for corner in row]
    for data, corner in zip(layer.data, loops):
        data.uv = corner[4:6]
    for polygon in mesh.polygons:
        polygon.use_smooth = True
    mesh.calc_tangents(uvmap=layer.name)

    normals, tangents, decoded, signs = [], [], [], 0
    for index, row in enumerate(rows):
        ours = corners[index]
        if ours[0][12] == 0:  # no area in the map
            continue
        theirs = mesh.loops[3 * index:3 * index + 3]
        for corner, loop in zip(ours, theirs):
            tangents.append(angle(Vector(corner[9:12]), loop.tangent))
            normals.append(angle(Vector(corner[6:9]), loop.normal))
            signs += corner[12] != loop.bitangent_sign
        second, third = row[39:41]
        weights = (1 - second - third, second, third)
        direction, held = Vector(row[41:44]), row[44:47]
        tangent, normal = Vector(), Vector()
        for weight, corner, loop in zip(weights, ours, theirs):
            tangent += weight * loop.tangent
            normal += weight * loop.normal
        bitangent = theirs[0].bitangent_sign * normal.cross(tangent)
        decoded.append(angle(held[0] * tangent + held[1] * bitangent + held[2] * normal, direction))
    print(f"{len(rows)} triangles, {signs} corners of another sign")
    summary("normals", normals)
    summary("tangents", tangents)
    summary("decoded directions", decoded)


main(sys.argv[sys.argv.index("--") + 1])

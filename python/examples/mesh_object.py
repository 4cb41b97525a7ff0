#!/usr/bin/python3
"""Any object with .vertices and .faces, as trimesh has them: bake it, and ask at points in the air.

    mesh_object.py MESH [OUT]     OUT: the mesh again, with its occlusion
"""
import sys

import numpy as np
import surfelao


def bake_object(mesh, **settings):
    """(n,) visibility of the vertices of an object that has .vertices and .faces: 1 = open."""
    return 1 - surfelao.bake(mesh.vertices, mesh.faces, **settings).occlusion


def openness_above(mesh, height):
    """How open the sky is over a grid of places above the mesh, `height` diagonals over its top."""
    prepared = surfelao.prepare(mesh.vertices, mesh.faces)
    low, high = np.min(mesh.vertices, 0), np.max(mesh.vertices, 0)
    x, z = np.meshgrid(np.linspace(low[0], high[0], 8), np.linspace(low[2], high[2], 8))
    points = np.stack([x, np.full_like(x, high[1] + height * prepared.diagonal), z], -1)
    down = np.broadcast_to([0.0, -1.0, 0.0], points.shape)
    occlusion, _ = prepared.solve(points.reshape(-1, 3), down.reshape(-1, 3))
    return 1 - occlusion.reshape(x.shape)


def main():
    mesh = surfelao.read(sys.argv[1])  # trimesh.load(path) would do as well
    print(f"mean visibility {bake_object(mesh).mean():.3f}")
    print(f"straight above, looking down: {openness_above(mesh, 0.05).mean():.3f}")
    if len(sys.argv) > 2:
        mesh.write(sys.argv[2], surfelao.bake(mesh.vertices, mesh.faces, normals=mesh.normals,
                                              normal_faces=mesh.normal_faces))


if __name__ == "__main__":
    main()

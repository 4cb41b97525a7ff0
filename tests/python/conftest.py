"""Meshes made in code, for all tests of the package."""
import os
import pathlib

import numpy
import pytest


@pytest.fixture
def program():
    return os.environ["SURFELAO_PROGRAM"]


@pytest.fixture
def data():
    return pathlib.Path(os.environ["SURFELAO_DATA"])


def box(size=1.0, inward=False):
    """(8, 3) vertices and (12, 3) faces of a cube about the origin."""
    vertices = size * (numpy.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]) - 0.5)
    quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    faces = numpy.array([[q[0], q[i], q[i + 1]] for q in quads for i in (1, 2)])
    return vertices, faces[:, ::-1] if inward else faces


def waves(side):
    """(side^2, 3) vertices and (2 (side - 1)^2, 3) faces of a field of waves over the unit square."""
    x, y = numpy.meshgrid(*[numpy.linspace(0, 1, side)] * 2, indexing="ij")
    z = 0.1 * numpy.sin(20 * x) * numpy.cos(17 * y)
    corner = (numpy.arange(side - 1)[:, None] * side + numpy.arange(side - 1)).ravel()
    faces = numpy.concatenate([numpy.stack([corner, corner + side, corner + 1], 1),
                               numpy.stack([corner + 1, corner + side, corner + side + 1], 1)])
    return numpy.stack([x, y, z], -1).reshape(-1, 3), faces

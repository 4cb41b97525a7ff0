"""Ambient occlusion and bent normals of triangle meshes and point clouds, with a known error.

    import numpy, surfelao
    baked = surfelao.bake(vertices, faces)      # (n, 3) and (m, 3) arrays
    baked.occlusion                             # (n,), 0 = open to 1 = closed
    baked.bent_normals                          # (n, 3), to the middle of what is open
    baked.error["rmse"]                         # how wrong that is, as it will be seen

Conventions. 0 is open, 1 is closed; `1 - occlusion` is what is multiplied into a colour. Lengths are
in the units of the vertices. Arrays may be of any order, strides and number type; results are views
of the engine's memory, not copies. All cores compute (`threads` limits them, for the whole process
while the call lasts) without the interpreter's lock; Ctrl-C ends any call at once.

Arguments that several functions have:

    normals         None: smooth, over edges of up to `crease` degrees; "flat"; or an array: (n, 3),
                    one for each vertex, or (k, 3) with `normal_faces`. Any length; zero: none.
    normal_faces    (m, 3) integers: the row of `normals` at each corner of each face.
    crease          degrees, 0 to 180: faces that meet at more are not smoothed together.
    occluders       vertices and faces that occlude the mesh too, but are not baked.
    engine          "masks" (the default), "disks" (a preview) or "rays" (any exactness, slowest).
    quality         of masks and disks: "draft", "good", "best", or a number between and beyond
                    (0, 1, 2; masks -1 to 4, disks 0 to 2). The only control of time against error.
    rays            of the engine rays: rays per point, 1 to 2**20.
    device          "cpu", or "gpu" for masks and disks.
    max_distance    what is farther away does not occlude; None: everything does.
    falloff         "none", or "smooth": near things count more, up to `max_distance`.
    ground          an endless floor occludes too: True, just below the lowest point, or its height
                    along `up`.
    up              "y", "z" or three numbers.
    error           a bake as exact as this: the cheapest setting whose measured error lies below it
                    is found, in place of `engine`, `quality` and `rays`.
    check           points at which a bake's error is measured, 0 to 10**6; 0: it is not.
    threads         at most so many; None: all cores.
    progress        called as progress(stage, done), done from 0 to 1, up to fifty times a second in
                    the calling thread. The call ends in Cancelled where it returns False, and in
                    what it raises.

Errors: InputError and SettingsError are ValueErrors of one sentence; RuntimeError is the machine's
(no GPU, no memory on it).
"""
from __future__ import annotations

import os
from typing import Any, Callable, Literal, Optional, Sequence, Tuple, Union

import numpy
from numpy.typing import ArrayLike

from . import _core
from ._core import Bake, Cancelled, InputError, Mesh, SettingsError, Texture, __version__

__all__ = ["Bake", "Cancelled", "InputError", "Mesh", "PreparedMesh", "SettingsError", "Texture",
           "bake", "cloud", "compare", "prepare", "read", "texture"]

Engine = Literal["masks", "disks", "rays"]
Quality = Union[float, Literal["draft", "good", "best"]]
Normals = Union[ArrayLike, Literal["flat"], None]
Up = Union[Literal["y", "z"], Sequence[float]]
Progress = Optional[Callable[[str, float], Any]]


def bake(vertices: ArrayLike, faces: ArrayLike, *, normals: Normals = None,
         normal_faces: Optional[ArrayLike] = None,
         occluders: Optional[Tuple[ArrayLike, ArrayLike]] = None, engine: Engine = "masks",
         quality: Quality = "good", rays: int = 256, device: Literal["cpu", "gpu"] = "cpu",
         max_distance: Optional[float] = None, falloff: Literal["none", "smooth"] = "none",
         ground: Union[bool, float, None] = None, up: Up = "y",
         values: Literal["fit", "point"] = "fit", crease: float = 40.0,
         error: Optional[float] = None, check: int = 400, threads: Optional[int] = None,
         progress: Progress = None) -> Bake:
    """Occlusion and bent normals at the vertices of a mesh, equal to those of `surfelao bake`.

    vertices        (n, 3) numbers, finite.
    faces           (m, 3) integers, 0 to n - 1: triangles.
    values          "fit": the values whose interpolation over the faces is nearest to the truth all
                    over the surface; "point": the truth at the vertices themselves.

    The others: see the package. O(n log n). Raises InputError, SettingsError, Cancelled.
    """
    return _core.bake(vertices, faces, dict(
        normals=normals, normal_faces=normal_faces, occluders=occluders, engine=engine,
        quality=quality, rays=rays, device=device, max_distance=max_distance, falloff=falloff,
        ground=ground, up=up, values=values, crease=crease, error=error, check=check,
        threads=threads, progress=progress))


def texture(vertices: ArrayLike, faces: ArrayLike, uv: Optional[ArrayLike] = None,
            size: int = 1024, *, uv_faces: Optional[ArrayLike] = None, padding: int = 4,
            bent: bool = False, normals: Normals = None,
            normal_faces: Optional[ArrayLike] = None,
            occluders: Optional[Tuple[ArrayLike, ArrayLike]] = None, engine: Engine = "masks",
            quality: Quality = "good", rays: int = 256, device: Literal["cpu", "gpu"] = "cpu",
            max_distance: Optional[float] = None, falloff: Literal["none", "smooth"] = "none",
            ground: Union[bool, float, None] = None, up: Up = "y", crease: float = 40.0,
            error: Optional[float] = None, check: int = 400, threads: Optional[int] = None,
            progress: Progress = None) -> Texture:
    """Occlusion at the texels of a square map over the faces of a mesh.

    vertices        (n, 3) numbers, finite.
    faces           (m, 3) integers, 0 to n - 1: triangles.
    uv              (n, 2) numbers: where the vertices lie in the map, which goes from 0 to 1; or
                    (k, 2) with `uv_faces`. None: charts are made, see Texture.uv.
    size            texels of a side, 1 to 32768.
    uv_faces        (m, 3) integers: the row of `uv` at each corner of each face.
    padding         texels around each chart that take its colour, so that filters fetch it.
    bent            bent normals too, in world space.

    The centre of the texel [row, column] lies at uv = ((column + .5) / size, (row + .5) / size). So
    row 0 lies at v = 0; for a picture of which v grows upward (OBJ, Blender) turn it: [::-1].
    Where faces lie on each other in the map a texel holds their mean, and a note tells.

    The others: see the package. Raises InputError, SettingsError, Cancelled.
    """
    return _core.texture(vertices, faces, dict(
        uv=uv, size=size, uv_faces=uv_faces, padding=padding, bent=bent, normals=normals,
        normal_faces=normal_faces, occluders=occluders, engine=engine, quality=quality, rays=rays,
        device=device, max_distance=max_distance, falloff=falloff, ground=ground, up=up,
        crease=crease, error=error, check=check, threads=threads, progress=progress))


def cloud(points: ArrayLike, normals: Optional[ArrayLike] = None, *,
          viewpoint: Optional[Sequence[float]] = None, spacing: Optional[float] = None,
          engine: Engine = "masks", quality: Quality = "good", rays: int = 256,
          device: Literal["cpu", "gpu"] = "cpu", max_distance: Optional[float] = None,
          falloff: Literal["none", "smooth"] = "none", ground: Union[bool, float, None] = None,
          up: Up = "y", error: Optional[float] = None, check: int = 400,
          threads: Optional[int] = None, progress: Progress = None) -> Bake:
    """Occlusion and bent normals at points of a scanner, which occlude each other as small squares.

    points          (n, 3) numbers, finite.
    normals         (n, 3) numbers, zero where there is none; None: fitted to the neighbours, and
                    turned to the viewpoint or to where it is more open.
    viewpoint       three numbers: where the scanner stood.
    spacing         one point in each cube of this size occludes; None: all, up to 20 million.

    The others: see the package. O(n log n). Raises InputError, SettingsError, Cancelled.
    """
    return _core.cloud(points, dict(
        normals=normals, viewpoint=viewpoint, spacing=spacing, engine=engine, quality=quality,
        rays=rays, device=device, max_distance=max_distance, falloff=falloff, ground=ground, up=up,
        error=error, check=check, threads=threads, progress=progress))


def compare(vertices: ArrayLike, faces: ArrayLike, *,
            engines: Union[Engine, Sequence[Engine]] = ("masks", "disks"),
            qualities: Union[Quality, Sequence[Quality]] = ("draft", "good", "best"),
            rays: Union[int, Sequence[int]] = (1, 4, 16, 64, 256), normals: Normals = None,
            normal_faces: Optional[ArrayLike] = None, max_distance: Optional[float] = None,
            falloff: Literal["none", "smooth"] = "none", ground: Union[bool, float, None] = None,
            up: Up = "y", values: Literal["fit", "point"] = "fit", crease: float = 40.0,
            reference_rays: int = 4096, sample: int = 20000, rounds: int = 3,
            threads: Optional[int] = None, progress: Progress = None) -> dict:
    """Engines and ray tracing on one mesh, the same job: how long, how wrong.

    vertices        (n, 3) numbers, finite.
    faces           (m, 3) integers, 0 to n - 1: triangles.
    values          as in bake().
    engines         one or several of "masks" and "disks".
    qualities       one or several: each engine runs at each.
    rays            rows of ray tracing, each with so many rays per point.
    reference_rays  an even number: rays at each point of the truth.
    sample          points of the surface at which errors are taken.
    rounds          times that everything runs, in turns: medians count.

    Returns what `surfelao compare --json` writes: "rows", each with "engine", "setting", seconds
    "build_s", "solve_s" and "fit_s", and what is seen and what the engine itself answers, "seen" and
    "solve", each with "rmse", "bias", "p95" and "max"; "floor", the least error that values at
    these vertices can have; "reference".

    The others: see the package. Raises InputError, SettingsError, Cancelled.
    """
    return _core.compare(vertices, faces, dict(
        engines=engines, qualities=qualities, rays=rays, normals=normals,
        normal_faces=normal_faces, max_distance=max_distance, falloff=falloff, ground=ground,
        up=up, values=values, crease=crease, reference_rays=reference_rays, sample=sample,
        rounds=rounds, threads=threads, progress=progress))


def read(path: Union[str, os.PathLike]) -> Mesh:
    """The mesh or the cloud of a file: .obj .ply .off .stl .gltf .glb, .pcd .xyz .pts .txt .asc, and
    .fbx .dae .zae .3ds .3mf .x3d through assimp.

    Raises InputError, with one sentence, for what is no complete, finite, consistent one.
    """
    return _core.read(path)


class PreparedMesh:
    """A mesh, and what an engine has built of it: prepare() makes one."""

    def __init__(self, built: _core.Prepared) -> None:
        self._built = built

    @property
    def diagonal(self) -> float:
        """Of the bounding box of all faces, in the mesh's units."""
        return self._built.diagonal

    def solve(self, points: Optional[ArrayLike] = None, normals: Optional[ArrayLike] = None, *,
              offset: Optional[float] = None, quality: Quality = "good", rays: int = 256,
              seed: int = 0, max_distance: Optional[float] = None,
              falloff: Literal["none", "smooth"] = "none",
              ground: Union[bool, float, None] = None, up: Up = "y",
              threads: Optional[int] = None,
              progress: Progress = None) -> Tuple[numpy.ndarray, numpy.ndarray]:
        """Occlusion (n,) and bent normals (n, 3) at points anywhere, float32.

        points      (n, 3) numbers. None: the vertices, as bake(values="point") has them.
        normals     (n, 3) numbers of any length: about each the hemisphere is asked; zero: none,
                    occlusion 0.
        offset      each point is moved so far along its normal first, off the surface that it may
                    lie on. None: a ten-thousandth of `diagonal`.
        seed        of rays: another one, another independent estimate.

        Any number of threads may solve with one PreparedMesh at once. The others: see the package.
        O(n log m) for m faces. Raises InputError, SettingsError, Cancelled.
        """
        return self._built.solve(points, normals, dict(
            offset=offset, quality=quality, rays=rays, seed=seed, max_distance=max_distance,
            falloff=falloff, ground=ground, up=up, threads=threads, progress=progress))


def prepare(vertices: ArrayLike, faces: ArrayLike, *, normals: Normals = None,
            normal_faces: Optional[ArrayLike] = None, engine: Engine = "masks",
            device: Literal["cpu", "gpu"] = "cpu", crease: float = 40.0,
            threads: Optional[int] = None, progress: Progress = None) -> PreparedMesh:
    """What an engine builds of a mesh once, so that PreparedMesh.solve() may be asked often.

    vertices        (n, 3) numbers, finite.
    faces           (m, 3) integers, 0 to n - 1: triangles.

    The others: see the package. O(n log n). Raises InputError, SettingsError, Cancelled.
    """
    return PreparedMesh(_core.prepare(vertices, faces, dict(
        normals=normals, normal_faces=normal_faces, engine=engine, device=device, crease=crease,
        threads=threads, progress=progress)))

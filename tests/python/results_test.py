"""What comes out: known worlds, and the program's own bytes."""
import subprocess

import numpy
import pytest
import surfelao
from conftest import box, waves

FLOOR = numpy.array([[-50, 0, -50], [50, 0, -50], [50, 0, 50], [-50, 0, 50.0]])
FLOOR_FACES = numpy.array([[0, 2, 1], [0, 3, 2]])


def occlusion_of_ply(path):
    """(n,) occlusion and (n, 3) bent normals of a binary PLY."""
    contents = path.read_bytes()
    head, _, body = contents.partition(b"end_header\n")
    types = {b"float": "<f4", b"double": "<f8", b"uchar": "u1"}
    lines = head.split(b"\n")
    count = next(int(line.split()[2]) for line in lines if line.startswith(b"element vertex"))
    fields = [(line.split()[2].decode(), types[line.split()[1]])
              for line in lines if line.startswith(b"property") and b"list" not in line]
    table = numpy.frombuffer(body, numpy.dtype(fields), count)
    bent = [name for name, _ in fields if name.startswith("bent")]
    return table["occlusion"], numpy.stack([table[name] for name in bent], 1)


@pytest.mark.parametrize("arguments, settings", [
    ([], {}),
    (["--engine", "rays", "--rays", "16", "--check", "0"],
     {"engine": "rays", "rays": 16, "check": 0}),
    (["--max-distance", "0.2", "--falloff", "smooth", "--ground", "--up", "z"],
     {"max_distance": 0.2, "falloff": "smooth", "ground": True, "up": "z"}),
    (["--values", "point", "--quality", "draft", "--normals", "flat"],
     {"values": "point", "quality": "draft", "normals": "flat"}),
    (["--error", "0.02"], {"error": 0.02}),
])
def test_bake_equals_the_programs_bytes(program, data, tmp_path, arguments, settings):
    output = tmp_path / "out.ply"
    subprocess.run([program, "bake", data / "blocks.ply", "-o", output, *arguments], check=True,
                   capture_output=True)
    occlusion, bent = occlusion_of_ply(output)
    mesh = surfelao.read(data / "blocks.ply")
    baked = surfelao.bake(mesh.vertices, mesh.faces, **settings)
    assert baked.occlusion.tobytes() == occlusion.tobytes()
    assert baked.bent_normals.tobytes() == bent.tobytes()


@pytest.mark.parametrize("name, output", [("robot.glb", "out.glb"), ("bracket.obj", "out.obj")])
def test_written_files_are_the_programs_bytes(program, data, tmp_path, name, output):
    folders = [tmp_path / "program", tmp_path / "package"]
    for folder in folders:
        folder.mkdir()
    subprocess.run([program, "bake", data / name, "-o", folders[0] / output], check=True,
                   capture_output=True)
    mesh = surfelao.read(data / name)
    baked = surfelao.bake(mesh.vertices, mesh.faces, normals=mesh.normals,
                          normal_faces=mesh.normal_faces)
    assert isinstance(mesh.write(folders[1] / output, baked), list)
    assert (folders[1] / output).read_bytes() == (folders[0] / output).read_bytes()


def test_a_closed_box_is_closed_inside_and_open_outside():
    vertices, faces = box(inward=True)
    assert surfelao.bake(vertices, faces, normals="flat").occlusion.min() > 0.99
    vertices, faces = box()
    outside = surfelao.bake(vertices, faces, normals="flat")
    assert outside.occlusion.max() < 0.01
    assert outside.error["rmse"] < 0.01 and outside.seconds["total"] > 0


def test_occluders_occlude_and_are_not_baked():
    vertices, faces = box()
    lone = surfelao.bake(vertices + [0, 0.5, 0], faces, normals="flat")
    stands = surfelao.bake(vertices + [0, 0.5, 0], faces, normals="flat",
                           occluders=(FLOOR, FLOOR_FACES))
    assert stands.occlusion.shape == (8,)
    # half of what a wall sees is floor; at the foot corners one of three sides lies on it
    assert lone.occlusion.max() < 0.01
    assert stands.occlusion.min() > 0.2


def test_a_ground_is_an_occluder():
    vertices, faces = box()
    baked = surfelao.bake(vertices, faces, normals="flat", ground=True, values="point")
    floor = surfelao.bake(vertices + [0, 0.501, 0], faces, normals="flat", values="point",
                          occluders=(50 * FLOOR, FLOOR_FACES))
    assert numpy.abs(baked.occlusion - floor.occlusion).max() < 0.02
    high = surfelao.bake(vertices, faces, normals="flat", ground=-100.0, max_distance=10)
    assert high.occlusion.max() < 0.01


def test_solve_answers_anywhere_in_the_users_units():
    vertices, faces = box(size=1000.0)
    prepared = surfelao.prepare(vertices, faces)
    assert prepared.diagonal == pytest.approx(1000 * 3**0.5)
    points = numpy.array([[0, 0, 0], [0, 501, 0], [0, 501, 0], [0, 1500, 0]])
    normals = numpy.array([[0, 7, 0], [0, 1, 0], [0, -1, 0], [0, 0, 0]])
    occlusion, bent = prepared.solve(points, normals, offset=0)
    assert numpy.allclose(occlusion, [1, 0, 1, 0], atol=0.01)
    assert numpy.allclose(bent[1], [0, 1, 0], atol=0.01) and not bent[3].any()
    near, _ = prepared.solve(points, normals, offset=0, max_distance=300)
    assert numpy.allclose(near, [0, 0, 1, 0], atol=0.01)


def test_solve_without_points_is_a_bake_at_the_vertices():
    vertices, faces = waves(20)
    baked = surfelao.bake(vertices, faces, values="point", engine="rays", rays=64)
    occlusion, bent = surfelao.prepare(vertices, faces, engine="rays").solve(rays=64)
    assert numpy.array_equal(occlusion, baked.occlusion)
    assert numpy.array_equal(bent, baked.bent_normals)


def test_given_normals_are_used_by_vertex_and_by_corner():
    vertices, faces = waves(12)
    up = numpy.tile([0.0, 0.0, 3.0], (len(vertices), 1))
    by_vertex = surfelao.bake(vertices, faces, normals=up)
    by_corner = surfelao.bake(vertices, faces, normals=up[:1], normal_faces=0 * faces)
    assert numpy.array_equal(by_vertex.occlusion, by_corner.occlusion)
    assert not numpy.array_equal(by_vertex.occlusion, surfelao.bake(vertices, faces).occlusion)
    assert by_vertex.report["corners_from_file"] == faces.size


def test_a_texture_shows_what_vertices_show(program, data, tmp_path):
    vertices, faces = waves(30)
    texture = surfelao.texture(vertices, faces, vertices[:, :2], size=64, bent=True)
    assert texture.occlusion.shape == (64, 64) and texture.bent_normals.shape == (64, 64, 3)
    occlusion = surfelao.bake(vertices, faces, quality="best").occlusion
    # vertex (i, j) lies at uv (i, j) / 29, texel [row, column] at v, u
    column, row = numpy.minimum(vertices[:, :2].T * 64, 63).astype(int)
    assert numpy.sqrt(numpy.mean((texture.occlusion[row, column] - occlusion) ** 2)) < 0.05
    assert numpy.allclose(numpy.linalg.norm(texture.bent_normals, axis=-1), 1, atol=0.01)
    assert texture.uv_faces is None and numpy.array_equal(texture.uv, vertices[:, :2])


def test_a_texture_without_coordinates_gets_charts():
    vertices, faces = box(inward=True)
    texture = surfelao.texture(vertices, faces, size=128)
    assert texture.occlusion.min() > 0.95
    assert texture.uv_faces.shape == (12, 3) and texture.uv_faces.max() < len(texture.uv)
    assert texture.uv.min() >= 0 and texture.uv.max() <= 1
    again = surfelao.texture(vertices, faces, texture.uv, 128, uv_faces=texture.uv_faces)
    assert numpy.array_equal(again.occlusion, texture.occlusion)


def test_a_cloud_is_a_surface():
    vertices, _ = waves(40)
    baked = surfelao.cloud(vertices, numpy.tile([0.0, 0.0, 1.0], (1600, 1)))
    valley, ridge = vertices[:, 2] < -0.08, vertices[:, 2] > 0.08
    assert baked.occlusion[valley].mean() > baked.occlusion[ridge].mean() + 0.2
    assert surfelao.cloud(vertices, viewpoint=[0.5, 0.5, 9]).bent_normals[:, 2].mean() > 0.5


def test_compare_tells_errors_and_seconds_of_all(data):
    mesh = surfelao.read(data / "blob.off")
    told = surfelao.compare(mesh.vertices, mesh.faces, engines="masks", qualities=["draft"],
                            rays=[4], reference_rays=64, sample=500, rounds=1)
    rows = {row["setting"]: row for row in told["rows"]}
    assert rows["draft"]["solve"]["rmse"] < rows["4 rays"]["solve"]["rmse"]
    for row in told["rows"]:
        assert {"rmse", "bias", "p95", "max"} <= row["seen"].keys()
        assert row["solve_s"] > 0


def test_results_live_as_long_as_their_views():
    vertices, faces = waves(50)
    occlusion = surfelao.bake(vertices, faces).occlusion
    again = surfelao.bake(vertices, faces)
    assert occlusion.base is not None and not occlusion.flags.owndata
    assert numpy.shares_memory(again.occlusion, again.occlusion)
    assert numpy.array_equal(occlusion, again.occlusion)

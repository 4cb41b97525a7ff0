"""What is refused, and in which words."""
import numpy
import pytest
import surfelao
from conftest import box

VERTICES, FACES = box()
NAN = numpy.where(numpy.arange(8)[:, None] == 5, numpy.nan, VERTICES)


@pytest.mark.parametrize("vertices, faces, message", [
    (VERTICES[:, :2], FACES, "vertices: the shape is (8, 2), but (n, 3) is wanted"),
    (VERTICES.ravel(), FACES, "vertices: the shape is (24,)"),
    (NAN, FACES, "vertices: row 5 holds nan, but finite numbers are wanted"),
    (VERTICES.astype(complex), FACES, "vertices: the type is complex128, but numbers are wanted"),
    (VERTICES.astype(str), FACES, "vertices: the type is <U"),
    (None, FACES, "vertices: "),
    ([[1, 2, 3], [4, 5]], FACES, "vertices: "),
    (numpy.full((8, 3), 1e301), FACES, "vertex 0 has a coordinate that is no number or beyond 1e300"),
    (VERTICES, FACES.astype(float), "faces: the type is float64, but integers are wanted"),
    (VERTICES, FACES.reshape(-1, 4), "faces: the shape is (9, 4), but (n, 3) is wanted: triangles"),
    (VERTICES, FACES - 1, "faces: row 0 has the index -1"),
    (VERTICES, FACES + 1, "triangle 2 uses vertex 8, but there are 8 vertices"),
    (VERTICES, FACES + 2**40, "faces: row 0 has the index 1099511627776"),
    (VERTICES, numpy.uint64(FACES) + numpy.uint64(2**63), "faces: row 0 has the index 9223372036"),
    (VERTICES, FACES[:0], "faces: there is no triangle"),
    (VERTICES, [], "faces: there is no triangle"),
    ([], FACES, "triangle 0 uses vertex"),
])
def test_bad_arrays_name_element_and_fault(vertices, faces, message):
    for function in (surfelao.bake, surfelao.prepare, surfelao.texture, surfelao.compare):
        with pytest.raises(surfelao.InputError) as caught:
            function(vertices, faces)
        assert str(caught.value).startswith(message)


@pytest.mark.parametrize("settings, message", [
    ({"engine": "mask"}, "engine must be masks, disks or rays, not 'mask'"),
    ({"quality": "fine"}, "quality must be draft, good, best or a number, not 'fine'"),
    ({"quality": 9}, "quality of masks must be between -1 and 4"),
    ({"quality": numpy.nan}, "quality of masks must be between -1 and 4"),
    ({"engine": "rays", "rays": 0}, "rays must be between 1 and"),
    ({"engine": "rays", "rays": 2**70}, "rays is out of its range"),
    ({"engine": "rays", "rays": 4.5}, "rays must be an integer, not 4.5"),
    ({"engine": "rays", "device": "gpu"}, "rays do not run on the GPU"),
    ({"max_distance": 0}, "max_distance must be above 0"),
    ({"max_distance": numpy.nan}, "max_distance must be above 0"),
    ({"max_distance": "5%"}, "max_distance must be a number, not '5%'"),
    ({"falloff": "smooth"}, "a falloff needs a max_distance"),
    ({"falloff": "linear"}, "falloff must be none or smooth, not 'linear'"),
    ({"ground": numpy.inf}, "ground must be True or a finite height"),
    ({"up": "x"}, "up must be y, z or three numbers, not 'x'"),
    ({"up": [0, 0, 0]}, "up must have a length"),
    ({"values": "mean"}, "values must be fit or point, not 'mean'"),
    ({"normals": "smooth"}, "normals must be flat, not 'smooth'"),
    ({"crease": 200}, "crease must be between 0 and 180 degrees"),
    ({"check": -1}, "check must be between 0 and 1000000"),
    ({"error": 0}, "error must be above 0, and finite"),
    ({"error": 0.01, "check": 0}, "error needs a check of at least 1 point"),
    ({"threads": 0}, "threads must be between 1 and"),
    ({"threads": True}, "threads must be an integer, not True"),
])
def test_bad_settings_name_argument_and_range(settings, message):
    with pytest.raises(surfelao.SettingsError) as caught:
        surfelao.bake(VERTICES, FACES, **settings)
    assert str(caught.value).startswith(message)


@pytest.mark.parametrize("arguments, message", [
    ({"normals": VERTICES[:3]}, "there are 3 normals for 8 vertices"),
    ({"normals": NAN}, "normals: row 5 holds nan"),
    ({"normals": VERTICES, "normal_faces": FACES[:2]}, "there are normals of 2 triangles for 12"),
    ({"normals": VERTICES[:1], "normal_faces": FACES}, "triangle 0 uses a normal that there is not"),
    ({"normal_faces": FACES}, "normal_faces: there are no normals that they index"),
    ({"occluders": VERTICES}, "occluders: a pair of vertices and faces is wanted"),
    ({"occluders": (VERTICES, FACES + 9)}, "triangle 0 uses vertex"),
])
def test_what_does_not_fit_the_mesh_is_refused(arguments, message):
    with pytest.raises(surfelao.InputError) as caught:
        surfelao.bake(VERTICES, FACES, **arguments)
    assert str(caught.value).startswith(message)


@pytest.mark.parametrize("arguments, error, message", [
    ({"uv": VERTICES}, surfelao.InputError, "uv: the shape is (8, 3), but (n, 2) is wanted"),
    ({"uv_faces": FACES}, surfelao.InputError, "uv_faces: there is no uv that they index"),
    ({"uv": VERTICES[:, :2], "uv_faces": FACES + 1}, surfelao.InputError, "triangle 2 uses a texture"),
    ({"uv": NAN[:, :2]}, surfelao.InputError, "uv: row 5 holds nan"),
    ({"uv": 0 * VERTICES[:, :2]}, surfelao.InputError, "no triangle has an area"),
    ({"size": 0}, surfelao.SettingsError, "size must be between 1 and 32768"),
    ({"padding": -1}, surfelao.SettingsError, "padding must be between 0 and"),
])
def test_bad_maps_are_refused(arguments, error, message):
    with pytest.raises(error) as caught:
        surfelao.texture(VERTICES, FACES, **arguments)
    assert message in str(caught.value)


@pytest.mark.parametrize("points, normals, settings, message", [
    (VERTICES, None, {}, "normals: one for each point is wanted"),
    (None, VERTICES, {}, "points: there are normals, but no points"),
    (VERTICES, VERTICES[:2], {}, "normals: there are 2 for 8 points"),
    (NAN, VERTICES, {}, "points: row 5 holds nan"),
    (1e9 * VERTICES, VERTICES, {}, "receiver 0"),
    (VERTICES, VERTICES, {"offset": -1}, "offset must be 0 or more, and finite"),
    (VERTICES, VERTICES, {"offset": numpy.inf}, "offset must be 0 or more, and finite"),
    (VERTICES, VERTICES, {"seed": -1}, "seed must be between 0 and"),
    (VERTICES, VERTICES, {"quality": 5}, "quality of masks must be between -1 and 4"),
])
def test_bad_questions_are_refused(points, normals, settings, message):
    with pytest.raises(ValueError) as caught:
        surfelao.prepare(VERTICES, FACES).solve(points, normals, **settings)
    assert message in str(caught.value)


@pytest.mark.parametrize("settings, message", [
    ({"engines": "rays"}, "engines are masks or disks"),
    ({"engines": []}, "engines and qualities must not be empty"),
    ({"reference_rays": 3}, "reference_rays must be even"),
    ({"rays": [0]}, "rays must be between 1 and"),
    ({"rounds": 0}, "rounds must be between 1 and 99"),
    ({"sample": 0}, "sample must be between 1 and"),
])
def test_bad_comparisons_are_refused(settings, message):
    with pytest.raises(surfelao.SettingsError) as caught:
        surfelao.compare(VERTICES, FACES, **settings)
    assert str(caught.value).startswith(message)


def test_bad_clouds_are_refused():
    with pytest.raises(surfelao.InputError, match="points: there is none"):
        surfelao.cloud([])
    with pytest.raises(surfelao.InputError, match="there are 2 normals for 8 vertices"):
        surfelao.cloud(VERTICES, VERTICES[:2])
    with pytest.raises(surfelao.SettingsError, match="spacing"):
        surfelao.cloud(VERTICES, spacing=-1)


def test_files_are_refused_in_the_programs_words(tmp_path):
    with pytest.raises(surfelao.InputError, match="nothing.ply"):
        surfelao.read(tmp_path / "nothing.ply")


@pytest.mark.parametrize("change", [
    lambda a: a.astype(numpy.float32), lambda a: numpy.asfortranarray(a),
    lambda a: numpy.repeat(a, 3, 0)[::3], lambda a: a[::-1][::-1], lambda a: a.astype(">f8"),
    lambda a: a.tolist(), lambda a: a.astype(numpy.float16), lambda a: memoryview(a)])
def test_vertices_of_any_kind_are_the_same(change):
    expected = surfelao.bake(VERTICES, FACES, check=0).occlusion
    assert numpy.array_equal(surfelao.bake(change(VERTICES), FACES, check=0).occlusion, expected)


@pytest.mark.parametrize("kind", ["i1", "u1", "i2", "i4", "u4", "i8", "u8", ">i4", "list", "F", "view"])
def test_faces_of_any_kind_are_the_same(kind):
    faces = {"list": FACES.tolist(), "F": numpy.asfortranarray(FACES),
             "view": numpy.repeat(FACES, 2, 1)[:, ::2]}
    given = faces[kind] if kind in faces else FACES.astype(kind)
    expected = surfelao.bake(VERTICES, FACES, check=0).occlusion
    assert numpy.array_equal(surfelao.bake(VERTICES, given, check=0).occlusion, expected)

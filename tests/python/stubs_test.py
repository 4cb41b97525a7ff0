"""Types, names and words: what editors and help() show is what there is."""
import ast
import inspect
import pathlib

import pytest
import surfelao
from surfelao import _core

STUB = ast.parse(pathlib.Path(_core.__file__).with_name("_core.pyi").read_text())


def public(names):
    return {name for name in names if not name.startswith("_")}


def arguments_of_doc(function):
    """Names in the first line of what pybind11 writes: `bake(vertices: object, ...) -> ...`."""
    line = function.__doc__.splitlines()[0]
    parsed = ast.parse(f"def {line.split(' -> ')[0]}: ...".replace("surfelao::", ""))
    return [argument.arg for argument in parsed.body[0].args.args]


def test_the_stub_names_what_the_module_has():
    stubbed = {node.name for node in STUB.body if isinstance(node, (ast.ClassDef, ast.FunctionDef))}
    assert stubbed == public(vars(_core))


@pytest.mark.parametrize("node", [n for n in STUB.body if isinstance(n, ast.ClassDef)],
                         ids=lambda node: node.name)
def test_the_stub_names_what_classes_have(node):
    stubbed = {member.name for member in node.body if isinstance(member, ast.FunctionDef)}
    assert stubbed == public(vars(getattr(_core, node.name)))


@pytest.mark.parametrize("node", [n for n in STUB.body if isinstance(n, ast.FunctionDef)],
                         ids=lambda node: node.name)
def test_the_stub_names_the_arguments_of_functions(node):
    assert [a.arg for a in node.args.args] == arguments_of_doc(getattr(_core, node.name))


@pytest.mark.parametrize("function", [surfelao.bake, surfelao.texture, surfelao.cloud,
                                      surfelao.prepare, surfelao.compare, surfelao.read,
                                      surfelao.PreparedMesh.solve], ids=lambda f: f.__name__)
def test_every_argument_has_a_type_and_words(function):
    signature = inspect.signature(function)
    words = inspect.getdoc(function) + surfelao.__doc__
    for name, parameter in signature.parameters.items():
        if name in ("self", "path"):
            continue
        assert parameter.annotation is not inspect.Parameter.empty, name
        assert f"\n{name}  " in words or f"\n    {name}  " in words, name
    assert signature.return_annotation is not inspect.Signature.empty


def test_everything_public_has_words():
    for name in surfelao.__all__:
        thing = getattr(surfelao, name)
        assert inspect.getdoc(thing)
        for member in public(vars(thing)) if inspect.isclass(thing) else ():
            assert not isinstance(vars(thing)[member], property) or vars(thing)[member].__doc__, member


def test_the_marker_of_types_is_there():
    assert pathlib.Path(surfelao.__file__).with_name("py.typed").exists()

#include "bake/bake.h"
#include "files/scene_io.h"
#include "python/arrays.h"
#include "python/baked.h"
#include "python/bindings.h"
#include "python/calls.h"

#include <pybind11/pybind11.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <utility>

namespace py = pybind11;

namespace surfelao {
namespace {

/// What a file holds.
struct FileMesh {
    std::shared_ptr<const Scene> scene;
};

template <class List>
py::object rows_or_none(const FileMesh& mesh, const List& list)
{
    return list.empty() ? py::object(py::none()) : rows_of(mesh.scene, list);
}

FileMesh read_arrays(const std::filesystem::path& path)
{
    return {result_of(
        [path](const StageProgress& progress) {
            return read_scene(path,
                              {.progress = [&](double done) { return progress("read", done); }});
        },
        py::none(), {})};
}

py::list list_of_texts(const std::vector<std::string>& texts)
{
    py::list list;
    for (const std::string& text : texts)
        list.append(text);
    return list;
}

/// As bake() of files writes it.
py::list write_file(const FileMesh& mesh, const std::filesystem::path& path, const ValueBake& baked)
{
    return list_of_texts(*result_of(
        [mesh, path, owner = baked.owner(), &bake = baked.bake()](const StageProgress&) {
            return write_scene(path, *mesh.scene, bake.values,
                               {.mark = mark_of(bake.report.settings)});
        },
        py::none(), {}));
}

}  // namespace

void bind_files(py::module_& module)
{
    py::class_<FileMesh>(module, "Mesh",
                         "What a file holds, as arrays: views of the engine's memory.")
        .def_property_readonly(
            "vertices",
            [](const FileMesh& mesh) { return rows_of(mesh.scene, mesh.scene->positions); },
            "(n, 3) float64, world space, in the file's own order.")
        .def_property_readonly(
            "faces",
            [](const FileMesh& mesh) { return rows_of(mesh.scene, mesh.scene->triangles); },
            "(m, 3) uint32; polygons are cut into triangles. No rows: a cloud of points.")
        .def_property_readonly(
            "normals",
            [](const FileMesh& mesh) { return rows_or_none(mesh, mesh.scene->normals.values); },
            "(k, 3) float32, or None: the file's normals, zero where it has none.")
        .def_property_readonly(
            "normal_faces",
            [](const FileMesh& mesh) { return rows_or_none(mesh, mesh.scene->normals.corners); },
            "(m, 3) uint32: rows of normals at the corners of each face; None: the faces.")
        .def_property_readonly(
            "uv",
            [](const FileMesh& mesh) {
                return mesh.scene->uvs.empty() ? py::object(py::none())
                                               : rows_or_none(mesh, mesh.scene->uvs[0].values);
            },
            "(k, 2) float64, or None: the first texture coordinates, v downward.")
        .def_property_readonly(
            "uv_faces",
            [](const FileMesh& mesh) {
                return mesh.scene->uvs.empty() ? py::object(py::none())
                                               : rows_or_none(mesh, mesh.scene->uvs[0].corners);
            },
            "(m, 3) uint32: rows of uv at the corners of each face; None: the faces.")
        .def_property_readonly(
            "name", [](const FileMesh& mesh) { return mesh.scene->name; }, "The file's name.")
        .def_property_readonly(
            "notes", [](const FileMesh& mesh) { return list_of_texts(mesh.scene->notes); },
            "list of str: what the file holds and nobody honours.")
        .def("write", &write_file, py::arg("path"), py::arg("bake"),
             "Writes the file anew with the values of a bake of its vertices, as `surfelao bake` "
             "does: .ply .obj .off, and .gltf .glb of one. It appears complete or not at all. "
             "Returns notes: a list of str. Raises InputError, SettingsError where the number of "
             "values is another one, RuntimeError where the disk is full.");
    module.def("read", &read_arrays, py::arg("path"));
}

}  // namespace surfelao

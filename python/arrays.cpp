#include "python/arrays.h"

#include "surfels/errors.h"
#include "surfels/number_text.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

namespace py = pybind11;

namespace surfelao {
namespace {

[[noreturn]] void refuse_array(const std::string& name, const std::string& fault)
{
    throw InputError(name + ": " + fault);
}

std::string shape_of(const py::array& array)
{
    return py::str(py::tuple(array.attr("shape")));
}

/// As numpy sees it: of numbers, or of integers alone, (n, columns).
py::array table_of(const py::object& given, const std::string& name, py::ssize_t columns,
                   bool are_whole)
{
    py::array array;
    try {
        array = py::module_::import("numpy").attr("asarray")(given);
    } catch (const py::error_already_set& error) {
        if (!error.matches(PyExc_ValueError) && !error.matches(PyExc_TypeError))
            throw;
        refuse_array(name, "no array of numbers");
    }
    if (array.ndim() == 1 && array.size() == 0)  // [] has no columns
        array = array.attr("reshape")(0, columns);
    if (array.ndim() != 2 || array.shape(1) != columns)
        refuse_array(name, "the shape is " + shape_of(array) + ", but (n, " +
                               std::to_string(columns) + ") is wanted" +
                               (are_whole && array.ndim() == 2 ? ": triangles only" : ""));
    const char kind = array.dtype().kind();
    const bool is_whole = kind == 'i' || kind == 'u';
    if (!is_whole && (are_whole || kind != 'f') && array.size() > 0)
        refuse_array(name, "the type is " + std::string(py::str(array.dtype())) + ", but " +
                               (are_whole ? "integers" : "numbers") + " are wanted");
    return array;
}

/// to(row, number): what becomes of a number.
template <class From, class Vector, class To>
std::vector<Vector> copied(const py::array& array, const To& to)
{
    const auto numbers = array.unchecked<From, 2>();
    std::vector<Vector> list(static_cast<std::size_t>(numbers.shape(0)));
    for (py::ssize_t row = 0; row < numbers.shape(0); ++row)
        for (int column = 0; column < Vector::length(); ++column)
            list[static_cast<std::size_t>(row)][column] = to(row, numbers(row, column));
    return list;
}

template <class T>
bool is_of(const py::array& array)
{
    return py::isinstance<py::array_t<T>>(array) &&
           (array.flags() & py::detail::npy_api::NPY_ARRAY_ALIGNED_) != 0;
}

/// (n, length of Vector) numbers.
template <class Vector>
std::vector<Vector> vectors_of(const py::object& given, const std::string& name)
{
    const py::array array = table_of(given, name, Vector::length(), false);
    const auto finite = [&](py::ssize_t row, auto number) {
        const auto kept = static_cast<typename Vector::value_type>(number);
        if (!std::isfinite(kept))
            refuse_array(name, "row " + std::to_string(row) + " holds " + exact(kept) +
                                   ", but finite numbers are wanted");
        return kept;
    };
    if (is_of<float>(array))
        return copied<float, Vector>(array, finite);
    return copied<double, Vector>(
        is_of<double>(array) ? array : py::array(array.attr("astype")("f8")), finite);
}

}  // namespace

std::vector<glm::dvec3> places_of(const py::object& array, const std::string& name)
{
    return vectors_of<glm::dvec3>(array, name);
}

std::vector<glm::vec3> directions_of(const py::object& array, const std::string& name)
{
    return vectors_of<glm::vec3>(array, name);
}

std::vector<glm::dvec2> uvs_of(const py::object& array, const std::string& name)
{
    return vectors_of<glm::dvec2>(array, name);
}

std::vector<glm::uvec3> triples_of(const py::object& given, const std::string& name)
{
    const py::array array = table_of(given, name, 3, true);
    const auto index = [&](py::ssize_t row, auto number) {
        if (std::cmp_less(number, 0) ||
            std::cmp_greater(number, std::numeric_limits<std::uint32_t>::max()))
            refuse_array(name, "row " + std::to_string(row) + " has the index " +
                                   std::to_string(number) + ", but they go from 0 on");
        return static_cast<std::uint32_t>(number);
    };
    if (is_of<std::int32_t>(array))
        return copied<std::int32_t, glm::uvec3>(array, index);
    if (is_of<std::uint32_t>(array))
        return copied<std::uint32_t, glm::uvec3>(array, index);
    if (is_of<std::int64_t>(array))
        return copied<std::int64_t, glm::uvec3>(array, index);
    const bool is_signed = array.dtype().kind() == 'i';
    const py::array wide = array.attr("astype")(is_signed ? "i8" : "u8");
    if (is_signed)
        return copied<std::int64_t, glm::uvec3>(wide, index);
    return copied<std::uint64_t, glm::uvec3>(wide, index);
}

py::array occlusion_of(const std::shared_ptr<const void>& owner,
                       const std::vector<Occlusion>& answers)
{
    return view_of(owner, answers.empty() ? nullptr : &answers.front().occlusion,
                   {static_cast<py::ssize_t>(answers.size())}, {sizeof(Occlusion)});
}

py::array bent_normals_of(const std::shared_ptr<const void>& owner,
                          const std::vector<Occlusion>& answers)
{
    return view_of(owner, answers.empty() ? nullptr : &answers.front().bent_normal.x,
                   {static_cast<py::ssize_t>(answers.size()), 3},
                   {sizeof(Occlusion), sizeof(float)});
}

Scene scene_of(const MeshArrays& arrays)
{
    Scene scene;
    scene.positions = places_of(arrays.vertices, "vertices");
    scene.triangles = triples_of(arrays.faces, "faces");
    if (scene.triangles.empty())
        refuse_array("faces", "there is no triangle");
    if (!arrays.normals.is_none())
        scene.normals.values = directions_of(arrays.normals, "normals");
    if (!arrays.normal_faces.is_none() && scene.normals.empty())
        refuse_array("normal_faces", "there are no normals that they index");
    if (!arrays.normal_faces.is_none())
        scene.normals.corners = triples_of(arrays.normal_faces, "normal_faces");
    if (!arrays.uv.is_none())
        scene.uvs.push_back({uvs_of(arrays.uv, "uv"), {}});
    if (!arrays.uv_faces.is_none()) {
        if (scene.uvs.empty())
            refuse_array("uv_faces", "there is no uv that they index");
        scene.uvs.front().corners = triples_of(arrays.uv_faces, "uv_faces");
    }
    check_scene(scene);
    Part part;
    part.vertex_count = static_cast<std::uint32_t>(scene.positions.size());
    part.triangle_count = static_cast<std::uint32_t>(scene.triangles.size());
    scene.parts = {part};
    return scene;
}

Scene cloud_of(const py::object& points, const py::object& normals)
{
    Scene scene;
    scene.positions = places_of(points, "points");
    if (scene.positions.empty())
        refuse_array("points", "there is none");
    if (!normals.is_none())
        scene.normals.values = directions_of(normals, "normals");
    check_scene(scene);
    Part part;
    part.vertex_count = static_cast<std::uint32_t>(scene.positions.size());
    scene.parts = {part};
    return scene;
}

}  // namespace surfelao

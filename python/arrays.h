/// arrays.h: numpy arrays in, numpy arrays out.
///
/// In: anything that numpy makes an array of, of any order, strides and number type. It is read
/// once, into the engine's own lists, which are all that is kept: no array in between for float64,
/// float32, int32, uint32 and int64. Out: views of the engine's own memory, which lives as long as
/// any view of it. Faults are InputError and name array, row, what was found and what was wanted.
#pragma once

#include "surfels/occlusion.h"
#include "surfels/scene.h"

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <memory>
#include <string>
#include <vector>

namespace surfelao {

/// (n, 3) numbers. name: what messages call the array.
[[nodiscard]] std::vector<glm::dvec3> places_of(const pybind11::object& array,
                                                const std::string& name);

/// (n, 3) numbers as floats.
[[nodiscard]] std::vector<glm::vec3> directions_of(const pybind11::object& array,
                                                   const std::string& name);

/// (n, 2) numbers.
[[nodiscard]] std::vector<glm::dvec2> uvs_of(const pybind11::object& array,
                                             const std::string& name);

/// (m, 3) integers from 0 on; 2^32 - 1 is kNone of normals and texture coordinates.
[[nodiscard]] std::vector<glm::uvec3> triples_of(const pybind11::object& array,
                                                 const std::string& name);

/// A view of the numbers at `first`, `strides` in bytes, which keeps the owner alive.
template <class T>
[[nodiscard]] pybind11::array view_of(const std::shared_ptr<const void>& owner, const T* first,
                                      std::vector<pybind11::ssize_t> shape,
                                      std::vector<pybind11::ssize_t> strides)
{
    if (first == nullptr)  // an empty list has no memory
        return pybind11::array(pybind11::dtype::of<T>(), std::move(shape), std::move(strides));
    const pybind11::capsule keeper(new std::shared_ptr<const void>(owner), [](void* held) {
        delete static_cast<std::shared_ptr<const void>*>(held);
    });
    return pybind11::array(pybind11::dtype::of<T>(), std::move(shape), std::move(strides), first,
                           keeper);
}

/// (n, L) of a list of GLM's vectors of length L.
template <class Vector>
[[nodiscard]] pybind11::array rows_of(const std::shared_ptr<const void>& owner,
                                      const std::vector<Vector>& list)
{
    using T = typename Vector::value_type;
    return view_of(owner, list.empty() ? nullptr : &list.front()[0],
                   {static_cast<pybind11::ssize_t>(list.size()), Vector::length()},
                   {sizeof(Vector), sizeof(T)});
}

/// (n,) and (n, 3) of answers.
[[nodiscard]] pybind11::array occlusion_of(const std::shared_ptr<const void>& owner,
                                           const std::vector<Occlusion>& answers);
[[nodiscard]] pybind11::array bent_normals_of(const std::shared_ptr<const void>& owner,
                                              const std::vector<Occlusion>& answers);

/// What a user gives of a mesh. Of the pairs of values and faces, faces may be None: one value per
/// vertex. Throws InputError as make_scene() does.
struct MeshArrays {
    pybind11::object vertices, faces;
    pybind11::object normals = pybind11::none(), normal_faces = pybind11::none();
    pybind11::object uv = pybind11::none(), uv_faces = pybind11::none();
};
[[nodiscard]] Scene scene_of(const MeshArrays& arrays);

/// Points, with normals or None.
[[nodiscard]] Scene cloud_of(const pybind11::object& points, const pybind11::object& normals);

}  // namespace surfelao

/// bindings.h: what the module _core consists of. The package `surfelao` around it has the
/// functions as users call them; those here take the same arguments in one dict (options.h).
#pragma once

#include <pybind11/pybind11.h>

namespace surfelao {

void bind_bakes(pybind11::module_& module);     ///< Result, Bake, Texture; bake, cloud, texture
void bind_prepared(pybind11::module_& module);  ///< Prepared; prepare
void bind_compare(pybind11::module_& module);   ///< compare
void bind_files(pybind11::module_& module);     ///< Mesh; read

}  // namespace surfelao

#include "python/bindings.h"
#include "python/calls.h"
#include "surfels/errors.h"
#include "surfels/progress.h"

#include <pybind11/pybind11.h>

namespace py = pybind11;

PYBIND11_MODULE(_core, module)
{
    using namespace surfelao;
    module.doc() = "The engine behind the package surfelao, which is how it is called.";
    module.attr("__version__") = SURFELAO_VERSION;
    py::register_exception<InputError>(module, "InputError", PyExc_ValueError).doc() =
        "An array or a file is no mesh, or no cloud. The message names element and fault.";
    py::register_exception<SettingsError>(module, "SettingsError", PyExc_ValueError).doc() =
        "An argument is out of its range. The message names it and the range.";
    py::register_exception<Cancelled>(module, "Cancelled", PyExc_Exception).doc() =
        "The function given as `progress` returned False.";
    for (const char* name : {"InputError", "SettingsError", "Cancelled"})
        module.attr(name).attr("__module__") = "surfelao";
    bind_bakes(module);
    bind_prepared(module);
    bind_compare(module);
    bind_files(module);
    py::module_::import("atexit").attr("register")(py::cpp_function(&end_calls));
}

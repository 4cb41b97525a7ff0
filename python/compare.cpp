#include "bake/compare.h"
#include "python/arrays.h"
#include "python/bindings.h"
#include "python/calls.h"
#include "python/options.h"
#include "reference/rays.h"
#include "surfels/errors.h"

#include <pybind11/pybind11.h>

#include <utility>

namespace py = pybind11;

namespace surfelao {
namespace {

constexpr std::int64_t kMostRounds = 99;
constexpr std::int64_t kMostPoints = std::int64_t{1} << 30;

/// A single value stands for a list of one.
py::list list_of(const py::object& given)
{
    py::list list;
    if (py::isinstance<py::str>(given) || !py::isinstance<py::iterable>(given))
        list.append(given);
    else
        for (const py::handle item : given)
            list.append(item);
    return list;
}

std::int64_t rays_in(const py::handle& number)
{
    py::dict one;
    one["rays"] = number;
    return Options(one).integer("rays", 1, kMostRays);
}

CompareSettings compare_settings_of(const Options& options)
{
    CompareSettings settings;
    for (const py::handle engine : list_of(options.get("engines"))) {
        for (const py::handle quality : list_of(options.get("qualities"))) {
            EngineSettings& candidate = settings.candidates.emplace_back();
            candidate.engine = engine_named(py::reinterpret_borrow<py::object>(engine));
            candidate.quality = quality_of(py::reinterpret_borrow<py::object>(quality));
            require(candidate.engine != Engine::rays,
                    "engines are masks or disks: rays are what they are compared with");
        }
    }
    require(!settings.candidates.empty(), "engines and qualities must not be empty");
    settings.rays.clear();
    for (const py::handle number : list_of(options.get("rays")))
        settings.rays.push_back(static_cast<std::uint32_t>(rays_in(number)));
    settings.max_distance = limit_of(options);
    settings.ground = ground_of(options);
    settings.target = target_of(options);
    settings.reference_rays =
        static_cast<std::uint32_t>(options.integer("reference_rays", 2, kMostRays));
    require(settings.reference_rays % 2 == 0, "reference_rays must be even");
    settings.sample = static_cast<std::uint64_t>(options.integer("sample", 1, kMostPoints));
    settings.rounds = static_cast<int>(options.integer("rounds", 1, kMostRounds));
    settings.use_cache = false;
    for (EngineSettings candidate : settings.candidates)
        check_settings(candidate, candidate);
    return settings;
}

py::object compare_arrays(const py::object& vertices, const py::object& faces,
                          const py::dict& given)
{
    const Options options(given);
    CompareSettings settings = compare_settings_of(options);
    Scene scene = scene_of({vertices, faces, normal_rows_of(options), options.get("normal_faces")});
    const auto told = result_of(
        [scene = std::make_shared<Scene>(std::move(scene)),
         settings = std::move(settings)](const StageProgress& progress) {
            return json_of(compare(std::move(*scene), settings, progress));
        },
        options.get("progress"), threads_of(options));
    return py::module_::import("json").attr("loads")(*told);
}

}  // namespace

void bind_compare(py::module_& module)
{
    module.def("compare", &compare_arrays, py::arg("vertices"), py::arg("faces"),
               py::arg("options"));
}

}  // namespace surfelao

#include "bake/vertex_target.h"
#include "bake/world.h"
#include "engines/engine.h"
#include "python/arrays.h"
#include "python/bindings.h"
#include "python/calls.h"
#include "python/options.h"
#include "surfels/errors.h"

#include <pybind11/pybind11.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <cstdint>
#include <mutex>
#include <utility>

namespace py = pybind11;

namespace surfelao {
namespace {

/// A mesh, and what an engine has built of it.
struct PreparedMesh {
    std::shared_ptr<const Mesh> mesh;
    TargetSettings target;
    Prepared prepared;
    std::mutex one_at_a_time = {};  ///< on the GPU

    PreparedMesh(std::shared_ptr<const Mesh> of, TargetSettings settings, Prepared built)
        : mesh(std::move(of)), target(std::move(settings)), prepared(std::move(built))
    {
    }
};

/// Points of the world, each with a direction of any length.
struct Places {
    std::vector<glm::dvec3> points;
    std::vector<glm::vec3> normals;
    double offset = 0.0;  ///< along the normal, in the world's units
};

std::vector<Receiver> receivers_in(const Frame& frame, const Places& places)
{
    std::vector<Receiver> receivers;
    receivers.reserve(places.points.size());
    for (std::size_t i = 0; i < places.points.size(); ++i) {
        const glm::dvec3 direction(places.normals[i]);
        const double length = glm::length(direction);
        const glm::dvec3 normal = length > 0.0 ? direction / length : glm::dvec3(0.0);
        const glm::dvec3 place = places.points[i] + places.offset * normal;
        receivers.push_back({glm::vec3((place - frame.centre) / frame.diagonal), glm::vec3(normal),
                             static_cast<float>(places.offset / frame.diagonal)});
    }
    return receivers;
}

Places places_in(const py::object& points, const py::object& normals, const Options& options,
                 double usual_offset)
{
    Places places{places_of(points, "points"), {}, options.number("offset").value_or(usual_offset)};
    require(std::isfinite(places.offset) && places.offset >= 0.0,
            "offset must be 0 or more, and finite");
    if (normals.is_none())
        throw InputError("normals: one for each point is wanted");
    places.normals = directions_of(normals, "normals");
    if (places.normals.size() != places.points.size())
        throw InputError("normals: there are " + std::to_string(places.normals.size()) + " for " +
                         std::to_string(places.points.size()) + " points");
    return places;
}

/// At places, or at the vertices where there are none.
std::vector<Occlusion> answers_at(PreparedMesh& of, const std::optional<Places>& places,
                                  const SolveSettings& settings, const Progress& progress)
{
    std::unique_lock lock(of.one_at_a_time, std::defer_lock);
    if (of.prepared.choice().device == Device::gpu)
        lock.lock();
    if (places)
        return solve(of.prepared, receivers_in(of.mesh->geometry.frame, *places), settings,
                     progress)
            .occlusion;
    const VertexTarget target(of.mesh, of.target);
    return target.values(solve(of.prepared, target.receivers(), settings, progress).occlusion);
}

py::tuple solve_arrays(const std::shared_ptr<PreparedMesh>& of, const py::object& points,
                       const py::object& normals, const py::dict& given)
{
    const Options options(given);
    const Geometry& geometry = of->mesh->geometry;
    SolveSettings settings;
    settings.quality = quality_of(options.get("quality"));
    settings.rays = static_cast<std::uint32_t>(options.integer("rays", 1, UINT32_MAX));
    settings.seed = static_cast<std::uint32_t>(options.integer("seed", 0, UINT32_MAX));
    settings.definition = definition_of(limit_of(options), Kernel::cosine, geometry.frame);
    settings.definition.ground =
        ground_of(ground_of(options), {geometry}, largest_offset_of(of->target, geometry.frame));
    check_settings(of->prepared.choice(), settings);
    std::optional<Places> places;
    if (!points.is_none())
        places = places_in(points, normals, options, kMostOffset * geometry.frame.diagonal);
    else if (!normals.is_none())
        throw InputError("points: there are normals, but no points");
    const auto solved = result_of(
        [of, settings, places = std::move(places)](const StageProgress& progress) {
            return answers_at(*of, places, settings,
                              [&](double done) { return progress("solve", done); });
        },
        options.get("progress"), threads_of(options));
    return py::make_tuple(occlusion_of(solved, *solved), bent_normals_of(solved, *solved));
}

std::shared_ptr<PreparedMesh> prepare_arrays(const py::object& vertices, const py::object& faces,
                                             const py::dict& given)
{
    const Options options(given);
    EngineChoice choice;
    choice.engine = engine_named(options.get("engine"));
    choice.device = options.word("device", {"cpu", "gpu"}) == 0 ? Device::cpu : Device::gpu;
    TargetSettings target = target_of(options);
    target.values = VertexValues::point;
    Scene scene = scene_of({vertices, faces, normal_rows_of(options), options.get("normal_faces")});
    const auto built = result_of(
        [scene = std::make_shared<Scene>(std::move(scene)), target,
         choice](const StageProgress& progress) {
            if (!progress("read", 0.0))
                throw Cancelled();
            auto mesh =
                std::make_shared<const Mesh>(mesh_of(std::move(*scene), {}, target.normals, {}));
            if (!progress("prepare", 0.0))
                throw Cancelled();
            Prepared prepared = prepare(mesh->occluding(), choice);
            return std::make_shared<PreparedMesh>(std::move(mesh), target, std::move(prepared));
        },
        options.get("progress"), threads_of(options));
    return *built;
}

}  // namespace

void bind_prepared(py::module_& module)
{
    py::class_<PreparedMesh, std::shared_ptr<PreparedMesh>>(
        module, "Prepared", "A mesh, and what an engine has built of it.")
        .def_property_readonly(
            "diagonal", [](const PreparedMesh& of) { return of.mesh->geometry.frame.diagonal; },
            "float: of the bounding box of all faces, in the mesh's units.")
        .def("solve", &solve_arrays, py::arg("points"), py::arg("normals"), py::arg("options"));
    module.def("prepare", &prepare_arrays, py::arg("vertices"), py::arg("faces"),
               py::arg("options"));
}

}  // namespace surfelao

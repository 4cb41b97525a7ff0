#include "bake/bake.h"
#include "python/arrays.h"
#include "python/baked.h"
#include "python/bindings.h"
#include "python/calls.h"
#include "python/options.h"
#include "surfels/errors.h"

#include <pybind11/pybind11.h>

#include <utility>

namespace py = pybind11;

namespace surfelao {
namespace {

struct TextureBake : BakeResult {
    using BakeResult::BakeResult;
};

/// As the program's --json tells it.
py::object report_of(const BakeReport& report)
{
    const BatchEntry entry{{}, {}, report, {}};
    return py::module_::import("json").attr("loads")(json_of({&entry, 1}));
}

MeshArrays arrays_of(py::object vertices, py::object faces, const Options& options)
{
    return {std::move(vertices),         std::move(faces),  normal_rows_of(options),
            options.get("normal_faces"), options.get("uv"), options.get("uv_faces")};
}

/// None, or vertices and faces.
std::vector<Scene> occluders_of(const Options& options)
{
    const py::object given = options.get("occluders");
    std::vector<Scene> scenes;
    if (given.is_none())
        return scenes;
    if (!py::isinstance<py::sequence>(given) || py::len(given) != 2)
        throw InputError("occluders: a pair of vertices and faces is wanted");
    scenes.push_back(scene_of({given[py::int_(0)], given[py::int_(1)]}));
    return scenes;
}

/// From what maps hold to what is told everywhere else: 0 is open; directions themselves.
void decode(MapBake& map)
{
    for (float& value : map.visibility.front().values)
        value = 1.0f - value;
    if (!map.bent.empty())
        for (float& value : map.bent.front().values)
            value = 2.0f * value - 1.0f;
}

std::shared_ptr<SceneBake> run_bake(Scene scene, std::vector<Scene> others, BakeSettings settings,
                                    const Options& options)
{
    return result_of(
        [scene = std::make_shared<Scene>(std::move(scene)), others = std::move(others),
         settings = std::move(settings)](const StageProgress& progress) {
            SceneBake bake = bake_scene(std::move(*scene), others, settings, progress);
            if (bake.map)
                decode(*bake.map);
            return bake;
        },
        options.get("progress"), threads_of(options));
}

ValueBake bake_arrays(const py::object& vertices, const py::object& faces, const py::dict& given)
{
    const Options options(given);
    BakeSettings settings = bake_settings_of(options);
    return ValueBake(run_bake(scene_of(arrays_of(vertices, faces, options)), occluders_of(options),
                              std::move(settings), options));
}

ValueBake cloud_arrays(const py::object& points, const py::dict& given)
{
    const Options options(given);
    BakeSettings settings = bake_settings_of(options);
    if (const py::object eye = options.get("viewpoint"); !eye.is_none()) {
        py::list rows;
        rows.append(eye);
        settings.target.viewpoint = places_of(rows, "viewpoint").front();
    }
    if (const std::optional<double> spacing = options.number("spacing"))
        settings.target.occluder_spacing = Length{*spacing, false};
    return ValueBake(
        run_bake(cloud_of(points, normal_rows_of(options)), {}, std::move(settings), options));
}

TextureBake texture_arrays(const py::object& vertices, const py::object& faces,
                           const py::dict& given)
{
    const Options options(given);
    BakeSettings settings = bake_settings_of(options);
    TexelSettings& texels = settings.texels.emplace();
    texels.size = static_cast<std::uint32_t>(options.integer("size", 1, kMostTexels));
    texels.padding = static_cast<std::uint32_t>(options.integer("padding", 0, kMostTexels));
    texels.uvs = options.get("uv").is_none() ? UvChoice::made : UvChoice::file;
    texels.depth = MapDepth::whole;
    if (py::bool_(options.get("bent")))
        texels.bent = BentSpace::world;
    return TextureBake(run_bake(scene_of(arrays_of(vertices, faces, options)),
                                occluders_of(options), std::move(settings), options));
}

py::array texels_of(const BakeResult& baked, const Map& map)
{
    const auto rows = static_cast<py::ssize_t>(map.height);
    const auto columns = static_cast<py::ssize_t>(map.width);
    const auto channels = static_cast<py::ssize_t>(map.channels);
    constexpr py::ssize_t kSize = sizeof(float);
    if (channels == 1)
        return view_of(baked.owner(), map.values.data(), {rows, columns}, {columns * kSize, kSize});
    return view_of(baked.owner(), map.values.data(), {rows, columns, channels},
                   {columns * channels * kSize, channels * kSize, kSize});
}

void bind_result(py::module_& module)
{
    py::class_<BakeResult>(module, "Result", "What every bake tells of itself.")
        .def_property_readonly(
            "report", [](const BakeResult& baked) { return baked.report(); },
            "dict: everything that is told of the bake, as `surfelao bake --json` writes it.")
        .def_property_readonly(
            "error", [](const BakeResult& baked) { return baked.told("error"); },
            "dict or None: the error of what is displayed, measured at `check` points: rmse, in 95 "
            "of 100 bakes between low and high; bias (positive: too dark), p95, floor (what more "
            "exact answers would leave).")
        .def_property_readonly(
            "seconds", [](const BakeResult& baked) { return baked.told("seconds"); },
            "dict: wall-clock seconds of each stage.")
        .def_property_readonly(
            "notes", [](const BakeResult& baked) { return baked.told("notes"); },
            "list of str: what a user should know of the input and the result, in the words of the "
            "program, whose options are called --so.");
}

}  // namespace

BakeResult::BakeResult(std::shared_ptr<SceneBake> bake)
    : bake_(std::move(bake)), report_(report_of(bake_->report))
{
}

void bind_bakes(py::module_& module)
{
    bind_result(module);
    py::class_<ValueBake, BakeResult>(module, "Bake", "Values at vertices or points.")
        .def_property_readonly(
            "occlusion",
            [](const ValueBake& baked) { return occlusion_of(baked.owner(), baked.bake().values); },
            "(n,) float32, 0 = open to 1 = closed. A view of the engine's memory.")
        .def_property_readonly(
            "bent_normals",
            [](const ValueBake& baked) {
                return bent_normals_of(baked.owner(), baked.bake().values);
            },
            "(n, 3) float32, of unit length: to the middle of what is open; zero where a vertex "
            "has no normal. A view of the engine's memory.");

    py::class_<TextureBake, BakeResult>(module, "Texture", "A map over a surface.")
        .def_property_readonly(
            "occlusion",
            [](const TextureBake& baked) {
                return texels_of(baked, baked.bake().map->visibility.front());
            },
            "(size, size) float32, 0 = open to 1 = closed; row 0 lies at v = 0.")
        .def_property_readonly(
            "bent_normals",
            [](const TextureBake& baked) -> py::object {
                const std::vector<Map>& bent = baked.bake().map->bent;
                return bent.empty() ? py::object(py::none()) : texels_of(baked, bent.front());
            },
            "(size, size, 3) float32 in world space, or None where they were not asked for.")
        .def_property_readonly(
            "uv",
            [](const TextureBake& baked) {
                return rows_of(baked.owner(), baked.bake().layout->pages.front().values);
            },
            "(k, 2) float64, 0 to 1: texture coordinates, given or made.")
        .def_property_readonly(
            "uv_faces",
            [](const TextureBake& baked) -> py::object {
                const std::vector<glm::uvec3>& corners = baked.bake().layout->pages.front().corners;
                return corners.empty() ? py::object(py::none()) : rows_of(baked.owner(), corners);
            },
            "(m, 3) uint32: rows of uv at the corners of each face, 2**32 - 1 where it has no "
            "place; None: the faces themselves.");

    module.def("bake", &bake_arrays, py::arg("vertices"), py::arg("faces"), py::arg("options"));
    module.def("cloud", &cloud_arrays, py::arg("points"), py::arg("options"));
    module.def("texture", &texture_arrays, py::arg("vertices"), py::arg("faces"),
               py::arg("options"));
}

}  // namespace surfelao

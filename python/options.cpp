#include "python/options.h"

#include "python/arrays.h"
#include "surfels/errors.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <limits>
#include <utility>

namespace py = pybind11;

namespace surfelao {
namespace {

[[noreturn]] void refuse_option(const std::string& sentence)
{
    throw SettingsError(sentence);
}

std::string quoted(const py::handle& object)
{
    return py::repr(object);
}

/// Of anything that Python can make a float of, but for text.
std::optional<double> number_in(const py::object& object)
{
    if (object.is_none() || py::isinstance<py::str>(object) || py::isinstance<py::bool_>(object))
        return {};
    const double number = PyFloat_AsDouble(object.ptr());
    if (PyErr_Occurred() == nullptr)
        return number;
    PyErr_Clear();
    return {};
}

/// "y", "z" or a direction.
glm::vec3 direction_of(const py::object& up)
{
    if (py::isinstance<py::str>(up)) {
        const std::string name = py::str(up);
        if (name == "y")
            return {0.0f, 1.0f, 0.0f};
        if (name == "z")
            return {0.0f, 0.0f, 1.0f};
        refuse_option("up must be y, z or three numbers, not " + quoted(up));
    }
    py::list rows;
    rows.append(up);
    const glm::dvec3 direction = places_of(rows, "up").front();
    const double length = glm::length(direction);
    if (!(length > 0.0) || !std::isfinite(length))
        refuse_option("up must have a length");
    return glm::vec3(direction / length);
}

}  // namespace

py::object Options::get(const char* name) const
{
    return given_.contains(name) ? py::object(given_[name]) : py::none();
}

std::optional<double> Options::number(const char* name) const
{
    const py::object object = get(name);
    const std::optional<double> found = number_in(object);
    if (!found && !object.is_none())
        refuse_option(std::string(name) + " must be a number, not " + quoted(object));
    return found;
}

std::optional<std::int64_t> Options::integer(const char* name) const
{
    const py::object object = get(name);
    if (object.is_none())
        return {};
    if (PyIndex_Check(object.ptr()) == 0 || py::isinstance<py::bool_>(object))
        refuse_option(std::string(name) + " must be an integer, not " + quoted(object));
    const py::object index = py::reinterpret_steal<py::object>(PyNumber_Index(object.ptr()));
    if (!index)
        throw py::error_already_set();
    int overflow = 0;
    const long long value = PyLong_AsLongLongAndOverflow(index.ptr(), &overflow);
    if (overflow != 0)
        refuse_option(std::string(name) + " is out of its range: " + quoted(object));
    return value;
}

std::int64_t Options::integer(const char* name, std::int64_t least, std::int64_t most) const
{
    const std::optional<std::int64_t> value = integer(name);
    if (!value || *value < least || *value > most)
        refuse_option(std::string(name) + " must be between " + std::to_string(least) + " and " +
                      std::to_string(most));
    return *value;
}

std::size_t Options::word(const char* name, std::initializer_list<const char*> words) const
{
    const py::object object = get(name);
    std::string all;
    for (std::size_t i = 0; i < words.size(); ++i) {
        const char* const word = words.begin()[i];
        if (py::isinstance<py::str>(object) && std::string(py::str(object)) == word)
            return i;
        all += i == 0 ? "" : i + 1 < words.size() ? ", " : " or ";
        all += word;
    }
    refuse_option(std::string(name) + " must be " + all + ", not " + quoted(object));
}

Engine engine_named(const py::object& name)
{
    for (const Engine engine : {Engine::masks, Engine::disks, Engine::rays})
        if (py::isinstance<py::str>(name) && std::string(py::str(name)) == name_of(engine))
            return engine;
    refuse_option("engine must be masks, disks or rays, not " + quoted(name));
}

float quality_of(const py::object& quality)
{
    if (const std::optional<double> number = number_in(quality))
        return static_cast<float>(*number);
    const std::string word = py::isinstance<py::str>(quality) ? std::string(py::str(quality)) : "";
    if (word == "draft")
        return kDraft;
    if (word == "good")
        return kGood;
    if (word == "best")
        return kBest;
    refuse_option("quality must be draft, good, best or a number, not " + quoted(quality));
}

EngineSettings engine_of(const Options& options)
{
    EngineSettings settings;
    settings.engine = engine_named(options.get("engine"));
    settings.device = options.word("device", {"cpu", "gpu"}) == 0 ? Device::cpu : Device::gpu;
    settings.quality = quality_of(options.get("quality"));
    settings.rays = static_cast<std::uint32_t>(
        options.integer("rays", 1, std::numeric_limits<std::uint32_t>::max()));
    return settings;
}

DistanceLimit limit_of(const Options& options)
{
    DistanceLimit limit;
    limit.value = options.number("max_distance").value_or(limit.value);
    if (options.word("falloff", {"none", "smooth"}) == 1)
        limit.falloff = Falloff::smooth;
    return limit;
}

std::optional<GroundPlane> ground_of(const Options& options)
{
    const py::object ground = options.get("ground");
    const glm::vec3 up = direction_of(options.get("up"));
    if (ground.is_none() || ground.is(py::bool_(false)))
        return {};
    if (ground.is(py::bool_(true)))
        return GroundPlane{up, {}};
    const std::optional<double> height = options.number("ground");
    if (!std::isfinite(*height))
        refuse_option("ground must be True or a finite height");
    return GroundPlane{up, height};
}

py::object normal_rows_of(const Options& options)
{
    const py::object normals = options.get("normals");
    return py::isinstance<py::str>(normals) ? py::none() : normals;
}

TargetSettings target_of(const Options& options)
{
    TargetSettings settings;
    const py::object normals = options.get("normals");
    if (py::isinstance<py::str>(normals)) {
        static_cast<void>(options.word("normals", {"flat"}));
        settings.normals.source = NormalSource::flat;
    }
    if (const std::optional<double> crease = options.number("crease"))
        settings.normals.crease = static_cast<float>(*crease);
    if (!options.get("values").is_none() && options.word("values", {"fit", "point"}) == 1)
        settings.values = VertexValues::point;
    return settings;
}

std::optional<int> threads_of(const Options& options)
{
    if (options.get("threads").is_none())
        return {};
    return static_cast<int>(options.integer("threads", 1, std::numeric_limits<int>::max()));
}

BakeSettings bake_settings_of(const Options& options)
{
    BakeSettings settings;
    settings.engine = engine_of(options);
    check_settings(settings.engine, settings.engine);
    settings.max_distance = limit_of(options);
    settings.ground = ground_of(options);
    settings.target = target_of(options);
    settings.check = static_cast<std::uint32_t>(options.integer("check", 0, kMostCheckPoints));
    settings.error = options.number("error");
    require(!settings.error || (*settings.error > 0.0 && std::isfinite(*settings.error)),
            "error must be above 0, and finite");
    require(!settings.error || settings.check > 0, "error needs a check of at least 1 point");
    return settings;
}

}  // namespace surfelao

/// options.h: the keyword arguments of the package's functions, as settings of the engine.
///
/// The package passes every argument of a function by its name. A wrong type or value is a
/// SettingsError that names the argument; ranges that the engine knows are checked there.
#pragma once

#include "bake/bake.h"
#include "engines/engine.h"

#include <pybind11/pybind11.h>

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <utility>

namespace surfelao {

class Options {
public:
    explicit Options(pybind11::dict given) : given_(std::move(given)) {}

    /// None where it is not among the arguments.
    [[nodiscard]] pybind11::object get(const char* name) const;
    /// Empty for None.
    [[nodiscard]] std::optional<double> number(const char* name) const;
    [[nodiscard]] std::optional<std::int64_t> integer(const char* name) const;
    /// least to most; the argument is not None.
    [[nodiscard]] std::int64_t integer(const char* name, std::int64_t least,
                                       std::int64_t most) const;
    /// One of these words; its place among them.
    [[nodiscard]] std::size_t word(const char* name,
                                   std::initializer_list<const char*> words) const;

private:
    pybind11::dict given_;
};

/// engine, device, quality, rays.
[[nodiscard]] EngineSettings engine_of(const Options& options);
[[nodiscard]] Engine engine_named(const pybind11::object& name);
/// A number, or "draft", "good", "best".
[[nodiscard]] float quality_of(const pybind11::object& quality);
/// max_distance, falloff.
[[nodiscard]] DistanceLimit limit_of(const Options& options);
/// ground, up.
[[nodiscard]] std::optional<GroundPlane> ground_of(const Options& options);
/// The argument normals where it is no word ("flat"): rows of an array, or None.
[[nodiscard]] pybind11::object normal_rows_of(const Options& options);
/// normals (where it is a word), crease, values.
[[nodiscard]] TargetSettings target_of(const Options& options);
/// threads.
[[nodiscard]] std::optional<int> threads_of(const Options& options);

/// What bakes of every kind have in common: all of the above, error and check.
[[nodiscard]] BakeSettings bake_settings_of(const Options& options);

}  // namespace surfelao

/// baked.h: a result, as Python sees it.
#pragma once

#include "bake/bake.h"

#include <pybind11/pybind11.h>

#include <memory>

namespace surfelao {

class BakeResult {
public:
    explicit BakeResult(std::shared_ptr<SceneBake> bake);

    [[nodiscard]] const SceneBake& bake() const { return *bake_; }
    [[nodiscard]] std::shared_ptr<const void> owner() const { return bake_; }
    /// What the program's --json tells, as a dict.
    [[nodiscard]] pybind11::object report() const { return report_; }
    [[nodiscard]] pybind11::object told(const char* key) const { return report_[key]; }

private:
    std::shared_ptr<SceneBake> bake_;
    pybind11::object report_;
};

/// Values at vertices or points.
struct ValueBake : BakeResult {
    using BakeResult::BakeResult;
};

}  // namespace surfelao

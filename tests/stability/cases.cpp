#include "tests/stability/cases.h"

#include "tests/scenes.h"

#include <cstdio>

namespace surfelao::stability {

std::string label(const char* format, double value)
{
    char text[128];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

Scene two_faced(Scene scene)
{
    const Scene back = scenes::flipped(scene);
    scene.triangles.insert(scene.triangles.end(), back.triangles.begin(), back.triangles.end());
    return scene;
}

std::vector<Case> all_cases()
{
    std::vector<Case> cases;
    add_sheet_cases(cases);
    add_solid_cases(cases);
    add_clutter_cases(cases);
    add_degenerate_cases(cases);
    add_invariance_cases(cases);
    return cases;
}

}  // namespace surfelao::stability

#include "tests/stability/cases.h"

#include <cstdio>

namespace surfelao::stability {

std::string label(const char* format, double value)
{
    char text[128];
    std::snprintf(text, sizeof text, format, value);
    return text;
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

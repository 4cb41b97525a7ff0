/// differences.h: how far two lists of answers are apart, for the tests of every folder.
#pragma once

#include "surfels/occlusion.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

namespace surfelao {

/// Of b from a, over all receivers, in occlusion but for `bent_normal`.
struct Difference {
    double mean = 0.0;  ///< with its sign
    double rms = 0.0;
    double largest = 0.0;
    /// RMS length of the bent normals' difference times what is open in a: where only little is,
    /// it may be another little.
    double bent_normal = 0.0;
    /// Length of the bent normals' difference, where more than 5 % is open in a.
    double largest_bent_normal = 0.0;
};

/// Both of one length, not empty.
inline Difference difference(const std::vector<Occlusion>& a, const std::vector<Occlusion>& b)
{
    Difference result;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double d = double{b[i].occlusion} - double{a[i].occlusion};
        const double turned = glm::distance(b[i].bent_normal, a[i].bent_normal);
        const double bent = turned * (1.0 - double{a[i].occlusion});
        result.mean += d;
        result.rms += d * d;
        result.bent_normal += bent * bent;
        result.largest = std::max(result.largest, std::abs(d));
        if (a[i].occlusion < 0.95f)
            result.largest_bent_normal = std::max(result.largest_bent_normal, turned);
    }
    const double n = static_cast<double>(a.size());
    result.mean /= n;
    result.rms = std::sqrt(result.rms / n);
    result.bent_normal = std::sqrt(result.bent_normal / n);
    return result;
}

inline double rms_difference(const std::vector<Occlusion>& a, const std::vector<Occlusion>& b)
{
    return difference(a, b).rms;
}

inline double mean_occlusion(const std::vector<Occlusion>& answers)
{
    double sum = 0.0;
    for (const Occlusion& answer : answers)
        sum += answer.occlusion;
    return sum / static_cast<double>(answers.size());
}

/// Any vectors of plain values.
template <class Values>
bool same_bytes(const Values& a, const Values& b)
{
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0;
}

}  // namespace surfelao

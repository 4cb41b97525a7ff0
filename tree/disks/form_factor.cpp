#include "tree/disks/form_factor.h"

#include <algorithm>
#include <vector>

namespace surfelao {

double disk_form_factor(Kernel kernel, const glm::dvec3& receiver, const glm::dvec3& normal,
                        const DiskShape& disk)
{
    const glm::dvec3 c = glm::dvec3(disk.center) - receiver;
    const double d2 = glm::dot(c, c) + double{kTinyLength} * kTinyLength;
    const glm::dvec3 w = c / std::sqrt(d2);
    const glm::dvec3 m(disk.normal);
    const double at_receiver = glm::dot(normal, w);
    const double at_disk = glm::dot(m, w);
    if (at_receiver <= 0.0)
        return 0.0;
    const double facing = disk.two_sided ? std::abs(at_disk) : std::max(0.0, at_disk);
    const double x = disk.flat_area / (std::numbers::pi * d2);
    if (kernel == Kernel::bunnell)
        return (1.0 - 1.0 / std::sqrt(1.0 + x)) * facing * std::min(1.0, 4.0 * at_receiver);

    const double all = disk.area / (std::numbers::pi * d2);
    const double spread = std::max(0.0, all - x) * (disk.two_sided ? 0.5 : 0.25);
    const double second = x < kNearDisk ? x : 0.0;
    const double correction =
        at_receiver * (2.0 - 3.0 * at_disk * at_disk) + at_disk * glm::dot(normal, m);
    const double flat = x * facing * std::max(0.0, at_receiver + second * correction);
    return (flat + spread * at_receiver) / (1.0 + all);
}

glm::dvec3 triangle_moment(const glm::dvec3& c, const glm::dvec3& normal, const Surfel& surfel)
{
    const glm::dvec3 a(surfel.corners[0]), b(surfel.corners[1]);
    const glm::dvec3 corners[] = {c + a, c + b, c - a - b};
    std::vector<glm::dvec3> above;
    for (int i = 0; i < 3; ++i) {
        const glm::dvec3& from = corners[i];
        const glm::dvec3& to = corners[(i + 1) % 3];
        const double at_from = glm::dot(from, normal), at_to = glm::dot(to, normal);
        if (at_from > 0.0)
            above.push_back(from);
        if ((at_from > 0.0) != (at_to > 0.0))
            above.push_back(from + at_from / (at_from - at_to) * (to - from));
    }
    glm::dvec3 moment(0.0);
    for (std::size_t i = 0; i < above.size(); ++i) {
        const glm::dvec3& from = above[i];
        const glm::dvec3& to = above[(i + 1) % above.size()];
        const glm::dvec3 across = glm::cross(from, to);
        const double sine = glm::length(across);
        if (sine > 0.0)
            moment +=
                std::atan2(sine, glm::dot(from, to)) / (2.0 * std::numbers::pi * sine) * across;
    }
    return glm::dot(moment, normal) < 0.0 ? -moment : moment;
}

double distance_weight(const Definition& definition, double distance, double area)
{
    if (!std::isfinite(definition.max_distance))
        return 1.0;
    if (definition.falloff != Falloff::none)
        return hit_weight(definition, static_cast<float>(distance));
    const double width =
        std::min(2.0 * std::sqrt(area / std::numbers::pi), double{definition.max_distance});
    return std::clamp(0.5 + (definition.max_distance - distance) / width, 0.0, 1.0);
}

double ground_weight(const Definition& definition, const GroundSight& sight, const glm::dvec3& c,
                     double area)
{
    const double distance = std::sqrt(glm::dot(c, c) + double{kTinyLength} * kTinyLength);
    const double along = glm::dot(c, glm::dvec3(sight.towards));
    const double edge = sight.distance / definition.max_distance;
    const double radius2 = area / std::numbers::pi;
    const double inside = along - distance * edge;
    double share = std::clamp(0.5 + 0.5 * inside / std::sqrt(radius2), 0.0, 1.0);
    if (std::isfinite(definition.max_distance))
        share *= std::clamp(distance * distance * (1.0 - edge * edge) / radius2, 0.0, 1.0);
    if (definition.falloff == Falloff::none)
        return share;
    const double hit = sight.distance * distance / std::max(along, double{kTinyLength});
    return share * hit_weight(definition, static_cast<float>(hit));
}

}  // namespace surfelao

#include "sampled_cloud.h"

#include "random.h"
#include "surfels/geometry.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace surfelao::scenes {

SampledCloud sampled(const Mesh& mesh, const CloudSampling& sampling)
{
    const Geometry& geometry = mesh.geometry;
    std::vector<double> until = triangle_areas(geometry);
    std::partial_sum(until.begin(), until.end(), until.begin());
    const double area = until.back();
    Random random(sampling.seed);
    const auto uniform = [&] { return random.share(); };
    const auto normal_number = [&] {  // Box, Muller. 1958
        return std::sqrt(-2.0 * std::log(1.0 - uniform())) *
               std::cos(6.283185307179586 * uniform());
    };
    SampledCloud sampled;
    const double spacing = std::sqrt(area / sampling.points);  // unit frame
    sampled.spacing = spacing * geometry.frame.diagonal;
    Scene& cloud = sampled.cloud;
    cloud.name = mesh.scene.name + " as points";
    for (std::uint32_t i = 0; i < sampling.points; ++i) {
        const double at = area * (i + uniform()) / sampling.points;
        const auto triangle = static_cast<std::uint32_t>(std::min<std::ptrdiff_t>(
            std::upper_bound(until.begin(), until.end(), at) - until.begin(),
            static_cast<std::ptrdiff_t>(until.size()) - 1));
        const double root = std::sqrt(uniform()), along = uniform();
        const SurfacePoint point{
            triangle, {static_cast<float>(root * (1.0 - along)), static_cast<float>(root * along)}};
        const glm::vec2 w = point.at;
        const glm::uvec3 t = geometry.triangles[triangle];
        const glm::vec3 a = geometry.positions[t.x], b = geometry.positions[t.y],
                        c = geometry.positions[t.z];
        glm::dvec3 place = (1.0f - w.x - w.y) * a + w.x * b + w.y * c;
        for (int axis = 0; axis < 3; ++axis)
            place[axis] += sampling.noise * spacing * normal_number();
        cloud.positions.push_back(geometry.frame.centre + geometry.frame.diagonal * place);
        if (sampling.has_normals) {
            const glm::uvec3 corners = mesh.surface.corners(mesh.geometry)[triangle];
            const std::vector<glm::vec3>& n = mesh.surface.normals;
            const glm::vec3 shading =
                (1.0f - w.x - w.y) * n[corners.x] + w.x * n[corners.y] + w.y * n[corners.z];
            cloud.normals.values.push_back(shading);
        }
        sampled.samples.push_back(point);
    }
    Part part;
    part.vertex_count = sampling.points;
    cloud.parts.push_back(part);
    return sampled;
}

}  // namespace surfelao::scenes

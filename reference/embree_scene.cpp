#include "reference/embree_scene.h"

#include <tbb/parallel_for.h>

#include <stdexcept>
#include <string>

namespace surfelao {

RTCDevice device_for(RayScene::Isa isa)
{
    const auto start = [](const char* config) {
        const RTCDevice device = rtcNewDevice(config);
        if (device == nullptr)
            throw std::runtime_error("Embree cannot start (error " +
                                     std::to_string(rtcGetDeviceError(nullptr)) + ")");
        return device;
    };
    if (isa == RayScene::Isa::avx2) {
        static const RTCDevice device = start("max_isa=avx2");
        return device;
    }
    static const RTCDevice device = start(nullptr);
    return device;
}

void keep_floating_point_mode()
{
    tbb::parallel_for(0, 2, [](int) {});
}

RayScene::Impl::Impl(RTCDevice device, RTCSceneFlags flags, RTCBuildQuality quality)
    : scene(rtcNewScene(device)),
      wide(rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED) != 0)
{
    rtcSetSceneFlags(scene, flags);
    rtcSetSceneBuildQuality(scene, quality);
}

EmbreeMesh new_mesh(RTCDevice device, std::size_t vertices, std::size_t triangles)
{
    const RTCGeometry mesh = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    void* places = rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                           sizeof(glm::vec3), vertices);
    void* corners = rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                            sizeof(glm::uvec3), triangles);
    if (places == nullptr || corners == nullptr) {
        rtcReleaseGeometry(mesh);
        check_device(device);
        throw std::runtime_error("Embree gives no buffers for its triangles");
    }
    return {mesh, static_cast<glm::vec3*>(places), static_cast<glm::uvec3*>(corners)};
}

void check_device(RTCDevice device)
{
    if (const RTCError error = rtcGetDeviceError(device); error != RTC_ERROR_NONE) {
        throw std::runtime_error(error == RTC_ERROR_OUT_OF_MEMORY
                                     ? "not enough memory for the ray tracer's hierarchy"
                                     : "Embree cannot build its hierarchy (error " +
                                           std::to_string(error) + ")");
    }
}

}  // namespace surfelao

// screen_tables: milliseconds of the screen-space passes alone, at 1280 x 720, as JSON.
//
//   screen_tables [egl|osmesa]
//
// Two scenes: a bumpy ball framed as `render` frames it, and a room with boxes seen from inside,
// where no pixel is background. Radius 0.1 diagonals; 8, 16 and 24 samples. ms: the median of
// rounds after a first drawing, by the clock that the JSON names. On software also cpu_ms, the
// processor time of a drawing over the threads there are: ms on a quiet machine, and nearly the
// same on others.

#include "pixels/pixel_engine.h"
#include "scenes.h"

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <exception>
#include <string>
#include <string_view>
#include <thread>

namespace surfelao {
namespace {

using scenes::operator+;

constexpr PictureSize kSize = {1280, 720};
constexpr int kRoundsOnSoftware = 4, kRoundsOnHardware = 100;
constexpr float kRadius = 0.1f;

struct Scenery {
    const char* name;
    Mesh mesh;
    Camera camera;
};

Scenery ball()
{
    Mesh mesh = make_mesh(scenes::bumpy_sphere(96));
    const Camera camera = frame_points(mesh.geometry.positions, UpAxis::y, 16.0f / 9.0f);
    return {"ball", std::move(mesh), camera};
}

Scenery room()
{
    Mesh mesh = make_mesh(scenes::room({-2, 0, -2}, {2, 2, 2}, 8) +
                          scenes::box({-1.2, 0, -1.5}, {-0.4, 0.9, -0.7}, 4) +
                          scenes::box({0.2, 0, -1.2}, {1.4, 0.3, -0.2}, 4) +
                          scenes::box({0.5, 0.3, -1.0}, {0.9, 1.1, -0.6}, 4));
    Camera camera;
    camera.eye = glm::vec3(0.05f, 0.0f, 0.3f);
    camera.target = glm::vec3(0.0f, -0.05f, -0.1f);
    camera.fovy_deg = 60.0f;
    return {"room", std::move(mesh), camera};
}

void run(GlBackend backend)
{
    const GlContext context = GlContext::create(backend);
    ScreenSpace screen(context);
    const bool software = context.info().software;
    const int rounds = software ? kRoundsOnSoftware : kRoundsOnHardware;
    std::string rows, clock;
    for (const Scenery& scene : {ball(), room()}) {
        const DrawnMesh drawn(context, scene.mesh.geometry, scene.mesh.surface);
        GBuffer seen(context, kSize.width, kSize.height);
        seen.draw(drawn, view_of(scene.camera, kSize.width, kSize.height));
        const auto triangles = seen.read_triangles();
        const double covered = 1.0 - static_cast<double>(std::ranges::count(triangles, 0u)) /
                                         static_cast<double>(triangles.size());
        const Framebuffer target = screen.make_target(seen);
        for (const ScreenMethod method : screen_methods()) {
            for (const int samples : {8, 16, 24}) {
                const ScreenSettings settings = screen_settings(method, samples);
                const Definition definition{.max_distance = kRadius};
                screen.draw(seen, settings, definition, target);  // makes the shaders
                context.finish("drawing");
                const std::clock_t before = std::clock();
                const PassTime time = screen.time(seen, settings, definition, target, rounds);
                const double processor_ms = 1e3 * static_cast<double>(std::clock() - before) /
                                            CLOCKS_PER_SEC / (rounds + 1) /
                                            std::thread::hardware_concurrency();
                char row[256];
                std::snprintf(row, sizeof(row),
                              "%s  {\"scene\": \"%s\", \"covered\": %.3f, \"engine\": \"%s\", "
                              "\"samples\": %d, \"ms\": %.4g, \"cpu_ms\": %.4g}",
                              rows.empty() ? "" : ",\n", scene.name, covered,
                              name_of(method).c_str(), samples, 1e3 * time.seconds,
                              software ? processor_ms : 0.0);
                rows += row;
                clock = time.clock;
            }
        }
    }
    std::printf(
        "{\"renderer\": \"%s\", \"platform\": \"%s\", \"software\": %s, \"clock\": \"%s\",\n"
        " \"width\": %d, \"height\": %d, \"rows\": [\n%s\n]}\n",
        context.info().renderer.c_str(), context.info().platform.c_str(),
        software ? "true" : "false", clock.c_str(), kSize.width, kSize.height, rows.c_str());
}

}  // namespace
}  // namespace surfelao

int main(int argument_count, char** arguments)
{
    using namespace surfelao;
    const std::string_view name = argument_count > 1 ? arguments[1] : "";
    try {
        run(name == "egl"      ? GlBackend::egl
            : name == "osmesa" ? GlBackend::osmesa
                               : GlBackend::automatic);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "screen_tables: %s\n", error.what());
        return 1;
    }
}

#include "gpu/screen_space.h"

#include "gpu/draw.h"
#include "gpu/gl_table.inc"
#include "gpu/program.h"
#include "gpu/screen_samples.h"
#include "surfels/errors.h"
#include "surfels/stopwatch.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace surfelao {
namespace {

/// In units of view space: behind it, everything is as good as endless, and floats still tell
/// where.
constexpr float kEndless = 1e6f;

/// How far beside the plane of a pixel another one is still the same surface, in radii.
constexpr float kSameSurface = 0.1f;

/// The power of the steps that has shaders of its own: powers are slow on software.
constexpr float kSquare = 2.0f;

float radius_of(const Definition& definition)
{
    return std::isfinite(definition.max_distance) ? definition.max_distance : 1.0f;
}

/// The distance at which ssao-disc's disk is as large as R: that of the scene's middle, or half a
/// diagonal where the eye is inside of it.
float disc_distance(const View& view)
{
    return std::max(0.5f, glm::length(view.eye));
}

bool is_ssao(ScreenMethod method)
{
    return method == ScreenMethod::ssao_disc || method == ScreenMethod::ssao_sphere;
}

const char* file_of(ScreenMethod method)
{
    switch (method) {
        case ScreenMethod::ssao_disc:
        case ScreenMethod::ssao_sphere:
            return "ssao.frag";
        case ScreenMethod::vo:
            return "vo.frag";
        case ScreenMethod::hbao:
            return "hbao.frag";
        case ScreenMethod::gtao:
            return "gtao.frag";
        case ScreenMethod::bitmask:
            return "bitmask.frag";
    }
    SURFELAO_CHECK(false);
}

/// shaders/steps.glsl
std::vector<std::string> definitions_of(const ScreenSettings& settings)
{
    const bool has_steps =
        settings.method == ScreenMethod::gtao || settings.method == ScreenMethod::bitmask;
    if (!has_steps || settings.power == kSquare)
        return {};
    return {"ANY_POWER 1"};
}

/// Of a frame: steps of a sequence of pairs that fills the square evenly (Roberts, 2018).
glm::vec2 phase_of(int frame)
{
    const double x = frame * 0.7548776662466927, y = frame * 0.5698402910980532;
    return {static_cast<float>(x - std::floor(x)), static_cast<float>(y - std::floor(y))};
}

glm::vec2 cosine_and_sine(double angle)
{
    return {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))};
}

double median(std::vector<double> values)
{
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    return *middle;
}

/// shaders/g_buffer.glsl
void set_seen(Program& program, const GBuffer& seen)
{
    const Lens& lens = seen.view().lens;
    program.set("u_lens_low", lens.low);
    program.set("u_lens_high", lens.high);
    program.set("u_is_orthographic", lens.orthographic ? 1 : 0);
    program.set("u_size", glm::ivec2(seen.width(), seen.height()));
    program.set("u_surface", seen.surface());
}

GlHandle make_query(const GlTable& gl)
{
    GLuint id = 0;
    gl.GenQueries(1, &id);
    return {gl, id, [](const GlTable& table, unsigned name) { table.DeleteQueries(1, &name); }};
}

}  // namespace

ScreenSpace::ScreenSpace(const GlContext& context)
    : context_(context),
      nothing_(context),
      noise_(context, kNoiseSide, kNoiseSide, TexelFormat::rg32f,
             std::span<const glm::vec2>(noise_pairs()))
{
}

Framebuffer ScreenSpace::make_target(const GBuffer& seen) const
{
    return {context_,
            {.width = seen.width(), .height = seen.height(), .colors = {TexelFormat::r32f}}};
}

const TextureBuffer& ScreenSpace::samples_of(const ScreenSettings& settings)
{
    const auto key = std::tuple(settings.method, settings.samples, settings.pairs);
    const auto found = samples_.find(key);
    if (found != samples_.end())
        return found->second;
    auto* make = settings.method == ScreenMethod::ssao_disc     ? &disk_samples
                 : settings.method == ScreenMethod::ssao_sphere ? &ball_samples
                                                                : &line_samples;
    const std::vector<glm::vec4> samples = make(settings.samples, settings.pairs);
    return samples_
        .try_emplace(key, context_, TexelFormat::rgba32f, std::span<const glm::vec4>(samples))
        .first->second;
}

const TextureBuffer& ScreenSpace::probes_of(int count)
{
    const auto found = probes_.find(count);
    if (found != probes_.end())
        return found->second;
    const std::vector<glm::vec2> offsets = probe_offsets(count);
    return probes_
        .try_emplace(count, context_, TexelFormat::rg32f, std::span<const glm::vec2>(offsets))
        .first->second;
}

void ScreenSpace::set_noise(Program& program, const ScreenSettings& settings)
{
    constexpr int kMirrorsMask = 3, kTurnsMask = kNoiseSide - 1;
    int mask = is_ssao(settings.method) ? kMirrorsMask : kTurnsMask;
    if (settings.noise == ScreenNoise::none)
        mask = 0;
    if (settings.noise == ScreenNoise::gradient)
        mask = -1;
    program.set("u_noise", noise_);
    program.set("u_noise_mask", mask);
    program.set("u_phase", phase_of(settings.frame));
}

void ScreenSpace::set_slices(Program& program, const ScreenSettings& settings,
                             const Definition& definition)
{
    const bool is_hbao = settings.method == ScreenMethod::hbao;
    const int slices = settings.directions / 2;
    const float radius = radius_of(definition);
    program.set("u_steps", settings.samples / settings.directions);
    program.set("u_turn", cosine_and_sine(is_hbao ? 2.0 * std::numbers::pi / settings.directions
                                                  : std::numbers::pi / slices));
    program.set("u_per_square", 1.0f / (radius * radius));
    program.set("u_is_faded", definition.falloff == Falloff::smooth ? 1 : 0);
    if (is_hbao) {
        program.set("u_directions", settings.directions);
        program.set("u_bias",
                    cosine_and_sine(static_cast<double>(settings.bias) * std::numbers::pi / 180.0));
        program.set("u_has_own_fade", settings.fade && definition.falloff == Falloff::none ? 1 : 0);
        program.set("u_has_normals", settings.normals ? 1 : 0);
        return;
    }
    program.set("u_slices", slices);
    if (settings.power != kSquare)
        program.set("u_power", settings.power);
    if (settings.method == ScreenMethod::bitmask)
        program.set("u_thickness", std::min(kEndless, settings.thickness * radius));
}

void ScreenSpace::set_dynamic_radius(Program& program, const ScreenSettings& settings, float radius)
{
    program.set("u_rule", settings.rule);
    program.set("u_probes", probes_of(settings.probes));
    program.set("u_probe_count", settings.probes);
    program.set("u_depth_limit", settings.depth_limit * radius);
}

/// With everything set for a drawing.
Program& ScreenSpace::method_program(const GBuffer& seen, const ScreenSettings& settings,
                                     const Definition& definition)
{
    check_settings(settings);
    check_definition(definition);
    const float radius = radius_of(definition);
    Program& program =
        context_.program("fullscreen.vert", file_of(settings.method), definitions_of(settings));
    set_seen(program, seen);
    program.set("u_distance", seen.distance());
    program.set("u_radius", radius);
    set_noise(program, settings);
    if (is_ssao(settings.method)) {
        program.set("u_samples", samples_of(settings));
        program.set("u_pairs", settings.samples / 2);
        program.set("u_is_paired", settings.pairs ? 1 : 0);
        program.set("u_disc_distance",
                    settings.method == ScreenMethod::ssao_disc ? disc_distance(seen.view()) : 0.0f);
        program.set("u_reach", settings.reach);
        program.set("u_is_by_ratio", settings.ratio_test ? 1 : 0);
    } else if (settings.method == ScreenMethod::vo) {
        program.set("u_samples", samples_of(settings));
        program.set("u_pairs", settings.samples / 2);
        program.set("u_is_paired", settings.pairs ? 1 : 0);
        program.set("u_reach", settings.reach);
        program.set("u_dual", static_cast<int>(settings.dual));
        set_dynamic_radius(program, settings, radius);
    } else {
        set_slices(program, settings, definition);
    }
    return program;
}

void ScreenSpace::blur(const GBuffer& seen, float radius, const Framebuffer& target)
{
    Program& program = context_.program("fullscreen.vert", "screen_blur.frag");
    set_seen(program, seen);
    program.set("u_occlusion", sharp_->color());
    program.set("u_beside", kSameSurface * radius);
    draw_fullscreen(target, program, nothing_);
}

void ScreenSpace::draw(const GBuffer& seen, const ScreenSettings& settings,
                       const Definition& definition, const Framebuffer& target)
{
    const Program& program = method_program(seen, settings, definition);
    if (!settings.blur) {
        draw_fullscreen(target, program, nothing_);
        return;
    }
    if (!sharp_ || sharp_->width() != seen.width() || sharp_->height() != seen.height())
        sharp_ = make_target(seen);
    draw_fullscreen(*sharp_, program, nothing_);
    blur(seen, radius_of(definition), target);
}

PassTime ScreenSpace::time(const GBuffer& seen, const ScreenSettings& settings,
                           const Definition& definition, const Framebuffer& target, int rounds)
{
    SURFELAO_CHECK(rounds >= 1);
    draw(seen, settings, definition, target);  // makes the shaders
    context_.finish("drawing");
    std::vector<double> seconds;
    if (context_.info().software) {
        for (int round = 0; round < rounds; ++round) {
            Stopwatch watch;
            draw(seen, settings, definition, target);
            context_.finish("drawing");
            seconds.push_back(watch.lap());
        }
        return {median(seconds), "finish + steady_clock"};
    }
    const GlTable& gl = context_.gl();
    const GlHandle before = make_query(gl), after = make_query(gl);
    for (int round = 0; round < rounds; ++round) {
        gl.QueryCounter(before.id(), GL_TIMESTAMP);
        draw(seen, settings, definition, target);
        gl.QueryCounter(after.id(), GL_TIMESTAMP);
        GLuint64 start = 0, end = 0;
        gl.GetQueryObjectui64v(before.id(), GL_QUERY_RESULT, &start);
        gl.GetQueryObjectui64v(after.id(), GL_QUERY_RESULT, &end);
        seconds.push_back(static_cast<double>(end - start) * 1e-9);
    }
    check_gl(gl, "timing a pass");
    return {median(seconds), "GL_TIMESTAMP"};
}

void ScreenSpace::draw_radius(const GBuffer& seen, const ScreenSettings& settings,
                              const Definition& definition, const Framebuffer& target)
{
    check_settings(settings);
    check_definition(definition);
    const float radius = radius_of(definition);
    Program& program = context_.program("fullscreen.vert", "dynamic_radius.frag");
    set_seen(program, seen);
    program.set("u_distance", seen.distance());
    program.set("u_radius", radius);
    set_dynamic_radius(program, settings, radius);
    draw_fullscreen(target, program, nothing_);
}

}  // namespace surfelao

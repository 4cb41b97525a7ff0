/// screen_space.h: ambient occlusion as the methods find it that know no more of a scene than what
/// its picture shows: a fragment shader each over a G-buffer. What lies behind what is seen, and
/// beside the picture, is missing however many samples are taken.
///
/// Common to all: a pixel's point p in view space, its normal n, the radius R = max_distance of the
/// definition (one diagonal where there is none), which is seen as R * pixels_per_unit(z) pixels.
/// A sample reads the pixel nearest to it, and knows that pixel's middle. Samples outside of the
/// picture are left out; the background never occludes. A radius below one pixel answers 0.
/// docs/screen_space.md derives each and shows where it errs; each shader names its paper and where
/// it departs from it.
///
/// What becomes of the definition's falloff:
///   gtao bitmask   none: a sample counts up to R; smooth: it counts (1 - (L / R)^2)^2 of what it
///                  stands over the tangent plane (in cosines)
///   hbao           none: its own W = 1 - (L / R)^2, as published, or with `fade` off nothing but
///                  the limit; smooth: (1 - (L / R)^2)^2
///   ssao-* vo      none of their own: they measure how much of the ball of R is free, and every
///                  part of it counts the same
#pragma once

#include "gpu/context.h"
#include "gpu/g_buffer.h"
#include "surfels/occlusion.h"

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

namespace surfelao {

enum class ScreenMethod {
    ssao_disc,    ///< samples on a disk of the picture, in front or behind
    ssao_sphere,  ///< samples in a ball of view space
    vo,           ///< volumetric obscurance: lines through the ball, in pairs
    hbao,         ///< horizons over the tangent plane
    gtao,         ///< horizons of slices through the ray to the eye, integrated exactly
    bitmask,      ///< slices as gtao's, sectors as bits, occluders of finite thickness
};

/// How the samples of neighbouring pixels differ.
enum class ScreenNoise {
    none,      ///< not at all: bands instead of noise
    gradient,  ///< interleaved gradient noise
    origin,    ///< 4 x 4 mirror vectors (ssao), a table of 64 x 64 turns (the others), tiled
};

enum class DualRadii { none, product, minimum };

/// Settings of one method; those that it does not know do not count.
struct ScreenSettings {
    ScreenMethod method = ScreenMethod::gtao;
    int samples = 24;         ///< 1 to 4096, reads of the picture a pixel; ssao vo: even
    int directions = 6;       ///< hbao gtao bitmask: divides `samples`; gtao, bitmask: even, two
                              ///< a slice
    float bias = 10.0f;       ///< hbao: degrees, 0 to 90: horizons below it do not count
    float thickness = 0.5f;   ///< bitmask: > 0, in radii; infinite: as gtao
    float power = 2.0f;       ///< gtao bitmask: 1 to 8: steps lie at the radius times (k / n)^power
    float reach = 2.0f;       ///< ssao vo: > 0, in radii: what is nearer to the eye by more than
                              ///< that says nothing
    bool normals = true;      ///< hbao: the tangent plane is that of n; else of the four pixels
                              ///< around
    bool fade = true;         ///< hbao: with a hard limit, the fade as published
    bool pairs = true;        ///< ssao vo: each sample has one opposite of it
    bool ratio_test = false;  ///< ssao: what says nothing is told by the ratio of depths
    DualRadii dual = DualRadii::none;  ///< vo: half the radius too: twice as many reads
    int rule = 0;                      ///< vo: of the dynamic radius, 1 to 6; 0 = the radius is R
    int probes = 20;                   ///< of the rule: 4, 9, 20 or 328
    float depth_limit = 1.0f;          ///< rules 4 and 5: in radii, > 0
    ScreenNoise noise = ScreenNoise::gradient;
    int frame = 0;      ///< 0 to 65535: each has other noise; the mean over many has next to none
    bool blur = false;  ///< the mean of 5 x 5 pixels of the same surface
    bool operator==(const ScreenSettings&) const = default;
};

/// "ssao-disc", "ssao-sphere", "vo", "hbao", "gtao", "bitmask"
[[nodiscard]] std::string name_of(ScreenMethod method);
[[nodiscard]] std::optional<ScreenMethod> screen_method_of(std::string_view name);
[[nodiscard]] std::span<const ScreenMethod> screen_methods();

/// What distinguishes settings of one method: "24 samples", "6 x 4, bias 30, blur".
[[nodiscard]] std::string setting_of(const ScreenSettings& settings);

/// The method with so many samples, its other settings as published: 8, 16 and 24 are 4 x 2, 4 x 4
/// and 6 x 4 directions and steps, and other numbers are split alike: the least even number of
/// directions that is not below that of steps.
[[nodiscard]] ScreenSettings screen_settings(ScreenMethod method, int samples);

/// A setting that a user may name.
struct ScreenParameter {
    std::string_view name;              ///< "bias"
    std::string_view meaning;           ///< a line for people, with unit and range
    std::vector<ScreenMethod> methods;  ///< that know it
};
[[nodiscard]] std::span<const ScreenParameter> screen_parameters();

/// name and text as a user gives them ("bias", "30"). Throws SettingsError for a name that the
/// method does not know, and a text that is no value of it.
void set_parameter(ScreenSettings& settings, std::string_view name, std::string_view text);

/// Throws SettingsError where a setting of the method is out of its range.
void check_settings(const ScreenSettings& settings);

/// Median seconds of a pass alone, and the clock that told it.
struct PassTime {
    double seconds = 0.0;
    std::string clock;  ///< "GL_TIMESTAMP", or "finish + steady_clock" on software
};

class ScreenSpace {
public:
    /// Uses the context in every call.
    explicit ScreenSpace(const GlContext& context);

    /// R32F, as large as the G-buffer.
    [[nodiscard]] Framebuffer make_target(const GBuffer& seen) const;

    /// Occlusion of every pixel, 0 on the background: R32F, as large as the G-buffer, which must be
    /// drawn. definition: its limit and falloff; the kernel is cosine, a ground is not known to
    /// pictures. Throws as check_settings() and check_definition().
    void draw(const GBuffer& seen, const ScreenSettings& settings, const Definition& definition,
              const Framebuffer& target);

    /// Of the pass alone, over `rounds` drawings after a first one, without the blur unless
    /// settings say so. rounds >= 1.
    [[nodiscard]] PassTime time(const GBuffer& seen, const ScreenSettings& settings,
                                const Definition& definition, const Framebuffer& target,
                                int rounds);

    /// The radius that settings.rule chose over R at every pixel, R32F, 0 on the background: for a
    /// heat map.
    void draw_radius(const GBuffer& seen, const ScreenSettings& settings,
                     const Definition& definition, const Framebuffer& target);

private:
    const TextureBuffer& samples_of(const ScreenSettings& settings);
    const TextureBuffer& probes_of(int count);
    void set_noise(Program& program, const ScreenSettings& settings);
    void set_slices(Program& program, const ScreenSettings& settings, const Definition& definition);
    void set_dynamic_radius(Program& program, const ScreenSettings& settings, float radius);
    Program& method_program(const GBuffer& seen, const ScreenSettings& settings,
                            const Definition& definition);
    void blur(const GBuffer& seen, float radius, const Framebuffer& target);

    const GlContext& context_;
    VertexArray nothing_;
    Texture2D noise_;
    std::map<std::tuple<ScreenMethod, int, bool>, TextureBuffer> samples_;
    std::map<int, TextureBuffer> probes_;
    std::optional<Framebuffer> sharp_;  ///< before the blur
};

}  // namespace surfelao

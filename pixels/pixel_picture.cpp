#include "pixels/pixel_picture.h"

#include "pixels/edge_pixels.h"
#include "pixels/sampled_triangles.h"
#include "surfels/errors.h"
#include "surfels/for_all.h"
#include "surfels/stopwatch.h"

#include <glm/common.hpp>

#include <algorithm>
#include <numeric>
#include <optional>
#include <string>
#include <string_view>

namespace surfelao {
namespace {

constexpr std::size_t kPaintGrain = 4096;  // receivers of one task

/// A part of the picture that is answered at once.
struct Band {
    Rect rect;
    View view;  ///< of the part
};

/// From the bottom, rows of as many parts as the device's pictures are narrower. Methods that know
/// the picture alone must see it whole, or there were borders in its middle.
std::vector<Band> bands_of(const View& view, const PixelPictureSettings& settings, int largest)
{
    const PictureSize size = settings.size;
    if (settings.engine && std::holds_alternative<ScreenSettings>(*settings.engine)) {
        const int widest = std::max(size.width, size.height) + 2 * settings.guard;
        if (widest > largest)
            throw InputError("a method that knows the picture alone needs it whole: " +
                             std::to_string(widest) + " pixels with the guard, " +
                             std::to_string(largest) + " each way can be drawn here");
        return {{{0, 0, size.width, size.height}, view}};
    }
    const int most = std::max(1, largest - 2 * settings.guard);
    const int width = std::min(size.width, most);
    const int height =
        std::clamp(static_cast<int>(settings.band_pixels) / width, 1, std::min(size.height, most));
    std::vector<Band> bands;
    for (int y = 0; y < size.height; y += height) {
        for (int x = 0; x < size.width; x += width) {
            const Rect rect{x, y, std::min(width, size.width - x),
                            std::min(height, size.height - y)};
            Band& band = bands.emplace_back(Band{rect, view});
            band.view.lens = part_of(view.lens, size.width, size.height, rect);
        }
    }
    return bands;
}

/// The answers of one list of receivers.
struct Answers {
    std::vector<Occlusion> values, references;
    std::vector<std::uint8_t> holes;      ///< 1 where no cube map answered; empty without maps
    std::vector<std::uint32_t> surfaces;  ///< GridWorld::surfaces_at(); empty without grids
};

/// What the receivers of each pixel add up to.
class PixelSums {
public:
    explicit PixelSums(PictureSize size)
        : size_(size),
          sums_(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height))
    {
    }

    /// colors: one for each share.
    void add(std::span<const PixelSamples::Share> shares, std::span<const glm::vec3> colors)
    {
        for (std::size_t i = 0; i < shares.size(); ++i)
            sums_[shares[i].pixel] +=
                glm::vec4(colors[i] * shares[i].base, static_cast<float>(shares[i].samples));
    }

    /// Means of what is covered, and its share of all samples.
    void put_into(Image& image, const Rect& rect, int samples) const
    {
        for (int y = 0; y < size_.height; ++y) {
            for (int x = 0; x < size_.width; ++x) {
                const glm::vec4 sum = sums_[static_cast<std::size_t>(y * size_.width + x)];
                if (sum.w > 0.0f)
                    image.at(rect.x + x, image.height - 1 - rect.y - y) = {
                        glm::vec3(sum) / sum.w, sum.w / static_cast<float>(samples)};
            }
        }
    }

private:
    PictureSize size_;
    std::vector<glm::vec4> sums_;
};

class PictureMaker {
public:
    PictureMaker(const GlContext& context, const Mesh& mesh, const DrawnMesh& drawn,
                 Occluders& occluders, const PixelPictureSettings& settings,
                 const PixelPaint& paint, const StageProgress& progress)
        : context_(context),
          mesh_(mesh),
          drawn_(drawn),
          occluders_(occluders),
          settings_(settings),
          paint_(paint),
          progress_(progress),
          parts_(parts_of(mesh)),
          screen_(context)
    {
    }

    PixelPicture make(const View& view)
    {
        picture_.image = Image(settings_.size.width, settings_.size.height);
        const std::vector<Band> bands = bands_of(view, settings_, context_.info().max_texture_size);
        picture_.bands = static_cast<int>(bands.size());
        prepare();
        for (band_ = 0; band_ < bands.size(); ++band_)
            make_band(bands[band_]);
        return std::move(picture_);
    }

private:
    /// How far a stage is, of all bands.
    [[nodiscard]] Progress stage(std::string_view name) const
    {
        if (!progress_)
            return {};
        return [this, name](double done) {
            return progress_(name, (static_cast<double>(band_) + done) / picture_.bands);
        };
    }

    /// An engine that runs on the device uses our context, which stays current.
    [[nodiscard]] EngineSettings here(EngineSettings engine) const
    {
        if (engine.device == Device::gpu)
            engine.context = &context_;
        engine.definition = settings_.definition;
        return engine;
    }
    [[nodiscard]] EngineSettings rays() const
    {
        EngineSettings engine{{.engine = Engine::rays}, {.rays = *settings_.reference_rays}};
        return here(engine);
    }

    void prepare()
    {
        Stopwatch watch;
        if (is_drawn())
            rims_.emplace(mesh_.geometry);
        if (settings_.samples > 1 && !paint_.base)
            edges_.emplace(mesh_, parts_);
        if (settings_.engine) {
            if (const auto* engine = std::get_if<EngineSettings>(&*settings_.engine))
                static_cast<void>(occluders_.prepared_for(here(*engine)));
            else if (const GridPixels* grids = with_grids())
                grids->world->prepare(grids->rest);
        }
        picture_.prepare_s = watch.lap();
    }

    [[nodiscard]] std::vector<std::uint32_t> surfaces_at(std::span<const SurfacePoint> points) const
    {
        return with_grids() != nullptr ? with_grids()->world->surfaces_at(points)
                                       : std::vector<std::uint32_t>();
    }

    /// What the engine of the scene says of them, or nothing. surfaces: surfaces_at() of them.
    std::vector<Occlusion> solved(std::span<const Receiver> receivers,
                                  std::span<const std::uint32_t> surfaces, const Progress& progress)
    {
        if (!settings_.engine || std::holds_alternative<ScreenSettings>(*settings_.engine))
            return std::vector<Occlusion>(receivers.size());
        if (with_grids() != nullptr)
            return solve_with_grids(defined_grids(), receivers, surfaces, progress);
        const EngineSettings engine = here(std::get<EngineSettings>(*settings_.engine));
        return solve(occluders_.prepared_for(engine), receivers, engine, progress).occlusion;
    }

    std::vector<Occlusion> referenced(std::span<const Receiver> receivers, const Progress& progress)
    {
        if (!settings_.reference_rays)
            return {};
        Stopwatch watch;
        const EngineSettings engine = rays();
        std::vector<Occlusion> values =
            solve(occluders_.prepared_for(engine), receivers, engine, progress).occlusion;
        picture_.reference_s += watch.lap();
        return values;
    }

    [[nodiscard]] const ScreenSettings* on_screen() const
    {
        return settings_.engine ? std::get_if<ScreenSettings>(&*settings_.engine) : nullptr;
    }

    /// Whether somebody answers on the device, for what it has drawn.
    [[nodiscard]] bool is_drawn() const
    {
        return on_screen() != nullptr || with_grids() != nullptr || settings_.cube_maps != nullptr;
    }

    [[nodiscard]] const GridPixels* with_grids() const
    {
        return settings_.engine ? std::get_if<GridPixels>(&*settings_.engine) : nullptr;
    }
    [[nodiscard]] GridPixels defined_grids() const
    {
        GridPixels grids = *with_grids();
        grids.rest.definition = settings_.definition;
        return grids;
    }

    /// What grids say of the pixels that the G-buffer was drawn for.
    std::vector<Occlusion> solved_by_pass(const GBuffer& drawing, const SeenPixels& seen,
                                          std::span<const std::uint32_t> surfaces)
    {
        if (!grid_pass_)
            grid_pass_.emplace(context_);
        return solve_with_grids(*grid_pass_, drawing, defined_grids(), seen.receivers, surfaces,
                                seen.pixels, stage("solve"));
    }

    /// What the picture's method finds at those of the pixels that the G-buffer was drawn for.
    template <class Pixels>
    void put_screen(const GBuffer& drawing, PictureSize size, const Pixels& pixels,
                    std::span<Occlusion> values)
    {
        const Framebuffer target = screen_.make_target(drawing);
        screen_.draw(drawing, *on_screen(), settings_.definition, target);
        const std::vector<float> occlusion =
            inner(target.read_red(target.rect()), size, settings_.guard);
        for (std::size_t i = 0; i < values.size(); ++i)
            values[i].occlusion = occlusion[pixels(i)];
    }

    /// Who answers the middles: cube maps before the engine, which then answers the rest. drawing:
    /// null where the picture is not drawn.
    Answers answers_at(const GBuffer* drawing, PictureSize size, const SeenPixels& seen)
    {
        Stopwatch watch;
        const auto pixels = [&](std::size_t i) { return seen.pixels[i]; };
        Answers answers;
        if (settings_.cube_maps == nullptr) {
            answers.surfaces = surfaces_at(seen.points);
            answers.values = with_grids() != nullptr
                                 ? solved_by_pass(*drawing, seen, answers.surfaces)
                                 : solved(seen.receivers, {}, stage("solve"));
            if (on_screen())
                put_screen(*drawing, size, pixels, answers.values);
            picture_.solve_s += watch.lap();
            return answers;
        }
        answers.values.resize(seen.pixels.size());
        const Framebuffer target =
            settings_.cube_maps->make_target(drawing->width(), drawing->height());
        settings_.cube_maps->project(*drawing, target);
        const std::vector<glm::vec4> told =
            inner(target.read_color(target.rect()), size, settings_.guard);
        picture_.project_s += watch.lap();

        if (on_screen() && !settings_.white_holes)
            put_screen(*drawing, size, pixels, answers.values);
        std::vector<std::size_t> open;
        std::vector<Receiver> asked;
        for (std::size_t i = 0; i < seen.pixels.size(); ++i) {
            const float share = told[seen.pixels[i]].y;
            answers.holes.push_back(share > 0.0f ? 0 : 1);
            picture_.holes += answers.holes.back();
            picture_.faded += share > 0.0f && share < 1.0f ? 1 : 0;
            if (share < 1.0f && !on_screen() && !settings_.white_holes) {
                open.push_back(i);
                asked.push_back(seen.receivers[i]);
            }
        }
        if (!asked.empty()) {
            const std::vector<Occlusion> filled = solved(asked, {}, stage("solve"));
            for (std::size_t k = 0; k < open.size(); ++k)
                answers.values[open[k]].occlusion = filled[k].occlusion;
        }
        for (std::size_t i = 0; i < seen.pixels.size(); ++i) {
            const glm::vec4 texel = told[seen.pixels[i]];
            float& occlusion = answers.values[i].occlusion;
            occlusion = glm::mix(occlusion, texel.x, settings_.white_holes ? 1.0f : texel.y);
        }
        picture_.solve_s += watch.lap();
        return answers;
    }

    /// Those where samples may see something else than the middle does.
    [[nodiscard]] std::vector<std::uint32_t> pixels_with_samples(const Projected& projected,
                                                                 const SeenPixels& seen) const
    {
        if (settings_.samples == 1)
            return {};
        if (edges_)
            return edges_->find(projected, seen);
        std::vector<std::uint32_t> all(static_cast<std::size_t>(seen.width) *
                                       static_cast<std::size_t>(seen.height));
        std::iota(all.begin(), all.end(), 0u);  // base colours change everywhere
        return all;
    }

    void make_band(const Band& band)
    {
        const PictureSize size{band.rect.width, band.rect.height};
        Stopwatch watch;
        std::optional<GBuffer> drawing;
        if (is_drawn()) {
            drawing.emplace(context_, size.width + 2 * settings_.guard,
                            size.height + 2 * settings_.guard);
            drawing->draw(drawn_, widened(band.view, size, settings_.guard));
        }
        const Projected projected(mesh_.geometry, band.view, size.width, size.height);
        const SeenPixels seen =
            drawing ? seen_pixels(mesh_, *rims_, projected,
                                  inner(drawing->read_triangles(), size, settings_.guard),
                                  settings_.offset)
                    : seen_pixels(mesh_, projected, settings_.offset);
        picture_.middles += seen.pixels.size();
        picture_.see_s += watch.lap();

        Answers middles = answers_at(drawing ? &*drawing : nullptr, size, seen);
        watch.lap();

        Answers extras;
        const std::vector<std::uint32_t> pixels = pixels_with_samples(projected, seen);
        PixelSamples samples(mesh_, parts_, seen, pixels, settings_.samples, paint_.base);
        ProgressMeter meter(stage("edges"), static_cast<std::uint64_t>(settings_.samples) - 1);
        const int at_once = on_screen() ? 1 : static_cast<int>(kSamplesAtOnce);
        for (int first = 1; first < settings_.samples && !pixels.empty(); first += at_once) {
            std::vector<glm::vec2> shifts;
            for (int i = first; i < std::min(first + at_once, settings_.samples); ++i)
                shifts.push_back(sample_shift(i));
            const auto triangles = sampled_triangles(projected, pixels, shifts);
            View view = band.view;
            for (std::size_t s = 0; s < shifts.size(); ++s) {
                view.lens = shifted(band.view.lens, size.width, size.height, shifts[s]);
                samples.add(view, triangles[s]);
            }
            if (on_screen()) {
                drawing->draw(drawn_, widened(view, size, settings_.guard));
                const std::size_t before = extras.values.size();
                extras.values.resize(samples.extras().size());
                put_screen(
                    *drawing, size,
                    [&](std::size_t k) { return samples.extras()[before + k].pixel; },
                    std::span(extras.values).subspan(before));
            }
            meter.add(shifts.size());
        }
        const std::vector<Receiver> extra_receivers =
            receivers_facing(mesh_, band.view, samples.extra_points(), settings_.offset);
        extras.surfaces = surfaces_at(samples.extra_points());
        if (!on_screen())
            extras.values = solved(extra_receivers, extras.surfaces, {});
        picture_.extras += extra_receivers.size();
        picture_.edge_pixels += samples.edge_pixels();
        picture_.edges_s += watch.lap();

        middles.references = referenced(seen.receivers, stage("reference"));
        extras.references = referenced(extra_receivers, {});
        watch.lap();
        PixelSums sums(size);
        sums.add(samples.middles(), colors_of(seen.receivers, middles));
        sums.add(samples.extras(), colors_of(extra_receivers, extras));
        sums.put_into(picture_.image, band.rect, settings_.samples);
        picture_.paint_s += watch.lap();
    }

    [[nodiscard]] std::vector<glm::vec3> colors_of(std::span<const Receiver> receivers,
                                                   const Answers& answers) const
    {
        const std::vector<Occlusion>& references =
            answers.references.empty() ? answers.values : answers.references;
        std::vector<glm::vec3> colors(receivers.size());
        for_all(receivers.size(), kPaintGrain, [&](std::size_t i) {
            colors[i] = paint_.color({receivers[i], answers.values[i], references[i],
                                      !answers.holes.empty() && answers.holes[i] != 0, with_grids(),
                                      answers.surfaces.empty() ? 0 : answers.surfaces[i]});
        });
        return colors;
    }

    const GlContext& context_;
    const Mesh& mesh_;
    const DrawnMesh& drawn_;
    Occluders& occluders_;
    const PixelPictureSettings& settings_;
    const PixelPaint& paint_;
    const StageProgress& progress_;
    std::vector<std::uint32_t> parts_;
    std::optional<Rims> rims_;
    std::optional<EdgeFinder> edges_;  ///< where samples are looked at, and not everywhere
    ScreenSpace screen_;
    std::optional<GridPass> grid_pass_;
    PixelPicture picture_;
    std::size_t band_ = 0;
};

}  // namespace

PixelPicture pixel_picture(const GlContext& context, const Mesh& mesh, const DrawnMesh& drawn,
                           Occluders& occluders, const View& view,
                           const PixelPictureSettings& settings, const PixelPaint& paint,
                           const StageProgress& progress)
{
    require(settings.size.width >= 1 && settings.size.height >= 1,
            "a picture has one pixel at least");
    require(settings.samples >= 1, "samples: one a pixel at least");
    return PictureMaker(context, mesh, drawn, occluders, settings, paint, progress).make(view);
}

}  // namespace surfelao

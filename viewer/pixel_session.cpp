#include "viewer/pixel_session.h"

#include "pixels/seen.h"
#include "surfels/stopwatch.h"
#include "viewer/pixel_fill.h"

#include <algorithm>
#include <exception>
#include <span>
#include <utility>

namespace surfelao {
namespace {

/// The progress of one part of a job; parts are told by how much there is to solve.
class JobProgress {
public:
    JobProgress(const Progress& progress, std::size_t all)
        : progress_(progress), all_(std::max<std::size_t>(all, 1))
    {
    }

    /// Of the next part, which has so many receivers.
    [[nodiscard]] Progress part(std::size_t count)
    {
        const double from = share(done_), length = share(count);
        done_ += count;
        return [this, from, length](double done) { return progress_(from + length * done); };
    }

private:
    double share(std::size_t count) const
    {
        return static_cast<double>(count) / static_cast<double>(all_);
    }
    const Progress& progress_;
    std::size_t all_, done_ = 0;
};

std::vector<Receiver> chosen_receivers(const SeenPixels& seen,
                                       std::span<const std::uint32_t> chosen)
{
    std::vector<Receiver> receivers;
    receivers.reserve(chosen.size());
    for (const std::uint32_t i : chosen)
        receivers.push_back(seen.receivers[i]);
    return receivers;
}

std::vector<glm::vec4> picture_of(const SeenPixels& seen, std::span<const Occlusion> values)
{
    std::vector<glm::vec4> picture(
        static_cast<std::size_t>(seen.width) * static_cast<std::size_t>(seen.height),
        glm::vec4(0.0f));
    for (std::size_t i = 0; i < values.size(); ++i)
        picture[seen.pixels[i]] = glm::vec4(values[i].bent_normal, values[i].occlusion);
    return picture;
}

}  // namespace

void PixelSession::forget()
{
    found_.ask();
    answers_ = {};
    worker_.cancel();
}

void PixelSession::solve(PixelQuestion question)
{
    forget();
    worker_.start(
        [this, number = found_.ask(), question = std::move(question)](const Progress& progress) {
            try {
                find(number, question, progress);
            } catch (const Cancelled&) {
                throw;
            } catch (const std::exception& error) {
                PixelAnswers failed;
                failed.message = error.what();
                found_.post(number, std::move(failed));
            }
        });
}

void PixelSession::find(std::uint64_t number, const PixelQuestion& question,
                        const Progress& progress)
{
    const Model& model = *question.model;
    const Prepared& prepared =
        question.prepared ? *question.prepared : own_.prepared_for(question.model, question.engine);
    const SeenPixels seen =
        seen_pixels(*model.mesh, question.view, question.width, question.height, question.triangles,
                    offset_of(model.settings, model.geometry().frame));
    const std::vector<std::uint32_t> sample = spread_pixels(seen, question.sample);
    const std::vector<std::uint32_t> draft =
        question.whole ? draft_pixels(seen) : std::vector<std::uint32_t>();
    JobProgress job(progress, sample.size() + draft.size() + seen.pixels.size());

    PixelAnswers found;
    found.width = seen.width;
    found.height = seen.height;
    const auto solve_some = [&](std::span<const Receiver> receivers) {
        return surfelao::solve(prepared, receivers, question.engine, job.part(receivers.size()))
            .occlusion;
    };
    if (question.sample > 0) {
        for (const std::uint32_t i : sample)
            found.sample.pixels.push_back(seen.pixels[i]);
        found.sample.values = solve_some(chosen_receivers(seen, sample));
        found_.post(number, found);
    }
    if (!question.whole)
        return;
    if (draft.size() < seen.pixels.size()) {
        const std::vector<Occlusion> values = solve_some(chosen_receivers(seen, draft));
        found.picture = picture_of(seen, fill_draft(seen, question.view.eye, draft, values));
        found.is_draft = true;
        found_.post(number, found);
    }
    Stopwatch watch;
    found.picture = picture_of(seen, solve_some(seen.receivers));
    found.seconds = watch.lap();
    found.is_draft = false;
    found_.post(number, std::move(found));
}

bool PixelSession::update()
{
    std::optional<PixelAnswers> found = found_.take();
    if (!found)
        return false;
    answers_ = std::move(*found);
    return true;
}

}  // namespace surfelao

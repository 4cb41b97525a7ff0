#include "bake/moving_compare.h"

#include "bake/moving_solver.h"
#include "bake/moving_world.h"
#include "bake/statistics.h"
#include "bake/table.h"
#include "engines/threads.h"
#include "surfels/errors.h"
#include "surfels/for_all.h"
#include "surfels/number_text.h"
#include "surfels/stopwatch.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace surfelao {
namespace {

/// One engine on its way through the frames.
struct Runner {
    Runner(const MovingWorld& world, const EngineSettings& engine, bool is_smoothed)
        : solver(world, engine)
    {
        row.engine = engine;
        row.is_smoothed = is_smoothed;
    }

    MovingSolver solver;
    MovingRow row;
    std::vector<double> place, tree, solve, fit;  ///< milliseconds, of each frame
    std::vector<float> last;                      ///< occlusion at the points
    std::vector<float> errors;                    ///< of all frames
    double flicker_squares = 0.0, solved = 0.0;
};

double median_but_first(std::vector<double> values)
{
    if (values.size() > 1)
        values.erase(values.begin());
    return quantile(std::move(values), 0.5);
}

class FrameComparer {
public:
    FrameComparer(const MovingCompareSettings& settings, const StageProgress& progress)
        : progress_(progress),
          world_(settings.input, settings.seconds, settings.target, settings.parts,
                 settings.reading),
          truth_(world_.scene_for({.engine = Engine::rays}))
    {
        result_.settings = settings;
        const Definition definition =
            world_.definition_for(settings.max_distance, settings.kernel, settings.ground,
                                  largest_offset_of(settings.target, world_.frame()));
        reference_ = truth_settings();
        reference_.rays = settings.reference_rays;
        reference_.definition = definition;
        neighbours_ = world_.neighbours();
        const auto add = [&](EngineSettings engine, bool is_smoothed) {
            engine.definition = definition;
            runners_.emplace_back(std::make_unique<Runner>(world_, engine, is_smoothed));
        };
        for (const EngineSettings& candidate : settings.candidates)
            add(candidate, false);
        EngineSettings rays = truth_settings();
        rays.rays = kOpponentRays;
        add(rays, false);
        if (!neighbours_.empty())
            add(rays, true);
        rays.rays = 4 * kOpponentRays;
        add(rays, false);
        const std::size_t count = world_.receiver_count();
        const std::size_t points = std::min<std::size_t>(count, settings.sample);
        for (std::size_t i = 0; i < points; ++i) {
            const std::size_t receiver = i * count / points;
            if (!world_.has_normal(receiver))
                continue;
            points_.push_back(receiver);
            is_still_.push_back(world_.body_of(receiver) == 0);
        }
        result_.points = points_.size();
        result_.still_points = static_cast<std::uint64_t>(std::ranges::count(is_still_, true));
    }

    MovingComparison run()
    {
        std::vector<double> pose;
        for (std::size_t frame = 0; frame < result_.settings.seconds.size(); ++frame) {
            Stopwatch watch;
            world_.pose(result_.settings.seconds[frame]);
            pose.push_back(1e3 * watch.lap());
            const std::vector<float> truth = truth_now();
            for (const std::unique_ptr<Runner>& runner : runners_)
                run(*runner, truth);
            last_truth_ = truth;
            if (progress_ &&
                !progress_("frames", static_cast<double>(frame + 1) /
                                         static_cast<double>(result_.settings.seconds.size())))
                throw Cancelled();
        }
        result_.pose_ms = median_but_first(pose);
        for (const std::unique_ptr<Runner>& runner : runners_)
            finish(*runner);
        result_.animation = world_.animation();
        result_.vertices = world_.scene().positions.size();
        result_.triangles = world_.triangle_count();
        result_.receivers = world_.receiver_count();
        result_.bodies = world_.body_count();
        result_.threads = thread_count();
        return std::move(result_);
    }

private:
    static EngineSettings truth_settings()
    {
        EngineSettings rays;
        rays.engine = Engine::rays;
        return rays;
    }

    std::vector<float> truth_now()
    {
        world_.place(truth_);
        const std::vector<Receiver> all = world_.receivers_now();
        std::vector<Receiver> asked;
        for (const std::size_t point : points_)
            asked.push_back(all[point]);
        const std::vector<Occlusion> found = truth_.solve(asked, reference_).occlusion;
        std::vector<float> truth;
        for (const Occlusion& answer : found)
            truth.push_back(answer.occlusion);
        if (!last_truth_.empty()) {
            for (std::size_t i = 0; i < truth.size(); ++i)
                result_.untouched += is_still_[i] && truth[i] == last_truth_[i] ? 1 : 0;
        }
        return truth;
    }

    std::vector<Occlusion> smoothed(const std::vector<Occlusion>& answers) const
    {
        std::vector<Occlusion> means(answers.size());
        for_all(answers.size(), [&](std::size_t i) {
            means[i] = answers[i];
            double sum = 0.0;
            for (const std::uint32_t other : neighbours_[i])
                sum += static_cast<double>(answers[other].occlusion);
            if (!neighbours_[i].empty())
                means[i].occlusion =
                    static_cast<float>(sum / static_cast<double>(neighbours_[i].size()));
        });
        return means;
    }

    void run(Runner& runner, const std::vector<float>& truth)
    {
        Stopwatch watch;
        runner.solver.place();
        const double place = watch.lap();
        const FrameReport report = runner.solver.solve();
        watch.lap();
        std::vector<Occlusion> answers = runner.solver.answers();
        if (runner.row.is_smoothed)
            answers = smoothed(answers);
        const double smoothing = watch.lap();
        static_cast<void>(runner.solver.values_of(answers));
        runner.fit.push_back(1e3 * watch.lap());
        runner.place.push_back(1e3 * (place + report.place));
        runner.tree.push_back(1e3 * report.tree);
        runner.solve.push_back(1e3 * (report.solve + smoothing));
        runner.solved += static_cast<double>(report.solved);

        double squares = 0.0;
        std::vector<float> now;
        for (std::size_t i = 0; i < points_.size(); ++i) {
            now.push_back(answers[points_[i]].occlusion);
            const float error = now[i] - truth[i];
            runner.errors.push_back(error);
            squares += static_cast<double>(error) * static_cast<double>(error);
            if (runner.last.empty() || !is_still_[i])
                continue;
            const double change = static_cast<double>(now[i]) - static_cast<double>(runner.last[i]);
            const double wanted =
                static_cast<double>(truth[i]) - static_cast<double>(last_truth_[i]);
            runner.flicker_squares += (change - wanted) * (change - wanted);
            runner.row.flicker_max = std::max(runner.row.flicker_max, std::abs(change - wanted));
            if (wanted == 0.0)
                runner.row.untouched_max = std::max(runner.row.untouched_max, std::abs(change));
        }
        runner.row.rmse_by_frame.push_back(
            std::sqrt(squares / static_cast<double>(std::max<std::size_t>(points_.size(), 1))));
        runner.last = std::move(now);
    }

    void finish(Runner& runner)
    {
        MovingRow& row = runner.row;
        const double frames = static_cast<double>(row.rmse_by_frame.size());
        std::vector<double> sizes;
        double sum = 0.0, squares = 0.0;
        for (const float error : runner.errors) {
            sizes.push_back(std::abs(static_cast<double>(error)));
            sum += static_cast<double>(error);
            squares += sizes.back() * sizes.back();
        }
        const double count = static_cast<double>(sizes.size());
        if (!sizes.empty()) {
            row.rmse = std::sqrt(squares / count);
            row.bias = sum / count;
            row.max = *std::ranges::max_element(sizes);
            row.p95 = quantile(std::move(sizes), 0.95);
        }
        if (result_.still_points > 0 && frames > 1.0)
            row.flicker_rms = std::sqrt(runner.flicker_squares /
                                        (static_cast<double>(result_.still_points) * (frames - 1)));
        row.place_ms = median_but_first(runner.place);
        row.tree_ms = median_but_first(runner.tree);
        row.solve_ms = median_but_first(runner.solve);
        row.fit_ms = median_but_first(runner.fit);
        row.solved = runner.solved / frames;
        result_.rows.push_back(std::move(row));
    }

    const StageProgress& progress_;
    MovingWorld world_;
    MovingScene truth_;
    EngineSettings reference_;
    std::vector<std::vector<std::uint32_t>> neighbours_;
    std::vector<std::unique_ptr<Runner>> runners_;
    std::vector<std::size_t> points_;
    std::vector<bool> is_still_;
    std::vector<float> last_truth_;
    MovingComparison result_;
};

std::string name_of_row(const MovingRow& row)
{
    return name_of(row.engine.engine) + (row.is_smoothed ? " smoothed" : "");
}

}  // namespace

MovingComparison compare_frames(const MovingCompareSettings& settings,
                                const StageProgress& progress)
{
    require(settings.seconds.size() >= 2, "a comparison of frames needs two of them at least");
    if (progress && !progress("read", 0.0))
        throw Cancelled();
    return FrameComparer(settings, progress).run();
}

std::string table_of(const MovingComparison& comparison)
{
    std::string text =
        comparison.settings.input.string() + ": \"" + comparison.animation + "\", " +
        std::to_string(comparison.settings.seconds.size()) + " frames, " +
        std::to_string(comparison.vertices) + " vertices, " + std::to_string(comparison.triangles) +
        " triangles, " + count_text(comparison.bodies, "body|bodies") + ", " +
        std::to_string(comparison.receivers) + " places; errors at " +
        std::to_string(comparison.points) + " of them, " + std::to_string(comparison.still_points) +
        " on what never moves, against " + std::to_string(comparison.settings.reference_rays) +
        " rays; pose " + fixed(comparison.pose_ms, 2) + " ms\n";
    Table table({"engine", "setting", "rmse", "bias", "p95", "max", "flicker", "at most",
                 "untouched", "place ms", "tree ms", "solve ms", "frame ms", "fit ms", "solved"});
    for (const MovingRow& row : comparison.rows)
        table.add({name_of_row(row), setting_of(row.engine), fixed(row.rmse, 4), fixed(row.bias, 4),
                   fixed(row.p95, 4), fixed(row.max, 3), fixed(row.flicker_rms, 5),
                   fixed(row.flicker_max, 4), fixed(row.untouched_max, 5), fixed(row.place_ms, 2),
                   fixed(row.tree_ms, 2), fixed(row.solve_ms, 2), fixed(row.total_ms(), 2),
                   fixed(row.fit_ms, 2), fixed(row.solved, 0)});
    return text + table.text();
}

std::string csv_of(const MovingComparison& comparison)
{
    std::string text =
        "engine,setting,smoothed,rmse,bias,p95,max,flicker_rms,flicker_max,untouched_max,place_ms,"
        "tree_ms,solve_ms,fit_ms,solved\n";
    for (const MovingRow& row : comparison.rows) {
        text += name_of(row.engine.engine) + ',' + csv_field(setting_of(row.engine)) + ',' +
                (row.is_smoothed ? "1" : "0");
        for (const double value :
             {row.rmse, row.bias, row.p95, row.max, row.flicker_rms, row.flicker_max,
              row.untouched_max, row.place_ms, row.tree_ms, row.solve_ms, row.fit_ms, row.solved})
            text += ',' + exact(value);
        text += '\n';
    }
    return text;
}

}  // namespace surfelao

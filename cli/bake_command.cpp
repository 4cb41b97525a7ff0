#include "cli/bake_command.h"

#include "bake/bake.h"
#include "bake/moving_bake.h"
#include "cli/bake_text.h"
#include "cli/commands.h"
#include "cli/engine_options.h"
#include "cli/frame_options.h"
#include "cli/frame_scenes.h"
#include "cli/grid_bake_options.h"
#include "cli/output.h"
#include "cli/part_options.h"
#include "cli/preset.h"
#include "cli/progress_bar.h"
#include "cli/read_options.h"
#include "cli/texel_options.h"
#include "cli/value_checks.h"
#include "engines/threads.h"
#include "files/file_type.h"
#include "files/maker_mark.h"
#include "files/scene_io.h"
#include "grid/grid_file.h"
#include "surfels/errors.h"
#include "surfels/heap_pages.h"
#include "surfels/progress.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <iostream>
#include <memory>
#include <span>

namespace surfelao {
namespace {

namespace fs = std::filesystem;

struct BakeOptions {
    std::vector<std::string> inputs;
    std::string output;
    ReadOptions reading;
    FrameOptions frames;
    EngineOptions engine;
    MeasureOptions measure;
    std::optional<std::string> up;
    SurfaceOptions surface;
    ColorOptions colors;
    TexelOptions texels;
    GridBakeOptions grid;
    std::optional<double> subdivide;
    PartOptions parts;
    bool together = false;
    std::uint32_t check = kCheckPoints;
    std::optional<double> error;
    bool resume = false;
    bool overwrite = false;
    std::optional<std::string> part;     ///< "3/7"
    std::vector<std::string> arguments;  ///< what of the command line a part's file holds
    std::optional<std::string> json;
    std::optional<int> threads;
};

/// One file of the batch.
struct Job {
    fs::path input, output;
    std::optional<Moment> moment = {};  ///< of a frame
};

/// Whether -o names a folder: then the names of the files in it are ours, not the user's.
bool is_folder(const BakeOptions& options)
{
    std::error_code error;
    return options.inputs.size() > 1 || options.output.ends_with('/') ||
           fs::is_directory(options.output, error);
}

/// The frames of an animation.
std::vector<FrameFile> frames_of(const BakeOptions& options)
{
    return frames_of(options.frames, options.inputs, options.output, options.reading);
}

/// "FOLDER/NAME.aogrid.exr" of a grid, else as output_in_folder().
fs::path result_in_folder(const BakeOptions& options, const fs::path& input)
{
    if (is_at_grid(options.texels))
        return fs::path(options.output) / (input.stem().string() + ".aogrid.exr");
    return output_in_folder(input, options.output);
}

/// Where every result goes. Two results under one name, or one in the place of an input, are
/// refused before anything is overwritten.
std::vector<Job> jobs_of(const BakeOptions& options)
{
    std::error_code error;
    if (options.inputs.size() > 1 && !fs::is_directory(options.output, error) &&
        (fs::path(options.output).has_extension() || fs::exists(options.output, error)))
        throw UsageError(options.output +
                         " is no folder, but several files are to be written: -o FOLDER/.");
    FilePlan files;
    for (const std::string& input : options.inputs)
        files.reads(input);
    for (const auto* others : {&options.texels.high, &options.parts.occluders})
        for (const std::string& other : *others)
            files.reads(other);
    const bool into_folder = is_folder(options);
    std::vector<Job> jobs;
    for (const FrameFile& frame : frames_of(options))
        jobs.push_back({options.inputs.front(), frame.output, frame.moment});
    if (jobs.empty()) {
        for (const std::string& input : options.inputs)
            jobs.push_back(
                {input, into_folder ? result_in_folder(options, input) : fs::path(options.output)});
    }
    for (const Job& job : jobs) {
        files.writes(job.output, job.input.string());
        if (is_at_grid(options.texels))
            files.writes(grid_text_path(job.output), job.input.string());
        if (texel_settings_of(options.texels, job.output)) {
            if (options.subdivide)
                throw UsageError("--subdivide is for values at vertices: it goes with no map.");
            for (const auto& beside : {map_file_of(job.output), map_materials_of(job.output)}) {
                if (beside)
                    files.writes(*beside, job.input.string());
            }
        }
        if (options.texels.bent.value_or("none") != "none")
            files.writes(bent_path(job.output), job.input.string());
    }
    files.writes_report(options.json, "--json");
    return jobs;
}

/// Throws UsageError for what is no share.
std::optional<BakeShare> share_of(const BakeOptions& options)
{
    if (!options.part)
        return std::nullopt;
    std::uint32_t numbers[2] = {};
    const char* const end = options.part->data() + options.part->size();
    const auto first = std::from_chars(options.part->data(), end, numbers[0]);
    const bool has_second = first.ec == std::errc() && first.ptr != end && *first.ptr == '/';
    const auto second = has_second ? std::from_chars(first.ptr + 1, end, numbers[1]) : first;
    if (!has_second || second.ec != std::errc() || second.ptr != end || numbers[0] < 1 ||
        numbers[0] > numbers[1] || numbers[1] > kMostShares)
        throw UsageError("--part: \"" + *options.part + "\" is not K/N with K from 1 to N.");
    return BakeShare{{numbers[0] - 1, numbers[1]}, options.arguments};
}

BakeSettings settings_for(const BakeOptions& options, const Job& job)
{
    BakeSettings settings;
    settings.input = job.input;
    settings.output = job.output;
    settings.engine = settings_of(options.engine);
    settings.max_distance = distance_limit_of(options.measure);
    settings.kernel = kernel_of(options.measure);
    settings.ground = ground_plane_of(options.measure, options.up);
    settings.target = target_settings_of(options.surface, options.up);
    settings.parts = part_choice_of(options.parts);
    if (options.together) {
        for (const std::string& other : options.inputs) {
            if (job.input != other)
                settings.beside.emplace_back(other);
        }
    }
    settings.check = options.check;
    settings.error = options.error;
    settings.texels = texel_settings_of(options.texels, job.output);
    settings.grid = grid_settings_of(options.grid, options.texels);
    if (options.texels.at && *options.texels.at != "texels" && !settings.grid)
        settings.at_points = options.texels.at == "points";
    settings.subdivide = options.subdivide;
    settings.colors = colors_of(options.colors);
    settings.encoding = encoding_of(options.colors);
    settings.share = share_of(options);
    settings.reading = options.reading;
    if (job.moment)
        settings.reading.moment = job.moment;
    return settings;
}

/// The text beside a grid has a name that its user did not give.
void refuse_foreign_text(const BakeSettings& settings)
{
    if (!settings.grid)
        return;
    const fs::path text = grid_text_path(settings.output);
    std::error_code ignored;
    if (fs::exists(text, ignored) && command_of_mark(grid_maker(text)) != "bake")
        throw InputError(text.string() +
                         ": stands there and was not made by bake (--overwrite replaces it)");
}

/// Of what could not be done; the exit code.
int tell_failure(const std::exception& error, std::span<BatchEntry> entries)
{
    std::cerr << "surfelao: " << error.what() << '\n';
    for (BatchEntry& entry : entries)
        entry.error = error.what();
    return dynamic_cast<const SettingsError*>(&error) != nullptr ? kWrongUsage : kFailed;
}

/// One job, or several that are baked together; `label` stands in front of its progress; frames:
/// null, or those of which it is one. The exit code: whatever it is, the others can still be done.
int run_jobs(const std::vector<BakeSettings>& settings, bool ask_before_replacing, bool overwrite,
             const std::string& label, FrameScenes* frames, std::span<BatchEntry> entries)
{
    try {
        for (const BakeSettings& one : settings) {
            if (ask_before_replacing)
                refuse_foreign(one.output, "bake");
            if (!overwrite)
                refuse_foreign_text(one);
        }
        ProgressBar bar(label);
        const auto update = [&](std::string_view stage, double done) {
            return bar.update(stage, done);
        };
        std::vector<BakeReport> reports;
        if (frames != nullptr)
            reports.push_back(frames->bake(settings.front(), update));
        else
            reports = bake_together(settings, update);
        for (std::size_t i = 0; i < reports.size(); ++i)
            entries[i].report = std::move(reports[i]);
    } catch (const Cancelled&) {
        throw;
    } catch (const std::exception& error) {
        return tell_failure(error, entries);
    }
    return kDone;
}

void add_written(const BatchEntry& entry, std::vector<fs::path>& written)
{
    if (const auto& part = entry.report->settings.share) {
        written.push_back(part_path(entry.output, part->share));
        return;
    }
    if (!entry.report->texels || type_of(entry.output) != FileType::unknown)
        written.push_back(entry.output);
    if (entry.report->grid)
        written.push_back(grid_text_path(entry.output));
    if (entry.report->texels)
        written.insert(written.end(), entry.report->texels->written.begin(),
                       entry.report->texels->written.end());
}

std::string label_of(const std::vector<Job>& jobs, std::size_t job)
{
    return std::to_string(job + 1) + "/" + std::to_string(jobs.size()) + " " +
           jobs[job].input.filename().string() + " ";
}

/// Frames of one animation, in one go; the exit code.
int run_sequence(const std::vector<Job>& jobs, std::span<const BakeSettings> settings, bool resume,
                 bool quiet, std::span<BatchEntry> entries, std::vector<fs::path>& written)
{
    std::optional<ProgressBar> bar(label_of(jobs, 0));
    std::size_t next = 0;
    try {
        bake_frames(
            settings, resume,
            [&](std::size_t frame, std::optional<BakeReport> report) {
                BatchEntry& entry = entries[frame];
                bar.reset();
                entry.report = std::move(report);
                if (entry.report)
                    add_written(entry, written);
                if (!quiet && entry.report)
                    print_report(*entry.report);
                else if (!quiet)
                    std::cout << entry.output.string() << ": finished before, skipped\n";
                next = frame + 1;
                if (next < jobs.size())
                    bar.emplace(label_of(jobs, next));
            },
            [&](std::string_view stage, double done) { return bar->update(stage, done); });
    } catch (const Cancelled&) {
        throw;
    } catch (const std::exception& error) {
        return tell_failure(error, entries.subspan(next));
    }
    return kDone;
}

/// Tells what was written, and how many failed.
void finish(const BakeOptions& options, std::span<const BatchEntry> entries,
            std::vector<fs::path>& written)
{
    const auto failed = static_cast<std::size_t>(std::ranges::count_if(
        entries, [](const BatchEntry& entry) { return !entry.error.empty(); }));
    const bool quiet = options.json == "-";
    if (options.json)
        write_report(*options.json, json_of(entries));
    if (options.json && !quiet)
        written.emplace_back(*options.json);
    print_written(written, quiet);
    const bool is_whole_sequence = options.frames.frames && failed == entries.size();
    if (failed > 0 && entries.size() > 1 && !is_whole_sequence)
        std::cerr << "surfelao: " << failed << " of " << entries.size()
                  << (options.frames.frames ? " frames failed\n" : " files failed\n");
}

/// Whether memory counts more than pages that come ready: from some 5 million triangles on.
bool is_large(const Job& job)
{
    constexpr std::uintmax_t kLarge = 100'000'000;  // bytes
    std::error_code unreadable;                     // which reading will tell
    const std::uintmax_t bytes = fs::file_size(job.input, unreadable);
    return !unreadable && bytes >= kLarge;
}

int run(const BakeOptions& options, const std::vector<Job>& jobs)
{
    if (std::ranges::any_of(jobs, is_large))
        return_heap_pages();
    OutputFolders folders;
    folders.make_for_report(options.json);
    if (is_folder(options))
        folders.make(options.output);
    for (const Job& job : jobs)
        folders.make_for(job.output);
    std::optional<ThreadLimit> limit;
    if (options.threads)
        limit.emplace(*options.threads);
    const bool batch = jobs.size() > 1;
    const bool quiet = options.json == "-";
    const bool ask = is_folder(options) && !options.overwrite;
    int code = kDone;
    std::vector<BatchEntry> entries;
    for (const Job& job : jobs) {
        BatchEntry& entry = entries.emplace_back();
        entry.input = job.input;
        entry.output = job.output;
    }
    std::vector<fs::path> written;
    if (options.frames.frames && is_for_bodies(settings_for(options, jobs.front()))) {
        std::vector<BakeSettings> settings;
        for (const Job& job : jobs)
            settings.push_back(settings_for(options, job));
        code = run_sequence(jobs, settings, options.resume, quiet, entries, written);
        finish(options, entries, written);
        return code;
    }
    std::optional<FrameScenes> frames;
    if (options.frames.frames)
        frames.emplace(options.inputs.front(), seconds_of(options.frames, options.inputs),
                       part_choice_of(options.parts), options.reading);
    const std::size_t step = options.together ? jobs.size() : 1;
    for (std::size_t first = 0; first < jobs.size(); first += step) {
        std::vector<BakeSettings> settings;
        for (const Job& job : std::span(jobs).subspan(first, step))
            settings.push_back(settings_for(options, job));
        if (frames)
            settings.front().frame = frames->frame();
        const std::span<BatchEntry> of_run = std::span(entries).subspan(first, step);
        if (options.resume && std::ranges::all_of(settings, is_finished)) {
            for (const BatchEntry& entry : of_run)
                if (!quiet)
                    std::cout << entry.input.string() << ": finished before, skipped\n";
            continue;
        }
        const int of_jobs = run_jobs(settings, ask, options.overwrite,
                                     batch && step == 1 ? label_of(jobs, first) : "",
                                     frames ? &*frames : nullptr, of_run);
        code = std::max(code, of_jobs);  // wrong usage is what its user can mend
        if (of_jobs != kDone)
            continue;
        for (const BatchEntry& entry : of_run) {
            add_written(entry, written);
            if (!quiet)
                print_report(*entry.report);
        }
    }
    finish(options, entries, written);
    return code;
}

/// Throws UsageError for what cannot be done in shares.
void check_part(const BakeOptions& options, const EngineSettings& engine)
{
    if (!share_of(options))
        return;
    if (options.inputs.size() != 1 || is_folder(options))
        throw UsageError("--part is for a single file.");
    if (options.error)
        throw UsageError("--part is a share of a known engine's work: leave out --error.");
    if (engine.device != Device::cpu)
        throw UsageError("--part is for --device cpu.");
    if (texel_settings_of(options.texels, options.output))
        throw UsageError("--part is for values at vertices.");
    if (options.resume)
        throw UsageError("--resume knows no parts: leave it or --part out.");
}

/// Throws UsageError for what is of no use round an object.
void check_grid_options(const BakeOptions& options)
{
    if (!grid_settings_of(options.grid, options.texels))
        return;
    if (options.together || !options.parts.occluders.empty())
        throw UsageError("--at grid is of one object alone: leave out --together and --occluders.");
    if (options.error || options.part || options.subdivide || options.frames.frames)
        throw UsageError("--at grid goes with none of --error, --part, --subdivide and --frames.");
    check_about_an_object(options.measure, options.surface);
}

/// What a preset leaves alone.
std::vector<std::string> moot_of(const BakeOptions& options)
{
    if (is_at_grid(options.texels))
        return {"--normals", "--crease", "--subdivide", "--colors"};
    if (texel_settings_of(options.texels, options.output))
        return {"--subdivide", "--colors"};
    if (options.frames.frames)
        return {"--subdivide"};
    return {};
}

/// Throws UsageError for colours of what has none.
void check_colors(const BakeOptions& options)
{
    if ((options.colors.colors || options.colors.encoding) &&
        (is_at_grid(options.texels) || texel_settings_of(options.texels, options.output)))
        throw UsageError(
            "--colors and --encoding are for values at vertices and points: neither a map nor a "
            "grid has such colours.");
}

/// Throws UsageError for what contradicts itself.
void check_options(const BakeOptions& options)
{
    const EngineSettings engine = settings_of(options.engine);
    static_cast<void>(distance_limit_of(options.measure));
    static_cast<void>(ground_plane_of(options.measure, options.up));
    static_cast<void>(target_settings_of(options.surface, options.up));
    check_colors(options);
    check_kernel(engine.engine, kernel_of(options.measure));
    if (options.error && options.check == 0)
        throw UsageError("--error needs the points of --check.");
    if (options.error && kernel_of(options.measure) != Kernel::cosine)
        throw UsageError("--error tries masks, which know --kernel cosine only.");
    if (options.together && options.inputs.size() < 2)
        throw UsageError("--together is for several files.");
    if (!options.texels.high.empty() && (options.together || !options.parts.occluders.empty()))
        throw UsageError(
            "With --high nothing else occludes: leave out --occluders and --together.");
    if (options.resume && options.texels.udim)
        throw UsageError("--resume knows no tiles: leave it or --udim out.");
    check_part(options, engine);
    check_grid_options(options);
    if (!frames_of(options).empty() &&
        (options.part || options.subdivide || !options.texels.high.empty()))
        throw UsageError("--frames goes with neither --part nor --subdivide nor --high.");
}

void add_options(CLI::App* command, const std::shared_ptr<BakeOptions>& options)
{
    command->add_option("IN", options->inputs, kMeshOrCloud)->required()->type_name("");
    command
        ->add_option(
            "-o,--output", options->output,
            "Mesh or cloud file (.ply .obj .off, .gltf/.glb of meshes, .pcd .xyz .pts .txt .asc "
            "from clouds), a map over the file's texture "
            "coordinates (.png .tif .exr), with --at grid NAME.aogrid.exr or .png, or a folder "
            "(made where it is "
            "missing, for several files and behind a /): there every "
            "result has its input's name, .ply for .stl, .glb for what assimp reads, and only "
            "files that bake made are "
            "replaced")
        ->required()
        ->type_name("OUT|DIR");
    add_read_options(*command, options->reading);
    add_frame_options(*command, options->frames);
    add_engine_options(*command, options->engine);
    add_measure_options(*command, options->measure);
    add_up_option(*command, options->up, "What is measured");
    add_surface_options(*command, options->surface);
    add_subdivide_option(*command, options->subdivide);
    add_color_options(*command, options->colors);
    add_texel_options(*command, options->texels);
    add_grid_bake_options(*command, options->grid, true);
    add_part_options(*command, options->parts);
    command
        ->add_flag("--together", options->together,
                   "Several files in the same coordinates are one scene: all occlude each other, "
                   "each is written by itself")
        ->group("Parts");
    command
        ->add_option("--check", options->check,
                     "Points of the surface at which the result is measured against rays; 0: none")
        ->check(whole_from(0, kMostCheckPoints))
        ->type_name("N")
        ->default_str(std::to_string(kCheckPoints))
        ->group("Error");
    CLI::Option* error =
        command
            ->add_option(
                "--error", options->error,
                "Take the cheapest setting of masks or rays whose error, as seen, is below "
                "this with its whole interval (0.01); instead of --engine and --quality")
            ->check(number_from(1e-6, 1.0))
            ->type_name("E")
            ->group("Error");
    for (const char* other : {"--engine", "--quality", "--rays", "--passes", "--strength"})
        error->excludes(command->get_option(other));
    command->add_flag("--resume", options->resume,
                      "Skip files whose result is not older than they are and says that it was "
                      "made with these settings (a comment in the file, asset.extras in glTF)");
    add_overwrite_option(*command, options->overwrite);
    add_preset_option(*command);
    command
        ->add_option("--json", options->json,
                     "Write what was done and how long it took; - = "
                     "standard output; a list for several files")
        ->type_name("FILE");
    command
        ->add_option("--part", options->part,
                     "Only the K-th of N equal shares of the work, for one machine of N: writes "
                     "OUT.K-of-N.part; `surfelao merge` makes OUT of all of them")
        ->type_name("K/N");
    add_thread_option(*command, options->threads);
}

/// What `merge` needs of the command line to say the same settings again: not where it reads and
/// writes, nor what concerns this machine alone.
std::vector<std::string> arguments_of(const CLI::App& command)
{
    std::vector<std::string> arguments;
    for (const CLI::Option* option : command.get_options()) {
        const std::string name = option->get_name();
        if (option->count() == 0 || option->get_positional() || name == "--output" ||
            name == "--part" || name == "--preset" || name == "--threads" || name == "--json" ||
            name == "--overwrite")
            continue;
        arguments.push_back(name);
        if (option->get_items_expected_max() > 0)
            arguments.insert(arguments.end(), option->results().begin(), option->results().end());
    }
    return arguments;
}

}  // namespace

BakeSettings bake_settings_of(const fs::path& input, const fs::path& output,
                              std::span<const std::string> arguments)
{
    const auto options = std::make_shared<BakeOptions>();
    CLI::App command;
    add_options(&command, options);
    std::vector<std::string> line(arguments.rbegin(), arguments.rend());  // as parse() takes it
    line.insert(line.end(), {output.string(), "-o", input.string()});
    try {
        command.parse(std::move(line));
        check_options(*options);
    } catch (const CLI::ParseError&) {
        throw InputError(input.string() + ": its parts have options that no bake has");
    } catch (const UsageError&) {
        throw InputError(input.string() + ": its parts have options that contradict each other");
    }
    return settings_for(*options, {input, output});
}

void add_bake_command(CLI::App& app, Work& work)
{
    const auto options = std::make_shared<BakeOptions>();
    CLI::App* command = app.add_subcommand("bake",
                                           "Occlusion and bent normals at every vertex or point, "
                                           "as a map, or in a grid round an object: a mesh or a "
                                           "cloud of points in, the same or a picture out");
    add_options(command, options);
    command->callback([options, command, &work] {
        apply_preset(*command, moot_of(*options));
        options->arguments = arguments_of(*command);
        check_options(*options);
        work = [options, jobs = jobs_of(*options)] { return run(*options, jobs); };
    });
}

}  // namespace surfelao

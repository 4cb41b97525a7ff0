#include "viewer/saver.h"

#include "files/file_type.h"
#include "files/scene_io.h"
#include "files/sidecars.h"
#include "image/image_file.h"

#include <algorithm>
#include <exception>
#include <utility>

namespace surfelao {
namespace {

namespace fs = std::filesystem;

/// All that saving writes.
std::vector<fs::path> files_of(Saved what, const fs::path& path, const Session& session)
{
    std::vector<fs::path> files = {path};
    if (what == Saved::picture || !session.state().layout || type_of(path) == FileType::unknown)
        return files;
    for (const auto& beside : {map_file_of(path), map_materials_of(path)}) {
        if (beside)
            files.push_back(*beside);
    }
    return files;
}

/// Why nothing can be saved now; else empty.
std::string lack_of(Saved what, const Savable& content)
{
    if (what == Saved::picture)
        return content.picture ? "" : "there is no picture yet";
    if (!content.session.state().is_solved)
        return "nothing is solved yet";
    return content.is_moving ? "not saved: this pose is not solved yet" : "";
}

}  // namespace

void Saver::add_input(const fs::path& path)
{
    files_.add_input(path);
    unread_.push_back(path);
}

/// Its textures and materials too: found when they are first in danger, for models are long.
Standing Saver::standing_of(const fs::path& path)
{
    if (files_.standing_of(path) == Standing::foreign) {
        for (const fs::path& input : std::exchange(unread_, {})) {
            for (const fs::path& file : sidecars_of(input))
                files_.add_input(file);
        }
    }
    return files_.standing_of(path);
}

std::string Saver::save(Saved what, const fs::path& path, const Savable& content)
{
    if (std::string lack = lack_of(what, content); !lack.empty())
        return lack;
    const fs::path whole = whole_path(path);
    SaveQuestion question{.what = what, .path = whole, .there = {}};
    for (const fs::path& file : files_of(what, whole, content.session)) {
        const Standing standing = standing_of(file);
        question.is_input |= standing == Standing::input;
        if (standing == Standing::input || standing == Standing::foreign)
            question.there.push_back(file);
    }
    if (question.there.empty())
        return write(what, whole, content);
    question_ = std::move(question);
    return {};
}

std::string Saver::reply(SaveReply reply, const Savable& content)
{
    if (!question_ || reply == SaveReply::none)
        return {};
    const SaveQuestion question = *std::exchange(question_, std::nullopt);
    if (reply == SaveReply::cancel)
        return "not saved";
    const auto files = [&](const fs::path& path) {
        return files_of(question.what, path, content.session);
    };
    if (reply == SaveReply::keep_both)
        return write(question.what, next_free_name(question.path, files), content);
    const bool is_input = std::ranges::any_of(
        question.there, [&](const fs::path& file) { return standing_of(file) == Standing::input; });
    return is_input ? save(question.what, question.path, content)  // it was opened meanwhile
                    : write(question.what, question.path, content);
}

std::string Saver::write(Saved what, const fs::path& path, const Savable& content)
{
    const Session& session = content.session;
    if (std::string lack = lack_of(what, content); !lack.empty())
        return lack;
    std::string note = "saved " + path.string();
    try {
        if (what == Saved::picture)
            write_image(path, content.picture());
        else
            session.save(path);
    } catch (const std::exception& error) {
        return error.what();
    }
    for (const fs::path& file : files_of(what, path, session)) {
        files_.add_written(file);
        if (file != path)
            note += ", " + file.filename().string() + " beside it";
    }
    if (what == Saved::baked && session.state().is_draft)
        note += ", of the draft";
    if (what == Saved::baked && !session.state().pose.is_rest())
        note += ": values of this pose; a glTF keeps the file's own places";
    return note;
}

}  // namespace surfelao

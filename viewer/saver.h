/// saver.h: writes what a window shows, and asks before anything is lost.
#pragma once

#include "image/image.h"
#include "viewer/output_files.h"
#include "viewer/session.h"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace surfelao {

/// What can be saved.
enum class Saved { picture, baked };

/// Asked before a file is written where another one stands.
struct SaveQuestion {
    Saved what = Saved::picture;
    std::filesystem::path path;
    std::vector<std::filesystem::path> there;  ///< all files that would be lost
    bool is_input = false;  ///< one of them was read: then replacing is not offered
};
enum class SaveReply { none, replace, keep_both, cancel };

/// What there is to save.
struct Savable {
    const Session& session;
    bool is_moving = false;          ///< another pose than the session's is shown
    std::function<Image()> picture;  ///< null until there is one
};

/// For one window.
class Saver {
public:
    /// A file that was read: neither it nor what it is made of besides (files/sidecars.h) is ever
    /// replaced.
    void add_input(const std::filesystem::path& path);

    /// Writes the file and what belongs beside it, or asks. What is then to be told, one line:
    /// where it is, or what went wrong; empty while there is a question.
    [[nodiscard]] std::string save(Saved what, const std::filesystem::path& path,
                                   const Savable& content);
    [[nodiscard]] std::string reply(SaveReply reply, const Savable& content);

    /// Open until there is a reply.
    const std::optional<SaveQuestion>& question() const { return question_; }
    const std::vector<std::filesystem::path>& written() const { return files_.written(); }

private:
    [[nodiscard]] Standing standing_of(const std::filesystem::path& path);
    [[nodiscard]] std::string write(Saved what, const std::filesystem::path& path,
                                    const Savable& content);
    OutputFiles files_;
    std::vector<std::filesystem::path> unread_;  ///< inputs whose sidecars are not known yet
    std::optional<SaveQuestion> question_;
};

}  // namespace surfelao

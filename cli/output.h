/// output.h: which files a run reads and writes, so that nothing that its user owns is lost.
///
/// The rule of all commands: a file that is read is never written, under whatever name; a file that
/// the run did not make is replaced only where its user named it (`-o FILE`, `--json FILE`) or said
/// so (`--overwrite`); every file that was written is named at the end.
#pragma once

#include <filesystem>
#include <iosfwd>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace CLI {
class App;
}

namespace surfelao {

/// The files of one run, told before any work.
class FilePlan {
public:
    /// A file that is read. Of a mesh what it refers to as well (files/sidecars.h).
    void reads(const std::filesystem::path& file);

    /// A file that is going to be written; `what` names the result in messages ("--json"). Throws
    /// UsageError when that would replace a file that is read, also through links and other
    /// spellings of its path, or another result of this run.
    void writes(const std::filesystem::path& file, const std::string& what);

    /// The same for a report. Nothing for none and for "-".
    void writes_report(const std::optional<std::string>& file, const std::string& what);

private:
    using Identity = std::pair<unsigned long long, unsigned long long>;  ///< device and inode
    static std::optional<Identity> identity_of(const std::filesystem::path& file);
    void refuse_sidecar(const std::filesystem::path& file, Identity identity) const;

    std::map<Identity, std::filesystem::path> read_;
    std::map<std::filesystem::path, std::string> written_;  ///< what, by canonical path
};

/// The folders that results go to. Made where they are missing, the folders above them too, and
/// taken back at the end of the run where nothing was written into them.
class OutputFolders {
public:
    OutputFolders() = default;
    ~OutputFolders();
    OutputFolders(const OutputFolders&) = delete;
    OutputFolders& operator=(const OutputFolders&) = delete;

    /// Throws InputError when it cannot be made.
    void make(const std::filesystem::path& folder);
    /// The folder that the file is to stand in.
    void make_for(const std::filesystem::path& file);
    /// Also refuses a report that could not be written, before any work. Nothing for none and "-".
    void make_for_report(const std::optional<std::string>& file);

private:
    std::vector<std::filesystem::path> made_;  ///< from the outermost
};

/// Adds `--overwrite`.
void add_overwrite_option(CLI::App& command, bool& overwrite);

/// For names that the user did not give: throws InputError when a file stands there that no earlier
/// run of `command` made (files/maker_mark.h).
void refuse_foreign(const std::filesystem::path& file, std::string_view command);

/// Writes the file atomically; "-" = standard output.
void write_report(const std::string& file, const std::string& text);

/// "wrote FILE", one line each: on standard output, or on standard error where the former belongs
/// to a report.
void print_written(std::span<const std::filesystem::path> files, bool report_on_stdout);

}  // namespace surfelao

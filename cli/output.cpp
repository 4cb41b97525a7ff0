#include "cli/output.h"

#include "cli/commands.h"
#include "files/file_type.h"
#include "files/maker_mark.h"
#include "files/sidecars.h"
#include "surfels/atomic_file.h"
#include "surfels/errors.h"

#include <CLI/CLI.hpp>

#include <sys/stat.h>

#include <iostream>

namespace surfelao {

namespace fs = std::filesystem;

std::optional<FilePlan::Identity> FilePlan::identity_of(const fs::path& file)
{
    struct stat status = {};
    if (stat(file.c_str(), &status) != 0)
        return std::nullopt;
    return Identity(status.st_dev, status.st_ino);
}

void FilePlan::reads(const fs::path& file)
{
    if (const std::optional<Identity> identity = identity_of(file))
        read_.emplace(*identity, file);
}

/// Looks into the meshes only now that a file stands where a result is to go.
void FilePlan::refuse_sidecar(const fs::path& file, Identity identity) const
{
    for (const auto& [unused, input] : read_) {
        for (const fs::path& sidecar : sidecars_of(input)) {
            if (identity_of(sidecar) == identity) {
                throw UsageError(file.string() + " belongs to " + input.string() +
                                 " and would be overwritten.");
            }
        }
    }
}

void FilePlan::writes(const fs::path& file, const std::string& what)
{
    if (const std::optional<Identity> identity = identity_of(file)) {
        if (const auto input = read_.find(*identity); input != read_.end()) {
            throw UsageError(input->second.string() + " is read and would be overwritten" +
                             (input->second == file ? "." : " by " + file.string() + "."));
        }
        if (type_of(file) == FileType::unknown)  // no sidecar has a mesh's extension
            refuse_sidecar(file, *identity);
    }
    std::error_code error;
    const auto [other, is_new] = written_.emplace(fs::weakly_canonical(file, error), what);
    if (!is_new) {
        throw UsageError(other->second + " and " + what + " would both be written to " +
                         file.string() + ".");
    }
}

void FilePlan::writes_report(const std::optional<std::string>& file, const std::string& what)
{
    if (file && *file != "-")
        writes(*file, what);
}

void OutputFolders::make(const fs::path& folder)
{
    std::error_code error;
    std::vector<fs::path> missing;
    for (fs::path at = folder; !at.empty() && !fs::exists(at, error); at = at.parent_path()) {
        if (at.has_filename())
            missing.push_back(at);
    }
    for (auto at = missing.rbegin(); at != missing.rend(); ++at) {
        if (!fs::create_directory(*at, error))
            throw InputError(at->string() + ": the folder cannot be made");
        made_.push_back(*at);
    }
}

void OutputFolders::make_for(const fs::path& file)
{
    make(file.parent_path());
}

void OutputFolders::make_for_report(const std::optional<std::string>& file)
{
    if (!file || file == "-")
        return;
    make_for(*file);
    check_writable(*file);
}

OutputFolders::~OutputFolders()
{
    std::error_code error;
    for (auto at = made_.rbegin(); at != made_.rend(); ++at)
        fs::remove(*at, error);  // leaves alone what is not empty
}

void add_overwrite_option(CLI::App& command, bool& overwrite)
{
    command.add_flag("--overwrite", overwrite,
                     "In a folder, replace files too that this command did not make");
}

void refuse_foreign(const fs::path& file, std::string_view command)
{
    std::error_code error;
    if (fs::exists(fs::symlink_status(file, error)) &&
        command_of_mark(read_mark(file)) != command) {
        throw InputError(file.string() + ": exists and is no result of surfelao " +
                         std::string(command) + "; --overwrite replaces it");
    }
}

void write_report(const std::string& file, const std::string& text)
{
    if (file == "-")
        std::cout << text;
    else
        write_atomically(file, text);
}

void print_written(std::span<const fs::path> files, bool report_on_stdout)
{
    for (const fs::path& file : files)
        (report_on_stdout ? std::cerr : std::cout) << "wrote " << file.string() << '\n';
}

}  // namespace surfelao

#include "files/foreign_io.h"

#include "files/file_contents.h"
#include "files/gltf_io.h"
#include "files/text_cursor.h"
#include "surfels/errors.h"

#include <dlfcn.h>
#include <link.h>
#include <signal.h>
#include <string.h>
#include <unistd.h>

#include <algorithm>
#include <string_view>

namespace surfelao {
namespace {

namespace fs = std::filesystem;

constexpr const char* kProgram = "surfelao-import";

/// Python's modules lie so deep below their PREFIX.
constexpr int kMostFoldersAbove = 6;

/// The program or module that this code is in.
fs::path own_file()
{
    Dl_info info;
    link_map* module = nullptr;
    if (dladdr1(reinterpret_cast<const void*>(&own_file), &info, reinterpret_cast<void**>(&module),
                RTLD_DL_LINKMAP) != 0 &&
        module->l_name[0] != '\0')
        return module->l_name;
    std::error_code error;
    return fs::read_symlink("/proc/self/exe", error);
}

constexpr std::string_view kNote = "note: ";

/// The lines of what it said, without control characters and with marks for what is no ASCII: it
/// may be bytes of the file.
std::vector<std::string> lines_of(std::string_view text)
{
    std::vector<std::string> lines;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        std::string line(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
        std::erase_if(line, [](unsigned char c) { return c < ' ' || c == 127; });
        std::ranges::replace_if(
            line, [](unsigned char c) { return c > 127; }, '?');
        constexpr std::size_t kLongest = 200;
        if (line.size() > kLongest)
            line = line.substr(0, kLongest) + "...";
        if (!line.empty())
            lines.push_back(std::move(line));
    }
    return lines;
}

std::string fault_of(const ChildResult& result, const ChildLimits& limits)
{
    const std::string mebibytes = " MiB that it may take for this file";
    const auto in_mebibytes = [](std::uint64_t bytes) { return std::to_string(bytes >> 20); };
    if (result.end == ChildResult::End::out_of_time)
        return "assimp took longer than the " + std::to_string(limits.seconds) +
               " s that it may take for this file";
    if (result.end == ChildResult::End::killed) {
        if (result.code == SIGXCPU)
            return "assimp took more than the " + std::to_string(limits.cpu_seconds) +
                   " s of processor time that it may take for this file";
        if (result.code == SIGXFSZ)
            return "assimp makes more of it than the " + in_mebibytes(limits.output) + mebibytes;
        const char* const name = sigdescr_np(result.code);
        return "assimp crashed on it (" +
               (name ? std::string(name) : "signal " + std::to_string(result.code)) + ")";
    }
    const std::vector<std::string> lines = lines_of(result.errors);
    if (lines.empty())
        return std::string(kProgram) + " failed with exit code " + std::to_string(result.code);
    if (lines.back() == "not enough memory")
        return "assimp needs more memory than the " + in_mebibytes(limits.memory) + mebibytes;
    return lines.back();
}

}  // namespace

ChildLimits import_limits(std::uint64_t file_size)
{
    constexpr std::uint64_t kMebibyte = 1u << 20, kPerByte = 200;
    const auto machine = static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)) *
                         static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
    const std::uint64_t mebibytes = file_size / kMebibyte;
    ChildLimits limits;
    limits.memory = std::min(machine, 512 * kMebibyte + kPerByte * file_size);
    limits.output = std::min<std::uint64_t>(limits.memory / 2, 0xffffffff);  // a GLB has no more
    limits.cpu_seconds =
        static_cast<std::uint32_t>(std::min<std::uint64_t>(20 + 5 * mebibytes, 600));
    limits.seconds = 4 * limits.cpu_seconds;
    return limits;
}

std::optional<fs::path> import_program()
{
    fs::path folder = own_file().parent_path();
    for (int i = 0; i < kMostFoldersAbove; ++i) {
        const fs::path program = folder / "libexec" / kProgram;
        if (access(program.c_str(), X_OK) == 0)
            return program;
        folder = folder.parent_path();
    }
    return std::nullopt;
}

ImportedFile import_file(const fs::path& path, const fs::path& program, const ChildLimits& limits,
                         const Progress& progress)
{
    const std::string arguments[] = {fs::absolute(path).string()};
    ChildResult result = run_child(program, arguments, limits, progress);
    if (result.end != ChildResult::End::exited || result.code != 0)
        throw InputError(path.string() + ": " + fault_of(result, limits));
    ImportedFile file{std::move(result.output), {}};
    for (const std::string& line : lines_of(result.errors)) {
        if (line.starts_with(kNote))
            file.notes.push_back(line.substr(kNote.size()));
    }
    return file;
}

ImportedFile import_file(const fs::path& path, const Progress& progress)
{
    const std::uint64_t size = contents_size(path, path.string());
    const std::optional<fs::path> program = import_program();
    if (!program)
        throw InputError(path.string() + ": is read through assimp by " + kProgram +
                         ", which is not installed; export it as .glb");
    return import_file(path, *program, import_limits(size), progress);
}

Scene read_foreign(const fs::path& path, const Progress& progress)
{
    ImportedFile file = import_file(path, progress);
    Scene scene = read_gltf(path, std::move(file.glb));
    scene.notes.insert(scene.notes.begin(), file.notes.begin(), file.notes.end());
    return scene;
}

}  // namespace surfelao

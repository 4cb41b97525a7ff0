#include "surfels/atomic_file.h"

#include "surfels/errors.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstring>
#include <mutex>
#include <string>
#include <system_error>

namespace surfelao {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, const char* what, int error)
{
    throw std::runtime_error(path.string() + ": " + what + ": " +
                             std::generic_category().message(error));
}

// ---- names of temporary files, where a signal handler finds them
// ---------------------------------

/// A fixed place, so that the handler needs no lock: `used` is set after the name is complete and
/// cleared before it changes.
struct Slot {
    std::atomic<bool> used{false};
    std::array<char, PATH_MAX> name{};
};
std::array<Slot, 64> slots;
static_assert(std::atomic<bool>::is_always_lock_free);
std::mutex slots_mutex;

/// The name of a new empty file beside `target`, removed on destruction unless it was renamed.
class Temporary {
public:
    explicit Temporary(const fs::path& target)
    {
        static std::atomic<unsigned> counter{0};
        const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
        while (true) {
            path_ = folder / (".surfelao-" + std::to_string(getpid()) + "-" +
                              std::to_string(counter++) + target.extension().string());
            enter_slot();
            const int file = open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
            if (file >= 0) {
                close(file);
                return;
            }
            const int error = errno;
            leave_slot();
            if (error != EEXIST)
                fail(target, "cannot create a file in its folder", error);
        }
    }
    Temporary(const Temporary&) = delete;
    Temporary& operator=(const Temporary&) = delete;
    ~Temporary()
    {
        if (!renamed_)
            unlink(path_.c_str());
        leave_slot();
    }

    [[nodiscard]] const fs::path& path() const { return path_; }

    void rename_to(const fs::path& target)
    {
        if (rename(path_.c_str(), target.c_str()) != 0)
            fail(target, "cannot be replaced", errno);
        renamed_ = true;
    }

private:
    /// More than 64 files at once, or a name too long for a slot: the file is not seen by
    /// remove_temporary_files().
    void enter_slot()
    {
        const std::lock_guard lock(slots_mutex);
        for (Slot& slot : slots) {
            if (slot.used || path_.native().size() >= slot.name.size())
                continue;
            std::memcpy(slot.name.data(), path_.c_str(), path_.native().size() + 1);
            slot.used = true;
            slot_ = &slot;
            return;
        }
    }
    void leave_slot()
    {
        if (slot_)
            slot_->used = false;
        slot_ = nullptr;
    }

    fs::path path_;
    Slot* slot_ = nullptr;
    bool renamed_ = false;
};

/// Closes on destruction.
struct File {
    int descriptor;
    ~File()
    {
        if (descriptor >= 0)
            close(descriptor);
    }
};

/// The file that a symbolic link leads to, which need not exist; other paths as they are.
fs::path followed(const fs::path& path)
{
    std::error_code error;
    if (!fs::is_symlink(path, error))
        return path;
    const fs::path target =
        fs::weakly_canonical(path.parent_path() / fs::read_symlink(path), error);
    return error ? path : target;
}

}  // namespace

void check_writable(const fs::path& given)
{
    const fs::path path = followed(given);
    const auto refuse = [&](const std::string& fault) {
        throw InputError(given.string() + ": cannot be written, " + fault);
    };
    std::error_code error;
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    const fs::file_status folder_status = fs::status(folder, error);
    if (!fs::exists(folder_status))
        refuse("the folder " + folder.string() + " does not exist");
    if (!fs::is_directory(folder_status))
        refuse(folder.string() + " is no folder");
    if (access(folder.c_str(), W_OK | X_OK) != 0)
        refuse("no permission to write in the folder " + folder.string());

    const fs::file_status status = fs::status(path, error);
    if (!fs::exists(status))
        return;
    if (fs::is_directory(status))
        refuse("it is a folder");
    if (!fs::is_regular_file(status))
        refuse("it is no regular file");
    // root may write everything, but a file that nobody may write was protected on purpose
    constexpr fs::perms kAnyWrite =
        fs::perms::owner_write | fs::perms::group_write | fs::perms::others_write;
    if ((status.permissions() & kAnyWrite) == fs::perms::none || access(path.c_str(), W_OK) != 0)
        refuse("the existing file is write-protected");
}

void write_atomically(const fs::path& given, const std::function<void(const fs::path&)>& produce)
{
    check_writable(given);
    const fs::path path = followed(given);
    Temporary temporary(path);
    produce(temporary.path());

    const File file{open(temporary.path().c_str(), O_RDONLY | O_CLOEXEC)};
    if (file.descriptor < 0)
        fail(path, "cannot be written", errno);
    struct stat old = {};
    if (stat(path.c_str(), &old) == 0)
        fchmod(file.descriptor, old.st_mode & 07777);
    if (fsync(file.descriptor) != 0)
        fail(path, "cannot be written", errno);
    temporary.rename_to(path);
}

void write_atomically(const fs::path& path, std::string_view contents)
{
    write_atomically(path, [&](const fs::path& temporary) {
        File file{open(temporary.c_str(), O_WRONLY | O_TRUNC | O_CLOEXEC)};
        if (file.descriptor < 0)
            fail(path, "cannot be written", errno);
        while (!contents.empty()) {
            const ssize_t written = write(file.descriptor, contents.data(), contents.size());
            if (written < 0 && errno == EINTR)
                continue;
            if (written < 0)
                fail(path, "cannot be written", errno);
            contents.remove_prefix(static_cast<std::size_t>(written));
        }
        const int result = close(file.descriptor);
        file.descriptor = -1;
        if (result != 0)
            fail(path, "cannot be written", errno);
    });
}

void remove_temporary_files() noexcept
{
    const int saved = errno;
    for (const Slot& slot : slots) {
        if (slot.used)
            unlink(slot.name.data());
    }
    errno = saved;
}

}  // namespace surfelao

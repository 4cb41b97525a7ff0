#include "files/file_contents.h"

#include "surfels/errors.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace surfelao {

namespace {

[[noreturn]] void refuse(const std::string& subject, const std::string& fault)
{
    throw InputError(subject + ": " + fault);
}

std::string reason()
{
    return std::generic_category().message(errno);
}

/// A regular file, open for reading.
class RegularFile {
public:
    RegularFile(const std::filesystem::path& path, const std::string& subject)
        // non-blocking: opening a pipe that nobody writes to must not wait
        : descriptor(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK))
    {
        struct stat status = {};
        if (descriptor < 0 || fstat(descriptor, &status) != 0)
            fail(subject, "cannot be opened: " + reason());
        if (S_ISDIR(status.st_mode))
            fail(subject, "is a folder, not a file");
        if (!S_ISREG(status.st_mode))
            fail(subject, "is no regular file");
        size = static_cast<std::size_t>(status.st_size);
    }
    RegularFile(const RegularFile&) = delete;
    RegularFile& operator=(const RegularFile&) = delete;
    ~RegularFile() { close(descriptor); }

    int descriptor;
    std::size_t size = 0;

private:
    [[noreturn]] void fail(const std::string& subject, const std::string& fault)
    {
        if (descriptor >= 0)
            close(descriptor);
        refuse(subject, fault);
    }
};

}  // namespace

std::string read_contents(const std::filesystem::path& path, const std::string& subject)
{
    const RegularFile file(path, subject);
    std::string contents(file.size, '\0');
    std::size_t filled = 0;
    while (filled < contents.size()) {
        const ssize_t count =
            read(file.descriptor, contents.data() + filled, contents.size() - filled);
        if (count < 0 && errno == EINTR)
            continue;
        if (count < 0)
            refuse(subject, "cannot be read: " + reason());
        if (count == 0)
            break;
        filled += static_cast<std::size_t>(count);
    }
    contents.resize(filled);
    if (contents.empty())
        refuse(subject, "is empty");
    return contents;
}

std::uint64_t contents_size(const std::filesystem::path& path, const std::string& subject)
{
    const RegularFile file(path, subject);
    if (file.size == 0)
        refuse(subject, "is empty");
    return file.size;
}

}  // namespace surfelao

#include "files/file_contents.h"

#include "surfels/errors.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace surfelao {

std::string read_contents(const std::filesystem::path& path, const std::string& subject)
{
    const auto refuse = [&](const std::string& fault) { throw InputError(subject + ": " + fault); };
    const auto reason = [] { return std::generic_category().message(errno); };
    struct File {
        int descriptor;
        ~File()
        {
            if (descriptor >= 0)
                close(descriptor);
        }
        // non-blocking: opening a pipe that nobody writes to must not wait
    } const file{open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)};
    struct stat status = {};
    if (file.descriptor < 0 || fstat(file.descriptor, &status) != 0)
        refuse("cannot be opened: " + reason());
    if (S_ISDIR(status.st_mode))
        refuse("is a folder, not a file");
    if (!S_ISREG(status.st_mode))
        refuse("is no regular file");
    std::string contents(static_cast<std::size_t>(status.st_size), '\0');
    std::size_t filled = 0;
    while (filled < contents.size()) {
        const ssize_t count =
            read(file.descriptor, contents.data() + filled, contents.size() - filled);
        if (count < 0 && errno == EINTR)
            continue;
        if (count < 0)
            refuse("cannot be read: " + reason());
        if (count == 0)
            break;
        filled += static_cast<std::size_t>(count);
    }
    contents.resize(filled);
    if (contents.empty())
        refuse("is empty");
    return contents;
}

}  // namespace surfelao

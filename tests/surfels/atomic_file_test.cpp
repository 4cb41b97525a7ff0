#include "surfels/atomic_file.h"

#include "surfels/errors.h"
#include "surfels/progress.h"

#include "temporary_folder.h"

#include <gtest/gtest.h>

#include <sys/resource.h>
#include <sys/wait.h>

#include <csignal>
#include <cstdlib>
#include <thread>
#include <vector>

namespace surfelao {
namespace {

namespace fs = std::filesystem;

/// what() of what write_atomically throws for these contents; empty when it throws nothing.
std::string failure(const fs::path& path, const std::string& contents = "new")
{
    try {
        write_atomically(path, contents);
    } catch (const std::runtime_error& error) {
        return error.what();
    }
    return "";
}

TEST(AtomicFile, AppearsWithItsContentsAndNothingBesideIt)
{
    const TemporaryFolder folder;
    write_atomically(folder / "new.ply", "first");
    EXPECT_EQ(contents_of(folder / "new.ply"), "first");
    write_atomically(folder / "new.ply", "second");
    EXPECT_EQ(contents_of(folder / "new.ply"), "second");
    EXPECT_EQ(folder.file_count(), 1);
}

TEST(AtomicFile, TheTemporaryFileIsANeighbourWithTheSameExtension)
{
    const TemporaryFolder folder;
    write_atomically(folder / "picture.png", [&](const fs::path& temporary) {
        EXPECT_EQ(temporary.parent_path(), (folder / "picture.png").parent_path());
        EXPECT_EQ(temporary.extension(), ".png");
        EXPECT_NE(temporary.filename(), "picture.png");
        EXPECT_FALSE(fs::exists(folder / "picture.png"));
        std::ofstream(temporary) << "pixels";
    });
    EXPECT_EQ(contents_of(folder / "picture.png"), "pixels");
}

TEST(AtomicFile, AnyExceptionLeavesTheOldFileAlone)
{
    const TemporaryFolder folder;
    const fs::path path = folder.file("old.ply", "old");
    EXPECT_THROW(write_atomically(path,
                                  [](const fs::path& temporary) {
                                      std::ofstream(temporary) << "half";
                                      throw Cancelled();
                                  }),
                 Cancelled);
    EXPECT_EQ(contents_of(path), "old");
    EXPECT_EQ(folder.file_count(), 1);
}

// A limit on the size of files stands for the full disk: write() fails in the same way, half-way.
TEST(AtomicFile, AWriteThatFailsHalfWayIsReportedAndLeavesTheOldFileAlone)
{
    const TemporaryFolder folder;
    const fs::path path = folder.file("old.ply", "old");
    rlimit limit = {};
    ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &limit), 0);
    const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit low{10'000, limit.rlim_max};
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &low), 0);
    const std::string sentence = failure(path, std::string(100'000, 'x'));
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &limit), 0);
    std::signal(SIGXFSZ, old_handler);
    EXPECT_EQ(sentence, path.string() + ": cannot be written: File too large");
    EXPECT_EQ(contents_of(path), "old");
    EXPECT_EQ(folder.file_count(), 1);
}

TEST(AtomicFile, SaysWhyAPlaceCannotBeWritten)
{
    const TemporaryFolder folder;
    fs::create_directory(folder / "folder.ply");
    folder.file("file", "");
    EXPECT_NE(failure(folder / "folder.ply").find("is a folder"), std::string::npos);
    EXPECT_NE(failure(folder / "missing/a.ply").find("does not exist"), std::string::npos);
    EXPECT_NE(failure(folder / "file/a.ply").find("is no folder"), std::string::npos);
    EXPECT_NE(failure("/dev/null").find("no regular file"), std::string::npos);
    EXPECT_THROW(check_writable(folder / "missing/a.ply"), InputError);
    EXPECT_NO_THROW(check_writable(folder / "new.ply"));
    EXPECT_EQ(folder.file_count(), 2);
}

TEST(AtomicFile, AWriteProtectedFileStays)
{
    const TemporaryFolder folder;
    const fs::path path = folder.file("old.ply", "old");
    fs::permissions(path, fs::perms::owner_read);
    EXPECT_NE(failure(path).find("write-protected"), std::string::npos);
    EXPECT_EQ(contents_of(path), "old");
}

TEST(AtomicFile, KeepsPermissionsAndFollowsLinks)
{
    const TemporaryFolder folder;
    const fs::path path = folder.file("real.ply", "old");
    fs::permissions(path, fs::perms::owner_read | fs::perms::owner_write);
    fs::create_symlink("real.ply", folder / "link.ply");
    write_atomically(folder / "link.ply", "new");
    EXPECT_TRUE(fs::is_symlink(folder / "link.ply"));
    EXPECT_EQ(contents_of(path), "new");
    EXPECT_EQ(fs::status(path).permissions(), fs::perms::owner_read | fs::perms::owner_write);

    fs::create_symlink("later.ply", folder / "dangling.ply");
    write_atomically(folder / "dangling.ply", "new");
    EXPECT_EQ(contents_of(folder / "later.ply"), "new");
}

TEST(AtomicFile, ManyThreadsLeaveOneCompleteFile)
{
    const TemporaryFolder folder;
    const fs::path path = folder / "shared.ply";
    std::vector<std::thread> threads;
    for (int t = 0; t < 8; ++t) {
        threads.emplace_back([&path, t] {
            for (int i = 0; i < 10; ++i)
                write_atomically(path, std::string(50'000, static_cast<char>('a' + t)));
        });
    }
    for (std::thread& thread : threads)
        thread.join();
    const std::string contents = contents_of(path);
    EXPECT_EQ(contents, std::string(50'000, contents.at(0)));
    EXPECT_EQ(folder.file_count(), 1);
}

// A process that is told to end at once, in the middle of writing, cleans up in its signal handler.
TEST(AtomicFile, ASignalHandlerCanRemoveWhatIsUnderWay)
{
    const TemporaryFolder folder;
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
        std::signal(SIGTERM, [](int) {
            remove_temporary_files();
            _exit(3);
        });
        write_atomically(folder / "never.ply", [](const fs::path& temporary) {
            std::ofstream(temporary) << "half";
            raise(SIGTERM);
        });
        _exit(0);
    }
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 3);
    EXPECT_EQ(folder.file_count(), 0);
}

}  // namespace
}  // namespace surfelao

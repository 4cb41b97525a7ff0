#include "program.h"
#include "scenes.h"
#include "temporary_folder.h"

#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <thread>

namespace surfelao {
namespace {

namespace fs = std::filesystem;

/// A result of an earlier bake, which may be replaced.
constexpr const char* kOld = "# surfelao 0.0.0 bake: of old\n";

/// A bake that takes minutes: 2^16 rays at ten thousand vertices.
class Interrupt : public testing::Test {
protected:
    void SetUp() override
    {
        write_obj(folder_ / "in.obj", scenes::bumpy_sphere(48));
        write_obj(folder_ / "quick.obj", scenes::box({0, 0, 0}, {1, 1, 1}, 1));
        fs::create_directory(folder_ / "out");
        std::ofstream(folder_ / "out/in.obj") << kOld;
    }
    std::vector<std::string> long_bake() const
    {
        return {"bake",
                folder_ / "quick.obj",
                folder_ / "in.obj",
                "-o",
                folder_ / "out",
                "--engine",
                "rays",
                "--rays",
                "65536"};
    }
    std::size_t outputs() const
    {
        return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_ / "out"), {}));
    }
    /// Until the first file of the batch is there and the second one is being worked on.
    void wait_for_first_output() const
    {
        for (int i = 0; i < 6000 && !fs::exists(folder_ / "out/quick.obj"); ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    TemporaryFolder folder_;
};

TEST_F(Interrupt, SignalsEndTheBatchWithTheirCodeAndLeaveFinishedAndOldFiles)
{
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        fs::remove(folder_ / "out/quick.obj");
        Program program(folder_.path(), long_bake());
        wait_for_first_output();
        program.send(signal);
        const Outcome outcome = program.wait();
        EXPECT_EQ(outcome.code, 128 + signal);
        EXPECT_NE(outcome.err.find("interrupted"), std::string::npos) << outcome.err;
        EXPECT_EQ(contents_of(folder_ / "out/in.obj"), kOld);
        EXPECT_EQ(outputs(), 2u) << "no temporary file";
    }
}

TEST_F(Interrupt, ASecondSignalEndsAtOnce)
{
    Program program(folder_.path(), long_bake());
    wait_for_first_output();
    program.send(SIGINT);
    program.send(SIGINT);
    EXPECT_EQ(program.wait().code, 128 + SIGINT);
    EXPECT_EQ(outputs(), 2u);
}

TEST_F(Interrupt, KilledHalfWayTheBatchGoesOnWithResume)
{
    fs::remove(folder_ / "out/in.obj");
    {
        Program program(folder_.path(), long_bake());
        wait_for_first_output();
        program.send(SIGKILL);
        EXPECT_EQ(program.wait().code, 128 + SIGKILL);
    }
    const std::string first = contents_of(folder_ / "out/quick.obj");
    EXPECT_FALSE(fs::exists(folder_ / "out/in.obj"));
    // the same settings would take minutes for the second file: a copy of the first takes its place
    fs::copy_file(folder_ / "quick.obj", folder_ / "in.obj", fs::copy_options::overwrite_existing);
    std::vector<std::string> again = long_bake();
    again.push_back("--resume");
    const Outcome outcome = run(folder_.path(), again);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("skipped"), std::string::npos);
    EXPECT_EQ(contents_of(folder_ / "out/quick.obj"), first);
    EXPECT_TRUE(fs::exists(folder_ / "out/in.obj"));
}

}  // namespace
}  // namespace surfelao

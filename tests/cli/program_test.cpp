#include "program.h"
#include "scenes.h"
#include "temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace surfelao {
namespace {

class ProgramTest : public testing::Test {
protected:
    void SetUp() override { write_obj(in(), scenes::bumpy_sphere(4)); }
    std::string in() const { return folder_ / "in.obj"; }
    std::string out() const { return folder_ / "out.ply"; }
    Outcome run(const std::vector<std::string>& arguments) const
    {
        return surfelao::run(folder_.path(), arguments);
    }
    std::size_t file_count() const
    {
        return static_cast<std::size_t>(
            std::distance(std::filesystem::directory_iterator(folder_.path()), {}));
    }
    TemporaryFolder folder_;
};

TEST_F(ProgramTest, HelpAndVersionAreResultsAndExitZero)
{
    const Outcome version = run({"--version"});
    EXPECT_EQ(version.code, 0);
    EXPECT_EQ(version.out.rfind("surfelao 0.1.0", 0), 0u) << version.out;
    for (const char* word : {"\nbuild ", "\ninstructions ", "; here ", "\nOpenGL ", "Embree 3"})
        EXPECT_NE(version.out.find(word), std::string::npos) << word << version.out;
    const Outcome help = run({"--help"});
    EXPECT_EQ(help.code, 0);
    for (const char* word : {"bake", "compare", "info", "Exit code"})
        EXPECT_NE(help.out.find(word), std::string::npos) << word;
    const Outcome bake = run({"bake", "--help"});
    EXPECT_EQ(bake.code, 0);
    for (const char* word :
         {"--engine", "--quality", "--rays", "--passes", "--strength", "--max-distance",
          "--falloff", "--kernel", "--colors", "--encoding", "--threads", "--json", "--resume",
          "--output", "--columns", "--normals", "--crease", "--values", "--offset"})
        EXPECT_NE(bake.out.find(word), std::string::npos) << word;
    const Outcome compare = run({"compare", "--help"});
    EXPECT_EQ(compare.code, 0);
    for (const char* word : {"--frontier", "--engines", "--qualities", "--sample", "--rounds",
                             "--reference-rays", "--json", "--csv", "--avx2", "--no-cache"})
        EXPECT_NE(compare.out.find(word), std::string::npos) << word;
    EXPECT_EQ(run({"info", "--help"}).code, 0);
}

TEST_F(ProgramTest, WrongUsageIsRefusedBeforeAnyWorkWithExitTwo)
{
    const std::vector<std::vector<std::string>> tables = {
        {},
        {"nonsense"},
        {"bake"},
        {"bake", in()},
        {"bake", in(), "-o", out(), "--nonsense"},
        {"bake", in(), "-o", out(), "--engine", "magic"},
        {"bake", in(), "-o", out(), "--engine", "rays", "--rays", "0"},
        {"bake", in(), "-o", out(), "--engine", "rays", "--rays", "many"},
        {"bake", in(), "-o", out(), "--engine", "rays", "--rays", "99999999"},
        {"bake", in(), "-o", out(), "--engine", "rays", "--quality", "good"},
        {"bake", in(), "-o", out(), "--engine", "rays", "--device", "gpu"},
        {"bake", in(), "-o", out(), "--device", "gpu", "--kernel", "bunnell"},
        {"bake", in(), "-o", out(), "--engine", "disks", "--rays", "16"},
        {"bake", in(), "-o", out(), "--rays", "16"},
        {"bake", in(), "-o", out(), "--passes", "2"},
        {"bake", in(), "-o", out(), "--engine", "disks", "--passes", "0"},
        {"bake", in(), "-o", out(), "--engine", "disks", "--strength", "-1"},
        {"bake", in(), "-o", out(), "--engine", "disks", "--strength", "nan"},
        {"bake", in(), "-o", out(), "--engine", "disks", "--quality", "3"},
        {"bake", in(), "-o", out(), "--quality", "4.5"},
        {"bake", in(), "-o", out(), "--quality", "superb"},
        {"bake", in(), "-o", out(), "--kernel", "bunnell"},
        {"bake", in(), "-o", out(), "--falloff", "smooth"},
        {"bake", in(), "-o", out(), "--max-distance", "0"},
        {"bake", in(), "-o", out(), "--max-distance", "-1"},
        {"bake", in(), "-o", out(), "--max-distance", "inf"},
        {"bake", in(), "-o", out(), "--max-distance", "5%%"},
        {"bake", in(), "-o", out(), "--max-distance", "%"},
        {"bake", in(), "-o", out(), "--max-distance", "1e999"},
        {"bake", in(), "-o", out(), "--normals", "rough"},
        {"bake", in(), "-o", out(), "--crease", "181"},
        {"info", in(), "--columns", "x y"},
        {"bake", in(), "-o", out(), "--columns", "x y z z"},
        {"bake", in(), "-o", out(), "--crease", "nan"},
        {"bake", in(), "-o", out(), "--values", "mean"},
        {"bake", in(), "-o", out(), "--offset", "0"},
        {"bake", in(), "-o", out(), "--offset", "-1%"},
        {"bake", in(), "-o", out(), "--colors"},
        {"bake", in(), "-o", out(), "--colors", "red"},
        {"bake", in(), "-o", out(), "--encoding", "gamma"},
        {"bake", in(), "-o", out(), "--threads", "0"},
        {"bake", in(), "-o", in()},
        {"bake", in(), in(), "-o", folder_.path()},
        {"compare", in(), in(), "-o", folder_.path()},
        {"compare", in(), "--frontier", "--qualities", "good"},
        {"compare", in(), "--frontier", "--rounds", "2"},
        {"compare", in(), "--reference-rays", "65"},
        {"compare", in(), "--sample", "0"},
        {"compare", in(), "--engines", "rays"},
        {"compare", in(), "--devices", "tpu"},
        {"compare", in(), "--json", "-", "--csv", "-"},
        {"info"},
        {"info", in(), in()},
    };
    for (const std::vector<std::string>& arguments : tables) {
        const Outcome outcome = run(arguments);
        std::string line;
        for (const std::string& argument : arguments)
            line += argument + ' ';
        EXPECT_EQ(outcome.code, 2) << line << outcome.err;
        EXPECT_EQ(outcome.out, "") << line;
        EXPECT_NE(outcome.err, "") << line;
        EXPECT_EQ(file_count(), 1u) << line;
    }
}

TEST_F(ProgramTest, FailuresAreOneSentenceAndExitOneAndLeaveTheOldFile)
{
    std::ofstream(out()) << "old";
    std::ofstream(folder_ / "cut.ply") << "ply\nformat ascii 1.0\nelement vertex 3\n";
    std::ofstream(folder_ / "nan.obj") << "v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    const std::size_t files = file_count();
    const std::vector<std::vector<std::string>> tables = {
        {"bake", folder_ / "none.obj", "-o", out()},
        {"bake", folder_ / "cut.ply", "-o", out()},
        {"bake", folder_ / "nan.obj", "-o", out()},
        {"bake", folder_.path(), "-o", out()},
        {"bake", in(), "-o", in() + "/out.ply"},
        {"bake", in(), "-o", folder_ / "out.xyz"},
        {"bake", in(), "-o", folder_ / "out.stl"},
        {"bake", in(), "-o", out(), "--json", in() + "/report.json"},
        {"bake", in(), "-o", out(), "--max-distance", "1e-60"},
        {"bake", in(), "-o", out(), "--offset", "100%"},
        {"bake", in(), "-o", out(), "--offset", "1e-60"},
        {"compare", folder_ / "none.obj", "-o", folder_.path()},
        {"compare", in(), "-o", folder_ / "nan.obj/folder"},
        {"info", folder_ / "none.obj"},
    };
    for (const std::vector<std::string>& arguments : tables) {
        const Outcome outcome = run(arguments);
        std::string line;
        for (const std::string& argument : arguments)
            line += argument + ' ';
        EXPECT_EQ(outcome.code, 1) << line;
        EXPECT_EQ(outcome.out, "") << line;
        EXPECT_EQ(outcome.err.rfind("surfelao: ", 0), 0u) << line << outcome.err;
        EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
        EXPECT_EQ(contents_of(out()), "old") << line;
        EXPECT_EQ(file_count(), files) << line;
    }
}

TEST_F(ProgramTest, ResultsThatCannotBePrintedAreAFailure)
{
    const Outcome outcome = run({"info", in(), "--json", "/dev/full"});
    EXPECT_EQ(outcome.code, 1);
    EXPECT_NE(outcome.err, "");
}

TEST_F(ProgramTest, TheProgressBarIsForTerminalsOnly)
{
    const std::vector<std::string> arguments = {"bake",     in(),   "-o",     out(),
                                                "--engine", "rays", "--rays", "16384"};
    EXPECT_EQ(run(arguments).err, "");
    Program on_terminal(folder_.path(), arguments, true);
    const Outcome outcome = on_terminal.wait();
    EXPECT_EQ(outcome.code, 0);
    EXPECT_NE(outcome.err.find("% solve"), std::string::npos);
    EXPECT_EQ(outcome.err.substr(outcome.err.size() - 4), "\r\033[K");  // and it cleans up
    EXPECT_EQ(outcome.out.find('\r'), std::string::npos);
}

}  // namespace
}  // namespace surfelao

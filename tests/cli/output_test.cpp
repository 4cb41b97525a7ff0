#include "program.h"
#include "scenes.h"
#include "temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace surfelao {
namespace {

namespace fs = std::filesystem;

/// Nothing that a user owns is lost: cli/output.h.
class Output : public testing::Test {
protected:
    void SetUp() override
    {
        write_obj(folder_ / "a.obj", scenes::box({0, 0, 0}, {1, 1, 1}, 1));
        write_obj(folder_ / "b.obj", scenes::box({0, 0, 0}, {1, 2, 1}, 1));
        fs::create_directory(folder_ / "out");
    }
    Outcome run(const std::vector<std::string>& arguments) const
    {
        return surfelao::run(folder_.path(), arguments);
    }
    /// The quickest comparison.
    Outcome compare(std::vector<std::string> more) const
    {
        std::vector<std::string> arguments = {"compare", "--reference-rays", "64",   "--engines",
                                              "masks",   "--rounds",         "1",    "--sample",
                                              "8",       "--qualities",      "draft"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run(arguments);
    }
    void expect_untouched(const std::string& name, const std::string& contents,
                          const Outcome& outcome, int code) const
    {
        EXPECT_EQ(outcome.code, code) << name << ": " << outcome.err;
        EXPECT_EQ(contents_of(folder_ / name), contents) << name;
        EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    }
    TemporaryFolder folder_;
};

TEST_F(Output, AnInputIsNeverATargetWhateverItsName)
{
    const std::string a = contents_of(folder_ / "a.obj");
    fs::create_symlink(folder_ / "a.obj", folder_ / "soft.obj");
    fs::create_hard_link(folder_ / "a.obj", folder_ / "hard.obj");
    for (const char* name : {"a.obj", "out/../a.obj", "./a.obj", "soft.obj", "hard.obj"}) {
        const std::string target = folder_ / name;
        expect_untouched("a.obj", a, run({"bake", folder_ / "a.obj", "-o", target}), 2);
        expect_untouched("a.obj", a, run({"info", folder_ / "a.obj", "--json", target}), 2);
        expect_untouched("a.obj", a, compare({folder_ / "a.obj", "--json", target}), 2);
        expect_untouched("a.obj", a, compare({folder_ / "a.obj", "--csv", target}), 2);
    }
    expect_untouched("a.obj", a, run({"bake", folder_ / "soft.obj", "-o", folder_ / "a.obj"}), 2);
    // another job's input
    fs::copy_file(folder_ / "a.obj", folder_ / "out/b.obj");
    expect_untouched("out/b.obj", a,
                     run({"bake", folder_ / "out/b.obj", folder_ / "b.obj", "-o", folder_ / "out"}),
                     2);
}

TEST_F(Output, WhatAnInputRefersToIsNoTarget)
{
    folder_.file("a.mtl", "material");
    std::ofstream(folder_ / "a.obj", std::ios::app) << "mtllib a.mtl\n";
    expect_untouched(
        "a.mtl", "material",
        run({"bake", folder_ / "a.obj", "-o", folder_ / "x.ply", "--json", folder_ / "a.mtl"}), 2);
}

TEST_F(Output, TwoResultsUnderOneNameAreRefused)
{
    const std::string x = folder_ / "x.json";
    EXPECT_EQ(compare({folder_ / "a.obj", "--json", x, "--csv", folder_ / "out/../x.json"}).code,
              2);
    EXPECT_EQ(
        run({"bake", folder_ / "a.obj", "-o", folder_ / "x.ply", "--json", folder_ / "x.ply"}).code,
        2);
}

TEST_F(Output, InAFolderBakeReplacesOnlyWhatItMade)
{
    folder_.file("out/a.obj", "mine");
    const std::vector<std::string> bake = {"bake", folder_ / "a.obj", folder_ / "b.obj", "-o",
                                           folder_ / "out"};
    Outcome outcome = run(bake);
    EXPECT_EQ(outcome.code, 1);
    EXPECT_NE(outcome.err.find("out/a.obj: exists and is no result of surfelao bake"),
              std::string::npos)
        << outcome.err;
    EXPECT_EQ(contents_of(folder_ / "out/a.obj"), "mine");
    EXPECT_TRUE(fs::exists(folder_ / "out/b.obj"));
    EXPECT_NE(outcome.out.find("wrote " + (folder_ / "out/b.obj").string() + "\n"),
              std::string::npos)
        << outcome.out;
    EXPECT_EQ(outcome.out.find("wrote " + (folder_ / "out/a.obj").string()), std::string::npos);

    std::vector<std::string> overwrite = bake;
    overwrite.push_back("--overwrite");
    EXPECT_EQ(run(overwrite).code, 0);
    EXPECT_EQ(run(bake).code, 0) << "both are results now";
    // a name is a word enough
    folder_.file("out/a.obj", "mine");
    EXPECT_EQ(run({"bake", folder_ / "a.obj", "-o", folder_ / "out/a.obj"}).code, 0);
}

TEST_F(Output, CompareWritesOnlyWhereItIsTold)
{
    const std::ptrdiff_t files = folder_.file_count();
    EXPECT_EQ(compare({folder_ / "a.obj"}).code, 0);
    EXPECT_EQ(folder_.file_count(), files);
    EXPECT_FALSE(fs::exists("difference.ply"));
    EXPECT_FALSE(fs::exists("report.html"));
}

TEST_F(Output, CompareReplacesOnlyWhatItMadeAndNamesIt)
{
    const std::vector<std::string> into_out = {folder_ / "a.obj", "-o", folder_ / "out"};
    for (const char* name : {"out/difference.ply", "out/report.html"}) {
        folder_.file(name, "mine");
        expect_untouched(name, "mine", compare(into_out), 1);
        fs::remove(folder_ / name);
    }
    for (int time = 0; time < 2; ++time) {
        const Outcome outcome = compare(into_out);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        for (const char* name : {"out/difference.ply", "out/report.html"}) {
            EXPECT_NE(outcome.out.find("wrote " + (folder_ / name).string() + "\n"),
                      std::string::npos)
                << outcome.out;
        }
    }
    const std::string difference = contents_of(folder_ / "out/difference.ply");
    expect_untouched("out/difference.ply", difference,
                     compare({folder_ / "out/difference.ply", "-o", folder_ / "out"}), 2);
}

}  // namespace
}  // namespace surfelao

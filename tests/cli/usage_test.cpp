// What a wrong command line is told: exact sentences.
#include "program.h"
#include "scenes.h"
#include "temporary_folder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace surfelao {
namespace {

namespace fs = std::filesystem;

class Usage : public testing::Test {
protected:
    void SetUp() override { write_obj(in(), scenes::box({0, 0, 0}, {1, 1, 1}, 1)); }
    std::string in() const { return folder_ / "in.obj"; }
    Outcome run(const std::vector<std::string>& arguments) const
    {
        return surfelao::run(folder_.path(), arguments);
    }
    /// A bake with more arguments is refused as wrong usage, with this sentence.
    void expect_refusal(std::vector<std::string> more, const std::string& sentence) const
    {
        more.insert(more.begin(), {"bake", in(), "-o", folder_ / "out.ply"});
        expect_sentence(more, sentence);
    }
    void expect_sentence(const std::vector<std::string>& arguments,
                         const std::string& sentence) const
    {
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.err, "surfelao: " + sentence + '\n');
        EXPECT_EQ(outcome.code, 2) << sentence;
        EXPECT_EQ(outcome.out, "") << sentence;
    }
    TemporaryFolder folder_;
};

TEST_F(Usage, HelpIsTheSameByItsCommandAndByItsOption)
{
    const Outcome all = run({"help"});
    EXPECT_EQ(all.code, 0);
    EXPECT_EQ(all.out, run({"--help"}).out);
    EXPECT_NE(all.out.find("\n  bake "), std::string::npos) << all.out;
    const Outcome bake = run({"help", "bake"});
    EXPECT_EQ(bake.code, 0);
    EXPECT_EQ(bake.out, run({"bake", "--help"}).out);
    EXPECT_NE(bake.out.find("--engine"), std::string::npos);
    EXPECT_EQ(run({"help", "help"}).out, run({"help", "--help"}).out);
    // alone it is wrong usage, and told what there is
    const Outcome alone = run({});
    EXPECT_EQ(alone.code, 2);
    EXPECT_EQ(alone.out, "");
    EXPECT_EQ(alone.err, all.out);
}

TEST_F(Usage, WordsThatAreNotKnownAreNamedWithTheNearestOnes)
{
    expect_sentence({"bkae", in()}, "\"bkae\" is no command: did you mean bake?");
    expect_sentence({"help", "comapre"}, "\"comapre\" is no command: did you mean compare?");
    expect_sentence({"xyz"}, "\"xyz\" is no command; surfelao help lists what there is.");
    expect_sentence({"--quality", "best", "bake", in()},
                    "--quality: options stand behind the command, as in surfelao bake IN -o OUT "
                    "--quality.");
    expect_refusal({"--qualtiy", "best"}, "bake has no option --qualtiy: did you mean --quality?");
    expect_refusal({"--qualtiy=best"}, "bake has no option --qualtiy: did you mean --quality?");
    expect_refusal({"--nonsense"},
                   "bake has no option --nonsense; surfelao help bake lists what there is.");
    expect_refusal({"--engine", "mask"},
                   "--engine: \"mask\" is none of masks, disks, rays: did you mean masks?");
    expect_refusal({"--engine", "MASKS"},
                   "--engine: \"MASKS\" is none of masks, disks, rays: did you mean masks?");
    expect_refusal({"--engine", "magic"}, "--engine: \"magic\" is none of masks, disks, rays.");
    expect_refusal({"--quality", "bset"},
                   "--quality: \"bset\" is not draft, good, best or a number from -1 to 4: did you "
                   "mean best?");
    expect_sentence({"compare", in(), "--engines", "masks,discs"},
                    "--engines: \"discs\" is none of masks, disks, rays, grid, ssao-disc, "
                    "ssao-sphere, vo, hbao, gtao, bitmask: did you mean disks?");
}

TEST_F(Usage, WhatIsMissingOrTooMuchIsNamed)
{
    expect_sentence({"bake"},
                    "bake needs IN and -o OUT|DIR; surfelao help bake lists what there is.");
    expect_sentence({"info", in(), "b.obj"}, "info: \"b.obj\" is one file too many.");
    expect_refusal({"--colors"}, "--colors needs a value: auto|grey|shaded|keep|bent.");
    expect_refusal({"-o", "again.ply"}, "--output is given 2 times: it has one value only.");
    expect_refusal({"--error", "0.1", "--rays", "8"}, "--rays excludes --error.");
    expect_refusal({"--fps", "24"}, "--fps requires --frames.");
    expect_refusal({"--resume=7"}, "--resume takes no value.");
}

TEST_F(Usage, NumbersAreFiniteWholeWhereTheyCountAndInTheirRange)
{
    const auto refused = [&](const std::string& option, const std::string& text,
                             const std::string& wanted) {
        expect_refusal({option, text}, option + ": \"" + text + "\" is not " + wanted + '.');
    };
    for (const char* text : {"-inf", "1e999", "", "1x", "0x1p3", "180.1"})
        refused("--crease", text, "a number from 0 to 180");
    for (const char* text : {"nan", "inf"}) {
        refused("--crease", text, "a number from 0 to 180");
        refused("--time", text, "a number from 0 to 1e+09");
        refused("--fps", text, "a number from 0.001 to 10000");
        refused("--error", text, "a number from 1e-06 to 1");
        refused("--subdivide", text, "a number from 1e-04 to 1");
        refused("--strength", text, "a number from 0 to 10");
        refused("--texels-per-unit", text, "a number above 0");
        refused("--max-distance", text, "a number above 0, with or without %");
        refused("--ground", text, "a number");
        refused("--threads", text, "a whole number from 1 to 1024");
    }
    for (const char* text : {"2.5", "1e2", "-1", "010", "99999999999999999999"})
        refused("--threads", text, "a whole number from 1 to 1024");
}

TEST_F(Usage, ColoursAreForWhatHasThem)
{
    const std::string sentence =
        "--colors and --encoding are for values at vertices and points: neither a map nor a grid "
        "has such colours.";
    const std::string picture = folder_ / "map.png", mesh = folder_ / "map.obj";
    expect_sentence({"bake", in(), "-o", picture, "--colors", "grey"}, sentence);
    expect_sentence({"bake", in(), "-o", mesh, "--at", "texels", "--encoding", "srgb"}, sentence);
    expect_sentence({"bake", in(), "-o", picture, "--at", "grid", "--colors", "auto"}, sentence);
}

// What only the file can tell is wrong usage all the same.
TEST_F(Usage, SettingsThatAreNotForTheFileAreWrongUsage)
{
    const std::string picture = folder_ / "x.png";
    const std::string columns = in() + ": columns are told of .xyz .pts .txt .asc only";
    expect_sentence({"info", in(), "--columns", "x y z"}, columns);
    expect_sentence({"render", in(), "-o", picture, "--columns", "x y z"}, columns);
    expect_sentence({"render", in(), "-o", picture, "--camera", "fov=nan", "--context", "osmesa"},
                    "--camera: \"fov=nan\" was found, a number was wanted");
    expect_sentence({"bake", in(), "-o", folder_ / "g.png", "--at", "grid", "--crease", "30"},
                    "--normals, --crease, --values, --offset, --viewpoint and --occluder-spacing "
                    "are not for --at grid: it asks about the object, not on it.");
    expect_sentence({"compare", in(), "--at", "grid", "--size", "64"},
                    "Of the options of maps only --depth is for --at grid.");
    EXPECT_EQ(run({"compare", in(), "--at", "grid", "--normals", "flat"}).code, 2);
}

TEST_F(Usage, FoldersOfOutputsAreMadeAndTakenBackWhereTheRunFails)
{
    const std::string deep = folder_ / "a/b/out.ply", report = folder_ / "c/report.json";
    const std::vector<std::string> quick = {"--quality", "draft", "--check", "0"};
    const auto with_quick = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.end(), quick.begin(), quick.end());
        return run(arguments);
    };
    EXPECT_EQ(with_quick({"bake", folder_ / "none.obj", "-o", deep}).code, 1);
    EXPECT_EQ(folder_.file_count(), 1);
    EXPECT_EQ(with_quick({"bake", in(), "-o", folder_ / "in.obj/out.ply"}).code, 1);
    EXPECT_EQ(folder_.file_count(), 1);
    EXPECT_EQ(with_quick({"bake", in(), "-o", deep, "--json", report}).code, 0);
    EXPECT_TRUE(fs::exists(deep));
    EXPECT_TRUE(fs::exists(report));
    EXPECT_EQ(with_quick({"bake", in(), "-o", folder_ / "d/"}).code, 0);
    EXPECT_TRUE(fs::exists(folder_ / "d/in.obj"));
}

/// docs/mistakes.md is the table: "    $ surfelao ARGUMENTS", then what standard error says.
TEST_F(Usage, TheCommonMistakesAreAnsweredAsTheirPageSays)
{
    write_obj(folder_ / "bunny.obj", scenes::box({0, 0, 0}, {1, 1, 1}, 1));
    std::ifstream page(SURFELAO_DOCS_FOLDER "/mistakes.md");
    const std::string prompt = "    $ surfelao ";
    int count = 0;
    for (std::string line; std::getline(page, line);) {
        if (!line.starts_with(prompt))
            continue;
        ++count;
        std::vector<std::string> arguments;
        std::istringstream words(line.substr(prompt.size()));
        for (std::string word; words >> word;) {
            const bool is_file = fs::path(word).has_extension();
            arguments.push_back(is_file ? (folder_ / word).string() : word);
        }
        std::string said = run(arguments).err;
        const std::string folder = folder_ / "";
        for (std::size_t at; (at = said.find(folder)) != std::string::npos;)
            said.erase(at, folder.size());
        std::string sentence;
        std::getline(page, sentence);
        EXPECT_EQ("    " + said, sentence + '\n') << line;
    }
    EXPECT_EQ(count, 13);
}

}  // namespace
}  // namespace surfelao

#include "files/scene_io.h"
#include "program.h"
#include "scenes.h"
#include "temporary_folder.h"

#include <gtest/gtest.h>
#include <sys/mount.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include <chrono>

namespace surfelao {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

class BakeCommand : public testing::Test {
protected:
    void SetUp() override
    {
        write_obj(folder_ / "a.obj", scenes::bumpy_sphere(4));
        write_obj(folder_ / "b.obj", scenes::nested_shells(2, 0.2, 4));
        fs::create_directory(folder_ / "out");
    }
    Outcome run(const std::vector<std::string>& arguments) const
    {
        return surfelao::run(folder_.path(), arguments);
    }
    TemporaryFolder folder_;
};

TEST_F(BakeCommand, EveryEngineAndFormatWritesAFileThatReadsBack)
{
    for (const char* engine : {"masks", "disks", "rays"}) {
        for (const char* name : {"x.ply", "x.obj", "x.off"}) {
            const Outcome outcome =
                run({"bake", folder_ / "a.obj", "-o", folder_ / name, "--engine", engine});
            EXPECT_EQ(outcome.code, 0) << outcome.err;
            EXPECT_NE(outcome.out.find("solve"), std::string::npos);
            EXPECT_EQ(read_scene(folder_ / name).positions.size(), 6u * 16 + 2);
        }
    }
}

TEST_F(BakeCommand, SameBytesForAnyNumberOfThreads)
{
    for (const char* engine : {"masks", "disks", "rays"}) {
        std::vector<std::string> bytes;
        for (const char* threads : {"1", "2", "5"}) {
            const Outcome outcome = run({"bake", folder_ / "b.obj", "-o", folder_ / "x.ply",
                                         "--engine", engine, "--threads", threads});
            EXPECT_EQ(outcome.code, 0) << outcome.err;
            bytes.push_back(contents_of(folder_ / "x.ply"));
        }
        EXPECT_EQ(bytes[0], bytes[1]) << engine;
        EXPECT_EQ(bytes[0], bytes[2]) << engine;
    }
}

TEST_F(BakeCommand, OptionsReachTheReport)
{
    const Outcome outcome = run({"bake",
                                 folder_ / "a.obj",
                                 "-o",
                                 folder_ / "x.ply",
                                 "--engine",
                                 "disks",
                                 "--passes",
                                 "3",
                                 "--strength",
                                 "0.5",
                                 "--quality",
                                 "draft",
                                 "--kernel",
                                 "bunnell",
                                 "--max-distance",
                                 "25%",
                                 "--falloff",
                                 "smooth",
                                 "--normals",
                                 "smooth",
                                 "--crease",
                                 "30",
                                 "--values",
                                 "point",
                                 "--offset",
                                 "0.5%",
                                 "--threads",
                                 "1",
                                 "--json",
                                 folder_ / "report.json"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const Json json = Json::parse(contents_of(folder_ / "report.json"));
    const Json& settings = json["settings"];
    EXPECT_EQ(json["engine"], "disks");
    EXPECT_EQ(settings["passes"], 3);
    EXPECT_EQ(settings["strength"], 0.5);
    EXPECT_EQ(settings["quality"], 0.0);
    EXPECT_EQ(settings["kernel"], "bunnell");
    EXPECT_EQ(settings["max_distance"], 0.25);
    EXPECT_EQ(settings["falloff"], "smooth");
    EXPECT_EQ(settings["normals"], "smooth");
    EXPECT_EQ(settings["crease"], 30);
    EXPECT_EQ(settings["values"], "point");
    EXPECT_EQ(settings["offset"], "0.5%");
    EXPECT_EQ(settings["threads"], 1);
    for (const char* key : {"input", "vertices", "triangles", "dropped_triangles", "surfels",
                            "engine", "settings", "seconds", "peak_rss_bytes", "residual"})
        EXPECT_TRUE(json.contains(key)) << key;
}

TEST_F(BakeCommand, AGroundIsToldEverywhereAndRefusedWhereItIsNone)
{
    write_obj(folder_ / "box.obj", scenes::box({0, 0, 0}, {1, 1, 1}, 1));
    std::vector<std::string> arguments = {"bake",     folder_ / "box.obj",
                                          "-o",       folder_ / "x.ply",
                                          "--values", "point",
                                          "--up",     "z",
                                          "--json",   folder_ / "report.json",
                                          "--ground"};
    const Outcome outcome = run(arguments);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NE(outcome.out.find(", over a ground at z = -0.000346407"), outcome.out.npos)
        << outcome.out;
    EXPECT_NE(contents_of(folder_ / "x.ply").find(" ground=z:lowest "), std::string::npos);
    const Json ground = Json::parse(contents_of(folder_ / "report.json"))["settings"]["ground"];
    EXPECT_EQ(ground["up"], (std::vector<double>{0, 0, 1}));
    EXPECT_NEAR(ground["height"].get<double>(), -0.5 / std::sqrt(3.0) - 2e-4, 1e-6);
    // by faces 0, 1/2 and 1: the mean over the corners of a box
    EXPECT_NE(outcome.out.find("mean occlusion 0.5000"), outcome.out.npos) << outcome.out;
    for (const std::vector<std::string>& wrong :
         {std::vector<std::string>{"--ground=high"},
          {"--ground", "nan"},
          {"--ground", "--engine", "disks", "--kernel", "bunnell"},
          {"--up", "w"}}) {
        std::vector<std::string> asked = {"bake", folder_ / "box.obj", "-o", folder_ / "y.ply"};
        asked.insert(asked.end(), wrong.begin(), wrong.end());
        EXPECT_EQ(run(asked).code, 2) << wrong[0];
        EXPECT_FALSE(fs::exists(folder_ / "y.ply"));
    }
}

TEST_F(BakeCommand, EveryResultStatesItsErrorAndTheStatementChangesNoByte)
{
    std::vector<std::string> bytes;
    for (const char* points : {"0", "50", "400"}) {
        const Outcome outcome = run({"bake", folder_ / "a.obj", "-o", folder_ / "x.ply", "--check",
                                     points, "--json", folder_ / "report.json"});
        ASSERT_EQ(outcome.code, 0) << outcome.err;
        bytes.push_back(contents_of(folder_ / "x.ply"));
        const Json error = Json::parse(contents_of(folder_ / "report.json"))["error"];
        const bool is_stated = std::string(points) != "0";
        EXPECT_EQ(outcome.out.find(" points\n") != std::string::npos, is_stated) << outcome.out;
        EXPECT_EQ(error.is_object(), is_stated);
        for (const char* key : {"rmse", "low", "high", "bias", "p95", "floor", "points", "rays"})
            EXPECT_EQ(error.contains(key), is_stated) << key;
        EXPECT_EQ(is_stated ? error["points"].get<int>() : 0, std::stoi(points));
    }
    EXPECT_EQ(bytes[0], bytes[1]);
    EXPECT_EQ(bytes[0], bytes[2]);
}

TEST_F(BakeCommand, AnErrorThatIsAskedForIsSearched)
{
    for (const auto& [asked, met] : {std::pair("0.2", true), {"0.0001", false}}) {
        const Outcome outcome = run({"bake", folder_ / "a.obj", "-o", folder_ / "x.ply", "--error",
                                     asked, "--json", folder_ / "report.json"});
        ASSERT_EQ(outcome.code, 0) << outcome.err;
        const Json json = Json::parse(contents_of(folder_ / "report.json"));
        EXPECT_EQ(json["asked"]["met"], met) << asked;
        EXPECT_EQ(json["asked"]["error"], std::stod(asked));
        EXPECT_EQ(json["error"]["high"].get<double>() <= std::stod(asked), met);
        EXPECT_NE(outcome.out.find(met ? "met by the last" : "not met"), std::string::npos);
        EXPECT_GE(json["asked"]["trials"].size(), 1u);
    }
    for (const std::vector<std::string>& wrong :
         {std::vector<std::string>{"--error", "0.01", "--check", "0"},
          {"--error", "0.01", "--quality", "good"},
          {"--error", "0.01", "--engine", "rays"},
          {"--error", "0"},
          {"--check", "-1"}}) {
        std::vector<std::string> arguments = {"bake", folder_ / "a.obj", "-o", folder_ / "y.ply"};
        arguments.insert(arguments.end(), wrong.begin(), wrong.end());
        EXPECT_EQ(run(arguments).code, 2) << wrong[1];
        EXPECT_FALSE(fs::exists(folder_ / "y.ply"));
    }
}

TEST_F(BakeCommand, SubdividesWhereThatIsAsked)
{
    using scenes::operator+;
    const Scene scene =
        scenes::sheet({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, 1) + scenes::sphere({0, 0, 0.5}, 0.5, 4);
    write_obj(folder_ / "floor.obj", scene);
    std::size_t least = 0;
    for (const std::vector<std::string>& more : std::vector<std::vector<std::string>>{
             {}, {"--engine", "disks"}, {"--error", "0.2"}, {"--values", "point"}}) {
        std::vector<std::string> arguments{
            "bake",   folder_ / "floor.obj", "-o",         folder_ / "x.ply",
            "--json", folder_ / "x.json",    "--subdivide"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Outcome outcome = run(arguments);
        ASSERT_EQ(outcome.code, 0) << outcome.err;
        const Json json = Json::parse(contents_of(folder_ / "x.json"));
        EXPECT_EQ(json["subdivision"]["tolerance"], 0.02);
        EXPECT_EQ(json["subdivision"]["old_vertices"], scene.positions.size());
        const std::size_t vertices = read_scene(folder_ / "x.ply").positions.size();
        EXPECT_EQ(json["vertices"], vertices);
        EXPECT_GT(vertices, scene.positions.size() + 100);
        least = least == 0 ? vertices : least;
        EXPECT_EQ(vertices, least);  // whoever bakes
    }
    for (const std::vector<std::string>& wrong : std::vector<std::vector<std::string>>{
             {"--subdivide", "0"}, {"--subdivide", "x"}, {"--subdivide", "--at", "texels"}}) {
        std::vector<std::string> arguments{"bake", folder_ / "floor.obj", "-o", folder_ / "y.ply"};
        arguments.insert(arguments.end(), wrong.begin(), wrong.end());
        EXPECT_EQ(run(arguments).code, 2) << wrong[1];
    }
    EXPECT_FALSE(fs::exists(folder_ / "y.ply"));
}

TEST_F(BakeCommand, TheGpuKnowsTheSameOptions)
{
    for (const char* engine : {"masks", "disks"}) {
        const Outcome outcome =
            run({"bake", folder_ / "a.obj", "-o", folder_ / "x.ply", "--engine", engine, "--device",
                 "gpu", "--max-distance", "50%", "--falloff", "smooth", "--quality", "1.5",
                 "--json", folder_ / "report.json"});
        ASSERT_EQ(outcome.code, 0) << outcome.err;
        const Json json = Json::parse(contents_of(folder_ / "report.json"));
        EXPECT_EQ(json["engine"], engine);
        EXPECT_EQ(json["settings"]["device"], "gpu");
        EXPECT_EQ(read_scene(folder_ / "x.ply").positions.size(), 6u * 16 + 2);
    }
    const Outcome refused = run({"bake", folder_ / "a.obj", "-o", folder_ / "y.ply", "--engine",
                                 "rays", "--device", "gpu"});
    EXPECT_EQ(refused.code, 2);
    EXPECT_NE(refused.err.find("--device gpu is only for --engine masks or disks."),
              std::string::npos)
        << refused.err;
}

TEST_F(BakeCommand, JsonToStandardOutputIsAllThatStandsThere)
{
    const Outcome outcome =
        run({"bake", folder_ / "a.obj", "-o", folder_ / "x.ply", "--json", "-"});
    EXPECT_EQ(Json::parse(outcome.out)["engine"], "masks");
}

TEST_F(BakeCommand, NotesStandBehindTheFactsAndInTheJsonOnly)
{
    write_obj(folder_ / "in.obj", scenes::flipped(scenes::sphere({0, 0, 0}, 1, 8)));
    const std::string sentence = "1 of 1 closed piece faces inward";
    const Outcome text = run({"bake", folder_ / "in.obj", "-o", folder_ / "x.ply"});
    EXPECT_GT(text.out.find("  note: " + sentence), text.out.find("solve")) << text.out;
    EXPECT_NE(text.out.find("places fitted to the vertices"), std::string::npos) << text.out;
    EXPECT_EQ(text.err, "");
    for (const std::vector<std::string>& command :
         {std::vector<std::string>{"bake", folder_ / "in.obj", "-o", folder_ / "x.ply"},
          std::vector<std::string>{"info", folder_ / "in.obj"}}) {
        std::vector<std::string> arguments = command;
        arguments.insert(arguments.end(), {"--json", "-"});
        const Outcome outcome = run(arguments);
        const Json notes = Json::parse(outcome.out)["notes"];
        ASSERT_FALSE(notes.empty());
        EXPECT_EQ(notes[0].get<std::string>().rfind(sentence, 0), 0u) << notes;
    }
}

TEST_F(BakeCommand, OneFailingFileDoesNotStopTheBatch)
{
    std::ofstream(folder_ / "bad.obj") << "v 1 2\n";
    const Outcome outcome = run({"bake", folder_ / "a.obj", folder_ / "bad.obj", folder_ / "b.obj",
                                 "-o", folder_ / "out", "--json", folder_ / "report.json"});
    EXPECT_EQ(outcome.code, 1);
    EXPECT_NE(outcome.err.find("bad.obj"), std::string::npos);
    EXPECT_NE(outcome.err.find("1 of 3"), std::string::npos);
    EXPECT_TRUE(fs::exists(folder_ / "out/a.obj"));
    EXPECT_FALSE(fs::exists(folder_ / "out/bad.obj"));
    EXPECT_TRUE(fs::exists(folder_ / "out/b.obj"));
    const Json json = Json::parse(contents_of(folder_ / "report.json"));
    ASSERT_EQ(json.size(), 3u);
    EXPECT_TRUE(json[0].contains("seconds"));
    EXPECT_TRUE(json[1].contains("error"));
}

// A setting that is not for one of the files is wrong usage, as it is for that file alone.
TEST_F(BakeCommand, ASettingThatIsNotForAFileOfABatchIsWrongUsage)
{
    std::ofstream(folder_ / "points.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
    std::ofstream(folder_ / "bad.obj") << "v 1 2\n";
    const Outcome outcome =
        run({"bake", folder_ / "points.obj", folder_ / "a.obj", folder_ / "bad.obj", "-o",
             folder_ / "out", "--subdivide", "--check", "0"});
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    EXPECT_NE(outcome.err.find("2 of 3 files failed"), std::string::npos) << outcome.err;
    EXPECT_TRUE(fs::exists(folder_ / "out/a.obj"));
}

TEST_F(BakeCommand, ColoursAreAsAskedForAndABakeOfABakeIsABakeOfTheOriginal)
{
    std::ofstream(folder_ / "scan.obj")
        << "mtllib scan.mtl\nv 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nv 0 0 1 1 1 0\n"
           "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
    std::ofstream(folder_ / "scan.mtl") << "newmtl cloth\n";
    const auto bake = [&](const fs::path& input, const fs::path& output,
                          const std::vector<std::string>& colors) {
        std::vector<std::string> arguments = {"bake", input, "-o", output};
        arguments.insert(arguments.end(), colors.begin(), colors.end());
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return outcome.out;
    };
    bake(folder_ / "scan.obj", folder_ / "scan.ply", {"--colors", "keep"});
    bake(folder_ / "scan.obj", folder_ / "scan.off", {"--colors", "keep"});
    const std::vector<std::string> shaded = {"--colors", "shaded", "--encoding", "linear"};
    for (const std::string name : {"scan.obj", "scan.off", "scan.ply"}) {
        const std::string told = bake(folder_ / name, folder_ / ("out/" + name), {});
        const std::string sentence = name == "scan.ply" ? "colours of the file kept; --colors"
                                                        : "colours of the file shaded";
        EXPECT_NE(told.find("note: " + sentence), told.npos) << told;
        const auto out = [&](const std::string& which) {
            return folder_ / ("out/" + which + name);
        };
        bake(out(""), out("again_"), {});
        EXPECT_EQ(contents_of(out("again_")), contents_of(out("")));
        bake(out("again_"), out("shaded_"), shaded);
        bake(folder_ / name, out("once_"), shaded);
        EXPECT_EQ(contents_of(out("shaded_")), contents_of(out("once_")));
    }
    EXPECT_NE(contents_of(folder_ / "out/scan.obj").find("mtllib ../scan.mtl\n"),
              std::string::npos);
}

TEST_F(BakeCommand, ResumeSkipsWhatIsFinishedAndRedoesWhatIsOlderOrHasOtherSettings)
{
    const fs::path result = folder_ / "out/a.obj";
    const auto resume = [&](const char* quality) {
        return run({"bake", folder_ / "a.obj", folder_ / "b.obj", "-o", folder_ / "out", "--resume",
                    "--quality", quality});
    };
    // as "good" left it, and recognisable
    std::string finished =
        "# surfelao 0.1.0 bake: engine=masks device=cpu quality=1 "
        "kernel=cosine max_distance=none falloff=none normals=auto crease=40 values=fit "
        "colors=auto encoding=auto\nfinished";
    std::ofstream(result) << finished;
    Outcome outcome = resume("good");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("skipped"), std::string::npos);
    EXPECT_EQ(contents_of(result), finished);
    EXPECT_TRUE(fs::exists(folder_ / "out/b.obj"));

    outcome = resume("draft");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.out.find("skipped"), std::string::npos) << outcome.out;
    EXPECT_NE(contents_of(result).find("quality=0 "), std::string::npos);

    finished = contents_of(result) + "# finished";
    std::ofstream(result) << finished;
    fs::last_write_time(folder_ / "a.obj", fs::last_write_time(result) + std::chrono::seconds(5));
    EXPECT_EQ(resume("draft").code, 0);
    EXPECT_NE(contents_of(result), finished);
}

TEST_F(BakeCommand, MakesTheFolderOfItsResultsAndLeavesNoEmptyOne)
{
    const std::string made = folder_ / "new/inner";
    EXPECT_EQ(run({"bake", folder_ / "a.obj", folder_ / "b.obj", "-o", made}).code, 0);
    EXPECT_TRUE(fs::exists(folder_ / "new/inner/b.obj"));
    EXPECT_EQ(run({"bake", folder_ / "a.obj", "-o", folder_ / "one/"}).code, 0);
    EXPECT_TRUE(fs::exists(folder_ / "one/a.obj"));
    std::ofstream(folder_ / "bad.obj") << "v 1 2\n";
    EXPECT_EQ(run({"bake", folder_ / "bad.obj", "-o", folder_ / "none/inner/"}).code, 1);
    EXPECT_FALSE(fs::exists(folder_ / "none"));
}

TEST_F(BakeCommand, ReadOnlyTargetIsRefusedAndUntouched)
{
    if (geteuid() == 0)
        GTEST_SKIP() << "root may write anywhere";
    std::ofstream(folder_ / "x.ply") << "old";
    fs::permissions(folder_ / "x.ply", fs::perms::owner_read);
    const Outcome outcome = run({"bake", folder_ / "a.obj", "-o", folder_ / "x.ply"});
    EXPECT_EQ(outcome.code, 1);
    EXPECT_EQ(contents_of(folder_ / "x.ply"), "old");
    fs::permissions(folder_ / "out", fs::perms::owner_read | fs::perms::owner_exec);
    EXPECT_EQ(run({"bake", folder_ / "a.obj", "-o", folder_ / "out/x.ply"}).code, 1);
}

TEST_F(BakeCommand, AFullDiskIsAFailureThatLeavesTheOldFileAndNothingElse)
{
    const fs::path disk = folder_ / "out";
    if (mount("none", disk.c_str(), "tmpfs", 0, "size=32k") != 0)
        GTEST_SKIP() << "only root can mount a tiny disk";
    std::ofstream(disk / "x.ply") << "old";
    write_obj(folder_ / "large.obj", scenes::bumpy_sphere(24));
    const Outcome outcome = run({"bake", folder_ / "large.obj", "-o", disk / "x.ply"});
    EXPECT_EQ(outcome.code, 1);
    EXPECT_EQ(outcome.err.rfind("surfelao: ", 0), 0u) << outcome.err;
    EXPECT_EQ(contents_of(disk / "x.ply"), "old");
    EXPECT_EQ(std::distance(fs::directory_iterator(disk), {}), 1);
    umount(disk.c_str());
}

TEST_F(BakeCommand, PartsAndFilesTogether)
{
    std::ofstream(folder_ / "named.obj") << "o tri\n" << contents_of(folder_ / "a.obj");
    const std::string named = folder_ / "named.obj", out = folder_ / "out";
    const struct {
        std::vector<std::string> arguments;
        int code;
        std::string words;
    } rows[] = {
        {{named, "-o", folder_ / "x.ply", "--exclude", "Tri"}, 1, "near it: tri"},
        {{named, "-o", folder_ / "x.ply", "--receivers", "tri"}, 0, "mean occlusion"},
        {{named, "-o", folder_ / "x.ply", "--together"}, 2, "--together is for several files."},
        {{named, folder_ / "b.obj", "-o", out, "--together", "--occluders", named}, 0, "b.obj"},
        {{named, "-o", named, "--occluders", folder_ / "b.obj"}, 2, "named.obj"},
    };
    for (const auto& row : rows) {
        std::vector<std::string> arguments{"bake"};
        arguments.insert(arguments.end(), row.arguments.begin(), row.arguments.end());
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.code, row.code) << outcome.err;
        EXPECT_NE((outcome.out + outcome.err).find(row.words), std::string::npos)
            << outcome.out << outcome.err;
    }
    const Json report = Json::parse(
        run({"bake", named, "-o", folder_ / "x.ply", "--receivers", "t*", "--json", "-"}).out);
    EXPECT_EQ(report["settings"]["parts"]["receivers"], Json({"t*"}));
    EXPECT_EQ(report["baked_triangles"], report["triangles"]);
    const Json info = Json::parse(run({"info", named, "--json", "-"}).out);
    EXPECT_EQ(info["labels"][0]["name"], "tri");
}

}  // namespace
}  // namespace surfelao

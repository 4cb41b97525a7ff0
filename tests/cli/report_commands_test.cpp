#include "program.h"
#include "scenes.h"
#include "temporary_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace surfelao {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

class ReportCommands : public testing::Test {
protected:
    void SetUp() override
    {
        write_obj(folder_ / "a.obj", scenes::bumpy_sphere(4));
        write_obj(folder_ / "b.obj", scenes::nested_shells(2, 0.2, 4));
    }
    Outcome run(const std::vector<std::string>& arguments) const
    {
        return surfelao::run(folder_.path(), arguments);
    }
    TemporaryFolder folder_;
};

TEST_F(ReportCommands, InfoTellsCountsAsTextAndJson)
{
    const Outcome text = run({"info", folder_ / "a.obj"});
    EXPECT_EQ(text.code, 0) << text.err;
    EXPECT_NE(text.out.find("98 vertices"), std::string::npos) << text.out;
    const Outcome json = run({"info", folder_ / "a.obj", "--json", "-"});
    EXPECT_EQ(Json::parse(json.out)["vertices"], 98);
}

TEST_F(ReportCommands, ComparePrintsATableAndWritesPictures)
{
    const Outcome outcome = run({"compare", folder_ / "a.obj", "-o", folder_.path(),
                                 "--reference-rays", "256", "--sample", "1000", "--rounds", "1",
                                 "--json", folder_ / "c.json", "--csv", folder_ / "c.csv"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    for (const char* word :
         {"masks", "disks", "rays", "seen RMSE", "solve RMSE", "floor", "Embree/ours"})
        EXPECT_NE(outcome.out.find(word), std::string::npos) << word;
    const Json json = Json::parse(contents_of(folder_ / "c.json"));
    EXPECT_EQ(json["reference"]["rays"], 256);
    for (const char* key : {"engine", "setting", "build_s", "solve_s", "fit_s", "us_per_receiver",
                            "seen", "solve", "beyond", "embree_ratio"})
        EXPECT_TRUE(json["rows"][0].contains(key)) << key;
    for (const char* file : {"difference.ply", "report.html", "c.csv"})
        EXPECT_GT(fs::file_size(folder_ / file), 100u) << file;
}

TEST_F(ReportCommands, ChosenEnginesQualitiesAndSampleAreUsed)
{
    const Outcome outcome = run({"compare", folder_ / "a.obj", "-o", folder_.path(), "--engines",
                                 "disks", "--qualities", "draft,1.5", "--sample", "20",
                                 "--reference-rays", "64", "--rounds", "1", "--json", "-"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const Json json = Json::parse(outcome.out);
    EXPECT_EQ(json["rows"][0]["setting"], "draft");
    EXPECT_EQ(json["rows"][1]["setting"], "quality 1.5");
    EXPECT_EQ(json["rows"][2]["engine"], "rays");
    EXPECT_EQ(json["reference"]["points"], 20);
}

TEST_F(ReportCommands, DevicesStandSideBySideAndErrAlike)
{
    const Outcome outcome = run({"compare",
                                 folder_ / "b.obj",
                                 "-o",
                                 folder_.path(),
                                 "--engines",
                                 "masks,disks",
                                 "--devices",
                                 "cpu,gpu",
                                 "--qualities",
                                 "good",
                                 "--reference-rays",
                                 "256",
                                 "--sample",
                                 "300",
                                 "--values",
                                 "point",
                                 "--rounds",
                                 "1",
                                 "--max-distance",
                                 "30%",
                                 "--falloff",
                                 "smooth",
                                 "--json",
                                 "-"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const Json rows = Json::parse(outcome.out)["rows"];
    for (const std::size_t cpu : {0u, 2u}) {
        EXPECT_EQ(rows[cpu]["setting"], "good");
        EXPECT_EQ(rows[cpu + 1]["setting"], "good on GPU");
        EXPECT_EQ(rows[cpu]["engine"], rows[cpu + 1]["engine"]);
        for (const char* kind : {"seen", "solve"}) {
            EXPECT_NEAR(rows[cpu][kind]["rmse"], rows[cpu + 1][kind]["rmse"], 1e-3);
            EXPECT_NEAR(rows[cpu][kind]["bias"], rows[cpu + 1][kind]["bias"], 1e-3);
        }
    }
}

TEST_F(ReportCommands, FrontierSumsUpOverScenesAndNamesTheBadOne)
{
    const Outcome outcome =
        run({"compare", "--frontier", folder_ / "a.obj", folder_ / "none.obj", folder_ / "b.obj",
             "-o", folder_.path(), "--reference-rays", "256", "--sample", "1000", "--json",
             folder_ / "f.json", "--csv", folder_ / "f.csv"});
    EXPECT_EQ(outcome.code, 1);  // one scene failed
    EXPECT_NE(outcome.err.find("none.obj"), std::string::npos);
    EXPECT_NE(outcome.out.find("MEDIAN"), std::string::npos);
    const Json json = Json::parse(contents_of(folder_ / "f.json"));
    EXPECT_EQ(json["summary"]["engine"], "masks");
    for (const char* key : {"median_ratio", "worst_ratio", "quartiles"}) {
        EXPECT_TRUE(json["summary"]["at_010"].contains(key));
        EXPECT_TRUE(json["summary"]["at_005"].contains(key));
        EXPECT_TRUE(json["summary"]["with_builds"]["at_010"].contains(key));
        EXPECT_TRUE(json["summary"]["with_builds"]["at_005"].contains(key));
    }
    EXPECT_EQ(json["scenes"].size(), 3u);
    EXPECT_GT(fs::file_size(folder_ / "report.html"), 1000u);
}

}  // namespace
}  // namespace surfelao

#include "files/scene_io.h"
#include "grid/grid_file.h"
#include "program.h"
#include "scenes.h"
#include "temporary_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>

namespace surfelao {
namespace {

namespace fs = std::filesystem;

class GridBakeCommand : public testing::Test {
protected:
    void SetUp() override
    {
        write_obj(folder_ / "a.obj", scenes::bumpy_sphere(4));
        write_obj(folder_ / "b.obj", scenes::box({0, 0, 0}, {1, 2, 3}, 2));
    }
    Outcome bake(std::vector<std::string> arguments) const
    {
        arguments.insert(arguments.begin(),
                         {"bake", folder_ / "a.obj", "--at", "grid", "--resolution", "8"});
        return surfelao::run(folder_.path(), arguments);
    }
    TemporaryFolder folder_;
};

TEST_F(GridBakeCommand, WritesAGridThatSaysHowItWasMade)
{
    const Outcome outcome = bake({"-o", folder_ / "a.aogrid.exr", "--store", "sh", "--extent",
                                  "0.1", "--border", "rescale", "--uniform", "--json", "-"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const nlohmann::json report = nlohmann::json::parse(outcome.out);
    EXPECT_EQ(report["grid"]["cells"], (nlohmann::json{8, 8, 8}));
    EXPECT_EQ(report["grid"]["bytes"], 8 * 8 * 8 * 24);
    EXPECT_GT(report["error"]["rmse"], 0.0);
    EXPECT_GE(report["seconds"]["repair"], 0.0);
    GridNotes notes;
    const AoGrid grid = read_grid(folder_ / "a.aogrid.exr", &notes);
    EXPECT_EQ(grid.store, GridStore::sh);
    EXPECT_EQ(grid.border, GridBorder::rescale);
    EXPECT_EQ(grid.inner.x, grid.inner_share);
    EXPECT_NE(notes.maker.find("at=grid resolution=8 extent=0.1"), std::string::npos);
    const nlohmann::json made = nlohmann::json::parse(notes.about);
    EXPECT_EQ(made["source"], "a.obj");
    EXPECT_EQ(made["engine"], "masks");
    EXPECT_EQ(made["error"]["rmse"], report["error"]["rmse"]);
}

TEST_F(GridBakeCommand, FoldersGetAFileForEachObject)
{
    const Outcome outcome = bake({folder_ / "b.obj", "-o", folder_ / "out/", "--check", "0"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(read_grid(folder_ / "out/a.aogrid.exr").cells.x, 8);
    EXPECT_GT(read_grid(folder_ / "out/b.aogrid.json").high.z, 3.0);
}

TEST_F(GridBakeCommand, TheTextOfAnotherMakerIsKept)
{
    folder_.file("a.aogrid.json", "{\"mine\": 1}");
    const std::vector<std::string> arguments = {"-o", folder_ / "a.aogrid.png", "--check", "0"};
    EXPECT_EQ(bake(arguments).code, 1);
    EXPECT_EQ(contents_of(folder_ / "a.aogrid.json"), "{\"mine\": 1}");
    EXPECT_FALSE(fs::exists(folder_ / "a.aogrid.png"));
    std::vector<std::string> insisting = arguments;
    insisting.emplace_back("--overwrite");
    EXPECT_EQ(bake(insisting).code, 0);
    EXPECT_EQ(bake(arguments).code, 0);  // its own may be replaced
}

TEST_F(GridBakeCommand, WrongUsageAndWrongNamesAreTold)
{
    for (const std::vector<std::string>& wrong : {std::vector<std::string>{"--size", "64"},
                                                  {"--error", "0.01"},
                                                  {"--ground", "lowest"},
                                                  {"--depth", "32"},
                                                  {"--subdivide"},
                                                  {"--kernel", "bunnell"},
                                                  {"--resolution", "3"},
                                                  {"--occluders", folder_ / "b.obj"}}) {
        std::vector<std::string> arguments = {"-o", folder_ / "a.aogrid.png"};
        arguments.insert(arguments.end(), wrong.begin(), wrong.end());
        EXPECT_EQ(bake(arguments).code, 2) << wrong.front();
    }
    const Outcome at_vertices = surfelao::run(
        folder_.path(), {"bake", folder_ / "a.obj", "-o", folder_ / "a.ply", "--extent", "0.1"});
    EXPECT_EQ(at_vertices.code, 2);
    const Outcome named = bake({"-o", folder_ / "a.png"});
    EXPECT_EQ(named.code, 1);
    EXPECT_NE(named.err.find("NAME.aogrid.exr"), std::string::npos) << named.err;
}

TEST_F(GridBakeCommand, ComparesWhatCellsHold)
{
    const Outcome outcome =
        surfelao::run(folder_.path(), {"compare", folder_ / "a.obj", "--at", "grid", "--resolution",
                                       "8", "--sample", "200", "--reference-rays", "256",
                                       "--qualities", "draft", "--rounds", "1", "--json", "-"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const nlohmann::json rows = nlohmann::json::parse(outcome.out)["rows"];
    ASSERT_EQ(rows.size(), 3u);
    EXPECT_EQ(rows[0]["store"], "cone");
    EXPECT_EQ(rows[1]["store"], "sh");
    EXPECT_EQ(rows[2]["origin"], true);
    EXPECT_LT(rows[1]["error"]["rmse"], rows[2]["error"]["rmse"]);
}

}  // namespace
}  // namespace surfelao

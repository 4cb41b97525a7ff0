// Presets: values for options that are not given.
#include "program.h"
#include "scenes.h"
#include "temporary_folder.h"

#include <gtest/gtest.h>

namespace surfelao {
namespace {

class PresetTest : public testing::Test {
protected:
    void SetUp() override { write_obj(in(), scenes::box({0, 0, 0}, {1, 1, 1}, 1)); }
    std::string in() const { return folder_ / "in.obj"; }
    /// The bytes of a bake, its mark among them.
    std::string baked(std::vector<std::string> more) const
    {
        more.insert(more.begin(), {"bake", in(), "-o", folder_ / "out.ply", "--check", "0"});
        const Outcome outcome = run(folder_.path(), more);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return contents_of(folder_ / "out.ply");
    }
    TemporaryFolder folder_;
};

TEST_F(PresetTest, IsWhatItsHelpSays)
{
    const std::string plain = baked({});
    const std::string interior = baked({"--preset", "interior"});
    EXPECT_EQ(interior, baked({"--max-distance", "10%", "--falloff", "smooth"}));
    EXPECT_NE(interior, plain);
    EXPECT_EQ(baked({"--preset", "game"}),
              baked({"--max-distance", "20%", "--falloff", "smooth", "--colors", "grey"}));
    EXPECT_EQ(baked({"--preset", "scan"}), baked({"--normals", "smooth", "--colors", "shaded"}));
    EXPECT_EQ(baked({"--preset", "cad"}),
              baked({"--normals", "smooth", "--crease", "30", "--subdivide", "0.02"}));
    const std::string help = run(folder_.path(), {"help", "render"}).out;
    EXPECT_NE(help.find("interior: --max-distance"), std::string::npos) << help;
    EXPECT_EQ(help.find("--subdivide"), std::string::npos) << "render does not cut";
}

TEST_F(PresetTest, GivesWayToWhatIsGiven)
{
    EXPECT_EQ(baked({"--preset", "interior", "--max-distance", "30%"}),
              baked({"--max-distance", "30%", "--falloff", "smooth"}));
    EXPECT_EQ(baked({"--falloff", "none", "--preset", "interior"}),
              baked({"--max-distance", "10%"}));
    // a map lies on the mesh as it is: the preset leaves it uncut
    std::vector<std::string> map = {"bake",    in(),     "-o",       folder_ / "map.ply",
                                    "--at",    "texels", "--size",   "16",
                                    "--check", "0",      "--preset", "cad"};
    EXPECT_EQ(run(folder_.path(), map).code, 0);
    map.back() = "game";  // nor has it colours
    EXPECT_EQ(run(folder_.path(), map).code, 0);
    map.emplace_back("--subdivide");
    EXPECT_EQ(run(folder_.path(), map).code, 2);
}

}  // namespace
}  // namespace surfelao

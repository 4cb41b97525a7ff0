// Each note is told by bake and by info where it is true, and only there.
#include "bake/notes.h"

#include "bake/bake.h"
#include "bake/info.h"
#include "files/scene_io.h"
#include "scenes.h"
#include "temporary_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace surfelao {
namespace {

using scenes::operator+;

/// The notes of a default bake and of info, which must agree in which there are. A sentence is
/// known by words of it.
class Notes : public testing::Test {
protected:
    Notes()
    {
        settings_.input = folder_ / "in.obj";
        settings_.output = folder_ / "out.ply";
    }
    void write(const Scene& scene) const { write_obj(settings_.input, scene); }

    std::vector<std::string> baked() const { return bake(settings_).notes; }

    void expect(const std::vector<std::string>& words) const
    {
        expect_in(baked(), words, "bake");
        const Info info = inspect(settings_.input);
        expect_in(info.notes, words, "info");
        const std::string text = text_of(info);
        EXPECT_EQ(text.find("nothing odd") != std::string::npos,
                  words.empty() && text.find("odd, but legal") == std::string::npos);
        for (const std::string& note : info.notes)
            EXPECT_NE(text.find("\n  " + note + "\n"), std::string::npos) << text;
    }

    static void expect_in(const std::vector<std::string>& notes,
                          const std::vector<std::string>& words, const char* who)
    {
        std::string all;
        for (const std::string& note : notes)
            all += note + '\n';
        ASSERT_EQ(notes.size(), words.size()) << who << ":\n" << all;
        for (std::size_t i = 0; i < words.size(); ++i)
            EXPECT_NE(notes[i].find(words[i]), std::string::npos) << who << ":\n" << all;
    }

    TemporaryFolder folder_;
    BakeSettings settings_;
};

TEST_F(Notes, AGoodMeshHasNone)
{
    write(scenes::bumpy_sphere(16));
    expect({});
}

TEST_F(Notes, ClosedPiecesThatFaceInward)
{
    const Scene ball = scenes::sphere({0, 0, 0}, 1, 8);
    write(ball + scenes::flipped(scenes::sphere({0, 0, 4}, 1, 8)));
    expect({"1 of 2 closed pieces faces inward, 50 % of the surface"});
    // which way an open surface faces is nobody's fault
    write(ball + scenes::flipped(scenes::wall_and_floor(40, 64)));
    expect({});
}

TEST_F(Notes, TrianglesTooLargeForTheShadowOnThem)
{
    const Scene ball = scenes::sphere({0, 0, 1.01}, 1, 8);
    write(ball + scenes::sheet({-5, -5, 0}, {10, 0, 0}, {0, 10, 0}, 1));
    expect({"of the surface lies in triangles too large for values at vertices"});
    // who asks at the vertices does not learn what lies between
    settings_.target.values = VertexValues::point;
    EXPECT_EQ(bake(settings_).misfit, std::nullopt);
    EXPECT_TRUE(baked().empty());
    // a floor without a shadow is right with two triangles
    write(scenes::sheet({-5, -5, 0}, {10, 0, 0}, {0, 10, 0}, 1));
    expect({});
}

TEST_F(Notes, MisfitIsWhatIsSeenLessTheAnswers)
{
    write(scenes::sphere({0, 0, 1.01}, 1, 32) +
          scenes::sheet({-5, -5, 0}, {10, 0, 0}, {0, 10, 0}, 1));
    const auto mesh = std::make_shared<const Mesh>(make_mesh(read_scene(settings_.input)));
    const VertexTarget target(mesh, {});
    std::vector<Occlusion> answers(target.receivers().size());
    const std::vector<Occlusion> open(mesh->scene.positions.size());
    EXPECT_EQ(target.misfit(answers, open)->rms, 0.0);
    for (Occlusion& answer : answers)
        answer.occlusion = 0.3f;
    EXPECT_NEAR(target.misfit(answers, open)->rms, 0.3, 1e-6);
    // the floor: nearly all triangles of the ball have one sample
    EXPECT_NEAR(target.misfit(answers, open)->share, 100.0 / 112.4, 0.01);
    for (Occlusion& answer : answers)
        answer.occlusion = 0.04f;
    EXPECT_EQ(target.misfit(answers, open)->share, 0.0) << "below what is seen as a wrong shade";
}

TEST_F(Notes, VerticesInsideOfOtherParts)
{
    const Scene ball = scenes::sphere({0, 0, 0}, 1, 16);
    write(ball + scenes::box({-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1}, 4));
    expect({"vertices are closed on all sides"});
    // 8 of 1546 are not worth a word
    write(ball + scenes::box({-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1}, 1));
    expect({});
}

TEST_F(Notes, InteriorsNeedAMaximumDistance)
{
    write(scenes::room({0, 0, 0}, {4, 3, 0.1}, 8));
    expect({"1 of 1 closed piece faces inward, 100 %", "an interior: try --preset interior"});
    settings_.max_distance = {90.0, true, Falloff::none};
    expect_in(baked(), {"faces inward", "an interior"}, "90 %");
    settings_.max_distance = {10.0, true, Falloff::none};
    expect_in(baked(), {"faces inward"}, "10 %");
}

TEST_F(Notes, NothingButTrianglesWithoutArea)
{
    write(scenes::triangle({0, 0, 0}, {1, 0, 0}, {2, 0, 0}));
    expect({"no triangle has an area"});
}

TEST_F(Notes, NormalsOfTheFileThatAreOfNoUse)
{
    std::ofstream(settings_.input) << "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nvn 0 0 -1\n"
                                      "f 1//1 2//1 3//1\nf 1//1 3//1 4//2\n";
    expect({"1 of 6 normals of the file"});
    EXPECT_EQ(bake(settings_).corners_from_file, 5u);
    EXPECT_NE(text_of(inspect(settings_.input)).find("normals in the file, used at 5 of 6 corners"),
              std::string::npos);
    settings_.target.normals.source = NormalSource::smooth;
    EXPECT_TRUE(baked().empty());
}

// a square over the left half of the map, its mirror image in the same place, a triangle that
// reaches out and lies on both again, one without area there, one without area in space, and one
// without coordinates
TEST_F(Notes, InfoTellsWhereTrianglesLieInTheMap)
{
    std::ofstream file(settings_.input);
    file << "vt 0 0\nvt .5 0\nvt .5 1\nvt 0 1\nvt -1 0\nvt nan 0\n";
    for (int n = 0; n < 6; ++n)
        file << "v 0 0 " << n << "\nv 1 0 " << n << "\nv 1 1 " << n << "\nv 0 1 " << n << "\n";
    file << "f 1/1 2/2 3/3 4/4\nf 5/2 6/1 7/4 8/3\nf 9/5 10/1 11/3\nf 13/1 14/2 15/6\n"
            "f 17/1 17/2 18/3\nf 21 22/2 23/3\n";
    file.close();
    const Info info = inspect(settings_.input);
    ASSERT_EQ(info.uvs.size(), 1u);
    const UvReport& uvs = info.uvs[0];
    EXPECT_EQ(uvs.set, 0u);
    EXPECT_EQ(uvs.triangles, 6u);
    EXPECT_EQ(uvs.flat, 1u);
    EXPECT_EQ(uvs.outside, 1u);
    EXPECT_NEAR(uvs.sheets, 1.5, 1e-12);
    // in the right half the triangle is alone, on a quarter of the map; elsewhere it does not count
    EXPECT_NEAR(uvs.overlap.value(), 0.5 / 0.75, 0.003);
    EXPECT_NE(text_of(info).find("texture coordinates: set 0, 6 triangles, 1 without area there, "
                                 "1 outside of [0, 1], 66.6 % of texels covered twice"),
              std::string::npos)
        << text_of(info);
    EXPECT_NE(json_of(info).find("\"overlap\": 0.66"), std::string::npos);
}

TEST_F(Notes, InfoLooksForNoOverlapWhereTheMapRepeats)
{
    std::ofstream(settings_.input) << "v 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvt 5 0\nvt 5 4\n"
                                      "f 1/1 2/2 3/3\n";
    const Info info = inspect(settings_.input);
    EXPECT_FALSE(info.uvs.at(0).overlap);
    EXPECT_NE(text_of(info).find("the map covered 10 times over"), std::string::npos);
    EXPECT_NE(json_of(info).find("\"overlap\": null"), std::string::npos);
}

TEST_F(Notes, WhatTheReaderPassesOverComesFirst)
{
    Scene scene = scenes::flipped(scenes::sphere({0, 0, 0}, 1, 4));
    scene.notes = {"1 dragon is taken as a hill"};
    const Mesh mesh = make_mesh(std::move(scene));
    const std::vector<Occlusion> values(mesh.scene.positions.size());
    expect_in(notes_of({mesh, analyse_topology(mesh.geometry), Definition{}, values, {}}),
              {"1 dragon is taken as a hill", "faces inward"}, "notes_of");
}

}  // namespace
}  // namespace surfelao

#include "viewer/output_files.h"

#include "temporary_folder.h"
#include "viewer/cell.h"

#include <gtest/gtest.h>

namespace surfelao {
namespace {

namespace fs = std::filesystem;

TEST(OutputFiles, AnInputIsKnownUnderEveryNameAndWhateverElseHappensToIt)
{
    const TemporaryFolder folder;
    const fs::path input = folder.file("input.ply", "x");
    fs::create_symlink("input.ply", folder / "link.ply");
    fs::create_hard_link(input, folder / "twin.ply");
    OutputFiles files;
    files.add_input(input);
    for (const char* name : {"input.ply", "link.ply", "twin.ply", "./input.ply"})
        EXPECT_EQ(files.standing_of(folder / name), Standing::input) << name;
    files.add_written(input);
    EXPECT_EQ(files.standing_of(input), Standing::input);
    EXPECT_EQ(files.standing_of(folder.file("other.ply", "x")), Standing::foreign);
    EXPECT_EQ(files.standing_of(folder / "none.ply"), Standing::nothing);
    EXPECT_EQ(files.standing_of(""), Standing::nothing);
}

TEST(OutputFiles, WhatWasWrittenMayBeReplacedAndIsListedOnce)
{
    const TemporaryFolder folder;
    OutputFiles files;
    const fs::path first = folder.file("first.ply", "x"), second = folder.file("second.ply", "x");
    files.add_written(first);
    files.add_written(second);
    files.add_written(folder / "./first.ply");
    EXPECT_EQ(files.standing_of(first), Standing::written);
    EXPECT_EQ(files.written(), (std::vector<fs::path>{first, second}));
}

TEST(NextFreeName, IsTheFirstUnderWhichNothingStandsNotEvenALinkToNothing)
{
    const TemporaryFolder folder;
    const auto with_map = [](const fs::path& path) {
        return std::vector{path, fs::path(path).replace_extension(".png")};
    };
    EXPECT_EQ(next_free_name(folder / "a.b.ply", with_map), folder / "a.b-2.ply");
    folder.file("a.b-2.ply", "x");
    fs::create_symlink("nothing", folder / "a.b-3.ply");
    folder.file("a.b-4.png", "x");
    EXPECT_EQ(next_free_name(folder / "a.b.ply", with_map), folder / "a.b-5.ply");
    EXPECT_EQ(next_free_name("name", with_map), "name-2");
}

TEST(ChooseEngine, EachEngineKeepsItsQuality)
{
    Cell cell;
    std::map<Engine, float> qualities;
    EngineSettings& settings = cell.settings.engine;
    settings.quality = 3.0f;
    choose_engine(cell, Engine::rays, Device::cpu, qualities);
    choose_engine(cell, Engine::disks, Device::gpu, qualities);
    EXPECT_EQ(settings.quality, kGood);
    settings.quality = 0.5f;
    choose_engine(cell, Engine::masks, Device::gpu, qualities);
    EXPECT_EQ(settings.quality, 3.0f);
    choose_engine(cell, Engine::masks, Device::cpu, qualities);
    EXPECT_EQ(settings.quality, 3.0f);
    EXPECT_EQ(settings.device, Device::cpu);
    choose_engine(cell, Engine::disks, Device::cpu, qualities);
    EXPECT_EQ(settings.quality, 0.5f);
}

}  // namespace
}  // namespace surfelao

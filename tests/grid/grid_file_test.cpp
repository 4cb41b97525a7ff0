#include "grid/grid_file.h"

#include "image/image_file.h"
#include "random.h"
#include "surfels/errors.h"
#include "temporary_folder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

namespace surfelao {
namespace {

/// Any values that a grid may have, the first cell nothing.
AoGrid random_grid(GridStore store)
{
    AoGrid grid;
    grid.cells = {5, 4, 7};
    grid.low = {-1.5, 0.25, 3};
    grid.high = {1e3, 0.75, 4};
    grid.inner = {0.25f, 0.5f, 0.125f};
    grid.inner_share = 0.75f;
    grid.store = store;
    grid.border = GridBorder::rescale;
    grid.border_value = 0.0625f;
    Random random(3);
    for (std::size_t cell = 0; cell < grid.cell_count(); ++cell) {
        const double alpha = cell == 0 ? 0.0 : random.share();
        for (const double m : {0, 1, 2})
            grid.values.push_back(static_cast<float>((m - 1.0) * 0.2 * alpha));
        grid.values.push_back(static_cast<float>(alpha));
        for (std::size_t more = 4; more < channels_of(store); ++more)
            grid.values.push_back(static_cast<float>(0.8 * (2.0 * random.share() - 1.0) * alpha));
    }
    return grid;
}

struct Encoding {
    const char* name;
    MapDepth depth;
    float half_step;  ///< of numbers in [-1, 1]
};
constexpr Encoding kEncodings[] = {{"g.aogrid.exr", MapDepth::half, 0x1p-12f},
                                   {"g.aogrid.png", MapDepth::half, 0.5f / 32767.0f},
                                   {"g.aogrid.png", MapDepth::byte, 0.5f / 127.0f}};

TEST(GridFile, KeepsEveryCellToHalfAStep)
{
    const TemporaryFolder folder;
    for (const GridStore store : {GridStore::cone, GridStore::sh}) {
        const AoGrid grid = random_grid(store);
        for (const Encoding& encoding : kEncodings) {
            write_grid(folder / encoding.name, grid, encoding.depth,
                       {"made by a test", "{\"a\":1}"});
            GridNotes notes;
            const AoGrid read = read_grid(folder / encoding.name, &notes);
            EXPECT_EQ(read.cells, grid.cells);
            EXPECT_EQ(read.low, grid.low);
            EXPECT_EQ(read.high, grid.high);
            EXPECT_EQ(read.inner, grid.inner);
            EXPECT_EQ(read.inner_share, grid.inner_share);
            EXPECT_EQ(read.store, store);
            EXPECT_EQ(read.border, grid.border);
            EXPECT_EQ(read.border_value, grid.border_value);
            EXPECT_EQ(notes, (GridNotes{"made by a test", "{\"a\":1}"}));
            ASSERT_EQ(read.values.size(), grid.values.size());
            for (std::size_t i = 0; i < grid.values.size(); ++i) {
                const std::size_t channel = i % channels_of(store);
                const float unit = store == GridStore::sh ? 3.5449077f : channel < 3 ? 0.25f : 1.0f;
                EXPECT_NEAR(read.values[i], grid.values[i], 1.001f * unit * encoding.half_step)
                    << encoding.name << " " << i;
            }
            EXPECT_EQ(std::vector(read.values.begin(), read.values.begin() + 4),
                      std::vector(4, 0.0f))
                << encoding.name;
        }
    }
}

TEST(GridFile, SlicesAreTilesInRows)
{
    AoGrid grid = random_grid(GridStore::cone);
    const Map sheet = sheet_of(grid, 0.0f);
    ASSERT_EQ(tile_columns(7), 3);
    EXPECT_EQ(sheet.width, 15u);
    EXPECT_EQ(sheet.height, 12u);
    // cell (2, 1, 5): tile 5 is the last of the second row
    const float alpha = grid.values[grid.index_of({2, 1, 5}) * 4 + 3];
    EXPECT_EQ(sheet.values[sheet.index(2 * 5 + 2, 1 * 4 + 1) + 3], alpha);
    grid = random_grid(GridStore::sh);
    const Map three = sheet_of(grid, 0.0f);
    EXPECT_EQ(three.height, 36u);
    const float last = grid.values[grid.index_of({2, 1, 5}) * 9 + 8] / 3.5449077f;
    EXPECT_NEAR(three.values[three.index(12, 2 * 12 + 5)], last, 1e-6f);
}

TEST(GridFile, IsReadByItsTextToo)
{
    const TemporaryFolder folder;
    const AoGrid grid = random_grid(GridStore::cone);
    write_grid(folder / "g.aogrid.png", grid, MapDepth::half);
    EXPECT_EQ(read_grid(folder / "g.aogrid.json").values,
              read_grid(folder / "g.aogrid.png").values);
}

TEST(GridFile, ATextOfAnotherPictureIsRefused)
{
    const TemporaryFolder folder;
    write_grid(folder / "g.aogrid.png", random_grid(GridStore::cone), MapDepth::half);
    write_grid(folder / "g.aogrid.exr", random_grid(GridStore::cone), MapDepth::half);
    EXPECT_THROW(static_cast<void>(read_grid(folder / "g.aogrid.png")), InputError);
    EXPECT_EQ(read_grid(folder / "g.aogrid.exr").cells.x, 5);
}

TEST(GridFile, OtherNamesAndDepthsAreRefusedBeforeAnyWork)
{
    const TemporaryFolder folder;
    EXPECT_TRUE(is_grid_name("a/b.AOGRID.EXR"));
    for (const char* name : {"g.exr", ".aogrid.exr", "g.aogrid.jpg", "g.aogrid", "g.aogrid.json"}) {
        EXPECT_FALSE(is_grid_name(name)) << name;
        EXPECT_THROW(check_grid_output(folder / name, MapDepth::half), InputError) << name;
    }
    EXPECT_THROW(check_grid_output(folder / "g.aogrid.exr", MapDepth::byte), InputError);
    EXPECT_THROW(check_grid_output(folder / "g.aogrid.png", MapDepth::whole), InputError);
    EXPECT_THROW(check_grid_output(folder / "none/g.aogrid.png", MapDepth::half), InputError);
}

TEST(GridFile, BothFilesAppearOrNone)
{
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "g.aogrid.exr");
    EXPECT_THROW(write_grid(folder / "g.aogrid.exr", random_grid(GridStore::cone), MapDepth::half),
                 InputError);
    EXPECT_FALSE(std::filesystem::exists(folder / "g.aogrid.json"));
}

/// What the reader says of the text after a change of it.
std::string refusal(const TemporaryFolder& folder, const std::string& from, const std::string& to)
{
    write_grid(folder / "g.aogrid.png", random_grid(GridStore::cone), MapDepth::half);
    std::string text = contents_of(folder / "g.aogrid.json");
    const std::size_t at = text.find(from);
    if (at == std::string::npos)
        return "no " + from;
    folder.file("g.aogrid.json", text.replace(at, from.size(), to));
    try {
        static_cast<void>(read_grid(folder / "g.aogrid.png"));
    } catch (const InputError& error) {
        return error.what();
    }
    return "accepted";
}

TEST(GridFile, MalformedTextsAreRefusedWithASentence)
{
    const TemporaryFolder folder;
    struct Case {
        const char *from, *to, *said;
    };
    constexpr Case kCases[] = {
        {"\"aogrid 1\"", "\"aogrid 9\"", "not the text of an AO grid"},
        {"{", "", "not the text of an AO grid"},
        {"\"cells\"", "\"cell\"", "has no cells"},
        {"    4,", "    1,", "whole number"},
        {"    4,", "    4.5,", "whole number"},
        {"    4,", "    6,", "its text wants"},
        {"-1.5", "1500.0", "box.low"},
        {"-1.5", "null", "no number"},
        {"0.125", "1.0", "warp.inner"},
        {"0.75,", "0.2,", "box.high"},
        {"\"cone\"", "\"cube\"", "cone or sh"},
        {"\"rescale\"", "7", "no text"},
        {"0.0625", "1.0", "border.value"},
        {"\"fade\": 0.1", "\"fade\": 0.2", "border.fade"},
        {"\"columns\": 3", "\"columns\": 4", "slices"},
    };
    for (const Case& one : kCases) {
        const std::string said = refusal(folder, one.from, one.to);
        EXPECT_NE(said.find(one.said), std::string::npos) << one.from << ": " << said;
    }
}

TEST(GridFile, WhatIsNotFiniteAndWhatIsMissingIsRefused)
{
    const TemporaryFolder folder;
    EXPECT_THROW(static_cast<void>(read_grid(folder / "g.aogrid.exr")), InputError);
    write_grid(folder / "g.aogrid.exr", random_grid(GridStore::cone), MapDepth::half);
    Map sheet = read_map(folder / "g.aogrid.exr");
    sheet.values[7] = std::numeric_limits<float>::quiet_NaN();
    write_map(folder / "g.aogrid.exr", sheet, MapDepth::half);
    EXPECT_THROW(static_cast<void>(read_grid(folder / "g.aogrid.exr")), InputError);
    std::filesystem::remove(folder / "g.aogrid.exr");
    EXPECT_THROW(static_cast<void>(read_grid(folder / "g.aogrid.json")), InputError);
}

}  // namespace
}  // namespace surfelao

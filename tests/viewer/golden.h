/// golden.h: pictures that were looked at, in tests/viewer/golden.
///
/// SURFELAO_UPDATE_GOLDEN=1 writes them anew: look at what changed before it is kept.
#pragma once

#include "image/difference.h"
#include "image/image_file.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace surfelao::test {

inline void expect_golden(const std::string& name, const Image& actual)
{
    namespace fs = std::filesystem;
    const fs::path expected_file = fs::path(SURFELAO_GOLDEN_FOLDER) / (name + ".png");
    if (std::getenv("SURFELAO_UPDATE_GOLDEN"))
        write_image(expected_file, actual);
    const Image expected = read_image(expected_file);
    ASSERT_EQ(expected.width, actual.width);
    ASSERT_EQ(expected.height, actual.height);
    const ImageDifference difference = compare_images(actual, expected);
    const bool agrees = difference.mean < 1.0 / 255.0 && difference.share_beyond < 0.005;
    EXPECT_TRUE(agrees) << name << ": mean " << 255.0 * difference.mean << " / 255, share beyond "
                        << difference.share_beyond << "; see " << testing::TempDir();
    if (!agrees) {
        const fs::path folder = testing::TempDir();
        write_image(folder / (name + "_actual.png"), actual);
        write_image(folder / (name + "_expected.png"), expected);
        write_image(folder / (name + "_difference.png"), difference_image(actual, expected, 0.1f));
    }
}

}  // namespace surfelao::test

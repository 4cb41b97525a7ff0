// The shaders of the mask engine have their numbers from tree/masks/constants.inc alone.

#include "gpu/shader_source.h"
#include "tree/masks/constants.h"
#include "tree/masks/raster.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace surfelao {
namespace {

std::string without_comments(std::string_view text)
{
    return std::regex_replace(std::string(text), std::regex("//[^\n]*"), "");
}

std::string source_of(std::string_view name)
{
    const auto found = std::ranges::find(shader_files(), name, &ShaderFile::name);
    EXPECT_NE(found, shader_files().end()) << "no shader file " << name;
    return found == shader_files().end() ? "" : without_comments(found->text);
}

const std::vector<std::string> kMaskShaders = {"mask_raster.glsl", "masks_face.frag",
                                               "masks_result.frag", "masks_walk.frag"};

// "const TYPE NAME = VALUE;" in mask_constants.glsl, each number as a driver reads it.
TEST(MaskConstants, TheShadersNumbersAreThoseOfTheTable)
{
    static const std::regex row("const (float|int|uint) (\\w+) = ([^;]+);");
    const std::string text = source_of("mask_constants.glsl");
    std::map<std::string, double> shown;
    for (std::sregex_iterator it(text.begin(), text.end(), row), end; it != end; ++it) {
        const std::string value = (*it)[3];
        shown[(*it)[2]] = (*it)[1] == "float" ? double{std::strtof(value.c_str(), nullptr)}
                                              : double(std::strtoull(value.c_str(), nullptr, 0));
    }
    std::map<std::string, double> expected;
    const auto add = [&](const std::string& type, const char* name, double value) {
        if (type == "float" || type == "int")
            expected[name] = value;
    };
#define SURFELAO_MASK_CONSTANT(type, name, value) add(#type, #name, double(name));
#define SURFELAO_MASK_FLAG(name, value) expected[#name] = double{name};
#define SURFELAO_MASK_QUALITY(quality, cluster, share_leaf, share_inner, graze)
#define SURFELAO_MASK_LIMIT(distance, weight)
#include "tree/masks/constants.inc"
#undef SURFELAO_MASK_CONSTANT
#undef SURFELAO_MASK_FLAG
#undef SURFELAO_MASK_QUALITY
#undef SURFELAO_MASK_LIMIT
    EXPECT_EQ(shown, expected);
}

// What a shader needs beside 0, 1 and the 32 bits of a word stands in the table. Its tables of rows
// are MaskRaster's.
TEST(MaskConstants, NoShaderHoldsNumbersOfItsOwn)
{
    static const std::regex number("[^\\w.]((\\d+\\.\\d*|\\.\\d+)(e[-+]?\\d+)?|\\d+e[-+]?\\d+)");
    static const std::regex rows("const vec4 kRow\\w+\\[4\\] = vec4\\[4\\]\\([^;]*;");
    for (const std::string& name : kMaskShaders) {
        const std::string text = std::regex_replace(source_of(name), rows, "");
        std::set<std::string> numbers;
        for (std::sregex_iterator it(text.begin(), text.end(), number), end; it != end; ++it)
            numbers.insert((*it)[1]);
        for (const char* const plain : {"0.0", "1.0", "32.0"})
            numbers.erase(plain);
        EXPECT_EQ(numbers, std::set<std::string>{}) << name;
        EXPECT_FALSE(std::regex_search(text, std::regex("(const|#define)[^\n]* kMask"))) << name;
    }
}

TEST(MaskConstants, TheShadersRowsAreThoseOfTheRaster)
{
    const std::string text = source_of("mask_raster.glsl");
    const auto row_values = [&](const std::string& name) {
        std::vector<float> values;
        const std::size_t begin = text.find("const vec4 " + name + "[4] = vec4[4](");
        EXPECT_NE(begin, std::string::npos) << name;
        const std::string table = text.substr(begin, text.find(';', begin) - begin);
        static const std::regex number("-?\\d+\\.\\d+");
        for (std::sregex_iterator it(table.begin(), table.end(), number), end; it != end; ++it)
            values.push_back(std::strtof(it->str().c_str(), nullptr));
        return values;
    };
    const MaskRaster& raster = mask_raster();
    EXPECT_EQ(row_values("kRowV"), std::vector<float>(raster.row_v, raster.row_v + kMaskRows));
    EXPECT_EQ(row_values("kRowShift"),
              std::vector<float>(raster.row_shift, raster.row_shift + kMaskRows));
}

}  // namespace
}  // namespace surfelao

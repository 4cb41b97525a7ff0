#include "gpu/shader_source.h"

#include <gtest/gtest.h>

#include <array>
#include <stdexcept>

namespace surfelao {
namespace {

constexpr ShaderFile kFiles[] = {
    {"a.frag", "#version 330 core\n#include \"b.glsl\"\n#include \"c.glsl\"\nlast\n"},
    {"b.glsl", "b1\n#include \"c.glsl\"\nb3\n"},
    {"c.glsl", "c1\n"},
    {"lost.frag", "#version 330 core\n\n#include \"nowhere.glsl\"\n"},
    {"late.frag", "// words first\n#version 330 core\n"},
};

TEST(ShaderSource, IncludesArePastedOnceAndLinesKeepTheirPlaces)
{
    const std::array<std::string, 1> definitions = {"SIDES 2"};
    const ShaderSource source = assemble_shader(kFiles, "a.frag", definitions);
    EXPECT_EQ(
        source.text,
        "#version 330 core\n#define SIDES 2\n"
        "#line 2 0\n#line 1 1\nb1\n#line 1 2\nc1\n#line 3 1\nb3\n#line 3 0\n#line 4 0\nlast\n");
    EXPECT_EQ(source.files, (std::vector<std::string>{"a.frag", "b.glsl", "c.glsl"}));
}

TEST(ShaderSource, UnknownFilesAndALateVersionAreRefused)
{
    const auto message = [](const char* name) -> std::string {
        try {
            static_cast<void>(assemble_shader(kFiles, name));
        } catch (const std::runtime_error& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_EQ(message("lost.frag"), "lost.frag:3: there is no shader file 'nowhere.glsl'");
    EXPECT_EQ(message("none.frag"), "there is no shader file 'none.frag'");
    EXPECT_EQ(message("late.frag"), "late.frag:1: a shader begins with #version");
}

TEST(ShaderSource, LogsOfAllDriversNameOurFiles)
{
    const std::array<std::string, 2> files = {"a.frag", "b.glsl"};
    EXPECT_EQ(name_files_in_log("1:12(5): error: x\nno place", files),
              "b.glsl:12(5): error: x\nno place\n");
    EXPECT_EQ(name_files_in_log("0(7) : error C1008", files), "a.frag(7) : error C1008\n");
    EXPECT_EQ(name_files_in_log("ERROR: 1:3: 'x'", files), "ERROR: b.glsl:3: 'x'\n");
    EXPECT_EQ(name_files_in_log("7:3: beyond the list", files), "7:3: beyond the list\n");
}

}  // namespace
}  // namespace surfelao

// Broken glTF containers and texts: each is refused in one sentence.
#include "gltf_maker.h"

#include <gtest/gtest.h>

namespace surfelao {
namespace {

using test::refusal;
using test::square;

struct BrokenBytes {
    const char* name;
    const char* sentence;  ///< behind "made.glb: "
    std::string (*make)(const std::string& good_glb);
};

void PrintTo(const BrokenBytes& broken, std::ostream* stream)
{
    *stream << broken.name;
}

/// `glb` with a 32-bit number replaced.
std::string patched(std::string glb, std::size_t offset, std::uint32_t value)
{
    std::memcpy(glb.data() + offset, &value, sizeof value);
    return glb;
}

const BrokenBytes kBrokenBytes[] = {
    {"Magic", "GLB header has 4 bytes instead of 12",
     [](const std::string&) { return std::string("glTF"); }},
    {"HeaderCut", "GLB header has 11 bytes instead of 12",
     [](const std::string& glb) { return glb.substr(0, 11); }},
    {"HeaderOnly", "GLB has no JSON chunk",
     [](const std::string& glb) { return patched(glb.substr(0, 12), 8, 12); }},
    {"ContainerOne", "GLB header has version 1, only 2 is read",
     [](const std::string& glb) { return patched(glb, 4, 1); }},
    {"FileCut", "GLB chunk 0 declares 428 bytes, but only 80 follow",
     [](const std::string& glb) { return glb.substr(0, 100); }},
    {"LastByteCut", "GLB chunk 1 declares 60 bytes, but only 59 follow",
     [](const std::string& glb) { return glb.substr(0, glb.size() - 1); }},
    {"JsonChunkPastTheEnd", "GLB chunk 0 declares 100000 bytes, but only 496 follow",
     [](const std::string& glb) { return patched(glb, 12, 100000); }},
    {"JsonChunkHuge", "GLB chunk 0 declares 4294967295 bytes, but only 496 follow",
     [](const std::string& glb) { return patched(glb, 12, 0xFFFFFFFFu); }},
    {"JsonChunkEmpty", "GLB chunk 1 declares 1667310203 bytes, but only 488 follow",
     [](const std::string& glb) { return patched(glb, 12, 0); }},
    {"FirstChunkIsBinary", "GLB chunk 0 is not of type JSON",
     [](const std::string& glb) { return patched(glb, 16, 0x004E4942u); }},
    {"TextEmptyObject", "asset is missing: this is not glTF",
     [](const std::string&) { return std::string("{}"); }},
    {"TextArray", "JSON is not an object",
     [](const std::string&) { return std::string("[1, 2]"); }},
    {"TextNumber", "JSON is not an object", [](const std::string&) { return std::string("7"); }},
    {"TextSpace",
     "JSON: parse error at line 1, column 2: syntax error while parsing value - unexpected end of "
     "input; expected '[', '{', or a literal",
     [](const std::string&) { return std::string(" "); }},
    {"TextNull",
     "JSON: parse error at line 1, column 1: syntax error while parsing value - unexpected end of "
     "input; expected '[', '{', or a literal",
     [](const std::string&) { return std::string(1, '\0'); }},
    {"TextCut",
     "JSON: parse error at line 1, column 19: syntax error while parsing object key - invalid "
     "string: missing closing quote; last read: '\"version'; expected string literal",
     [](const std::string&) { return std::string("{\"asset\":{\"version"); }},
    {"TextTwice",
     "JSON: parse error at line 1, column 4: syntax error while parsing value - unexpected '{'; "
     "expected end of input",
     [](const std::string&) { return std::string("{} {}"); }},
    {"TextComment",
     "JSON: parse error at line 1, column 4: syntax error while parsing value - invalid literal; "
     "last read: '{} /'; expected end of input",
     [](const std::string&) { return std::string("{} // end"); }},
    {"TextBadUnicode",
     "JSON: parse error at line 1, column 3: syntax error while parsing object key - invalid "
     "string: ill-formed UTF-8 byte; last read: '\"?'; expected string literal",
     [](const std::string&) { return std::string("{\"\xFF\": 1}"); }},
    {"TextNumberOverflows", "JSON: number overflow parsing '1e999'",
     [](const std::string&) { return std::string("{\"a\": 1e999}"); }},
    {"TextDeep", "JSON is nested deeper than 256 levels",
     [](const std::string&) { return std::string(100000, '['); }},
    {"TextDeepObjects", "JSON is nested deeper than 256 levels",
     [](const std::string&) {
         std::string text;
         for (int i = 0; i < 100000; ++i)
             text += "{\"a\":";
         return text;
     }},
    {"TextDeepInExtras", "JSON is nested deeper than 256 levels",
     [](const std::string&) {
         return "{\"asset\":{\"version\":\"2.0\"},\"extras\":" + std::string(300, '[') +
                std::string(300, ']') + "}";
     }},
    {"Obj",
     "JSON: parse error at line 1, column 1: syntax error while parsing value - invalid literal; "
     "last read: 'v'",
     [](const std::string&) { return std::string("v 0 0 0\nv 1 0 0\nf 1 2 3\n"); }},
};

class GltfBrokenBytes : public testing::TestWithParam<BrokenBytes> {};

TEST_P(GltfBrokenBytes, AreRefusedInOneSentence)
{
    EXPECT_EQ(refusal(GetParam().make(square().glb())), GetParam().sentence);
}

INSTANTIATE_TEST_SUITE_P(Each, GltfBrokenBytes, testing::ValuesIn(kBrokenBytes),
                         [](const auto& test) { return std::string(test.param.name); });

// Wherever a file is cut, it is refused: no length is trusted.
TEST(GltfBrokenBytes, EveryCutIsRefused)
{
    const std::string glb = square().glb();
    for (std::size_t size = 0; size < glb.size(); ++size)
        EXPECT_NE(refusal(glb.substr(0, size)), "was read") << "cut to " << size;
}

}  // namespace
}  // namespace surfelao

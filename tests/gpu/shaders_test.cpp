// Every shader of shaders/ compiles, links and keeps its contract.

#include "gpu/program.h"
#include "gpu/shader_source.h"
#include "tests/gpu/contexts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace surfelao {
namespace {

std::string text_of(std::string_view name)
{
    const auto found = std::ranges::find(shader_files(), name, &ShaderFile::name);
    EXPECT_NE(found, shader_files().end()) << "no shader file " << name;
    return found == shader_files().end() ? "" : std::string(found->text);
}

/// The file with everything it includes, as one text.
std::string text_with_includes(const std::string& name)
{
    static const std::regex include("#include \"([^\"]+)\"");
    const std::string text = text_of(name);
    std::string all = text;
    for (std::sregex_iterator it(text.begin(), text.end(), include), end; it != end; ++it)
        all += text_with_includes((*it)[1]);
    return all;
}

/// The words in the comments of a file that match.
std::set<std::string> comment_words(const std::string& text, const std::regex& word)
{
    static const std::regex comment("//[^\n]*");
    std::set<std::string> words;
    for (std::sregex_iterator line(text.begin(), text.end(), comment), end; line != end; ++line) {
        const std::string content = line->str();
        for (std::sregex_iterator it(content.begin(), content.end(), word); it != end; ++it)
            words.insert(it->str());
    }
    return words;
}

std::vector<std::string> fragment_files()
{
    std::vector<std::string> names;
    for (const ShaderFile& file : shader_files())
        if (file.name.ends_with(".frag"))
            names.emplace_back(file.name);
    return names;
}

/// The names in the contract's line "Definitions  A B: ...", each as 1: the most code there is.
std::vector<std::string> all_definitions(const std::string& text)
{
    std::smatch line;
    std::vector<std::string> definitions;
    if (!std::regex_search(text, line, std::regex("// Definitions +([A-Z_ ]+):")))
        return definitions;
    const std::string names = line[1];
    static const std::regex name("[A-Z_]+");
    for (std::sregex_iterator it(names.begin(), names.end(), name), end; it != end; ++it)
        definitions.push_back(it->str() + " 1");
    return definitions;
}

// The contract at the top of a .frag names the .vert it is drawn with ("Vertices  x.vert"); every
// u_ name in the comments of the two and of what they include is a uniform of the linked program,
// and the other way round.
TEST(Shaders, EachFragmentShaderLinksAndUsesTheUniformsOfItsContract)
{
    for (const std::string& name : fragment_files()) {
        const std::string text = text_of(name);
        const std::set<std::string> vertex = comment_words(text, std::regex("\\w+\\.vert"));
        ASSERT_EQ(vertex.size(), 1u) << name << " names its vertex shader once, as 'x.vert'";
        const Program program(test_context(), *vertex.begin(), name, all_definitions(text));

        const std::regex uniform("\\bu_\\w+");
        std::set<std::string> promised = comment_words(text_with_includes(name), uniform);
        promised.merge(comment_words(text_with_includes(*vertex.begin()), uniform));
        const std::vector<std::string> uniforms = program.uniforms();
        EXPECT_EQ(promised, std::set<std::string>(uniforms.begin(), uniforms.end())) << name;
    }
}

TEST(Shaders, EveryVertexShaderIsUsed)
{
    std::set<std::string> used;
    for (const std::string& name : fragment_files())
        used.merge(comment_words(text_of(name), std::regex("\\w+\\.vert")));
    for (const ShaderFile& file : shader_files())
        EXPECT_TRUE(!file.name.ends_with(".vert") || used.contains(std::string(file.name)))
            << file.name;
}

}  // namespace
}  // namespace surfelao

// What viewers show of a glTF result: COLOR_0, occlusion textures, and the file's own looks.
#include "gltf_maker.h"
#include "written_gltf.h"

#include "files/gltf_uri.h"
#include "files/maker_mark.h"

#include <tiny_gltf.h>

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace surfelao {
namespace {

using nlohmann::json;
using test::bytes_of;
using test::GltfMaker;
using test::pattern;
using test::primitive;
using test::round_trip;
using test::square;
using test::take_apart;
using test::Written;

constexpr VertexColors kAll[] = {VertexColors::automatic, VertexColors::grey, VertexColors::shaded,
                                 VertexColors::keep, VertexColors::bent};

/// One texel.
constexpr const char* kWhitePng =
    "data:image/"
    "png;base64,"
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR42mP4DwABAQEAHLCMmQAAAABJRU5ErkJggg==";

GltfMaker coloured_square()
{
    GltfMaker maker = square();
    const int colors = maker.add_accessor(
        maker.add_view(bytes_of<std::uint8_t>(
            {255, 0, 51, 255, 255, 0, 51, 255, 255, 0, 51, 255, 255, 0, 51, 102})),
        5121, "VEC4", 4);
    maker.document["accessors"][static_cast<std::size_t>(colors)]["normalized"] = true;
    primitive(maker)["attributes"]["COLOR_0"] = colors;
    return maker;
}

GltfMaker white_square()
{
    GltfMaker maker = square();
    primitive(maker)["attributes"]["COLOR_0"] =
        maker.add_vectors<float>({1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1});
    return maker;
}

/// With `sets` sets of texture coordinates.
GltfMaker textured_square(int sets = 1)
{
    GltfMaker maker = square();
    const int coordinates = maker.add_accessor(
        maker.add_view(bytes_of<float>({0, 0, 1, 0, 1, 1, 0, 1})), 5126, "VEC2", 4);
    for (int set = 0; set < sets; ++set)
        primitive(maker)["attributes"]["TEXCOORD_" + std::to_string(set)] = coordinates;
    maker.add("images", {{"uri", kWhitePng}});
    maker.add("textures", {{"source", 0}});
    maker.add("materials",
              {{"name", "wood"}, {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
    primitive(maker)["material"] = 0;
    return maker;
}

/// Its material is used by points as well, which get no occlusion.
GltfMaker shared_material()
{
    GltfMaker maker = textured_square();
    maker.document["meshes"][0]["primitives"].push_back(
        {{"attributes", {{"POSITION", 0}}}, {"mode", 0}, {"material", 0}});
    return maker;
}

GltfMaker occluded_square()
{
    GltfMaker maker = textured_square();
    maker.document["materials"][0]["occlusionTexture"] = {{"index", 0}};
    return maker;
}

struct Made {
    std::string name;
    GltfMaker maker;
    std::string shown_by;  ///< the attribute that a default bake gives; empty: none
};

std::vector<Made> all_made()
{
    GltfMaker twice = textured_square();
    twice.add("nodes", {{"mesh", 0}, {"translation", {0, 0, 1}}});
    twice.document["scenes"][0]["nodes"] = {0, 1};
    GltfMaker painted = coloured_square();
    painted.add("materials", {{"name", "paint"}});
    primitive(painted)["material"] = 0;
    GltfMaker plain = square();
    plain.add("materials", {{"name", "plain"}, {"normalTexture", {{"index", 0}}}});
    primitive(plain)["material"] = 0;
    return {{"bare", square(), "COLOR_0"},
            {"plain", plain, "COLOR_0"},
            {"white", white_square(), "COLOR_0"},
            {"coloured", coloured_square(), "TEXCOORD_0"},
            {"painted", painted, "TEXCOORD_0"},
            {"textured", textured_square(), "TEXCOORD_1"},
            {"textured twice", textured_square(2), "TEXCOORD_2"},
            {"used twice", twice, "TEXCOORD_1"},
            {"shared", shared_material(), "TEXCOORD_1"},
            {"occluded", occluded_square(), ""}};
}

/// The red of a picture between its texels, as a sampler LINEAR, CLAMP_TO_EDGE has it.
double filtered(const tinygltf::Image& image, double u)
{
    const double x = u * image.width - 0.5;
    const auto texel = [&](double column) {
        const auto at = static_cast<std::size_t>(std::fmin(std::fmax(column, 0), image.width - 1));
        return image.image[at * static_cast<std::size_t>(image.component)] / 255.0;
    };
    return std::lerp(texel(std::floor(x)), texel(std::floor(x) + 1.0), x - std::floor(x));
}

/// The visibility that another reader sees at each vertex of the first primitive.
std::vector<double> shown_visibility(const std::string& glb, const std::string& attribute)
{
    tinygltf::TinyGLTF reader;
    tinygltf::Model model;
    std::string error, warning;
    EXPECT_TRUE(reader.LoadBinaryFromMemory(&model, &error, &warning,
                                            reinterpret_cast<const unsigned char*>(glb.data()),
                                            static_cast<unsigned int>(glb.size()), "."))
        << error;
    if (attribute.empty())
        return {};
    const Written written = take_apart(glb);
    const std::vector<float> values = written.floats(written.attributes(0)[attribute]);
    const auto accessor = written.attributes(0)[attribute].get<std::size_t>();
    EXPECT_EQ(model.accessors[accessor].componentType, TINYGLTF_COMPONENT_TYPE_FLOAT);
    std::vector<double> shown;
    if (attribute == "COLOR_0") {
        for (std::size_t v = 0; v < values.size(); v += 4)
            shown.push_back(values[v]);
        return shown;
    }
    const tinygltf::Primitive& first = model.meshes[0].primitives[0];
    const tinygltf::OcclusionTextureInfo& info =
        model.materials[static_cast<std::size_t>(first.material)].occlusionTexture;
    EXPECT_EQ("TEXCOORD_" + std::to_string(info.texCoord), attribute);
    const tinygltf::Texture& texture = model.textures[static_cast<std::size_t>(info.index)];
    const tinygltf::Sampler& sampler = model.samplers[static_cast<std::size_t>(texture.sampler)];
    EXPECT_EQ(sampler.minFilter, TINYGLTF_TEXTURE_FILTER_LINEAR);
    EXPECT_EQ(sampler.wrapS, TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE);
    for (std::size_t v = 0; v < values.size(); v += 2)
        shown.push_back(
            filtered(model.images[static_cast<std::size_t>(texture.source)], values[v]));
    return shown;
}

std::set<std::string> names_of(const json& attributes)
{
    std::set<std::string> names;
    for (const auto& [name, accessor] : attributes.items())
        names.insert(name);
    return names;
}

TEST(GltfLooks, ADefaultBakeShowsTheVisibilityAndTintsNothing)
{
    for (const Made& made : all_made()) {
        const Scene scene = read_gltf("in.glb", made.maker.glb());
        const std::string glb = gltf_contents("out.glb", scene, pattern(scene)).contents;
        std::set<std::string> wanted = names_of(primitive(made.maker)["attributes"]);
        const bool is_white = wanted.contains("COLOR_0") && made.shown_by == "COLOR_0";
        wanted.insert({"_OCCLUSION", "_BENT_NORMAL"});
        wanted.insert(is_white ? "_OWN_COLOR" : "_OCCLUSION");
        wanted.insert(made.shown_by.empty() ? "_OCCLUSION" : made.shown_by);
        EXPECT_EQ(names_of(take_apart(glb).attributes(0)), wanted) << made.name;
        const std::vector<double> shown = shown_visibility(glb, made.shown_by);
        for (std::size_t v = 0; v < shown.size(); ++v)
            EXPECT_NEAR(shown[v], 1.0 - 0.25 * static_cast<double>(v), 1e-5) << made.name;
        EXPECT_EQ(shown.size(), made.shown_by.empty() ? 0u : 4u) << made.name;
    }
}

TEST(GltfLooks, ColorsAreWhatIsAskedFor)
{
    const auto colors = [](const GltfMaker& maker, const WriteOptions& options) {
        const Written written = round_trip(maker, options);
        return written.floats(written.attributes(0)["COLOR_0"]);
    };
    const auto expect = [](const std::vector<float>& values, std::size_t vertex,
                           const std::vector<float>& wanted) {
        ASSERT_EQ(values.size(), 16u);
        for (std::size_t k = 0; k < 4; ++k)
            EXPECT_NEAR(values[4 * vertex + k], wanted[k], 1e-5f) << vertex << ' ' << k;
    };
    const GltfMaker maker = coloured_square();
    expect(colors(maker, {.colors = VertexColors::shaded}), 1, {0.75f, 0, 0.15f, 1});
    expect(colors(maker, {.colors = VertexColors::shaded}), 3, {0.25f, 0, 0.05f, 0.4f});
    expect(colors(maker, {.colors = VertexColors::grey}), 3, {0.25f, 0.25f, 0.25f, 0.4f});
    expect(colors(maker, {.colors = VertexColors::bent}), 0, {0.5f, 0.5f, 1, 1});
    expect(colors(maker, {.colors = VertexColors::grey, .encoding = Encoding::srgb}), 3,
           {0.53710f, 0.53710f, 0.53710f, 0.4f});
    expect(colors(square(), {.colors = VertexColors::shaded}), 2, {0.5f, 0.5f, 0.5f, 1});
}

TEST(GltfLooks, TheOwnColorsStayInTheFile)
{
    for (const VertexColors what : kAll) {
        const json attributes = round_trip(coloured_square(), {.colors = what}).attributes(0);
        const bool kept = what == VertexColors::keep || what == VertexColors::automatic;
        EXPECT_EQ(attributes[kept ? "COLOR_0" : "_OWN_COLOR"], 2) << name_of(what);
        EXPECT_EQ(attributes.contains("_OWN_COLOR"), !kept) << name_of(what);
    }
}

TEST(GltfLooks, AMaterialThatOthersUseIsCopied)
{
    const json alone = round_trip(textured_square()).document;
    EXPECT_EQ(alone["materials"].size(), 1u);
    EXPECT_EQ(alone["materials"][0]["occlusionTexture"], (json{{"index", 1}, {"texCoord", 1}}));
    const json shared = round_trip(shared_material()).document;
    ASSERT_EQ(shared["materials"].size(), 2u);
    EXPECT_EQ(shared["materials"][0], shared_material().document["materials"][0]);
    const json& primitives = shared["meshes"][0]["primitives"];
    EXPECT_EQ(primitives[0]["material"], 1);
    EXPECT_EQ(primitives[1]["material"], 0);
}

// Blender shows colours of materials only, and three.js takes none for metal.
TEST(GltfLooks, ColorsWithoutAMaterialGetAPlainOne)
{
    for (const VertexColors colors : kAll) {
        json document = round_trip(square(), {.colors = colors}).document;
        const bool keeps = colors == VertexColors::keep;
        EXPECT_EQ(document.contains("materials"), !keeps) << name_of(colors);
        EXPECT_EQ(document["meshes"][0]["primitives"][0].value("material", -1), keeps ? -1 : 0);
    }
}

TEST(GltfLooks, ANoteTellsWhatKeepsItsLooks)
{
    GltfMaker maker = occluded_square();
    json& primitives = maker.document["meshes"][0]["primitives"];
    primitives.push_back(primitive(textured_square()));
    primitives.push_back(primitive(textured_square()));
    maker.add("materials", textured_square().document["materials"][0]);
    primitives[1]["material"] = primitives[2]["material"] = 1;
    const auto notes = [](const GltfMaker& made, VertexColors colors) {
        const Scene scene = read_gltf("in.glb", made.glb());
        return gltf_contents("out.glb", scene, pattern(scene), {.colors = colors}).notes;
    };
    using Notes = std::vector<std::string>;
    for (const VertexColors colors : kAll) {
        const bool automatic = colors == VertexColors::automatic;
        EXPECT_EQ(notes(maker, colors),
                  automatic ? Notes{"primitives with looks of their own: 2 get an "
                                    "occlusionTexture, 1 keeps the occlusionTexture it has "
                                    "(--colors grey or shaded shows the visibility as colours)"}
                            : Notes{});
        EXPECT_EQ(notes(coloured_square(), colors),
                  automatic ? Notes{"primitives with looks of their own: 1 gets an "
                                    "occlusionTexture; 1 of them keeps its colours "
                                    "(--colors grey or shaded shows the visibility as colours)"}
                            : Notes{});
        EXPECT_EQ(notes(square(), colors), Notes{});
    }
}

/// Baked in memory, as a bake marks it.
std::string baked(const char* path, const std::string& contents, VertexColors colors)
{
    const Scene scene = read_gltf(path, contents);
    return gltf_contents(path, scene, pattern(scene),
                         {.colors = colors, .mark = make_mark("bake", name_of(colors))})
        .contents;
}

TEST(GltfLooks, BakingABakedFileIsBakingTheOriginal)
{
    for (const auto& [name, maker, attribute] : all_made()) {
        for (const char* path : {"out.glb", "out.gltf"}) {
            const std::string original =
                std::string(path) == "out.glb"
                    ? maker.glb()
                    : maker.gltf(make_data_uri("application/octet-stream", maker.bin));
            std::vector<std::string> once;
            for (const VertexColors colors : kAll)
                once.push_back(baked(path, original, colors));
            for (std::size_t first = 0; first < std::size(kAll); ++first) {
                for (std::size_t second = 0; second < std::size(kAll); ++second)
                    EXPECT_TRUE(baked(path, once[first], kAll[second]) == once[second])
                        << name << ' ' << path << ' ' << name_of(kAll[first]) << ' '
                        << name_of(kAll[second]);
            }
        }
    }
}

// What another program has put behind our data keeps them in the file, but out of use.
TEST(GltfLooks, AnEditedResultIsNotShadedTwice)
{
    struct Row {
        GltfMaker maker;
        VertexColors colors;
        const char* shown_by;
    };
    for (const Row& row : {Row{coloured_square(), VertexColors::shaded, "COLOR_0"},
                           Row{white_square(), VertexColors::automatic, "COLOR_0"},
                           Row{textured_square(), VertexColors::automatic, "TEXCOORD_1"},
                           Row{shared_material(), VertexColors::automatic, "TEXCOORD_1"}}) {
        const std::string uri = make_data_uri("application/octet-stream", row.maker.bin);
        const Written once = take_apart(baked("x.gltf", row.maker.gltf(uri), row.colors));
        json edited = once.document;
        edited["accessors"].push_back(edited["accessors"][0]);
        for (const char* list : {"materials", "textures"})
            edited[list].push_back({{"name", "new"}});
        const Written again = take_apart(baked("x.gltf", edited.dump(), row.colors));
        EXPECT_EQ(names_of(again.attributes(0)), names_of(once.attributes(0)));
        EXPECT_EQ(again.floats(again.attributes(0)[row.shown_by]),
                  once.floats(once.attributes(0)[row.shown_by]));
    }
}

}  // namespace
}  // namespace surfelao

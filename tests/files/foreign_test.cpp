// What is read through assimp: the same board in three formats, and programs that end badly.
#include "files/foreign_io.h"
#include "files/scene_io.h"
#include "files/sidecars.h"
#include "surfels/errors.h"
#include "temporary_folder.h"

#include <gtest/gtest.h>
#include <minizip/zip.h>

#include <signal.h>

#include <algorithm>
#include <fstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace surfelao {
namespace {

namespace fs = std::filesystem;

// A board of 1 by 2 metres, half a metre up. COLLADA and FBX have it in centimetres and z upwards.

constexpr const char* kColladaHead = R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="centimeter" meter="0.01"/><up_axis>Z_UP</up_axis></asset>
)";

constexpr const char* kColladaBoard = R"(
<library_images><image id="i"><init_from>wood.png</init_from></image></library_images>
<library_effects>
<effect id="plain"><profile_COMMON><technique sid="c"><lambert><diffuse>
<color>0.8 0.4 0.2 1</color></diffuse></lambert></technique></profile_COMMON></effect>
<effect id="wood"><profile_COMMON>
<newparam sid="f"><surface type="2D"><init_from>i</init_from></surface></newparam>
<newparam sid="s"><sampler2D><source>f</source></sampler2D></newparam>
<technique sid="c"><lambert><diffuse><texture texture="s" texcoord="UV"/></diffuse></lambert>
</technique></profile_COMMON></effect></library_effects>
<library_materials><material id="m" name="Paint"><instance_effect url="#EFFECT"/></material>
</library_materials>
<library_geometries><geometry id="g" name="Plank"><mesh>
<source id="p"><float_array id="pa" count="12">0 0 0 100 0 0 100 200 0 0 200 0</float_array>
<technique_common><accessor source="#pa" count="4" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<source id="n"><float_array id="na" count="3">0 0 1</float_array>
<technique_common><accessor source="#na" count="1" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<source id="t"><float_array id="ta" count="8">0 0 1 0 1 0.25 0 0.25</float_array>
<technique_common><accessor source="#ta" count="4" stride="2"><param name="S" type="float"/>
<param name="T" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<polylist material="M" count="1"><input semantic="VERTEX" source="#v" offset="0"/>
<input semantic="NORMAL" source="#n" offset="1"/>
<input semantic="TEXCOORD" source="#t" offset="2" set="0"/>
<vcount>4</vcount><p>0 0 0 1 0 1 2 0 2 3 0 3</p></polylist></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="b" name="Board">
<translate>0 0 50</translate><instance_geometry url="#g"><bind_material><technique_common>
<instance_material symbol="M" target="#m"/></technique_common></bind_material></instance_geometry>
</node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>
)";

std::string collada_board(const std::string& effect)
{
    std::string text = std::string(kColladaHead) + kColladaBoard;
    return text.replace(text.find("EFFECT"), 6, effect);
}

constexpr const char* kX3dBoard = R"(<?xml version="1.0"?>
<X3D version="3.0"><Scene><Transform DEF="Board" translation="0 0.5 0"><Shape>
<IndexedFaceSet coordIndex="0 1 2 3 -1"><Coordinate point="0 0 0 1 0 0 1 0 -2 0 0 -2"/>
</IndexedFaceSet></Shape></Transform></Scene></X3D>
)";

constexpr const char* kFbxBoard = R"(; FBX 7.4.0 project file
FBXHeaderExtension:  {
	FBXHeaderVersion: 1003
	FBXVersion: 7400
}
GlobalSettings:  {
	Version: 1000
	Properties70:  {
		P: "UpAxis", "int", "Integer", "",2
		P: "UpAxisSign", "int", "Integer", "",1
		P: "FrontAxis", "int", "Integer", "",1
		P: "FrontAxisSign", "int", "Integer", "",-1
		P: "CoordAxis", "int", "Integer", "",0
		P: "CoordAxisSign", "int", "Integer", "",1
		P: "UnitScaleFactor", "double", "Number", "",1
	}
}
Objects:  {
	Geometry: 10, "Geometry::Plank", "Mesh" {
		Vertices: *12 {
			a: 0,0,0,100,0,0,100,200,0,0,200,0
		}
		PolygonVertexIndex: *4 {
			a: 0,1,2,-4
		}
		GeometryVersion: 124
	}
	Model: 20, "Model::Board", "Mesh" {
		Version: 232
		Properties70:  {
			P: "Lcl Translation", "Lcl Translation", "", "A",0,0,50
		}
	}
}
Connections:  {
	C: "OO",20,0
	C: "OO",10,20
}
)";

/// Goes into its objects and its connections: the board rises within a second.
constexpr const char* kFbxAnimation = R"(
	AnimationStack: 30, "AnimStack::Rise", "" {
		Properties70:  {
			P: "LocalStop", "KTime", "Time", "",46186158000
		}
	}
	AnimationLayer: 31, "AnimLayer::Base", "" {
	}
	AnimationCurveNode: 32, "AnimCurveNode::T", "" {
		Properties70:  {
			P: "d|Z", "Number", "", "A",50
		}
	}
	AnimationCurve: 33, "AnimCurve::", "" {
		Default: 0
		KeyVer: 4009
		KeyTime: *2 {
			a: 0,46186158000
		}
		KeyValueFloat: *2 {
			a: 50,90
		}
	}
)";
constexpr const char* kFbxConnections = R"(	C: "OO",31,30
	C: "OO",32,31
	C: "OP",32,20, "Lcl Translation"
	C: "OP",33,32, "d|Z"
)";

/// Whether a vertex of the scene stands there; what assimp computes is a float's.
bool has_vertex(const Scene& scene, const glm::dvec3& place)
{
    return std::ranges::any_of(scene.positions, [&](const glm::dvec3& position) {
        const glm::dvec3 off = position - place;
        return off.x * off.x + off.y * off.y + off.z * off.z < 1e-12;
    });
}

bool has_label(const Scene& scene, LabelKind kind, const std::string& name)
{
    return std::ranges::any_of(
        scene.labels, [&](const Label& label) { return label.kind == kind && label.name == name; });
}

TEST(Foreign, TheSameBoardStandsInTheSamePlaceInEveryFormat)
{
    const TemporaryFolder folder;
    for (const auto& [name, text] :
         {std::pair<const char*, std::string>{"board.dae", collada_board("plain")},
          {"board.X3D", kX3dBoard},
          {"board.fbx", kFbxBoard}}) {
        const Scene scene = read_scene(folder.file(name, text));
        EXPECT_EQ(scene.triangles.size(), 2u) << name;
        EXPECT_EQ(scene.positions.size(), 4u) << name;
        for (const glm::dvec3 corner : {glm::dvec3(0, .5, 0), glm::dvec3(1, .5, 0),
                                        glm::dvec3(1, .5, -2), glm::dvec3(0, .5, -2)})
            EXPECT_TRUE(has_vertex(scene, corner)) << name << " at z " << corner.z;
        EXPECT_TRUE(has_label(scene, LabelKind::node, "Board")) << name;
        EXPECT_TRUE(scene.notes.front().starts_with("read through assimp 5.")) << name;
    }
}

TEST(Foreign, NamesNormalsUvsAndColoursAreKept)
{
    const TemporaryFolder folder;
    const Scene scene = read_scene(folder.file("board.dae", collada_board("plain")));
    EXPECT_TRUE(has_label(scene, LabelKind::mesh, "Plank"));
    EXPECT_TRUE(has_label(scene, LabelKind::material, "Paint"));
    ASSERT_EQ(scene.normals.values.size(), 4u);
    EXPECT_NEAR(scene.normals.values[0].y, 1.0f, 1e-6f);
    ASSERT_EQ(scene.uvs.size(), 1u);
    // the file's v = .25 is three quarters down
    const auto lowest = std::ranges::min_element(scene.uvs[0].values, {},
                                                 [](const glm::dvec2& uv) { return uv.y; });
    EXPECT_EQ(lowest->y, 0.75);
    const BaseColors colors = scene.asset->base_colors();
    ASSERT_EQ(colors.materials.size(), 1u);
    EXPECT_FLOAT_EQ(colors.materials[0].factor.x, 0.8f);
    EXPECT_FLOAT_EQ(colors.materials[0].factor.z, 0.2f);
}

TEST(Foreign, TexturesBesideTheFileAreFound)
{
    const TemporaryFolder folder;
    const fs::path board = folder.file("board.dae", collada_board("wood"));
    const fs::path wood = folder.file("wood.png", "a picture");
    const BaseColors colors = read_scene(board).asset->base_colors();
    ASSERT_EQ(colors.pictures.size(), 1u);
    EXPECT_EQ(colors.pictures[0].file, wood);
    EXPECT_EQ(colors.materials[0].factor, glm::vec3(1.0f));  // a texture stands in its place
    EXPECT_EQ(sidecars_of(board), std::vector{wood});
}

TEST(Foreign, ResultsAreGlbPlyAndObj)
{
    const TemporaryFolder folder;
    const fs::path board = folder.file("board.dae", collada_board("plain"));
    const Scene scene = read_scene(board);
    const std::vector<Occlusion> answers(4, Occlusion{.occlusion = 0.5f});
    for (const char* name : {"board.glb", "board.ply", "board.obj"}) {
        const fs::path result = folder / name;
        EXPECT_NO_THROW(check_output(board, result)) << name;
        write_scene(result, scene, answers);
        EXPECT_TRUE(has_vertex(read_scene(result), {1, .5, -2})) << name;
    }
}

// Files of Debian's assimp-testmodels: formats that are no text.
TEST(Foreign, BinaryFormats)
{
    const fs::path models = "/usr/share/assimp/models";
    for (const auto& [name, triangle_count] :
         {std::pair<const char*, std::size_t>{"3DS/cube_with_diffuse_texture.3DS", 12},
          {"3MF/box.3mf", 12},
          {"FBX/box.fbx", 12},
          {"Collada/duck.zae", 4212}})
        EXPECT_EQ(read_scene(models / name).triangles.size(), triangle_count) << name;
}

TEST(Foreign, WhatRestsIsTold)
{
    const Scene scene = read_scene("/usr/share/assimp/models/Collada/box_nested_animation.dae");
    EXPECT_NE(std::ranges::find(scene.notes, "animations are left out: 1"), scene.notes.end());
}

TEST(Foreign, AnimationsOfFbxAreToldToo)
{
    const TemporaryFolder folder;
    std::string text = kFbxBoard;
    text.insert(text.find("}\nConnections"), kFbxAnimation);
    text.insert(text.rfind('}'), kFbxConnections);
    const Scene scene = read_scene(folder.file("board.fbx", text));
    EXPECT_NE(std::ranges::find(scene.notes, "animations are left out: 1"), scene.notes.end());
    EXPECT_TRUE(has_vertex(scene, {1, .5, -2}));
}

/// A 3MF of one triangle, with this in the element of its model.
fs::path triangle_of_3mf(const TemporaryFolder& folder, const std::string& unit)
{
    const fs::path path = folder / "triangle.3mf";
    const zipFile archive = zipOpen64(path.c_str(), APPEND_STATUS_CREATE);
    for (const auto& [name, text] :
         {std::pair<const char*, std::string>{
              "_rels/.rels",
              "<Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/"
              "relationships\"><Relationship Id=\"r\" Target=\"/3D/3dmodel.model\" "
              "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/>"
              "</Relationships>"},
          {"3D/3dmodel.model",
           "<?xml version=\"1.0\"?><model " + unit +
               " xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">"
               "<resources><object id=\"1\" type=\"model\"><mesh><vertices>"
               "<vertex x=\"0\" y=\"0\" z=\"0\"/><vertex x=\"100\" y=\"0\" z=\"0\"/>"
               "<vertex x=\"0\" y=\"0\" z=\"200\"/></vertices><triangles>"
               "<triangle v1=\"0\" v2=\"1\" v3=\"2\"/></triangles></mesh></object></resources>"
               "<build><item objectid=\"1\"/></build></model>"}}) {
        zipOpenNewFileInZip(archive, name, nullptr, nullptr, 0, nullptr, 0, nullptr, Z_DEFLATED, 1);
        zipWriteInFileInZip(archive, text.data(), static_cast<unsigned>(text.size()));
        zipCloseFileInZip(archive);
    }
    zipClose(archive, nullptr);
    return path;
}

TEST(Foreign, Of3mfTheUnitCounts)
{
    const TemporaryFolder folder;
    EXPECT_TRUE(has_vertex(read_scene(triangle_of_3mf(folder, "")), {0, 0.2, 0}));
    EXPECT_TRUE(has_vertex(read_scene(triangle_of_3mf(folder, "xml:lang='en' unit='inch'")),
                           {0, 200 * 0.0254, 0}));
    try {
        static_cast<void>(read_scene(triangle_of_3mf(folder, "unit=\"furlong\"")));
        ADD_FAILURE() << "a furlong is read";
    } catch (const InputError& error) {
        EXPECT_TRUE(std::string(error.what()).ends_with("its unit \"furlong\" is none of 3MF"))
            << error.what();
    }
}

// What COLLADA calls clear may be solid, what X3D calls so is.
TEST(Foreign, AnOpacityOfNothingIsBelievedWhereItIsMeant)
{
    const TemporaryFolder folder;
    std::string collada = collada_board("plain");
    collada.insert(collada.find("</lambert>"),
                   "<transparent opaque=\"A_ONE\"><color>1 1 1 1</color></transparent>"
                   "<transparency><float>0</float></transparency>");
    const Scene solid = read_scene(folder.file("board.dae", collada));
    EXPECT_EQ(solid.asset->base_colors().materials[0].opacity, Opacity::solid);
    EXPECT_NE(std::ranges::find(solid.notes,
                                "materials with an opacity of 0, which DAE has of solid ones too, "
                                "are taken as solid: 1"),
              solid.notes.end());
    std::string x3d = kX3dBoard;
    x3d.insert(x3d.find("<IndexedFaceSet"),
               "<Appearance><Material transparency=\"1\"/></Appearance>");
    const Scene clear = read_scene(folder.file("board.x3d", x3d));
    EXPECT_EQ(clear.asset->base_colors().materials[0].opacity, Opacity::clear);
    EXPECT_EQ(clear.asset->base_colors().materials[0].alpha, 0.0f);
}

TEST(Foreign, NamesInLatin1AreUtf8)
{
    const TemporaryFolder folder;
    std::string cube = contents_of("/usr/share/assimp/models/3DS/cube_with_diffuse_texture.3DS");
    for (std::size_t at = cube.find("Quader01"); at != cube.npos; at = cube.find("Quader01"))
        cube.replace(at, 8, "W\xfcrfel01");
    EXPECT_TRUE(
        has_label(read_scene(folder.file("a.3ds", cube)), LabelKind::node, "W\xc3\xbcrfel01"));
}

TEST(Foreign, UsdIsRefusedWithAWayOut)
{
    const TemporaryFolder folder;
    try {
        static_cast<void>(read_scene(folder.file("a.usdz", "x")));
        ADD_FAILURE() << "USD is read";
    } catch (const InputError& error) {
        EXPECT_TRUE(std::string(error.what()).ends_with("; export USD as .glb")) << error.what();
    }
}

/// The sentence behind the file's name; empty where it is read.
std::string refusal_of(const fs::path& path, const fs::path& program, const ChildLimits& limits)
{
    try {
        static_cast<void>(import_file(path, program, limits));
    } catch (const InputError& error) {
        const std::string said = error.what();
        EXPECT_TRUE(said.starts_with(path.string() + ": ")) << said;
        return said.substr(std::min(said.size(), path.string().size() + 2));
    }
    return {};
}

constexpr ChildLimits kSmall{
    .memory = 1u << 30, .output = 1u << 20, .cpu_seconds = 1, .seconds = 30};

/// A reader that does what a shell is told.
fs::path program_that(const TemporaryFolder& folder, const std::string& does)
{
    const fs::path program = folder.file("program", "#!/bin/sh\n" + does + "\n");
    fs::permissions(program, fs::perms::owner_all);
    return program;
}

TEST(ForeignProgram, EveryBadEndIsASentence)
{
    const TemporaryFolder folder;
    const fs::path file = folder.file("a.fbx", "x");
    const auto sentence = [&](const std::string& does, ChildLimits limits = kSmall) {
        return refusal_of(file, program_that(folder, does), limits);
    };
    EXPECT_EQ(sentence("kill -SEGV $$"), "assimp crashed on it (Segmentation fault)");
    EXPECT_EQ(sentence("kill -ABRT $$"), "assimp crashed on it (Aborted)");
    EXPECT_EQ(sentence("while :; do :; done"),
              "assimp took more than the 1 s of processor time that it may take for this file");
    ChildLimits hasty = kSmall;
    hasty.seconds = 0;
    EXPECT_EQ(sentence("sleep 100", hasty),
              "assimp took longer than the 0 s that it may take for this file");
    EXPECT_EQ(sentence("exec yes"),
              "assimp makes more of it than the 1 MiB that it may take for this file");
    EXPECT_EQ(sentence("echo not enough memory >&2; exit 1"),
              "assimp needs more memory than the 1024 MiB that it may take for this file");
    EXPECT_EQ(sentence("printf 'some line\\n\\nthe \\033 reason\\n' >&2; exit 1"), "the  reason");
    EXPECT_EQ(sentence("exit 3"), "surfelao-import failed with exit code 3");
    EXPECT_EQ(refusal_of(file, folder / "absent", kSmall),
              "surfelao-import failed with exit code 127");
}

// Four thousand million numbers are announced: the limit answers, not the machine.
TEST(ForeignProgram, MemoryIsLimited)
{
    const TemporaryFolder folder;
    std::string text = collada_board("plain");
    text.replace(text.find("count=\"12\""), 10, "count=\"4000000000\"");
    const fs::path file = folder.file("board.dae", text);
    EXPECT_EQ(refusal_of(file, import_program().value(), import_limits(text.size())),
              "assimp needs more memory than the 512 MiB that it may take for this file");
}

TEST(ForeignProgram, NoneIsLeftBehindByWhoeverStops)
{
    const TemporaryFolder folder;
    const fs::path file = folder.file("a.fbx", "x");
    const fs::path told = folder / "told";
    const fs::path program =
        program_that(folder, "echo $$ >" + told.string() + ".new; mv " + told.string() + ".new " +
                                 told.string() + "; exec sleep 100");
    EXPECT_THROW(static_cast<void>(
                     import_file(file, program, kSmall, [&](double) { return !fs::exists(told); })),
                 Cancelled);
    pid_t child = 0;
    std::ifstream(told) >> child;
    ASSERT_GT(child, 0);
    EXPECT_EQ(kill(child, 0), -1);
}

// As part of a program that ignores SIGCHLD we never learn how a child ended.
TEST(ForeignProgram, AnEndThatNobodyLearnsOfIsNoHang)
{
    const TemporaryFolder folder;
    const fs::path program = program_that(folder, "exit 0");
    const auto before = signal(SIGCHLD, SIG_IGN);
    std::string said;
    try {
        static_cast<void>(import_file(folder.file("a.fbx", "x"), program, kSmall));
    } catch (const std::runtime_error& error) {
        said = error.what();
    }
    signal(SIGCHLD, before);
    EXPECT_TRUE(said.starts_with("another program cannot be waited for")) << said;
}

TEST(ForeignProgram, NotesAreThoseItMarks)
{
    const TemporaryFolder folder;
    const fs::path file = folder.file("a.fbx", "x");
    const ImportedFile imported = import_file(
        file, program_that(folder, "echo a warning >&2; echo note: two lights >&2; printf x"),
        kSmall);
    EXPECT_EQ(imported.notes, std::vector<std::string>{"two lights"});
    EXPECT_EQ(imported.glb, "x");
}

}  // namespace
}  // namespace surfelao

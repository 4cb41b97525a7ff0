#include "gpu/context.h"

#include "gpu/draw.h"
#include "gpu/gl_table.inc"
#include "gpu/objects.h"
#include "gpu/program.h"
#include "tests/gpu/contexts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <span>
#include <stdexcept>
#include <string>
#include <thread>

namespace surfelao {
namespace {

constexpr ShaderFile kTestShaders[] = {
    {"corner.vert",
     "#version 330 core\n"
     "void main() {\n"
     "    gl_Position = vec4(2 * (gl_VertexID & 1) - 1, (gl_VertexID & 2) - 1, 0.0, 1.0);\n"
     "}\n"},
    {"flat.frag",
     "#version 330 core\n"
     "uniform vec4 u_color;\n"
     "out vec4 out_color;\n"
     "void main() { out_color = u_color; }\n"},
    {"fetch.frag",
     "#version 330 core\n"
     "uniform usamplerBuffer u_values;\n"
     "out vec4 out_value;\n"
     "void main() {\n"
     "    out_value = uintBitsToFloat(texelFetch(u_values, int(gl_FragCoord.x)));\n"
     "}\n"},
};

/// fetch.frag with its vertex shader.
std::span<const ShaderFile> fetch_shaders()
{
    static const ShaderFile both[] = {
        *std::ranges::find(shader_files(), "fullscreen.vert", &ShaderFile::name), kTestShaders[2]};
    return both;
}

std::string message_of(const auto& action)
{
    try {
        action();
    } catch (const std::runtime_error& error) {
        return error.what();
    }
    return "nothing was thrown";
}

/// The lower left half of a square target in one colour: n * (n + 1) / 2 pixels, give or take the
/// diagonal, whose rasterisation is the driver's.
void draw_half_a_square(const GlContext& context)
{
    constexpr int kSide = 64;
    const VertexArray vertices(context);
    Program program(context, "corner.vert", "flat.frag", {}, kTestShaders);
    const glm::vec4 color(0.25f, 0.5f, 2.0f, 1.0f);
    program.set("u_color", color);
    const Framebuffer target(context,
                             {.width = kSide, .height = kSide, .colors = {TexelFormat::rgba32f}});
    target.clear_color(glm::vec4(0.0f));
    draw(target, program, vertices, {.count = 3});

    const std::vector<glm::vec4> pixels = target.read_color(target.rect());
    const auto inside = std::ranges::count(pixels, color);
    EXPECT_NEAR(static_cast<double>(inside), kSide * kSide / 2.0, kSide);
    EXPECT_EQ(pixels.front(), color);
    EXPECT_EQ(pixels.back(), glm::vec4(0.0f));
    EXPECT_EQ(inside + std::ranges::count(pixels, glm::vec4(0.0f)), kSide * kSide);
}

TEST(GlContext, OsmesaDrawsATriangle)
{
    const GlContext& context = test_context();
    EXPECT_EQ(context.info().platform, "OSMesa");
    EXPECT_TRUE(context.info().software);
    draw_half_a_square(context);
}

TEST(GlContext, EglDrawsATriangleWithoutADisplay)
{
    const GlContext context = GlContext::create(GlBackend::egl);
    EXPECT_EQ(context.info().platform.substr(0, 3), "EGL");
    draw_half_a_square(context);
}

TEST(GlContext, TwoLibrariesTakeTurnsInOneThread)
{
    const GlContext egl = GlContext::create(GlBackend::egl);
    draw_half_a_square(test_context());
    egl.make_current();
    draw_half_a_square(egl);
    draw_half_a_square(test_context());
}

TEST(GlContext, MovesToAnotherThread)
{
    const GlContext context = GlContext::create(GlBackend::osmesa);
    context.release();
    std::thread worker([&] {
        context.make_current();
        draw_half_a_square(context);
        context.release();
    });
    worker.join();
    context.make_current();
    draw_half_a_square(context);
}

TEST(GlContext, AdoptsAContextThatSomebodyElseOwns)
{
    const GlContext owner = GlContext::create(GlBackend::osmesa);
    const GlTable& functions = owner.gl();
    std::string log;
    const ForeignContext foreign = {
        .get_proc =
            [&](const char* name) {
    // the owner's own table stands in for a window library's lookup
#define SURFELAO_GL_FIND(function, upper)    \
    if (name == std::string("gl" #function)) \
        return reinterpret_cast<void*>(functions.function);
                SURFELAO_GL_FUNCTIONS(SURFELAO_GL_FIND)
#undef SURFELAO_GL_FIND
                return static_cast<void*>(nullptr);
            },
        .make_current =
            [&] {
                owner.make_current();
                log += "made current. ";
            },
        .release = [&] { log += "released. "; },
    };
    {
        const GlContext adopted = GlContext::adopt(foreign);
        EXPECT_EQ(adopted.info().platform, "window");
        draw_half_a_square(adopted);
    }
    EXPECT_EQ(log, "made current. released. ");
}

TEST(GlContext, AContextWithoutTheFunctionsIsRefusedByName)
{
    const ForeignContext foreign = {
        .get_proc = [](const char*) { return nullptr; }, .make_current = [] {}, .release = [] {}};
    const std::string message = message_of([&] { static_cast<void>(GlContext::adopt(foreign)); });
    EXPECT_NE(message.find("window has no function gl"), std::string::npos) << message;
    EXPECT_NE(message.find("OpenGL 3.3 is needed"), std::string::npos) << message;
}

// In a process of its own, where EGL finds no driver and no display.
TEST(GlContextDeathTest, NoDriverIsAnErrorThatSaysWhatWasTried)
{
    testing::FLAGS_gtest_death_test_style = "threadsafe";
    EXPECT_EXIT(
        {
            setenv("LIBGL_DRIVERS_PATH", "/nowhere", 1);
            unsetenv("DISPLAY");
            const std::string message =
                message_of([] { static_cast<void>(GlContext::create(GlBackend::egl)); });
            std::fprintf(stderr, "%s\n", message.c_str());
            std::exit(1);
        },
        testing::ExitedWithCode(1),
        "no OpenGL context can be had: EGL surfaceless: .*; EGL default display: ");
}

TEST(GlContext, ALostDeviceIsAnErrorThatNamesTheWork)
{
    GlTable lost = test_context().gl();
    lost.GetGraphicsResetStatus = []() -> GLenum { return GL_GUILTY_CONTEXT_RESET; };
    EXPECT_EQ(message_of([&] { check_gl(lost, "summing disks"); }),
              "OpenGL: the device was lost while summing disks");
}

TEST(GlContext, AnErrorOfTheDriverIsReportedOnceWithTheWork)
{
    const GlContext& context = test_context();
    context.gl().Enable(GL_TEXTURE0);
    EXPECT_EQ(message_of([&] { context.finish("testing"); }), "OpenGL: invalid enum while testing");
    EXPECT_NO_THROW(context.finish("testing again"));
}

TEST(GlObjects, SizesOfZeroAndBeyondTheLimitAreRefused)
{
    const GlContext& context = test_context();
    const int too_large = context.info().max_texture_size + 1;
    EXPECT_NE(message_of([&] {
                  Framebuffer(context, {.width = 0, .height = 5});
              }).find("framebuffer of 0 x 5 pixels"),
              std::string::npos);
    EXPECT_THROW(Framebuffer(context, {.width = too_large, .height = 1}), std::runtime_error);
    EXPECT_THROW(Texture2D(context, 3, 0, TexelFormat::rgba8), std::runtime_error);
    EXPECT_THROW(static_cast<void>(Framebuffer::window(context, 0, 0)), std::runtime_error);
}

TEST(GlObjects, TextureBuffersKeepEveryBit)
{
    // small indices are denormal floats, and NaN patterns are integers like any other
    const std::array<std::uint32_t, 8> values = {1, 2, 3, 0x3F800000, 7, 0x7F7FFFFF, 42, 5};
    const GlContext& context = test_context();
    TextureBuffer texture(context, TexelFormat::rgba32ui, std::span<const std::uint32_t>(values));
    Program program(context, "fullscreen.vert", "fetch.frag", {}, fetch_shaders());
    program.set("u_values", texture);
    const Framebuffer target(context, {.width = 2, .height = 1, .colors = {TexelFormat::rgba32f}});
    draw_fullscreen(target, program, VertexArray(context));
    const std::vector<glm::vec4> pixels = target.read_color(target.rect());
    EXPECT_EQ(pixels[0].w, 1.0f);
    EXPECT_EQ(pixels[1].y, std::numeric_limits<float>::max());
}

TEST(GlObjects, TooManyTexelsAreRefusedWithBothNumbers)
{
    const GlContext& context = test_context();
    const std::size_t limit = static_cast<std::size_t>(context.info().max_buffer_texels);
    // never touched: only the length is asked
    const std::span<const std::byte> huge(reinterpret_cast<const std::byte*>(&context),
                                          (limit + 1) * 4);
    const std::string message =
        message_of([&] { TextureBuffer(context, TexelFormat::r32f, huge); });
    EXPECT_NE(message.find(std::to_string(limit + 1) + " texels"), std::string::npos) << message;
    EXPECT_NE(message.find("takes " + std::to_string(limit)), std::string::npos) << message;
}

TEST(Program, ErrorsNameOurFileAndLine)
{
    constexpr ShaderFile kBroken[] = {
        {"corner.vert", kTestShaders[0].text},
        {"good.glsl", "float one() { return 1.0; }\n"},
        {"bad.glsl", "\n\nfloat two() { return undeclared; }\n"},
        {"broken.frag",
         "#version 330 core\n#include \"good.glsl\"\n#include \"bad.glsl\"\n"
         "out vec4 out_color;\nvoid main() { out_color = vec4(two()); }\n"},
        {"broken_too.frag",
         "#version 330 core\n#include \"good.glsl\"\n\nvoid main() { undeclared; }\n"},
        {"unlinkable.frag",
         "#version 330 core\nfloat elsewhere();\nout vec4 out_color;\n"
         "void main() { out_color = vec4(elsewhere()); }\n"},
    };
    const GlContext& context = test_context();
    const auto build = [&](const char* fragment) {
        return message_of([&] { Program(context, "corner.vert", fragment, {}, kBroken); });
    };
    EXPECT_NE(build("broken.frag").find("\nbad.glsl:3("), std::string::npos)
        << build("broken.frag");
    EXPECT_NE(build("broken_too.frag").find("\nbroken_too.frag:4("), std::string::npos)
        << build("broken_too.frag");
    EXPECT_NE(build("unlinkable.frag").find("corner.vert + unlinkable.frag do not link"),
              std::string::npos)
        << build("unlinkable.frag");
}

TEST(Program, AnUnknownUniformIsRefusedByName)
{
    const Program program(test_context(), "corner.vert", "flat.frag", {}, kTestShaders);
    EXPECT_EQ(message_of([&] { program.set("u_colour", 1.0f); }),
              "the shaders corner.vert + flat.frag use no uniform 'u_colour'");
}

}  // namespace
}  // namespace surfelao

#include "viewer/ui_scale.h"

#include <imgui.h>

#include <backends/imgui_impl_opengl3.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <system_error>

namespace surfelao {
namespace {

constexpr float kLetters = 15.0f, kBitmapLetters = 13.0f;  // pixels at a scale of 1

/// Where Debian, Fedora and Arch have it.
constexpr const char* kFontFiles[] = {"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
                                      "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf",
                                      "/usr/share/fonts/TTF/DejaVuSans.ttf"};

/// Names of files are in more than Latin letters.
constexpr ImWchar kRanges[] = {0x0020, 0x024F, 0x0370, 0x052F, 0x2010, 0x2027, 0};

ImFont* add_font(ImFontAtlas& fonts, float scale)
{
    for (const char* file : kFontFiles) {
        std::error_code error;
        if (!std::filesystem::is_regular_file(file, error))
            continue;
        if (ImFont* font =
                fonts.AddFontFromFileTTF(file, std::round(kLetters * scale), nullptr, kRanges))
            return font;
    }
    ImFontConfig config;
    config.SizePixels = kBitmapLetters * std::max(1.0f, std::round(scale));
    return fonts.AddFontDefault(&config);
}

void set_style(float scale)
{
    ImGuiStyle& style = ImGui::GetStyle();
    style = ImGuiStyle();
    ImGui::StyleColorsDark();
    style.WindowRounding = 0.0f;
    style.FrameRounding = 3.0f;
    style.GrabRounding = 3.0f;
    style.WindowBorderSize = 0.0f;
    style.Colors[ImGuiCol_WindowBg].w = 0.92f;
    style.Colors[ImGuiCol_PopupBg].w = 1.0f;
    style.Colors[ImGuiCol_TextDisabled] = ImVec4(0.62f, 0.62f, 0.62f, 1.0f);
    style.ScaleAllSizes(scale);
}

}  // namespace

void set_ui_scale(float content_scale, float pixel_ratio)
{
    ImGuiIO& io = ImGui::GetIO();
    io.FontGlobalScale = content_scale / pixel_ratio;
    io.Fonts->Clear();
    // as large as it was drawn: the global scale is in that already
    add_font(*io.Fonts, content_scale)->Scale = 1.0f / content_scale;
    set_style(io.FontGlobalScale);
    ImGui_ImplOpenGL3_DestroyDeviceObjects();  // the next frame makes them anew, with this font
}

}  // namespace surfelao

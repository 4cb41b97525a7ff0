#include "viewer/cell_widgets.h"

#include <imgui.h>

#include <algorithm>
#include <string>
#include <vector>

namespace surfelao {
namespace {

/// True when the value is final: dragging a slider asks for nothing until it is let go.
bool was_let_go()
{
    return ImGui::IsItemDeactivatedAfterEdit();
}

bool edit_engine(EngineSettings& engine)
{
    bool apply = false;
    if (engine.engine == Engine::rays) {
        int rays = static_cast<int>(engine.rays);
        ImGui::SliderInt("rays", &rays, 1, 4096, "%d",
                         ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
        engine.rays = static_cast<std::uint32_t>(rays);
        return was_let_go();
    }
    ImGui::SliderFloat("quality", &engine.quality, least_quality(engine.engine),
                       most_quality(engine.engine), "%.2f", ImGuiSliderFlags_AlwaysClamp);
    apply |= was_let_go();
    if (engine.engine == Engine::disks) {
        ImGui::SliderInt("passes", &engine.passes, 1, 8, "%d", ImGuiSliderFlags_AlwaysClamp);
        apply |= was_let_go();
        ImGui::SliderFloat("strength", &engine.strength, 0.0f, 2.0f, "%.2f",
                           ImGuiSliderFlags_AlwaysClamp);
        apply |= was_let_go();
    }
    return apply;
}

bool edit_screen(ScreenSettings& screen)
{
    bool apply = false;
    if (ImGui::BeginCombo("samples", std::to_string(screen.samples).c_str())) {
        for (const int samples : {8, 16, 24, 96, 1024}) {
            if (ImGui::Selectable(std::to_string(samples).c_str(), samples == screen.samples)) {
                screen = screen_settings(screen.method, samples);
                apply = true;
            }
        }
        ImGui::EndCombo();
    }
    return apply;
}

}  // namespace

bool choose_where(Cell& cell, const Model* model, const TexelSettings& texels)
{
    const bool is_cloud = model && model->cloud;
    const Where now = where_of(cell);
    bool apply = false;
    if (!ImGui::BeginCombo("where", name_of(now, is_cloud).c_str()))
        return false;
    for (const Where where : {Where::vertices, Where::texels, Where::pixels}) {
        if (is_cloud && where != Where::vertices)
            continue;
        if (ImGui::Selectable(name_of(where, is_cloud).c_str(), where == now)) {
            set_where(cell, where, texels);
            apply = true;
        }
    }
    ImGui::EndCombo();
    return apply;
}

bool choose_how(Cell& cell, std::map<Engine, float>& qualities)
{
    bool apply = false;
    if (!ImGui::BeginCombo("how", how_of(cell).c_str()))
        return false;
    for (const Engine engine : {Engine::masks, Engine::disks, Engine::rays}) {
        for (const Device device : {Device::cpu, Device::gpu}) {
            if (!runs_on(engine, device))
                continue;
            const EngineSettings& now = cell.settings.engine;
            const bool is_chosen = !cell.screen && engine == now.engine && device == now.device;
            if (ImGui::Selectable(name_of({.engine = engine, .device = device}).c_str(),
                                  is_chosen)) {
                choose_engine(cell, engine, device, qualities);
                apply = true;
            }
        }
    }
    for (const ScreenMethod method : screen_methods()) {
        if (!cell.at_pixels)
            break;
        const bool is_chosen = cell.screen && cell.screen->method == method;
        if (ImGui::Selectable(name_of(method).c_str(), is_chosen)) {
            constexpr int kSamples = 24;
            cell.screen = screen_settings(method, cell.screen ? cell.screen->samples : kSamples);
            apply = true;
        }
    }
    ImGui::EndCombo();
    return apply;
}

bool edit_how(Cell& cell)
{
    return cell.screen ? edit_screen(*cell.screen) : edit_engine(cell.settings.engine);
}

}  // namespace surfelao

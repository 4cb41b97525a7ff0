#include "viewer/cell_widgets.h"

#include "pixels/cube_map.h"
#include "viewer/tip.h"

#include <imgui.h>

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
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
        apply = was_let_go();
        tip("at each place, 1 to 4096: the error halves with four times as many");
        return apply;
    }
    ImGui::SliderFloat("quality", &engine.quality, least_quality(engine.engine),
                       most_quality(engine.engine), "%.2f", ImGuiSliderFlags_AlwaysClamp);
    apply |= was_let_go();
    tip("more is nearer to rays, and slower");
    if (engine.engine == Engine::disks) {
        ImGui::SliderInt("passes", &engine.passes, 1, 8, "%d", ImGuiSliderFlags_AlwaysClamp);
        apply |= was_let_go();
        tip("each takes back what disks hide behind each other: 1 to 8");
        ImGui::SliderFloat("strength", &engine.strength, 0.0f, 2.0f, "%.2f",
                           ImGuiSliderFlags_AlwaysClamp);
        apply |= was_let_go();
        tip("a factor on the occlusion, 0 to 2; 1 is what was found");
    }
    return apply;
}

/// True when another one was chosen; then index is that one's.
bool choose(const char* label, std::span<const std::string> words, std::size_t& index)
{
    bool apply = false;
    if (!ImGui::BeginCombo(label, words[index].c_str()))
        return false;
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (ImGui::Selectable(words[i].c_str(), i == index)) {
            index = i;
            apply = true;
        }
    }
    ImGui::EndCombo();
    return apply;
}

/// One of some numbers.
bool choose_number(const char* label, std::span<const int> numbers, int& number)
{
    std::vector<std::string> words;
    for (const int known : numbers)
        words.push_back(std::to_string(known));
    const auto at = std::ranges::find(numbers, number);
    if (at == numbers.end())  // by a command line
        words.push_back(std::to_string(number));
    auto index = static_cast<std::size_t>(at - numbers.begin());
    if (!choose(label, words, index) || index >= numbers.size())
        return false;
    number = numbers[index];
    return true;
}

bool choose_directions(ScreenSettings& screen)
{
    const int step = screen.method == ScreenMethod::hbao ? 1 : 2;
    std::vector<int> numbers;
    for (int n = step; n <= screen.samples; n += step) {
        if (screen.samples % n == 0)
            numbers.push_back(n);
    }
    return choose_number("directions", numbers, screen.directions);
}

bool slide(const char* label, float& value, float low, float high, const char* format)
{
    ImGui::SliderFloat(label, &value, low, high, format, ImGuiSliderFlags_AlwaysClamp);
    return was_let_go();
}

template <class Choice>
bool choose_word(const char* label, std::span<const std::string> words, Choice& choice)
{
    auto index = static_cast<std::size_t>(choice);
    const bool apply = choose(label, words, index);
    choice = static_cast<Choice>(index);
    return apply;
}

/// The widget of one of screen_parameters(), by its name; what has none is for command lines.
bool edit_parameter(std::string_view name, ScreenSettings& screen)
{
    static const std::vector<std::string> kDual = {"none", "product", "minimum"};
    static const std::vector<std::string> kNoise = {"none", "gradient", "origin"};
    if (name == "directions")
        return choose_directions(screen);
    if (name == "bias")
        return slide("bias", screen.bias, 0.0f, 90.0f, "%.0f deg");
    if (name == "thickness")
        return slide("thickness", screen.thickness, 0.05f, 4.0f, "%.2f R");
    if (name == "power")
        return slide("power", screen.power, 1.0f, 8.0f, "%.1f");
    if (name == "reach")
        return slide("reach", screen.reach, 0.1f, 10.0f, "%.1f R");
    if (name == "depth-limit")
        return slide("depth limit", screen.depth_limit, 0.1f, 10.0f, "%.1f R");
    if (name == "normals")
        return ImGui::Checkbox("normals", &screen.normals);
    if (name == "fade")
        return ImGui::Checkbox("fade", &screen.fade);
    if (name == "pairs")
        return ImGui::Checkbox("pairs", &screen.pairs);
    if (name == "ratio-test")
        return ImGui::Checkbox("ratio test", &screen.ratio_test);
    if (name == "blur")
        return ImGui::Checkbox("blur", &screen.blur);
    if (name == "dual")
        return choose_word("dual", kDual, screen.dual);
    if (name == "noise")
        return choose_word("noise", kNoise, screen.noise);
    if (name == "rule")
        return choose_number("rule", std::vector<int>{0, 1, 2, 3, 4, 5, 6}, screen.rule);
    if (name == "probes")
        return choose_number("probes", std::vector<int>{4, 9, 20, 328}, screen.probes);
    return false;
}

bool edit_screen(ScreenSettings& screen)
{
    bool apply = false;
    int samples = screen.samples;
    if (choose_number("samples", std::vector<int>{8, 16, 24, 64, 256, 1024}, samples)) {
        screen.samples = samples;
        screen.directions = screen_settings(screen.method, samples).directions;
        apply = true;
    }
    tip("of the picture, at each pixel: 8 to 1024");
    for (const ScreenParameter& parameter : screen_parameters()) {
        if (std::ranges::find(parameter.methods, screen.method) == parameter.methods.end())
            continue;
        const float top = ImGui::GetCursorScreenPos().y;
        apply |= edit_parameter(parameter.name, screen);
        const bool is_drawn = ImGui::GetCursorScreenPos().y > top;
        if (is_drawn)
            tip(std::string(parameter.meaning).c_str());
    }
    return apply;
}

bool edit_guard(float& guard)
{
    float percent = 100.0f * guard;
    ImGui::SliderFloat("guard", &percent, 0.0f, 100.0f, "%.0f %%", ImGuiSliderFlags_AlwaysClamp);
    guard = 0.01f * percent;
    const bool apply = was_let_go();
    tip("so much beyond each edge of the picture is drawn for them too, in % of its height: 0 to "
        "100");
    return apply;
}

bool edit_grid(GridSettings& grid)
{
    static const std::vector<std::string> kStores = {"cone", "sh"};
    static const std::vector<std::string> kBorders = {"fade", "rescale"};
    bool apply = choose_number("cells", std::vector<int>{8, 16, 32, 64, 128}, grid.resolution);
    tip("along each axis");
    auto extent = static_cast<float>(grid.extent);
    ImGui::SliderFloat("extent", &extent, 0.001f, static_cast<float>(kMostExtent), "%.3f",
                       ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
    if (was_let_go()) {
        grid.extent = double{extent};
        apply = true;
    }
    tip("the box ends where the model hides about this share of the whole sphere: less is farther; "
        "many parts that move want .005, as each leaves out a little");
    apply |= choose_word("store", kStores, grid.store);
    tip("what a cell holds: a cone, or nine spherical harmonics, which tell more");
    apply |= choose_word("border", kBorders, grid.border);
    tip("how values end at the box: faded, or rescaled so that its largest value is 0");
    apply |= ImGui::Checkbox("cells evenly spaced", &grid.uniform);
    tip("else they stand closer about the model");
    return apply;
}

}  // namespace

bool choose_where(Cell& cell, const Model* model, const WhereSettings& settings)
{
    const bool is_cloud = model && model->cloud;
    const Where now = where_of(cell);
    bool apply = false;
    if (!ImGui::BeginCombo("where", name_of(now, is_cloud).c_str()))
        return false;
    for (const Where where :
         {Where::vertices, Where::texels, Where::pixels, Where::cube_maps, Where::grid}) {
        if (is_cloud && where != Where::vertices)
            continue;
        if (ImGui::Selectable(name_of(where, is_cloud).c_str(), where == now)) {
            set_where(cell, where, settings);
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
    if (where_of(cell) == Where::cube_maps &&
        ImGui::Selectable("horizon", cell.screen.has_value())) {
        cell.screen = cube_horizon();
        apply = true;
    }
    for (const ScreenMethod method : screen_methods()) {
        if (where_of(cell) != Where::pixels)
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
    bool apply = false;
    if (!cell.screen) {
        apply |= edit_engine(cell.settings.engine);
    } else if (!cell.from_maps) {  // horizons are those of the thesis
        apply |= edit_screen(*cell.screen);
        apply |= edit_guard(cell.guard);
    }
    if (cell.grid)
        apply |= edit_grid(*cell.grid);
    return apply;
}

}  // namespace surfelao

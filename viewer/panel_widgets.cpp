#include "viewer/panel_widgets.h"

#include "surfels/srgb.h"
#include "viewer/part_list.h"
#include "viewer/pixel_fill.h"
#include "viewer/tip.h"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>

namespace surfelao {
namespace {

constexpr int kBins = 48;

constexpr const char* kColorNames[] = {
    "visibility", "rays",    "difference", "bent normals", "normals", "levels",   "environment",
    "charts",     "density", "textured",   "coverage",     "radius",  "headlight"};
constexpr const char* kColorTips[] = {
    "1: the share of light that comes in, 1 - occlusion, as grey",
    "2: the same by rays",
    "3: between the answer and rays, in colours",
    "4: where light comes from on the mean: x, y, z as red, green, blue",
    "5: which way the surface faces, likewise",
    "6: how deep in the octree a surfel lies",
    "7: the light of a panorama on a grey surface",
    "8: of a map: the pieces that the surface was cut into",
    "9: of a map: texels per unit of length",
    "0: the file's colours, times visibility",
    "of cube maps: red where none of them answers",
    "of vo with a dynamic radius: that radius",
    "a lamp at the eye, times visibility"};
static_assert(std::size(kColorTips) == std::size(kColorNames));
constexpr const char* kSurfaceNames[] = {"triangles", "splats", "affine", "points"};

/// True when the value is final: dragging a slider asks for nothing until it is let go.
bool was_set()
{
    return ImGui::IsItemDeactivatedAfterEdit();
}

bool color_map_combo(ColorMap& map)
{
    bool changed = false;
    const auto name_of = [](std::size_t i) { return std::string(kColorMaps[i].first); };
    const bool is_open =
        ImGui::BeginCombo("colour map", name_of(static_cast<std::size_t>(map)).c_str());
    tip("colours of what is shown as a number");
    if (!is_open)
        return changed;
    for (std::size_t i = 0; i < kColorMaps.size(); ++i) {
        if (ImGui::Selectable(name_of(i).c_str(), kColorMaps[i].second == map)) {
            map = kColorMaps[i].second;
            changed = true;
        }
    }
    ImGui::EndCombo();
    return changed;
}

}  // namespace

bool edit_distance(DistanceLimit& limit, Falloff& falloff)
{
    float percent = std::isfinite(limit.value) ? static_cast<float>(limit.value) : 0.0f;
    if (percent > 0.0f)
        falloff = limit.falloff;
    if (ImGui::SliderFloat("distance", &percent, 0.0f, 100.0f,
                           percent > 0.0f ? "%.1f %%" : "unlimited",
                           ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp))
        limit = percent > 0.0f ? DistanceLimit{percent, true, falloff} : DistanceLimit{};
    bool apply = was_set();
    tip("how far occluders count, in % of the model's diagonal; 0: however far");
    bool smooth = falloff == Falloff::smooth;
    if (percent > 0.0f && ImGui::Checkbox("smooth falloff", &smooth)) {
        limit.falloff = smooth ? Falloff::smooth : Falloff::none;
        apply = true;
    }
    if (percent > 0.0f)
        tip("what occludes counts less towards that distance, not all or nothing");
    return apply;
}

bool edit_ground(std::optional<GroundPlane>& ground, const Model* model)
{
    bool occludes = ground.has_value();
    bool apply = false;
    if (ImGui::Checkbox("ground occludes", &occludes)) {
        ground.reset();
        if (occludes)
            ground = GroundPlane{model ? up_direction(model->up) : GroundPlane{}.up};
        apply = true;
    }
    tip("an endless plane under the model takes light from it");
    if (!ground || !model || !model->occluding_ground)
        return apply;
    const Frame& frame = model->geometry().frame;
    double height = ground->height.value_or(*plane_of(*model->occluding_ground, frame).height);
    constexpr double kPerPixel = 1e-3;  // diagonals
    if (ImGui::DragScalar("height", ImGuiDataType_Double, &height,
                          static_cast<float>(kPerPixel * frame.diagonal), nullptr, nullptr, "%.6g"))
        ground->height = height;
    apply |= was_set();
    tip("of the ground, along the up axis, in the file's units");
    if (ground->height && ImGui::Button("below the lowest point")) {
        ground->height.reset();
        apply = true;
    }
    if (ground->height)
        tip("where it lies unless a height is given");
    return apply;
}

bool edit_target(TargetSettings& target)
{
    bool apply = false;
    int source = static_cast<int>(target.normals.source);
    if (ImGui::Combo("normals", &source, "auto\0file\0smooth\0flat\0")) {
        target.normals.source = static_cast<NormalSource>(source);
        apply = true;
    }
    tip("which way the surface faces: as the file says where that is usable, as it says in any "
        "case, the mean of the faces around, or each face's own");
    ImGui::SliderFloat("crease", &target.normals.crease, 0.0f, 180.0f, "%.0f deg",
                       ImGuiSliderFlags_AlwaysClamp);
    apply |= was_set();
    tip("faces that meet at more degrees are not smoothed together, 0 to 180");
    int values = static_cast<int>(target.values);
    if (ImGui::Combo("values", &values, "fit\0point\0")) {
        target.values = static_cast<VertexValues>(values);
        apply = true;
    }
    tip("fit: values that are right all over the faces when they are interpolated; point: those at "
        "the vertices themselves");
    return apply;
}

bool edit_texels(TexelSettings& texels)
{
    bool apply = false;
    constexpr std::uint32_t kSizes[] = {256, 512, 1024, 2048, 4096};
    if (ImGui::BeginCombo("size", std::to_string(texels.size).c_str())) {
        for (const std::uint32_t size : kSizes) {
            if (ImGui::Selectable(std::to_string(size).c_str(), size == texels.size)) {
                texels.size = size;
                texels.texels_per_unit.reset();
                apply = true;
            }
        }
        ImGui::EndCombo();
    }
    tip("of the map, in texels each way");
    int uvs = texels.uvs != UvChoice::made ? 0 : texels.blended ? 2 : 1;
    if (ImGui::Combo("charts", &uvs, "the file's, or new\0new\0new, blended\0")) {
        texels.uvs = uvs == 0 ? UvChoice::automatic : UvChoice::made;
        texels.blended = uvs == 2;
        texels.udim = false;
        apply = true;
    }
    tip("texture coordinates: the file's where it has usable ones, new ones, or new ones that fade "
        "into each other at seams");
    return apply;
}

std::optional<std::uint32_t> edit_parts(const Scene& scene, PartChoice& parts)
{
    std::optional<std::uint32_t> clicked;
    int clear = static_cast<int>(parts.clear);
    if (ImGui::Combo("glass", &clear, "solid\0open\0cut by alpha\0"))
        parts.clear = static_cast<ClearSurfaces>(clear);
    tip("surfaces that let light through: they occlude, do not, or occlude where their alpha is at "
        "least a half");
    std::vector<PartTick> ticks = part_ticks(scene, parts);
    if (ticks.empty()) {
        ImGui::TextDisabled("no part of it has a name");
        return clicked;
    }
    constexpr float kRowsShown = 9.5f;
    const float row = ImGui::GetFrameHeightWithSpacing();
    const float height = row * std::min(kRowsShown, static_cast<float>(ticks.size()) + 1.5f);
    constexpr ImGuiTableFlags kFlags =
        ImGuiTableFlags_ScrollY | ImGuiTableFlags_RowBg | ImGuiTableFlags_BordersInnerV;
    if (!ImGui::BeginTable("parts", 3, kFlags, ImVec2(0.0f, height)))
        return clicked;
    ImGui::TableSetupScrollFreeze(0, 1);
    ImGui::TableSetupColumn("part", ImGuiTableColumnFlags_WidthStretch);
    ImGui::TableSetupColumn("occludes", ImGuiTableColumnFlags_WidthFixed);
    ImGui::TableSetupColumn("baked", ImGuiTableColumnFlags_WidthFixed);
    ImGui::TableHeadersRow();
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(ticks.size()));
    const std::vector<PartTick> before = ticks;
    while (clipper.Step()) {
        for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
            PartTick& tick = ticks[static_cast<std::size_t>(i)];
            ImGui::PushID(i);
            ImGui::TableNextRow();
            ImGui::TableNextColumn();
            if (ImGui::Selectable(tick.name.c_str())) {
                const Label& label = *parting_labels(scene)[static_cast<std::size_t>(i)];
                clicked = scene.triangles[label.ranges.front().first].x;
            }
            if (ImGui::IsItemHovered())
                ImGui::SetTooltip("%s, %llu triangles", tick.name.c_str(),
                                  static_cast<unsigned long long>(tick.triangles));
            ImGui::TableNextColumn();
            ImGui::Checkbox("##occludes", &tick.occludes);
            tip("takes light from others");
            ImGui::TableNextColumn();
            ImGui::Checkbox("##baked", &tick.is_baked);
            tip("has values, and is shown");
            ImGui::PopID();
        }
    }
    ImGui::EndTable();
    const bool is_any_baked = std::ranges::any_of(ticks, &PartTick::is_baked);
    if (ticks != before && is_any_baked)
        parts = choice_of(ticks, std::move(parts));
    return clicked;
}

namespace {

bool background_widget(std::optional<glm::vec4>& background)
{
    int kind = !background ? 0 : background->a == 0.0f ? 1 : 2;
    bool changed = ImGui::Combo("background", &kind, "gradient\0transparent\0one colour\0");
    if (changed && kind == 0)
        background.reset();
    else if (changed)
        background = kind == 1 ? glm::vec4(0.0f) : glm::vec4(1.0f);
    tip("behind the model, also in the picture that is saved; with the colours environment the "
        "gradient is the panorama; what is transparent is shown as checks");
    if (kind != 2)
        return changed;
    glm::vec3 shown(srgb_encode(background->r), srgb_encode(background->g),
                    srgb_encode(background->b));
    if (ImGui::ColorEdit3("##background", &shown.x, ImGuiColorEditFlags_NoOptions)) {
        background =
            glm::vec4(srgb_decode(shown.x), srgb_decode(shown.y), srgb_decode(shown.z), 1.0f);
        changed = true;
    }
    tip("red, green, blue as a screen shows them, 0 to 255");
    return changed;
}

bool surface_ticks(PanelState& state)
{
    ViewOptions& view = state.view;
    bool changed = ImGui::Checkbox("wireframe (X)", &view.wireframe);
    tip("the edges of triangles over what they show");
    ImGui::SameLine();
    changed |= ImGui::Checkbox("cull backs (K)", &view.cull);
    tip("without triangles that show their back: a room seen from outside shows its inside");
    return changed;
}

void flight_widgets(PanelState& state)
{
    ImGui::Checkbox("values under the mouse (I)", &state.inspects);
    tip("occlusion, rays' and the error, position in the file's units, normals, vertex, "
        "triangle and part");
    ImGui::Checkbox("fly (V)", &state.flight.is_on);
    tip("W S forward and back, A D aside, E Q up and down; left drag looks, the wheel changes "
        "the speed");
    if (!state.flight.is_on)
        return;
    float percent = 100.0f * state.flight.speed;
    if (ImGui::SliderFloat("speed##flight", &percent, 100.0f * kLeastFlightSpeed,
                           100.0f * kMostFlightSpeed, "%.1f %%/s",
                           ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp))
        state.flight.speed = 0.01f * percent;
    tip("of the model's diagonal, a second");
}

}  // namespace

bool view_widgets(PanelState& state)
{
    ViewOptions& view = state.view;
    bool changed = false;
    if (state.left.from_maps) {
        bool shows_holes = view.colors == Colors::coverage;
        if (ImGui::Checkbox("coverage: holes are red", &shows_holes)) {
            view.colors = shows_holes ? Colors::coverage : Colors::visibility;
            changed = true;
        }
        tip("shows the pixels that no cube map answers");
    }
    int colors = static_cast<int>(view.colors);
    if (ImGui::Combo("colours", &colors, kColorNames, IM_ARRAYSIZE(kColorNames))) {
        view.colors = static_cast<Colors>(colors);
        changed = true;
    }
    tip(kColorTips[colors]);
    int surface = static_cast<int>(view.surface);
    if (state.left.settings.texels)
        changed |= ImGui::Checkbox("flat (A)", &state.shows_atlas);
    else if (!state.left.at_pixels &&
             ImGui::Combo("surface", &surface, kSurfaceNames, IM_ARRAYSIZE(kSurfaceNames))) {
        view.surface = static_cast<Shape>(surface);
        changed = true;
    }
    if (state.left.settings.texels)
        tip("the map itself in place of the model");
    else if (!state.left.at_pixels)
        tip("T: what is drawn: triangles, surfels as disks, the same drawn affinely, or as points");
    if (view.surface != Shape::triangles && !state.left.settings.texels && !state.left.at_pixels) {
        changed |= ImGui::SliderFloat("splat radius", &view.radius_scale, 0.1f, 4.0f, "%.2f",
                                      ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
        tip("of disks, times what covers the surface: 0.1 to 4");
    }
    if (view.colors == Colors::environment) {
        changed |= ImGui::SliderFloat("exposure", &view.exposure, -6.0f, 6.0f, "%.1f EV",
                                      ImGuiSliderFlags_AlwaysClamp);
        tip("brighter or darker by stops: each doubles or halves the light");
    }
    if (view.colors == Colors::difference) {
        changed |= ImGui::Checkbox("signed: red is too dark", &view.is_signed);
        tip("shows which way it is wrong; else only by how much");
        changed |= ImGui::SliderFloat("full scale", &view.difference_scale, 0.001f, 1.0f, "%.3f",
                                      ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
        tip("the difference of occlusion at the end of the scale, 0.001 to 1");
    }
    if (shows_color_map(view) && map_of(view) != ColorMap::diverging)
        changed |= color_map_combo(view.color_map);
    changed |= surface_ticks(state);
    flight_widgets(state);
    changed |= background_widget(view.background);
    changed |= ImGui::Checkbox("shadow on the ground", &view.ground);
    tip("G: what the model takes from the ground below it; for the picture alone");
    return changed;
}

void progress_line(const char* what, double done)
{
    char text[64];
    std::snprintf(text, sizeof text, "%s %.0f %%", what, 100.0 * done);
    ImGui::ProgressBar(static_cast<float>(done), ImVec2(-1.0f, 0.0f), text);
}

void cell_progress(const CellView& view)
{
    const Session& session = view.session();
    if (session.solving() && !session.opening())
        progress_line(!session.state().is_solved ? "draft" : "solving", session.solve_progress());
    if (const std::optional<double> done = view.pixel_progress())
        progress_line(view.cubes().is_busy()  ? "cube maps"
                      : view.grid().is_busy() ? "cells"
                                              : "pixels",
                      *done);
}

void error_lines(const ShownError& error)
{
    ImGui::TextWrapped(
        "at pixels: RMSE %.4f   bias %+.4f\n95 %% %.4f   (%llu pixels, %u rays each)",
        error.found.rmse, error.found.bias, error.found.p95,
        static_cast<unsigned long long>(error.found.count), error.rays);
    tip("what the picture shows against rays there, of occlusion 0 to 1; bias: positive is too "
        "dark; "
        "95 % of the pixels are off by less");
}

bool map_lines(const CellView& view)
{
    const CubeLayer& cubes = view.cubes();
    if (cubes.is_placing())
        ImGui::TextUnformatted("looking for places of cube maps");
    else if (cubes.count() == 0)
        ImGui::TextWrapped("no cube map yet: C puts one where the eye is");
    else if (cubes.coverage())
        ImGui::Text("cube maps: %zu, %.1f %% of the pixels", cubes.count(),
                    100.0 * *cubes.coverage());
    else
        ImGui::Text("cube maps: %zu", cubes.count());
    const bool is_wanted = ImGui::Button("place cube maps");
    tip("where few of them see most of the surface, 16 at most, in place of those that are there");
    return is_wanted;
}

void grid_lines(const CellView& view)
{
    const auto grids = view.grid().grids();
    if (grids.empty())
        return;
    const glm::ivec3 cells = grids.front()->grid.cells;
    double seconds = 0.0;
    for (const auto& found : grids)
        seconds += found->seconds.solve + found->seconds.repair;
    if (grids.size() == 1)
        ImGui::Text("%d x %d x %d cells %.3f s", cells.x, cells.y, cells.z, seconds);
    else
        ImGui::Text("%zu grids of %d x %d x %d cells %.3f s", grids.size(), cells.x, cells.y,
                    cells.z, seconds);
    tip("of the grid, or of one for each part that moves and for the rest, and what it took to "
        "solve all of them; what the engine has built not counted");
}

void pixel_lines(const CellView& view)
{
    const PixelAnswers& found = view.pixels();
    if (found.picture.empty())
        return;
    if (found.is_draft)
        ImGui::Text("%d x %d pixels: one of %d is solved", found.width, found.height,
                    kDraftStep * kDraftStep);
    else
        ImGui::Text("%d x %d pixels %.3f s", found.width, found.height, found.seconds);
}

void stage_lines(const SessionState& s)
{
    if (s.build_s)
        ImGui::TextWrapped("read %.3f s   build %.3f s   solve %.3f s", s.read_s, *s.build_s,
                           s.solve_s);
    else
        ImGui::Text("read %.3f s   solve %.3f s", s.read_s, s.solve_s);
    tip("reading the file, building the engine's tree, solving");
    if (!s.reference.empty() && s.reference_s)
        ImGui::Text("reference %.3f s", *s.reference_s);
    else if (!s.reference.empty())
        ImGui::TextUnformatted("reference from the cache");
    if (s.layout)
        ImGui::TextWrapped("%s", text_of(*s.layout).c_str());
    if (s.map_error)
        ImGui::Text("seen %.4f (%.4f to %.4f)\nbias %+.4f   95 %% %.4f", s.map_error->rmse,
                    s.map_error->low, s.map_error->high, s.map_error->bias, s.map_error->p95);
    if (s.map_error)
        tip("against rays, of occlusion 0 to 1: RMSE all over the surface and where it lies in 95 "
            "of "
            "100 bakes; bias: positive is too dark; 95 % of the surface is off by less");
    if (!s.error)
        return;
    const ErrorStatistics& seen = s.error->seen;
    ImGui::Text(
        "seen %.4f (floor %.4f, solve %.4f)\nbias %+.4f   95 %% %.4f   max %.4f\n"
        "%llu points, %llu left out",
        seen.rmse, s.error->floor, s.error->solve, seen.bias, seen.p95, seen.max,
        static_cast<unsigned long long>(seen.count),
        static_cast<unsigned long long>(s.error->left_out));
    tip("against rays, of occlusion 0 to 1: RMSE all over the surface; floor: what the best values "
        "at vertices would leave; solve: of the answers alone; bias: positive is too dark; 95 % of "
        "the points are off by less");
}

void histogram(const Session& session)
{
    const SessionState& s = session.state();
    if (!s.is_solved || s.layout)
        return;
    const std::vector<Occlusion>& occlusion = session.occlusion();
    std::array<std::size_t, kBins> bins{};
    const std::size_t vertices = s.model->geometry().positions.size();
    for (std::size_t v = 0; v < vertices; ++v) {
        const float position = occlusion[v].occlusion * static_cast<float>(kBins);
        ++bins[std::min(static_cast<std::size_t>(position), bins.size() - 1)];
    }
    // roots, so that the many open vertices do not flatten the rest
    const float most = std::sqrt(static_cast<float>(*std::max_element(bins.begin(), bins.end())));
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const ImVec2 size(ImGui::GetContentRegionAvail().x, 70.0f * ImGui::GetIO().FontGlobalScale);
    const float step = size.x / kBins;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(corner, ImVec2(corner.x + size.x, corner.y + size.y),
                       ImGui::GetColorU32(ImGuiCol_FrameBg));
    for (std::size_t i = 0; i < bins.size(); ++i) {
        const float left = corner.x + step * static_cast<float>(i);
        const float height = (size.y - ImGui::GetTextLineHeight()) *  // below the title
                             std::sqrt(static_cast<float>(bins[i])) / std::max(most, 1.0f);
        list.AddRectFilled(ImVec2(left, corner.y + size.y - height),
                           ImVec2(left + step - 1.0f, corner.y + size.y),
                           ImGui::GetColorU32(ImGuiCol_PlotHistogram));
    }
    const char* title = "vertices by occlusion 0 .. 1, root scale";
    list.AddText(ImVec2(corner.x + size.x - ImGui::CalcTextSize(title).x - 4.0f, corner.y),
                 ImGui::GetColorU32(ImGuiCol_Text), title);
    ImGui::Dummy(size);
    if (ImGui::IsItemHovered()) {
        const float at = (ImGui::GetIO().MousePos.x - corner.x) / step;
        const auto bin =
            static_cast<std::size_t>(std::clamp(at, 0.0f, static_cast<float>(kBins - 1)));
        ImGui::SetTooltip("%zu vertices from %.2f to %.2f", bins[bin],
                          static_cast<double>(bin) / kBins, static_cast<double>(bin + 1) / kBins);
    }
}

}  // namespace surfelao

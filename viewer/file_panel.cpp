#include "viewer/file_panel.h"

#include "files/file_type.h"
#include "surfels/extension.h"
#include "viewer/output_files.h"
#include "viewer/tip.h"

#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <initializer_list>
#include <string_view>
#include <utility>

namespace surfelao {
namespace {

namespace fs = std::filesystem;

FileFilter ends_in(std::initializer_list<std::string_view> extensions)
{
    return [known = std::vector<std::string_view>(extensions)](const fs::path& file) {
        return std::ranges::find(known, lower_extension(file)) != known.end();
    };
}

bool is_model(const fs::path& file)
{
    return type_of(file) != FileType::unknown;
}

FileDialogOptions options_of(FileKind kind, bool is_map)
{
    FileDialogOptions options;
    options.saves = kind == FileKind::picture || kind == FileKind::baked;
    switch (kind) {
        case FileKind::model:
            options.title = "Open a mesh or a cloud";
            options.shows = is_model;
            break;
        case FileKind::environment:
            options.title = "Light of a panorama";
            options.shows = ends_in({".hdr", ".exr", ".png", ".jpg", ".jpeg"});
            break;
        case FileKind::picture:
            options.title = "Save the picture";
            options.shows = ends_in({".png", ".jpg", ".jpeg", ".exr"});
            break;
        case FileKind::baked:
            options.title = "Save the result";
            options.shows = [is_map, is_picture = ends_in({".png", ".tif", ".tiff", ".exr"})](
                                const fs::path& file) {
                return is_model(file) || (is_map && is_picture(file));
            };
            break;
    }
    return options;
}

/// The whole path, for what shows its end alone.
void path_tip(const fs::path& path)
{
    tip(path.c_str());
}

}  // namespace

void FilePanel::recent(const FileLists& files, FileWishes& wishes)
{
    for (const fs::path& file : files.recent) {
        ImGui::PushID(file.c_str());
        if (ImGui::Selectable(file.filename().c_str()))
            wishes.open = file;
        path_tip(file);
        ImGui::PopID();
    }
}

void FilePanel::open_list(const FileLists& files, FileWishes& wishes)
{
    constexpr float kRows = 5.5f;
    const float rows = std::min(kRows, static_cast<float>(files.open.size()) + 0.5f);
    const float row = files.switches->are_together ? ImGui::GetFrameHeightWithSpacing()
                                                   : ImGui::GetTextLineHeightWithSpacing();
    if (!ImGui::BeginListBox("##open", ImVec2(-1.0f, rows * row)))
        return;
    const bool together = files.switches->are_together;
    const auto is_on = [&](const fs::path& file) { return files.switches->is_on(file); };
    const bool is_last = std::ranges::count_if(files.open, is_on) < 2;
    for (const fs::path& file : files.open) {
        ImGui::PushID(file.c_str());
        if (together) {
            bool on = is_on(file);
            ImGui::BeginDisabled(on && is_last);
            if (ImGui::Checkbox("##on", &on))
                wishes.turn = file;
            ImGui::EndDisabled();
            tip("whether it is in this world; the last one stays");
            ImGui::SameLine();
        }
        const ImGuiStyle& style = ImGui::GetStyle();
        const float cross =
            ImGui::CalcTextSize("x").x + 2.0f * style.FramePadding.x + style.ItemSpacing.x;
        const ImVec2 room(ImGui::GetContentRegionAvail().x - cross, 0.0f);
        if (ImGui::Selectable(file.filename().c_str(), file == files.shown, 0, room))
            wishes.open = file;
        path_tip(file);
        ImGui::SameLine();
        ImGui::BeginDisabled(file == files.shown);
        if (ImGui::SmallButton("x"))
            wishes.forget = file;
        ImGui::EndDisabled();
        tip("take it off the list; the one that is shown stays");
        ImGui::PopID();
    }
    ImGui::EndListBox();
    bool wanted = together;
    if (ImGui::Checkbox("in one world", &wanted))
        wishes.together = wanted;
    tip("all files of the list that are ticked are shown together and occlude each other, each in "
        "its "
        "own coordinates");
}

void FilePanel::open_widgets(const FileLists& files, FileWishes& wishes)
{
    if (!files.shown.empty())
        model_ = files.shown;
    if (ImGui::Button("Open... (O)"))
        choose(FileKind::model);
    tip("a mesh or a cloud; files can be dropped on the window too");
    ImGui::SameLine();
    ImGui::BeginDisabled(files.recent.empty());
    if (ImGui::Button("Recent"))
        ImGui::OpenPopup("recent");
    ImGui::EndDisabled();
    tip("the files that were opened last, at most ten that are still there");
    if (ImGui::BeginPopup("recent")) {
        recent(files, wishes);
        ImGui::EndPopup();
    }
    ImGui::SameLine();
    int up = static_cast<int>(files.up);
    ImGui::SetNextItemWidth(2.8f * ImGui::GetFontSize());
    if (ImGui::Combo("up", &up, "y\0z\0"))
        wishes.up = static_cast<UpAxis>(up);
    tip("the file's axis that points to the sky: where the ground lies, and how the camera stands");
    if (files.open.size() > 1)
        open_list(files, wishes);
    if (!files.open.empty())
        return;
    ImGui::TextWrapped("Drop a mesh or a cloud on this window, or open one.");
    if (!files.recent.empty())
        ImGui::TextDisabled("opened last:");
    recent(files, wishes);
}

void FilePanel::environment_widget()
{
    if (ImGui::Button("panorama..."))
        choose(FileKind::environment, environment_);
    tip("light from a picture of the whole sphere: twice as wide as high, .hdr or .exr for light "
        "brighter than white");
}

void FilePanel::save_line(FileKind kind, std::string& path, FileWishes& wishes)
{
    const bool is_picture = kind == FileKind::picture;
    ImGui::PushID(static_cast<int>(kind));
    ImGui::InputText("##path", &path);
    path_tip(whole_path(path));
    ImGui::SameLine();
    if (ImGui::Button("..."))
        choose(kind, path);
    tip("choose a folder and a name");
    ImGui::SameLine();
    if (ImGui::Button(is_picture ? "picture" : "baked"))
        wishes.save = is_picture ? Saved::picture : Saved::baked;
    tip(is_picture ? "P: what the window shows, without the widgets: .png .jpg .exr"
                   : "B: the values at vertices in a mesh or a cloud, as the command bake writes "
                     "them; of a map the mesh with it, or the picture alone (.png .tif .exr)");
    ImGui::PopID();
}

void FilePanel::save_widgets(SavePaths& paths, bool is_map, FileWishes& wishes)
{
    saves_map_ = is_map;
    save_line(FileKind::picture, paths.picture, wishes);
    save_line(FileKind::baked, paths.baked, wishes);
}

void FilePanel::choose(FileKind kind, const fs::path& start)
{
    chooses_ = kind;
    FileDialogOptions options = options_of(kind, saves_map_);
    options.start = start.empty() && kind == FileKind::model ? model_.parent_path() : start;
    dialog_.open(std::move(options));
}

void FilePanel::dialog(SavePaths& paths, FileWishes& wishes)
{
    const std::optional<fs::path> chosen = dialog_.show();
    if (!chosen)
        return;
    switch (chooses_) {
        case FileKind::model:
            wishes.open = model_ = *chosen;
            break;
        case FileKind::environment:
            wishes.environment = environment_ = *chosen;
            break;
        case FileKind::picture:
            paths.picture = chosen->string();
            wishes.save = Saved::picture;
            break;
        case FileKind::baked:
            paths.baked = chosen->string();
            wishes.save = Saved::baked;
            break;
    }
}

}  // namespace surfelao

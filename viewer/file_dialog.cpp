#include "viewer/file_dialog.h"

#include "viewer/output_files.h"
#include "viewer/tip.h"

#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cstdlib>
#include <system_error>
#include <utility>

namespace surfelao {
namespace {

namespace fs = std::filesystem;

constexpr float kMostWidth = 560.0f, kMostHeight = 460.0f;  // unscaled pixels
constexpr float kOfWindow = 0.94f;                          // at most, of either side

/// Absolute, without a slash at its end.
fs::path clean(const fs::path& path)
{
    const fs::path whole = whole_path(path);
    return whole.has_filename() ? whole : whole.parent_path();
}

/// "~" is where the user is at home.
fs::path expanded(const std::string& typed)
{
    const char* home = std::getenv("HOME");
    const bool is_of_home = typed == "~" || typed.starts_with("~/");
    return is_of_home && home != nullptr ? fs::path(home + typed.substr(1)) : fs::path(typed);
}

bool is_folder(const fs::path& path)
{
    std::error_code error;
    return fs::is_directory(path, error);
}

}  // namespace

void FileDialog::open(FileDialogOptions options)
{
    options_ = std::move(options);
    is_closing_ = false;
    const fs::path start = clean(options_->start.empty() ? "." : options_->start);
    name_ = is_folder(start) || !options_->saves ? std::string() : start.filename().string();
    enter(is_folder(start) ? start : start.parent_path());
}

void FileDialog::enter(const fs::path& folder)
{
    folder_ = clean(folder);
    entries_ = entries_of(folder_, options_->shows, fault_);
    is_entered_ = true;
}

/// The way to the folder, each step a button.
void FileDialog::parents()
{
    fs::path step;
    std::optional<fs::path> wanted;
    const float right = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
    const ImGuiStyle& style = ImGui::GetStyle();
    for (const fs::path& name : folder_) {
        step /= name;
        const std::string text = name.string();
        const float width = ImGui::CalcTextSize(text.c_str()).x + 2.0f * style.FramePadding.x;
        if (step.has_relative_path()) {
            ImGui::SameLine(0.0f, 2.0f);
            if (ImGui::GetItemRectMax().x + width > right)
                ImGui::NewLine();
        }
        ImGui::PushID(step.c_str());
        if (ImGui::SmallButton(text.c_str()))
            wanted = step;
        tip("show this folder");
        ImGui::PopID();
    }
    if (wanted)
        enter(*wanted);
}

std::optional<fs::path> FileDialog::list()
{
    std::optional<fs::path> chosen, wanted;
    const float below = 2.0f * ImGui::GetFrameHeightWithSpacing();
    ImGui::BeginChild("entries", ImVec2(0.0f, -below), true);
    if (std::exchange(is_entered_, false))
        ImGui::SetScrollY(0.0f);
    if (!fault_.empty())
        ImGui::TextWrapped("%s", fault_.c_str());
    else if (entries_.empty())
        ImGui::TextDisabled("nothing here that can be read");
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(entries_.size()));
    while (clipper.Step()) {
        for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
            const FolderEntry& entry = entries_[static_cast<std::size_t>(i)];
            const std::string label = entry.is_folder ? entry.name + '/' : entry.name;
            ImGui::PushID(i);
            if (ImGui::Selectable(
                    label.c_str(), entry.name == name_,
                    ImGuiSelectableFlags_AllowDoubleClick | ImGuiSelectableFlags_DontClosePopups)) {
                if (entry.is_folder)
                    wanted = folder_ / entry.name;
                else
                    name_ = entry.name;
                if (!entry.is_folder && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left))
                    chosen = folder_ / entry.name;
            }
            ImGui::PopID();
        }
    }
    ImGui::EndChild();
    if (wanted)
        enter(*wanted);
    return chosen;
}

std::optional<fs::path> FileDialog::typed()
{
    if (ImGui::IsWindowAppearing())
        ImGui::SetKeyboardFocusHere();
    ImGui::SetNextItemWidth(-1.0f);
    bool is_done = ImGui::InputTextWithHint("##name", "a name or a path", &name_,
                                            ImGuiInputTextFlags_EnterReturnsTrue);
    tip(options_->saves ? "the file's name; its end says the format" : "a name, or a path");
    ImGui::BeginDisabled(name_.empty());
    is_done |= ImGui::Button(options_->saves ? "Save" : "Open");
    ImGui::EndDisabled();
    ImGui::SameLine();
    if (ImGui::Button("Cancel"))
        close();
    if (!is_done || name_.empty())
        return {};
    const fs::path path = clean(folder_ / expanded(name_));
    if (!is_folder(path))
        return path;
    name_.clear();
    enter(path);
    return {};
}

std::optional<fs::path> FileDialog::show()
{
    if (!options_)
        return {};
    const char* title = options_->title.c_str();
    if (!ImGui::IsPopupOpen(title))
        ImGui::OpenPopup(title);
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    const float scale = ImGui::GetIO().FontGlobalScale;
    ImGui::SetNextWindowPos(ImVec2(0.5f * display.x, 0.5f * display.y), ImGuiCond_Always,
                            ImVec2(0.5f, 0.5f));
    ImGui::SetNextWindowSize(ImVec2(std::min(kMostWidth * scale, kOfWindow * display.x),
                                    std::min(kMostHeight * scale, kOfWindow * display.y)));
    if (!ImGui::BeginPopupModal(
            title, nullptr,
            ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings))
        return {};
    parents();
    std::optional<fs::path> chosen = list();
    if (const auto by_name = typed())
        chosen = by_name;
    if (chosen || is_closing_) {
        options_.reset();
        ImGui::CloseCurrentPopup();
    }
    ImGui::EndPopup();
    return chosen;
}

}  // namespace surfelao

/// file_panel.h: the widgets by which a user opens files and says where results go.
#pragma once

#include "pixels/camera.h"
#include "viewer/file_dialog.h"
#include "viewer/open_files.h"
#include "viewer/saver.h"

#include <filesystem>
#include <optional>
#include <span>
#include <string>

namespace surfelao {

/// Of files, as the panel shows them. All absolute.
struct FileLists {
    std::span<const std::filesystem::path> open;    ///< in this window, in the order of opening
    std::span<const std::filesystem::path> recent;  ///< of any, the last first
    std::filesystem::path shown;                    ///< of `open`; empty where nothing is shown
    UpAxis up = UpAxis::y;                          ///< of what is shown and opened
    const OpenFiles* switches = nullptr;            ///< which of `open` are on, and together
};

/// What the user wants of files in a frame.
struct FileWishes {
    std::filesystem::path open;         ///< a mesh or a cloud; empty: nothing
    std::filesystem::path forget;       ///< of those that are open: it leaves the list
    std::filesystem::path environment;  ///< a panorama
    std::optional<UpAxis> up;
    std::optional<bool> together;
    std::filesystem::path turn;  ///< of those that are open: switched on or off
    std::optional<Saved> save;   ///< to the path of its kind
};

/// Where results go.
struct SavePaths {
    std::string picture = "picture.png";
    std::string baked = "baked.ply";
};

enum class FileKind { model, environment, picture, baked };

/// All are called between ImGui's NewFrame and Render.
class FilePanel {
public:
    /// At the panel's top: the files that are open, or those that were.
    void open_widgets(const FileLists& files, FileWishes& wishes);
    void environment_widget();
    /// What is saved, and where. is_map: the result is one.
    void save_widgets(SavePaths& paths, bool is_map, FileWishes& wishes);

    /// Opens the dialog: start is a file, or a folder; empty is where it was last.
    void choose(FileKind kind, const std::filesystem::path& start = {});
    /// The dialog, where it is open. All keys and clicks are its own then.
    void dialog(SavePaths& paths, FileWishes& wishes);
    bool is_choosing() const { return dialog_.is_open(); }
    void close() { dialog_.close(); }

private:
    void recent(const FileLists& files, FileWishes& wishes);
    void open_list(const FileLists& files, FileWishes& wishes);
    void save_line(FileKind kind, std::string& path, FileWishes& wishes);
    FileDialog dialog_;
    FileKind chooses_ = FileKind::model;
    std::filesystem::path model_, environment_;  ///< chosen last
    bool saves_map_ = false;
};

}  // namespace surfelao

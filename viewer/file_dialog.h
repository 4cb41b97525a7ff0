/// file_dialog.h: a folder's list over the picture, to choose a file from or a name to save under.
/// Its own, so that it is there on every system and can be driven by tests.
#pragma once

#include "viewer/folder_list.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace surfelao {

struct FileDialogOptions {
    std::string title;
    FileFilter shows;
    bool saves = false;           ///< a name that need not be there is asked for
    std::filesystem::path start;  ///< a file or a folder; empty: the working folder
};

/// At most one in a window.
class FileDialog {
public:
    void open(FileDialogOptions options);
    void close() { is_closing_ = true; }  ///< by the next show()
    bool is_open() const { return options_.has_value(); }

    /// Between ImGui's NewFrame and Render; nothing else can be used while it is shown. The file
    /// that was chosen, absolute, once; the dialog is closed then. Whether one stands there that
    /// would be replaced is not its concern.
    [[nodiscard]] std::optional<std::filesystem::path> show();

private:
    void enter(const std::filesystem::path& folder);
    void parents();
    [[nodiscard]] std::optional<std::filesystem::path> list();
    [[nodiscard]] std::optional<std::filesystem::path> typed();
    std::optional<FileDialogOptions> options_;
    std::filesystem::path folder_;
    std::vector<FolderEntry> entries_;
    std::string fault_;
    std::string name_;         ///< what is typed, or chosen in the list
    bool is_entered_ = false;  ///< the list begins at its top
    bool is_closing_ = false;
};

}  // namespace surfelao

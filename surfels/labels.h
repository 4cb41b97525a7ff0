/// labels.h: the names by which a user calls parts of a scene.
#pragma once

#include "surfels/scene.h"

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace surfelao {

/// "node", "mesh", "object", "group", "material"
[[nodiscard]] std::string_view name_of(LabelKind kind);

/// Makes Scene::labels. Ranges of one label come in the order of the triangles; what one of them
/// has already is passed over (a group within a group of the same name).
class LabelMaker {
public:
    /// Without a name or triangles it is no label.
    void add(LabelKind kind, std::string_view name, std::uint32_t first, std::uint32_t count);

    /// In the order in which their first triangles stand, of one place in that of the calls.
    [[nodiscard]] std::vector<Label> finish();

private:
    std::map<std::pair<LabelKind, std::string>, std::size_t> numbers_;
    std::vector<Label> labels_;
};

[[nodiscard]] std::uint64_t triangle_count(const Label& label);

/// Whether the pattern means the name: * ? [...] as in a shell (POSIX fnmatch), case counts, and *
/// means / too. All else stands for itself; \ takes the meaning from a sign.
[[nodiscard]] bool is_called(const std::string& name, const std::string& pattern);

/// Marks the triangles of all labels that a pattern means; `found`, one per pattern, those that
/// mean one. O(labels * patterns + triangles).
[[nodiscard]] std::vector<bool> triangles_called(const Scene& scene,
                                                 std::span<const std::string> patterns,
                                                 std::vector<bool>& found);

/// Up to three names of labels that a pattern without a match may have meant, nearest first.
[[nodiscard]] std::vector<std::string> names_near(std::span<const Label> labels,
                                                  std::string_view pattern);

}  // namespace surfelao

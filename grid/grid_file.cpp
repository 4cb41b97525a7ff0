#include "grid/grid_file.h"

#include "grid/cone.h"
#include "image/image_file.h"
#include "surfels/atomic_file.h"
#include "surfels/errors.h"
#include "surfels/extension.h"

#include <glm/vec2.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>

namespace surfelao {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kFormat = "aogrid 1";
constexpr std::uint32_t kTexelNumbers = 4;
/// Of each axis: a sheet then has 2^26 texels, and three of them still are a picture.
constexpr int kMostCells = 512;

float zero_of(const fs::path& picture, MapDepth depth)
{
    if (lower_extension(picture) == ".exr")
        return 0.0f;
    return depth == MapDepth::byte ? 128.0f / 255.0f : 32768.0f / 65535.0f;
}

/// What a channel's values are divided by to lie in [-1, 1].
float scale_of(GridStore store, std::size_t channel)
{
    if (store == GridStore::cone)
        return channel < 3 ? 0.25f : 1.0f;  // |m| / (4 pi) is 1/4 for half a sphere, at most
    const float constant = harmonics_along({0.0f, 0.0f, 1.0f})[0];
    return constant * 4.0f * std::numbers::pi_v<float>;
}

std::uint32_t sheets_of(GridStore store)
{
    return static_cast<std::uint32_t>((channels_of(store) + kTexelNumbers - 1) / kTexelNumbers);
}

/// Texels of all sheets together.
glm::uvec2 sheet_size(const AoGrid& grid)
{
    const auto columns = static_cast<std::uint32_t>(tile_columns(grid.cells.z));
    const glm::uvec3 cells(grid.cells);
    const std::uint32_t rows = (cells.z + columns - 1) / columns;
    return {columns * cells.x, sheets_of(grid.store) * rows * cells.y};
}

/// Calls visit(value, channel, place) for each number of the grid: `place` is where it stands among
/// the map's numbers.
template <class Grid, class Visit>
void for_each_number(Grid& grid, const Map& sheet, const Visit& visit)
{
    const auto columns = static_cast<std::uint32_t>(tile_columns(grid.cells.z));
    const glm::uvec3 cells(grid.cells);
    const std::uint32_t rows = (cells.z + columns - 1) / columns;
    const std::size_t channels = channels_of(grid.store);
    std::size_t value = 0;
    for (std::uint32_t z = 0; z < cells.z; ++z) {
        for (std::uint32_t y = 0; y < cells.y; ++y) {
            for (std::uint32_t x = 0; x < cells.x; ++x) {
                for (std::uint32_t c = 0; c < channels; ++c, ++value) {
                    const std::uint32_t row =
                        (c / kTexelNumbers * rows + z / columns) * cells.y + y;
                    visit(grid.values[value], c,
                          sheet.index(z % columns * cells.x + x, row) + c % kTexelNumbers);
                }
            }
        }
    }
}

/// The other way of sheet_of().
void take_sheet(const Map& sheet, float zero, AoGrid& grid)
{
    grid.values.resize(grid.cell_count() * channels_of(grid.store));
    for_each_number(grid, sheet, [&](float& value, std::size_t channel, std::size_t place) {
        value = (sheet.values[place] - zero) / (1.0f - zero) * scale_of(grid.store, channel);
    });
}

Json json_of(glm::dvec3 v)
{
    return {v.x, v.y, v.z};
}

Json json_of_grid(const fs::path& picture, const AoGrid& grid, MapDepth depth,
                  const GridNotes& notes)
{
    const int columns = tile_columns(grid.cells.z);
    Json json;
    json["format"] = kFormat;
    json["maker"] = notes.maker;
    json["picture"] = picture.filename().string();
    json["cells"] = {grid.cells.x, grid.cells.y, grid.cells.z};
    json["columns"] = columns;
    json["rows"] = (grid.cells.z + columns - 1) / columns;
    json["sheets"] = sheets_of(grid.store);
    json["box"] = {{"low", json_of(grid.low)}, {"high", json_of(grid.high)}};
    json["warp"] = {{"inner", {grid.inner.x, grid.inner.y, grid.inner.z}},
                    {"share", grid.inner_share}};
    json["store"] = name_of(grid.store);
    json["depth"] = depth == MapDepth::byte ? 8 : 16;
    json["zero"] = zero_of(picture, depth);
    json["border"] = {
        {"kind", name_of(grid.border)}, {"fade", kGridFade}, {"value", grid.border_value}};
    json["made"] = Json::parse(notes.about);
    return json;
}

/// Reads members and says which is missing or wrong.
class TextReader {
public:
    TextReader(const fs::path& path, const Json& json) : path_(path), json_(json) {}

    [[noreturn]] void refuse(const std::string& what) const
    {
        throw InputError(path_.string() + ": " + what);
    }

    /// "/box/low"
    [[nodiscard]] const Json& at(const std::string& key) const
    {
        const Json::json_pointer place(key);
        if (!json_.contains(place))
            refuse("has no " + name(key) + ", as the text of an AO grid has");
        return json_.at(place);
    }

    [[nodiscard]] double number(const std::string& key) const
    {
        const Json& value = at(key);
        if (!value.is_number() || !std::isfinite(value.get<double>()))
            refuse(name(key) + " is no number");
        return value.get<double>();
    }

    [[nodiscard]] int count(const std::string& key, int least, int most) const
    {
        const double value = number(key);
        if (!(value >= least && value <= most) || value != std::floor(value))
            refuse(name(key) + " is no whole number from " + std::to_string(least) + " to " +
                   std::to_string(most));
        return static_cast<int>(value);
    }

    [[nodiscard]] glm::dvec3 vector(const std::string& key) const
    {
        if (!at(key).is_array() || at(key).size() != 3)
            refuse(name(key) + " is no list of three numbers");
        return {number(key + "/0"), number(key + "/1"), number(key + "/2")};
    }

    [[nodiscard]] std::string text(const std::string& key) const
    {
        if (!at(key).is_string())
            refuse(name(key) + " is no text");
        return at(key).get<std::string>();
    }

    /// Throws where the text is none of two names.
    [[nodiscard]] bool is_second(const std::string& key, const std::string& first,
                                 const std::string& second) const
    {
        const std::string found = text(key);
        if (found != first && found != second)
            refuse(name(key) + " is \"" + found + "\", " + first + " or " + second + " was wanted");
        return found == second;
    }

private:
    static std::string name(const std::string& key)
    {
        std::string name = key.substr(1);
        std::ranges::replace(name, '/', '.');
        return name;
    }

    fs::path path_;
    const Json& json_;
};

/// All but the values.
AoGrid grid_of(const TextReader& text)
{
    AoGrid grid;
    for (int axis = 0; axis < 3; ++axis)
        grid.cells[axis] = text.count("/cells/" + std::to_string(axis), 2, kMostCells);
    grid.low = text.vector("/box/low");
    grid.high = text.vector("/box/high");
    grid.inner = glm::vec3(text.vector("/warp/inner"));
    grid.inner_share = static_cast<float>(text.number("/warp/share"));
    for (int axis = 0; axis < 3; ++axis) {
        if (!(grid.low[axis] < grid.high[axis]))
            text.refuse("box.low is not below box.high");
        if (!(grid.inner[axis] > 0.0f && grid.inner[axis] < 1.0f))
            text.refuse("warp.inner is not between 0 and 1");
    }
    if (!(grid.inner_share > 0.0f && grid.inner_share < 1.0f))
        text.refuse("warp.share is not between 0 and 1");
    grid.store = text.is_second("/store", "cone", "sh") ? GridStore::sh : GridStore::cone;
    grid.border =
        text.is_second("/border/kind", "fade", "rescale") ? GridBorder::rescale : GridBorder::fade;
    if (static_cast<float>(text.number("/border/fade")) != kGridFade)
        text.refuse("border.fade is another share than what is faded here");
    grid.border_value = static_cast<float>(text.number("/border/value"));
    if (!(grid.border_value >= 0.0f && grid.border_value < 1.0f))
        text.refuse("border.value is not from 0 to less than 1");
    const int columns = tile_columns(grid.cells.z);
    if (text.count("/columns", 1, kMostCells) != columns ||
        text.count("/rows", 1, kMostCells) != (grid.cells.z + columns - 1) / columns)
        text.refuse("columns and rows are not those of " + std::to_string(grid.cells.z) +
                    " slices");
    return grid;
}

Json parsed(const fs::path& path)
{
    std::error_code ignored;
    if (!fs::is_regular_file(path, ignored))
        throw InputError(path.string() + ": no such file");
    std::ifstream file(path, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    const Json json = Json::parse(bytes, nullptr, false);
    if (!json.is_object() || json.value("format", Json()) != kFormat)
        throw InputError(path.string() + ": is not the text of an AO grid");
    return json;
}

}  // namespace

int tile_columns(int slices)
{
    int columns = 1;
    while (columns * columns < slices)
        ++columns;
    return columns;
}

std::uint64_t bytes_of(const AoGrid& grid, MapDepth depth)
{
    return grid.cell_count() * sheets_of(grid.store) * kTexelNumbers *
           (depth == MapDepth::byte ? 1 : 2);
}

bool is_grid_name(const fs::path& path)
{
    const std::string extension = lower_extension(path);
    return (extension == ".exr" || extension == ".png") &&
           lower_extension(path.stem()) == ".aogrid";
}

fs::path grid_text_path(const fs::path& picture)
{
    fs::path text = picture;
    return text.replace_extension(".json");
}

void check_grid_output(const fs::path& picture, MapDepth depth)
{
    if (!is_grid_name(picture))
        throw InputError(picture.string() +
                         ": AO grids are written as NAME.aogrid.exr or NAME.aogrid.png");
    if (depth == MapDepth::whole || (depth == MapDepth::byte && zero_of(picture, depth) == 0.0f))
        throw InputError(picture.string() + ": AO grids have 16 bits, as .png 8 or 16");
    check_map_output(picture, depth);
    check_writable(grid_text_path(picture));
}

Map sheet_of(const AoGrid& grid, float zero)
{
    const glm::uvec2 size = sheet_size(grid);
    Map sheet(size.x, size.y, kTexelNumbers, zero);
    for_each_number(grid, sheet, [&](float value, std::size_t channel, std::size_t place) {
        const float x = std::clamp(value / scale_of(grid.store, channel), -1.0f, 1.0f);
        sheet.values[place] = zero + (1.0f - zero) * x;
    });
    return sheet;
}

void write_grid(const fs::path& picture, const AoGrid& grid, MapDepth depth, const GridNotes& notes)
{
    check_grid_output(picture, depth);
    const std::string text = json_of_grid(picture, grid, depth, notes).dump(2) + "\n";
    const Map sheet = sheet_of(grid, zero_of(picture, depth));
    write_atomically(grid_text_path(picture), [&](const fs::path& temporary) {
        std::ofstream file(temporary, std::ios::binary);
        file << text;
        file.close();
        if (!file)
            throw std::runtime_error(grid_text_path(picture).string() + ": cannot be written");
        write_map(picture, sheet, depth, notes.maker);
    });
}

AoGrid read_grid(const fs::path& path, GridNotes* notes)
{
    const bool is_text = lower_extension(path) == ".json";
    if (!is_text && !is_grid_name(path))
        throw InputError(path.string() +
                         ": AO grids are called NAME.aogrid.exr, NAME.aogrid.png or "
                         "NAME.aogrid.json");
    const fs::path text_path = is_text ? path : grid_text_path(path);
    const Json json = parsed(text_path);
    const TextReader text(text_path, json);
    AoGrid grid = grid_of(text);
    const float zero = static_cast<float>(text.number("/zero"));
    if (!(zero >= 0.0f && zero < 1.0f))
        text.refuse("zero is not from 0 to less than 1");
    const fs::path name = text.text("/picture");
    if (name.empty() || name.has_parent_path())
        text.refuse("picture is no name of a file beside it");
    if (!is_text && name != path.filename())
        text.refuse("is of " + name.string() + ", not of " + path.filename().string());
    const fs::path picture = is_text ? text_path.parent_path() / name : path;
    const Map sheet = read_map(picture);
    const glm::uvec2 wanted = sheet_size(grid);
    if (glm::uvec2(sheet.width, sheet.height) != wanted || sheet.channels != kTexelNumbers) {
        const auto size = [](std::uint32_t width, std::uint32_t height, std::uint32_t channels) {
            return std::to_string(width) + " x " + std::to_string(height) + " of " +
                   std::to_string(channels) + " channels";
        };
        throw InputError(picture.string() + ": is " +
                         size(sheet.width, sheet.height, sheet.channels) + ", its text wants " +
                         size(wanted.x, wanted.y, kTexelNumbers));
    }
    take_sheet(sheet, zero, grid);
    if (notes != nullptr) {
        notes->maker = text.text("/maker");
        notes->about = text.at("/made").dump();
    }
    return grid;
}

std::string grid_maker(const fs::path& text)
{
    try {
        const Json json = parsed(text);
        return TextReader(text, json).text("/maker");
    } catch (const InputError&) {
        return {};
    }
}

}  // namespace surfelao

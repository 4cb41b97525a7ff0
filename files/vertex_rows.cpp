#include "files/vertex_rows.h"

#include "files/ply_io.h"
#include "surfels/for_all.h"
#include "surfels/number_text.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace surfelao::table {
namespace {

constexpr std::string_view kMeasured[] = {"occlusion", "bent_nx", "bent_ny", "bent_nz"};
constexpr std::string_view kColor[] = {"red", "green", "blue"};
constexpr std::string_view kOwnColor[] = {"own_red", "own_green", "own_blue"};
/// Room for what a bake adds to a row: occlusion, bent normal and colour, in ascii.
constexpr std::size_t kAddedBytes = 64;

constexpr std::string_view kPacked = "rgb", kOwnPacked = "own_rgb";

/// Columns that another format gets of a cloud's own: ours have room beside them.
constexpr std::size_t kMostOthers = kMostColumns - 2 * kResultColumns;

bool names(std::span<const std::string_view> properties, std::string_view name)
{
    return std::ranges::find(properties, name) != properties.end();
}

void append_measured(std::string& text, const Occlusion& o, Notation notation)
{
    for (const float value : {o.occlusion, o.bent_normal.x, o.bent_normal.y, o.bent_normal.z}) {
        if (notation.ascii)
            append_shortest(text += notation.separator, value);
        else
            append_bytes(text, value, notation.endian);
    }
}

void append_color_bytes(std::string& text, const glm::vec3& numbers, Notation notation)
{
    for (int channel = 0; channel < 3; ++channel)
        append_number(text, Type::uint8, byte_of(numbers[channel]), notation);
}

/// Three bytes in the bits of a number of this type, which has four. alpha: the fourth's bits.
void append_packed(std::string& text, Type type, const glm::vec3& numbers, std::uint32_t alpha,
                   Notation notation)
{
    const std::uint32_t bits = alpha | static_cast<std::uint32_t>(byte_of(numbers.x)) << 16 |
                               static_cast<std::uint32_t>(byte_of(numbers.y)) << 8 |
                               byte_of(numbers.z);
    if (!notation.ascii)
        append_bytes(text, bits, notation.endian);
    else if (type == Type::float32)
        append_shortest(text, std::bit_cast<float>(bits));
    else
        append_integer(text, bits);
}

/// The fourth byte of such a number as it stands in a file.
std::uint32_t alpha_in(std::string_view word, Type type, Notation notation)
{
    std::uint32_t bits = 0;
    if (notation.ascii)
        bits = packed_bits(type, number_in(word).value_or(0.0));
    else
        std::memcpy(&bits, word.data(), sizeof(bits));  // PCD is of little-endian machines alone
    return bits & 0xff000000;
}

/// Colours that the file does not have.
void append_new_colors(std::string& text, const glm::vec3& numbers, ColorForm form,
                       Notation notation)
{
    if (form == ColorForm::apart)
        return append_color_bytes(text, numbers, notation);
    if (notation.ascii)
        text += notation.separator;
    append_packed(text, Type::float32, numbers, 0, notation);
}

/// What a bake adds; the types of the own colours where these are replaced.
std::vector<Column> added_columns(const ColorPlan& plan, ColorForm form, bool is_measured,
                                  const std::array<Type, 3>& own_types)
{
    std::vector<Column> added;
    for (std::size_t m = 0; m < 4 && is_measured; ++m)
        added.push_back({Type::float32, std::string(kMeasured[m])});
    const bool is_packed = form == ColorForm::packed;
    for (std::size_t c = 0; c < (is_packed ? 1 : 3); ++c) {
        if (plan.replaces())
            added.push_back({own_types[c], std::string(is_packed ? kOwnPacked : kOwnColor[c])});
        else if (!plan.has_own() && plan.writes())
            added.push_back({is_packed ? Type::float32 : Type::uint8,
                             std::string(is_packed ? kPacked : kColor[c])});
    }
    return added;
}

/// The number itself, without what stands before it in an ascii file.
std::string_view word_of(std::string_view property, Notation notation)
{
    const char between[] = {' ', '\t', '\v', '\f', notation.separator};
    if (notation.ascii)
        property.remove_prefix(
            std::min(property.find_first_not_of({between, sizeof(between)}), property.size()));
    return property;
}

/// Writes the rows of the vertices with what changes.
template <class Data>
class RowWriter {
public:
    /// occlusion: empty for a map.
    RowWriter(const RowSource& source, std::span<const Occlusion> occlusion,
              const VertexChanges& changes)
        : source_(source),
          occlusion_(occlusion),
          changes_(changes),
          properties_(source.vertices().properties),
          fates_(properties_.size(), kStays)
    {
        for (std::size_t p = 0; p < fates_.size(); ++p)
            fates_[p] = changes.drops(properties_[p].name) ? kGoes : kStays;
        for (int c = 0; c < 3 && changes.places.shown; ++c)
            fates_[(*changes.places.shown)[static_cast<std::size_t>(c)]] = c;
    }

    /// Appends them. All threads, each a range of rows; what they write lies in between only until
    /// so many of them are done.
    void write(std::string& text, std::size_t rest) const
    {
        const std::string no_name;
        const std::string_view rows = source_.vertex_rows();
        const Data data(no_name, rows, source_.form());
        const std::vector<RowRange> ranges = data.ranges(source_.vertices());
        text.reserve(text.size() + rows.size() + source_.vertices().count * kAddedBytes + rest);
        std::vector<std::string> texts(std::min(ranges.size(), kRangesPerThread * loop_threads()));
        for (std::size_t first = 0; first < ranges.size(); first += texts.size()) {
            const std::size_t count = std::min(texts.size(), ranges.size() - first);
            for_tasks(count, [&](std::size_t i) {
                texts[i].clear();
                append_range(texts[i], data, ranges, first + i);
            });
            for (std::size_t i = 0; i < count; ++i)
                text.append(texts[i]);
        }
    }

private:
    static constexpr int kStays = -1, kGoes = -2;

    /// Enough that no thread waits long for the others.
    static constexpr std::size_t kRangesPerThread = 4;

    void append_range(std::string& text, const Data& data, std::span<const RowRange> ranges,
                      std::size_t i) const
    {
        const std::string_view rows = source_.vertex_rows();
        Data at = data.at(ranges[i]);
        std::size_t end = ranges[i].offset;
        const std::size_t next = i + 1 < ranges.size() ? ranges[i + 1].offset : rows.size();
        text.reserve(next - end + (ranges[i].end - ranges[i].first) * kAddedBytes);
        std::vector<std::string_view> old(properties_.size());
        for (std::uint64_t row = ranges[i].first; row < ranges[i].end; ++row)
            end = append_row(text, at, row, end, old);
        text.append(rows.substr(end, next - end));
    }

    /// copied: where the row before ends. Returns where this one ends. old: room for its
    /// properties.
    std::size_t append_row(std::string& text, Data& data, std::uint64_t row, std::size_t copied,
                           std::span<std::string_view> old) const
    {
        const std::string_view rows = source_.vertex_rows();
        data.begin_row(source_.vertices(), row);
        text.append(rows.substr(copied, data.offset() - copied));
        for (std::size_t p = 0; p < old.size(); ++p) {
            const std::size_t begin = data.offset();
            skip_property(data, properties_[p]);
            old[p] = rows.substr(begin, data.offset() - begin);
        }
        append_changed(text, row, old);
        return data.offset();
    }

    /// old: the properties as they stand in the file.
    void append_changed(std::string& text, std::uint64_t row,
                        std::span<const std::string_view> old) const
    {
        const ColorPlan& plan = changes_.plan;
        const auto own_word = [&](std::size_t c) {
            return word_of(old[(*changes_.places.own)[c]], notation_);
        };
        const ColorForm form = changes_.places.packed ? ColorForm::packed : ColorForm::apart;
        glm::vec3 numbers(0.0f);
        if (plan.what != VertexColors::keep)
            numbers = plan.numbers(row, occlusion_[row]);
        for (std::size_t p = 0; p < old.size(); ++p) {
            if (fates_[p] == kStays)
                text.append(old[p]);
            if (fates_[p] < 0)
                continue;
            const std::string_view word = word_of(old[p], notation_);
            text.append(old[p].substr(0, old[p].size() - word.size()));
            const Type type = properties_[p].type;
            if (plan.what == VertexColors::keep)
                text.append(own_word(static_cast<std::size_t>(fates_[p])));
            else if (form == ColorForm::packed)
                append_packed(text, type, numbers, alpha_in(word, type, notation_), notation_);
            else
                append_channel(text, type, numbers[fates_[p]] * white_of(type, changes_.largest),
                               notation_);
        }
        if (!occlusion_.empty())
            append_measured(text, occlusion_[row], notation_);
        if (!plan.has_own() && plan.writes())
            append_new_colors(text, numbers, form, notation_);
        const std::size_t own_words = form == ColorForm::packed ? 1 : 3;
        for (std::size_t c = 0; c < own_words && plan.replaces(); ++c) {
            if (notation_.ascii)
                text += notation_.separator;
            text.append(own_word(c));
        }
    }

    const RowSource& source_;
    std::span<const Occlusion> occlusion_;
    const VertexChanges& changes_;
    const std::vector<Property>& properties_;
    const Notation notation_ = notation_of(source_.form());
    std::vector<int> fates_;  ///< of the properties, or a channel of the colour
};

/// Columns of a cloud that are no place, normal, colour or result of a bake.
struct Others {
    std::vector<Column> columns;
    std::vector<double> numbers;  ///< row by row; nan or 0 for what is no number
};

template <class Data>
Others read_others(const RowSource& source)
{
    const Element& points = source.vertices();
    const std::string no_name;
    const std::vector<Role> roles = roles_of(no_name, points);
    std::vector<bool> kept(roles.size());
    Others others;
    for (std::size_t p = 0; p < roles.size(); ++p) {
        const Property& property = points.properties[p];
        const std::string name = as_word(property.name);
        kept[p] = roles[p].kind == Role::none && !property.count_type && !property.is_second &&
                  name.find_first_not_of("-_") != name.npos && !names(kMeasured, name) &&
                  !names_color(name) && others.columns.size() < kMostOthers;
        if (kept[p])
            others.columns.push_back({property.type, name});
    }
    others.numbers.reserve(others.columns.size() * points.count);
    Data data(no_name, source.vertex_rows(), source.form());
    for (std::uint64_t row = 0; row < points.count && !others.columns.empty(); ++row) {
        data.begin_row(points, row);
        for (std::size_t p = 0; p < roles.size(); ++p) {
            const Type type = points.properties[p].type;
            if (!kept[p]) {
                skip_property(data, points.properties[p]);
                continue;
            }
            const double number = data.loose_number(type);
            others.numbers.push_back(is_integer(type) && !std::isfinite(number) ? 0.0 : number);
        }
    }
    return others;
}

}  // namespace

Notation notation_of(const RowForm& form)
{
    return {form.format == Format::ascii,
            form.format == Format::big_endian ? std::endian::big : std::endian::little,
            form.rules.separator};
}

void append_channel(std::string& text, Type type, double value, Notation notation)
{
    const std::int64_t whole = is_integer(type) ? std::llround(value) : 0;
    if (notation.ascii) {
        if (is_integer(type))
            append_integer(text, whole);
        else if (type == Type::float32)
            append_shortest(text, static_cast<float>(value));
        else
            append_shortest(text, value);
    } else if (type == Type::float32) {
        append_bytes(text, static_cast<float>(value), notation.endian);
    } else if (type == Type::float64) {
        append_bytes(text, value, notation.endian);
    } else if (size_of(type) == 1) {
        append_bytes(text, static_cast<std::uint8_t>(whole), notation.endian);
    } else if (size_of(type) == 2) {
        append_bytes(text, static_cast<std::uint16_t>(whole), notation.endian);
    } else {
        append_bytes(text, static_cast<std::uint32_t>(whole), notation.endian);
    }
}

void append_number(std::string& text, Type type, double value, Notation notation)
{
    if (notation.ascii)
        text += notation.separator;
    append_channel(text, type, value, notation);
}

bool needs_double(const std::vector<glm::dvec3>& positions)
{
    glm::dvec3 low = positions[0];
    glm::dvec3 high = positions[0];
    double largest_shift = 0.0;
    for (const glm::dvec3& p : positions) {
        low = glm::min(low, p);
        high = glm::max(high, p);
        const glm::dvec3 shift = glm::abs(p - glm::dvec3(glm::vec3(p)));
        largest_shift = std::max({largest_shift, shift.x, shift.y, shift.z});
    }
    return !(largest_shift <= kFloatSlack * glm::distance(low, high));
}

std::string as_word(std::string_view name)
{
    std::string word(name);
    for (char& c : word)
        c = std::string_view(" \t\v\f,;").find(c) == std::string_view::npos ? c : '_';
    return word;
}

bool VertexChanges::drops(std::string_view property) const
{
    if (names(kMeasured, property))
        return true;
    if (places.packed)
        return property == kOwnPacked || (!places.shown && property == kPacked);
    return names(kOwnColor, property) || (!places.shown && names(kColor, property));
}

VertexChanges changes_of(const RowSource& source, const WriteOptions& options, bool is_measured,
                         std::vector<std::string>& notes)
{
    const Element& vertices = source.vertices();
    RowSource::Own own = source.own();
    VertexChanges changes{
        color_places(vertices),
        plan_colors(options, std::move(own.colors), OcclusionPlace::beside, notes),
        own.largest,
        {}};
    std::array<Type, 3> types{};
    for (std::size_t c = 0; c < 3 && changes.places.own; ++c)
        types[c] = vertices.properties[(*changes.places.own)[c]].type;
    changes.added =
        added_columns(changes.plan, changes.places.packed ? ColorForm::packed : ColorForm::apart,
                      is_measured, types);
    return changes;
}

void append_changed_rows(std::string& text, const RowSource& source,
                         std::span<const Occlusion> occlusion, const VertexChanges& changes,
                         std::size_t rest)
{
    if (source.form().format == Format::ascii)
        RowWriter<AsciiData>(source, occlusion, changes).write(text, rest);
    else
        RowWriter<BinaryData>(source, occlusion, changes).write(text, rest);
}

NewRows::NewRows(const Scene& scene, std::span<const Occlusion> occlusion,
                 const WriteOptions& options, ColorForm form, std::vector<std::string>& notes)
    : scene_(scene),
      occlusion_(occlusion),
      form_(form),
      plan_(plan_colors(options, own_colors_of(scene), OcclusionPlace::beside, notes))
{
    const bool is_cloud = scene.triangles.empty();
    if (scene.normals.of_vertices()) {
        for (const char* axis : {"nx", "ny", "nz"})
            columns_.push_back({Type::float32, axis});
    }
    if (plan_.has_own() && form == ColorForm::packed)
        columns_.push_back({Type::float32, std::string(kPacked)});
    for (std::size_t c = 0; c < 3 && plan_.has_own() && form == ColorForm::apart; ++c)
        columns_.push_back({Type::uint8, std::string(kColor[c])});
    if (const auto* source = dynamic_cast<const RowSource*>(scene.asset.get());
        is_cloud && source) {
        Others others = source->form().format == Format::ascii ? read_others<AsciiData>(*source)
                                                               : read_others<BinaryData>(*source);
        others_ = std::move(others.columns);
        kept_ = std::move(others.numbers);
        columns_.insert(columns_.end(), others_.begin(), others_.end());
    }
    constexpr Type kByte = Type::uint8;
    std::array<Type, 3> own_types{kByte, kByte, kByte};
    if (form == ColorForm::packed)
        own_types[0] = Type::float32;
    std::ranges::move(added_columns(plan_, form, true, own_types), std::back_inserter(columns_));
}

void NewRows::append(std::string& text, std::size_t vertex, Notation notation) const
{
    const auto append_colors = [&](const glm::vec3& numbers) {
        append_new_colors(text, numbers, form_, notation);
    };
    const auto shown = [&] {
        return plan_.what == VertexColors::keep ? numbers_of(plan_.own[vertex])
                                                : plan_.numbers(vertex, occlusion_[vertex]);
    };
    if (scene_.normals.of_vertices()) {
        for (int axis = 0; axis < 3; ++axis)
            append_number(text, Type::float32, scene_.normals.values[vertex][axis], notation);
    }
    if (plan_.has_own())
        append_colors(shown());
    for (std::size_t c = 0; c < others_.size(); ++c)
        append_number(text, others_[c].type, kept_[vertex * others_.size() + c], notation);
    append_measured(text, occlusion_[vertex], notation);
    if (plan_.replaces())
        append_colors(numbers_of(plan_.own[vertex]));
    else if (!plan_.has_own() && plan_.writes())
        append_colors(shown());
}

}  // namespace surfelao::table

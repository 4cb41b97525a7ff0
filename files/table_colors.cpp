#include "files/own_colors.h"
#include "files/table_rows.h"

#include <cmath>
#include <type_traits>

namespace surfelao::table {
namespace {

using Names = std::array<std::string_view, 3>;

constexpr Names kShown[] = {{"red", "green", "blue"},
                            {"diffuse_red", "diffuse_green", "diffuse_blue"},
                            {"r", "g", "b"},
                            {"diffuse_r", "diffuse_g", "diffuse_b"}};
constexpr Names kOwn = {"own_red", "own_green", "own_blue"};

std::optional<Channels> channels_of(const Element& vertices, const Names& names)
{
    Channels channels{};
    for (std::size_t c = 0; c < channels.size(); ++c) {
        channels[c] = find_scalar(vertices, names[c]);
        if (channels[c] == vertices.properties.size())
            return std::nullopt;
    }
    return channels;
}

/// Whether a result has made these colours of nothing.
bool are_baked(const Element& vertices, const Channels& shown)
{
    return shown[0] > 0 && vertices.properties[shown[0] - 1].name == "bent_nz" &&
           shown[1] == shown[0] + 1 && shown[2] == shown[0] + 2;
}

ColorPlaces packed_places(const Element& vertices)
{
    ColorPlaces places;
    places.packed = true;
    const std::size_t none = vertices.properties.size();
    const auto find = [&](std::string_view name) {
        const std::size_t property = find_scalar(vertices, name);
        return property < none && size_of(vertices.properties[property].type) == 4 ? property
                                                                                   : none;
    };
    const std::size_t shown = std::min(find("rgb"), find("rgba"));
    if (shown == none || (shown > 0 && vertices.properties[shown - 1].name == "bent_nz"))
        return places;
    places.shown = Channels{shown, shown, shown};
    const std::size_t own = find("own_rgb");
    const bool is_own =
        own < none && vertices.properties[own].type == vertices.properties[shown].type;
    places.own = is_own ? Channels{own, own, own} : places.shown;
    return places;
}

template <class Data>
RowSource::Own read_packed(const RowSource& source, const Element& vertices, std::size_t place)
{
    const std::string no_name;
    Data data(no_name, source.vertex_rows(), source.form());
    RowSource::Own own{{}, 255.0};
    own.colors.reserve(vertices.count);
    for (std::uint64_t row = 0; row < vertices.count; ++row) {
        data.begin_row(vertices, row);
        for (std::size_t p = 0; p < vertices.properties.size(); ++p) {
            if (p != place) {
                skip_property(data, vertices.properties[p]);
                continue;
            }
            const std::uint32_t bits = data.bits(vertices.properties[p].type);
            const auto channel = [&](int shift) {
                return linear_of(static_cast<double>(bits >> shift & 0xff) / 255.0);
            };
            own.colors.emplace_back(channel(16), channel(8), channel(0), 1.0f);
        }
    }
    return own;
}

template <class Data>
RowSource::Own read_own(const RowSource& source, const Element& vertices, const ColorPlaces& places)
{
    const std::string no_name;
    Data data(no_name, source.vertex_rows(), source.form());
    std::vector<int> roles(vertices.properties.size(), -1);
    for (std::size_t c = 0; c < 3; ++c)
        roles[(*places.own)[c]] = static_cast<int>(c);
    if (places.alpha)
        roles[*places.alpha] = 3;
    std::vector<glm::dvec4> numbers(vertices.count, glm::dvec4(1e300));
    double largest = 0.0;
    for (std::uint64_t row = 0; row < vertices.count; ++row) {
        data.begin_row(vertices, row);
        for (std::size_t p = 0; p < roles.size(); ++p) {
            const Property& property = vertices.properties[p];
            if (roles[p] < 0) {
                skip_property(data, property);
                continue;
            }
            const double number = data.loose_number(property.type);
            numbers[row][roles[p]] = number;
            if (std::isfinite(number) && roles[p] < 3)
                largest = std::max(largest, number);
        }
    }
    glm::dvec4 white(1.0);
    for (std::size_t p = 0; p < roles.size(); ++p) {
        if (roles[p] >= 0)
            white[roles[p]] = white_of(vertices.properties[p].type, largest);
    }
    RowSource::Own own{{}, largest};
    own.colors.reserve(numbers.size());
    for (const glm::dvec4& number : numbers) {
        const glm::dvec4 scaled = number / white;
        const double alpha = std::isnan(scaled.w) ? 1.0 : std::clamp(scaled.w, 0.0, 1.0);
        own.colors.emplace_back(linear_of(scaled.x), linear_of(scaled.y), linear_of(scaled.z),
                                static_cast<float>(alpha));
    }
    return own;
}

}  // namespace

ColorPlaces color_places(const Element& vertices)
{
    ColorPlaces places;
    for (const Names& names : kShown) {
        if (!places.shown)
            places.shown = channels_of(vertices, names);
    }
    if (vertices.packs_colors && !places.shown)
        return packed_places(vertices);
    if (places.shown && are_baked(vertices, *places.shown))
        places.shown.reset();
    if (!places.shown)
        return places;
    const auto type_of = [&](std::size_t property) { return vertices.properties[property].type; };
    places.own = channels_of(vertices, kOwn);
    for (std::size_t c = 0; c < 3 && places.own; ++c) {
        if (type_of((*places.own)[c]) != type_of((*places.shown)[c]))
            places.own.reset();
    }
    if (!places.own)
        places.own = places.shown;
    if (const std::size_t alpha = find_scalar(vertices, "alpha");
        alpha < vertices.properties.size())
        places.alpha = alpha;
    return places;
}

bool names_color(std::string_view property)
{
    const auto is_in = [&](const Names& names) {
        return std::ranges::find(names, property) != names.end();
    };
    return std::ranges::any_of(kShown, is_in) || is_in(kOwn) || property == "rgb" ||
           property == "rgba" || property == "own_rgb";
}

double white_of(Type type, double largest)
{
    switch (type) {
        case Type::int8:
            return 127.0;
        case Type::uint16:
            return 65535.0;
        case Type::float32:
        case Type::float64:
            return surfelao::white_of(largest);
        default:
            return 255.0;
    }
}

RowSource::Own RowSource::own() const
{
    const ColorPlaces places = color_places(vertices());
    if (!places.own)
        return {};
    const auto read = [&]<class Data>(std::type_identity<Data>) {
        return places.packed ? read_packed<Data>(*this, vertices(), places.own->front())
                             : read_own<Data>(*this, vertices(), places);
    };
    return form().format == Format::ascii ? read(std::type_identity<AsciiData>())
                                          : read(std::type_identity<BinaryData>());
}

}  // namespace surfelao::table

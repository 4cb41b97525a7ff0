#include "files/table_rows.h"

namespace surfelao::table {
namespace {

struct TypeName {
    std::string_view name;
    Type type;
};
constexpr TypeName kTypeNames[] = {
    {"char", Type::int8},      {"uchar", Type::uint8},    {"short", Type::int16},
    {"ushort", Type::uint16},  {"int", Type::int32},      {"uint", Type::uint32},
    {"float", Type::float32},  {"double", Type::float64}, {"int8", Type::int8},
    {"uint8", Type::uint8},    {"int16", Type::int16},    {"uint16", Type::uint16},
    {"int32", Type::int32},    {"uint32", Type::uint32},  {"float32", Type::float32},
    {"float64", Type::float64}};

}  // namespace

std::optional<Type> type_named(std::string_view name)
{
    const auto found = std::ranges::find(kTypeNames, name, &TypeName::name);
    return found == std::end(kTypeNames) ? std::nullopt : std::optional(found->type);
}

std::string_view name_of(Type type)
{
    return kTypeNames[static_cast<std::size_t>(type)].name;  // the first ones, in their order
}

std::string row_name(const Element& element, std::uint64_t row)
{
    const std::string name = surfelao::quoted(element.name);
    return name.substr(1, name.size() - 2) + " " + std::to_string(row);
}

std::size_t find_scalar(const Element& element, std::string_view name)
{
    const auto found = std::ranges::find(element.properties, name, &Property::name);
    if (found == element.properties.end() || found->count_type)
        return element.properties.size();
    return static_cast<std::size_t>(found - element.properties.begin());
}

std::uint32_t packed_bits(Type type, double number)
{
    if (!(std::abs(number) <= 0xffffffff))
        return 0xffffff;
    return type == Type::float32 ? std::bit_cast<std::uint32_t>(static_cast<float>(number))
                                 : static_cast<std::uint32_t>(static_cast<std::int64_t>(number));
}

std::vector<RowRange> BinaryData::ranges(const Element& element) const
{
    const bool has_lists = std::ranges::any_of(element.properties, [](const Property& property) {
        return property.count_type.has_value();
    });
    if (!has_lists)
        return row_ranges(offset_, remaining(), least_bytes(element), element.count);
    std::vector<RowRange> ranges{{0, element.count, offset_, 0}};
    BinaryData rows = *this;
    try {
        for (std::uint64_t row = 0; row < element.count; ++row) {
            if (rows.offset_ - ranges.back().offset >= kRangeBytes) {
                ranges.back().end = row;
                ranges.push_back({row, element.count, rows.offset_, 0});
            }
            rows.begin_row(element, row);
            for (const Property& property : element.properties)
                skip_property(rows, property);
        }
    } catch (const InputError&) {
        // who reads the last range finds the same fault, or an earlier one
    }
    return ranges;
}

std::vector<Role> roles_of(const std::string& file_name, const Element& element)
{
    const std::size_t count = element.properties.size();
    std::vector<Role> roles(count);
    constexpr std::string_view kAxes[] = {"x", "y", "z"};
    for (int axis = 0; axis < 3; ++axis) {
        const std::size_t property = find_scalar(element, kAxes[axis]);
        if (property == count) {
            throw InputError(file_name + ": element \"vertex\" has no scalar property " +
                             quoted(kAxes[axis]));
        }
        roles[property] = {Role::position, axis};
    }
    const std::size_t normal[] = {find_scalar(element, "nx"), find_scalar(element, "ny"),
                                  find_scalar(element, "nz")};
    if (std::ranges::find(normal, count) == std::end(normal)) {
        for (int axis = 0; axis < 3; ++axis)
            roles[normal[axis]] = {Role::normal, axis};
    }
    constexpr std::string_view kUvNames[][2] = {
        {"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}, {"texture_s", "texture_t"}};
    for (const auto& names : kUvNames) {
        const std::size_t uv[] = {find_scalar(element, names[0]), find_scalar(element, names[1])};
        if (uv[0] == count || uv[1] == count)
            continue;
        for (int axis = 0; axis < 2; ++axis)
            roles[uv[axis]] = {Role::uv, axis};
        break;
    }
    return roles;
}

}  // namespace surfelao::table

#include "bake/table.h"

#include "surfels/errors.h"

#include <algorithm>
#include <utility>

namespace surfelao {
namespace {

constexpr std::size_t kTextColumns = 2;

std::string padding(std::size_t width, const std::string& cell)
{
    return std::string(width - cell.size(), ' ');
}

}  // namespace

std::string csv_field(const std::string& text)
{
    if (text.find_first_of(",\"\r\n") == std::string::npos)
        return text;
    std::string quoted = "\"";
    for (const char c : text) {
        quoted += c;
        if (c == '"')
            quoted += c;
    }
    return quoted + '"';
}

Table::Table(std::vector<std::string> names)
{
    rows_.push_back(std::move(names));
}

void Table::add(std::vector<std::string> cells)
{
    SURFELAO_CHECK(cells.size() == rows_.front().size());
    rows_.push_back(std::move(cells));
}

std::string Table::text() const
{
    std::vector<std::size_t> widths(rows_.front().size(), 0);
    for (const auto& row : rows_) {
        for (std::size_t i = 0; i < row.size(); ++i)
            widths[i] = std::max(widths[i], row[i].size());
    }
    std::string result;
    for (const auto& row : rows_) {
        std::string line;
        for (std::size_t i = 0; i < row.size(); ++i) {
            const std::string space = padding(widths[i], row[i]);
            line += (i > 0 ? "  " : "") + (i < kTextColumns ? row[i] + space : space + row[i]);
        }
        line.erase(line.find_last_not_of(' ') + 1);
        result += line + '\n';
    }
    return result;
}

}  // namespace surfelao

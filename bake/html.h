/// html.h: parts of pages that reports are.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace surfelao {

/// As text of a page.
[[nodiscard]] std::string escaped(std::string_view text);

/// A row of a table; tag: "td" or "th". The cells are escaped.
[[nodiscard]] std::string row_of_cells(const std::vector<std::string>& cells, std::string_view tag);

/// From the doctype to the heading, with the style of all reports; it ends with close_page(). mark:
/// make_mark().
[[nodiscard]] std::string open_page(const std::string& mark, const std::string& title,
                                    const std::string& heading);
[[nodiscard]] std::string close_page();

/// A picture in the page itself. png: the bytes of a file.
[[nodiscard]] std::string figure_html(std::string_view png, const std::string& caption);

}  // namespace surfelao

/// html.h: parts of pages that reports are. A page is one file: nothing is fetched, pictures, plots
/// and tables to save are in it. It is well-formed XML too, readable on a phone, light or dark as
/// the reader's system is.
#pragma once

#include "bake/run_facts.h"
#include "image/color_map.h"

#include <string>
#include <string_view>
#include <vector>

namespace surfelao {

struct Plot;

/// As text of a page.
[[nodiscard]] std::string escaped(std::string_view text);

/// The same, each line below the other.
[[nodiscard]] std::string lines_html(std::string_view text);

/// A table that scrolls by itself where the page is narrow. rows: as wide as the head.
[[nodiscard]] std::string table_html(const std::vector<std::string>& head,
                                     const std::vector<std::vector<std::string>>& rows);

/// From the doctype to the heading, with the style of all reports; it ends with close_page(). mark:
/// make_mark().
[[nodiscard]] std::string open_page(const std::string& mark, const std::string& title,
                                    const std::string& heading);
[[nodiscard]] std::string close_page();

/// Machine, versions, date, command line, and how to cite them.
[[nodiscard]] std::string facts_html(const RunFacts& facts);

/// What the colours of a picture mean: a bar with words at its ends and in its middle.
struct ColorBar {
    std::string low, middle, high;
    std::vector<Rgb> colors;  ///< evenly spread, two at least
};

/// Black 0 to white 1.
[[nodiscard]] ColorBar visibility_bar();
/// Of error_color(): -full too bright to +full too dark.
[[nodiscard]] ColorBar error_bar(const std::string& full);

/// A picture in the page itself. png: the bytes of a file.
[[nodiscard]] std::string figure_html(std::string_view png, const std::string& caption,
                                      const ColorBar& bar);

/// A plot with a link that saves it as NAME.svg.
[[nodiscard]] std::string plot_html(const Plot& plot, const std::string& name);

/// A link that saves the rows as NAME.csv.
[[nodiscard]] std::string csv_link(const std::string& csv, const std::string& name);

}  // namespace surfelao

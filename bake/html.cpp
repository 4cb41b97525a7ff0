#include "bake/html.h"

#include "bake/plot.h"
#include "files/gltf_uri.h"
#include "surfels/errors.h"

#include <algorithm>
#include <cstdint>

namespace surfelao {
namespace {

constexpr const char* kStyle =
    ":root{color-scheme:light dark;--line:#8886;--dim:#666}"
    "@media(prefers-color-scheme:dark){:root{--dim:#aaa}}"
    "body{font:15px/1.5 system-ui,sans-serif;max-width:76em;margin:1.5em auto;padding:0 1em;"
    "overflow-wrap:break-word}"
    ".wide{overflow-x:auto}"
    "table{border-collapse:collapse;margin:1em 0;font-variant-numeric:tabular-nums}"
    "td,th{padding:.15em .6em;text-align:right;border-bottom:1px solid var(--line);"
    "white-space:nowrap}"
    "td:nth-child(-n+2),th:nth-child(-n+2){text-align:left}"
    "dl{display:grid;grid-template-columns:max-content 1fr;gap:.1em 1em;margin:1em 0}"
    "dd{margin:0;min-width:0;overflow-wrap:anywhere}"
    "dt,figcaption,.scale,.save{color:var(--dim);font-size:13px}"
    ".plots,.pictures{display:flex;flex-wrap:wrap;gap:1em 2em}"
    ".plot{flex:1 1 34em;min-width:0;max-width:46em}.plot svg{width:100%;min-width:34rem}"
    "figure{margin:0}img{border:1px solid var(--line);max-width:100%;height:auto;display:block}"
    ".strip{display:flex;gap:1em;overflow-x:auto}.strip>*{flex:none}.strip "
    "figure{width:min-content;min-width:15em}"
    ".strip img{max-width:85vw}"
    ".bar{display:block;height:.7em;margin:.3em 0 0;border:1px solid var(--line)}"
    ".scale{display:flex;justify-content:space-between;gap:1em;margin-bottom:.3em}";

/// The bytes as what a link saves.
std::string save_link(std::string_view type, std::string_view bytes, const std::string& name)
{
    return "<a download=\"" + escaped(name) + "\" href=\"" + make_data_uri(type, bytes) + "\">" +
           escaped(name) + "</a>";
}

std::string row_html(const std::vector<std::string>& cells, const std::string& tag)
{
    std::string html = "<tr>";
    for (const std::string& cell : cells)
        html.append("<" + tag + ">" + escaped(cell) + "</" + tag + ">");
    return html + "</tr>\n";
}

std::string hex_of(const Rgb& color)
{
    constexpr char kDigits[] = "0123456789abcdef";
    std::string text = "#";
    for (const std::uint8_t channel : color)
        text += {kDigits[channel >> 4], kDigits[channel & 15]};
    return text;
}

std::string bar_html(const ColorBar& bar)
{
    std::string stops;
    for (const Rgb& color : bar.colors)
        stops += ',' + hex_of(color);
    std::string html = "<span class=\"bar\" style=\"background:linear-gradient(to right" + stops +
                       ")\"></span><span class=\"scale\">";
    for (const std::string& words : {bar.low, bar.middle, bar.high})
        html += "<span>" + escaped(words) + "</span>";
    return html + "</span>";
}

}  // namespace

std::string escaped(std::string_view text)
{
    std::string result;
    for (const char c : text) {
        switch (c) {
            case '<':
                result += "&lt;";
                break;
            case '>':
                result += "&gt;";
                break;
            case '&':
                result += "&amp;";
                break;
            case '"':
                result += "&quot;";
                break;
            default:
                result += c;
        }
    }
    return result;
}

std::string lines_html(std::string_view text)
{
    std::string html;
    for (std::size_t start = 0; start <= text.size();) {
        const std::size_t end = std::min(text.find('\n', start), text.size());
        html += (start > 0 ? "<br/>\n" : "") + escaped(text.substr(start, end - start));
        start = end + 1;
    }
    return html;
}

std::string table_html(const std::vector<std::string>& head,
                       const std::vector<std::vector<std::string>>& rows)
{
    std::string html = "<div class=\"wide\"><table>\n" + row_html(head, "th");
    for (const std::vector<std::string>& row : rows) {
        SURFELAO_CHECK(row.size() == head.size());
        html += row_html(row, "td");
    }
    return html + "</table></div>\n";
}

std::string open_page(const std::string& mark, const std::string& title, const std::string& heading)
{
    return "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"/><meta "
           "name=\"generator\" content=\"" +
           mark +
           "\"/><meta name=\"viewport\" content=\"width=device-width,initial-scale=1\"/><title>" +
           escaped(title) + "</title>\n<style>" + kStyle + "</style></head><body>\n<h1>" +
           escaped(heading) + "</h1>\n";
}

std::string close_page()
{
    return "</body></html>\n";
}

std::string facts_html(const RunFacts& facts)
{
    std::string html = "<h2>Machine and run</h2>\n<dl>\n";
    const auto add = [&](const std::string& name, const std::string& value) {
        html += "<dt>" + escaped(name) + "</dt><dd>" + escaped(value) + "</dd>\n";
    };
    for (const auto& [name, value] : facts)
        add(name, value);
    add("cite as", citation_of(facts));
    return html + "</dl>\n";
}

ColorBar visibility_bar()
{
    return {"closed 0", "visibility", "1 open", {Rgb{0, 0, 0}, Rgb{255, 255, 255}}};
}

ColorBar error_bar(const std::string& full)
{
    ColorBar bar{"-" + full + " too bright", "0", "too dark +" + full, {}};
    constexpr int kStops = 8;  // a side
    for (int i = -kStops; i <= kStops; ++i)
        bar.colors.push_back(error_color(static_cast<float>(i), static_cast<float>(kStops)));
    return bar;
}

std::string figure_html(std::string_view png, const std::string& caption, const ColorBar& bar)
{
    return "<figure><img alt=\"" + escaped(caption) + "\" src=\"" +
           make_data_uri("image/png", png) + "\"/><figcaption>" + bar_html(bar) + escaped(caption) +
           "</figcaption></figure>\n";
}

std::string plot_html(const Plot& plot, const std::string& name)
{
    return "<div class=\"plot\"><div class=\"wide\">" + svg_of(plot) +
           "</div><div class=\"save\">save as " +
           save_link("image/svg+xml", svg_file_of(plot), name + ".svg") + "</div></div>\n";
}

std::string csv_link(const std::string& csv, const std::string& name)
{
    return "<p class=\"save\">save all rows as " + save_link("text/csv", csv, name + ".csv") +
           "</p>\n";
}

}  // namespace surfelao

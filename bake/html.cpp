#include "bake/html.h"

#include "files/gltf_uri.h"

namespace surfelao {
namespace {

constexpr const char* kStyle =
    "body{font:15px/1.45 system-ui,sans-serif;max-width:62em;margin:2em auto;padding:0 1em;"
    "color:#222}"
    "table{border-collapse:collapse;margin:1em 0;font-variant-numeric:tabular-nums}"
    "td,th{padding:.15em .6em;text-align:right;border-bottom:1px solid #ddd}"
    "td:nth-child(-n+2),th:nth-child(-n+2){text-align:left}"
    "figure{display:inline-block;margin:0 1em 1em 0}figcaption{font-size:13px;color:#555}"
    "img{border:1px solid #ddd}svg text{font-size:12px;fill:#444}";

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

std::string row_of_cells(const std::vector<std::string>& cells, std::string_view tag)
{
    const std::string name(tag);
    std::string html = "<tr>";
    for (const std::string& cell : cells)
        html += '<' + name + '>' + escaped(cell) + "</" + name + '>';
    return html + "</tr>\n";
}

std::string open_page(const std::string& mark, const std::string& title, const std::string& heading)
{
    return "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta "
           "name=\"generator\" content=\"" +
           mark + "\"><title>" + escaped(title) + "</title>\n<style>" + kStyle +
           "</style></head><body>\n<h1>" + escaped(heading) + "</h1>\n";
}

std::string close_page()
{
    return "</body></html>\n";
}

std::string figure_html(std::string_view png, const std::string& caption)
{
    return "<figure><img alt=\"" + escaped(caption) + "\" src=\"" +
           make_data_uri("image/png", png) + "\"><figcaption>" + escaped(caption) +
           "</figcaption></figure>\n";
}

}  // namespace surfelao

/// plot.h: curves on two logarithmic axes as SVG, for reports. Readable on light and dark pages.
#pragma once

#include <string>
#include <vector>

namespace surfelao {

struct PlotPoint {
    double x = 0.0, y = 0.0;  ///< > 0
    std::string label;        ///< beside the point: "good"
};

struct PlotLine {
    std::string name;
    std::vector<PlotPoint> points;  ///< not empty; joined in this order
};

struct Plot {
    std::string title;
    std::string x_title, y_title;
    std::vector<PlotLine> lines;  ///< not empty; up to nine have colours of their own
};

/// An element for a page of HTML, with the title as what is read aloud.
[[nodiscard]] std::string svg_of(const Plot& plot);

/// The same as a file of its own.
[[nodiscard]] std::string svg_file_of(const Plot& plot);

}  // namespace surfelao

#include "bake/plot.h"

#include "bake/html.h"
#include "surfels/errors.h"
#include "surfels/number_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace surfelao {
namespace {

// pixels of the drawing
constexpr double kWidth = 640, kHeight = 420;
constexpr double kLeft = 68, kRight = 616, kTop = 56, kBottom = 362;
constexpr double kLetter = 6.6, kTextHeight = 12;

// of middle lightness: on white as on black
constexpr std::array kLineColors = {"#cf4a3c", "#3584c6", "#2c9b5a", "#b07d12", "#8c62c4",
                                    "#cf6099", "#40908c", "#8a7358", "#6f7d8a"};

std::string pixels(double value)
{
    return fixed(value, 1);
}

/// The largest of 1, 2 and 5 times a power of ten that is at most the value, and how it goes on.
double step_below(double value)
{
    const double decade = std::pow(10.0, std::floor(std::log10(value) + 1e-9));
    for (const double step : {5.0, 2.0}) {
        if (step * decade <= value * (1.0 + 1e-9))
            return step * decade;
    }
    return decade;
}

double step_above(double value)
{
    const double below = step_below(value);
    if (below >= value * (1.0 - 1e-9))
        return below;
    return step_below(2.6 * below);  // 1 to 2, 2 to 5, 5 to 10
}

/// A logarithmic axis from a round number to another.
struct LogAxis {
    double low = std::numeric_limits<double>::max();
    double high = 0.0;
    double from = 0.0, to = 0.0;  ///< pixels

    void include(double value)
    {
        low = std::min(low, value);
        high = std::max(high, value);
    }
    void make_round()
    {
        low = step_below(low);
        high = std::max(step_above(high), step_above(1.5 * low));
    }
    [[nodiscard]] double at(double value) const
    {
        return from + (to - from) * std::log(value / low) / std::log(high / low);
    }
    /// Numbers under it: 1, 2, 5, 10 of few decades, else powers of ten.
    [[nodiscard]] std::vector<double> ticks() const
    {
        const bool is_long = high / low > 500.0;
        std::vector<double> found;
        for (double tick = low; tick <= high * (1.0 + 1e-9); tick = step_above(1.01 * tick)) {
            const double power = std::log10(tick);
            if (!is_long || std::fabs(power - std::round(power)) < 1e-6)
                found.push_back(tick);
        }
        return found;
    }
};

struct TextBox {
    double left, top, right, bottom;

    [[nodiscard]] double overlap(const TextBox& other) const
    {
        return std::max(0.0, std::min(right, other.right) - std::max(left, other.left)) *
               std::max(0.0, std::min(bottom, other.bottom) - std::max(top, other.top));
    }
};

/// Puts labels where they cover least of points, lines' ends and other labels.
class LabelPlaces {
public:
    void take(const TextBox& box) { taken_.push_back(box); }

    /// The box of a text beside the point.
    TextBox place(double x, double y, std::size_t letters)
    {
        const double width = kLetter * static_cast<double>(letters);
        std::optional<TextBox> best;
        double least = std::numeric_limits<double>::max();
        for (const double gap : {7.0, 18.0}) {
            for (const double down : {-kTextHeight - gap, gap, -0.5 * kTextHeight}) {
                for (const double across : {gap, -width - gap, -0.5 * width}) {
                    const TextBox box = {x + across, y + down, x + across + width,
                                         y + down + kTextHeight};
                    const double covered = cover_of(box);
                    if (covered < least) {
                        least = covered;
                        best = box;
                    }
                }
            }
        }
        take(*best);
        return *best;
    }

private:
    [[nodiscard]] double cover_of(const TextBox& box) const
    {
        constexpr double kOutside = 1e4;
        double sum = box.left < kLeft || box.right > kWidth || box.top < kTop - kTextHeight ||
                             box.bottom > kBottom
                         ? kOutside
                         : 0.0;
        for (const TextBox& other : taken_)
            sum += box.overlap(other);
        return sum;
    }
    std::vector<TextBox> taken_;
};

std::string text_at(double x, double y, const char* anchor, const std::string& words,
                    const std::string& more = "")
{
    return "<text x=\"" + pixels(x) + "\" y=\"" + pixels(y) + "\" text-anchor=\"" + anchor + "\"" +
           more + ">" + escaped(words) + "</text>\n";
}

std::string grid_line(double x1, double y1, double x2, double y2)
{
    return "<line x1=\"" + pixels(x1) + "\" y1=\"" + pixels(y1) + "\" x2=\"" + pixels(x2) +
           "\" y2=\"" + pixels(y2) + "\" stroke=\"currentColor\" stroke-opacity=\"0.18\"/>\n";
}

std::string axes_of(const Plot& plot, const LogAxis& x, const LogAxis& y)
{
    std::string svg;
    for (const double tick : x.ticks())
        svg += grid_line(x.at(tick), kTop, x.at(tick), kBottom) +
               text_at(x.at(tick), kBottom + 17, "middle", significant(tick, 6));
    for (const double tick : y.ticks())
        svg += grid_line(kLeft, y.at(tick), kRight, y.at(tick)) +
               text_at(kLeft - 6, y.at(tick) + 4, "end", significant(tick, 6));
    return svg + text_at(0.5 * (kLeft + kRight), kBottom + 42, "middle", plot.x_title) +
           text_at(
               0, 0, "middle", plot.y_title,
               " transform=\"translate(14 " + pixels(0.5 * (kTop + kBottom)) + ") rotate(-90)\"");
}

/// The names of the lines in a row.
std::string names_of_lines(const Plot& plot)
{
    std::string svg;
    double x = kLeft;
    for (std::size_t i = 0; i < plot.lines.size(); ++i) {
        const std::string& name = plot.lines[i].name;
        svg += "<circle r=\"4\" cx=\"" + pixels(x + 4) + "\" cy=\"36\" fill=\"" +
               kLineColors[i % kLineColors.size()] + "\"/>\n" + text_at(x + 12, 40, "start", name);
        x += 28 + kLetter * static_cast<double>(name.size());
    }
    return svg;
}

std::string body_of(const Plot& plot)
{
    SURFELAO_CHECK(!plot.lines.empty());
    LogAxis x, y;
    for (const PlotLine& line : plot.lines) {
        for (const PlotPoint& point : line.points) {
            x.include(point.x);
            y.include(point.y);
        }
    }
    x.make_round();
    y.make_round();
    x.from = kLeft;
    x.to = kRight;
    y.from = kBottom;
    y.to = kTop;

    std::string svg = "<title>" + escaped(plot.title) + "</title>\n" +
                      text_at(kLeft, 16, "start", plot.title, " font-weight=\"bold\"") +
                      axes_of(plot, x, y) + names_of_lines(plot);
    LabelPlaces places;
    for (const PlotLine& line : plot.lines) {
        for (const PlotPoint& p : line.points)
            places.take({x.at(p.x) - 5, y.at(p.y) - 5, x.at(p.x) + 5, y.at(p.y) + 5});
    }
    for (std::size_t i = 0; i < plot.lines.size(); ++i) {
        const std::string color = kLineColors[i % kLineColors.size()];
        const std::vector<PlotPoint>& points = plot.lines[i].points;
        std::string way;
        for (const PlotPoint& point : points)
            way += pixels(x.at(point.x)) + ',' + pixels(y.at(point.y)) + ' ';
        svg += "<polyline fill=\"none\" stroke-width=\"2\" stroke=\"" + color + "\" points=\"" +
               way + "\"/>\n";
        for (const PlotPoint& point : points) {
            const double px = x.at(point.x), py = y.at(point.y);
            const TextBox box = places.place(px, py, point.label.size());
            svg += "<circle r=\"4\" cx=\"" + pixels(px) + "\" cy=\"" + pixels(py) + "\" fill=\"" +
                   color + "\"><title>" +
                   escaped(plot.lines[i].name + ", " + point.label + ": " +
                           significant(point.x, 3) + ", " + significant(point.y, 3)) +
                   "</title></circle>\n" +
                   text_at(box.left, box.bottom - 2, "start", point.label,
                           " font-size=\"11\" fill=\"" + color + "\"");
        }
    }
    return svg;
}

std::string element_of(const Plot& plot, const std::string& attributes)
{
    return "<svg viewBox=\"0 0 " + pixels(kWidth) + ' ' + pixels(kHeight) +
           "\" role=\"img\" font-family=\"sans-serif\" font-size=\"12\" fill=\"currentColor\"" +
           attributes + ">\n" + body_of(plot) + "</svg>\n";
}

}  // namespace

std::string svg_of(const Plot& plot)
{
    return element_of(plot, "");
}

std::string svg_file_of(const Plot& plot)
{
    return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n" +
           element_of(plot, " xmlns=\"http://www.w3.org/2000/svg\" width=\"" + pixels(kWidth) +
                                "\" height=\"" + pixels(kHeight) + "\"");
}

}  // namespace surfelao

// Draws convergence curves.
#include "cli/curve_chart.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>

#include "base/printable.h"
#include "cli/console.h"

namespace candela {
namespace {

// Sizes and places, in pixels of the drawing; the plot is the rectangle within the margins.
constexpr double WIDTH = 760, HEIGHT = 480;
constexpr double LEFT = 80, RIGHT = 20, TOP = 20, BOTTOM = 60;
constexpr double LEGEND_LINE = 18;

constexpr std::array<const char*, 8> COLOURS = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                "#56b4e9", "#e69f00", "#000000", "#8c6d00"};

// A name as XML, which cannot hold all control characters.
std::string escape(const std::string& text) {
    std::string escaped;
    for (const char c : printable(text, MAX_NAME_BYTES)) {
        if (c == '&') {
            escaped += "&amp;";
        } else if (c == '<') {
            escaped += "&lt;";
        } else if (c == '>') {
            escaped += "&gt;";
        } else if (c == '"') {
            escaped += "&quot;";
        } else {
            escaped += c;
        }
    }
    return escaped;
}

// A logarithmic axis: maps numbers to places in the drawing.
class Axis {
  public:
    // From `min` to `max` (more than 0), widened slightly and to at least one decade, so that there are
    // three numbers to label. The ends lie at `from` and `to`.
    Axis(double min, double max, double from, double to) : from_(from), to_(to) {
        const double margin = std::max(MARGIN, 0.5 - 0.5 * std::log10(max / min));
        min_ = std::log10(min) - margin;
        max_ = std::log10(max) + margin;
    }

    double place(double value) const {
        return from_ + (to_ - from_) * (std::log10(value) - min_) / (max_ - min_);
    }
    // Numbers to label: 1, 2 and 5 times powers of ten, or, if these are many, only the powers.
    std::vector<double> ticks() const {
        const bool many = max_ - min_ > MAX_DECADES;
        std::vector<double> ticks;
        for (int power = int(std::floor(min_)); power <= int(std::ceil(max_)); ++power) {
            for (const double digit : {1.0, 2.0, 5.0}) {
                const double tick = digit * std::pow(10.0, power);
                const bool within = std::log10(tick) >= min_ && std::log10(tick) <= max_;
                if (within && (digit == 1.0 || !many)) ticks.push_back(tick);
            }
        }
        return ticks;
    }

  private:
    static constexpr double MARGIN = 0.05;  // Decades.
    static constexpr double MAX_DECADES = 3.5;

    double min_, max_, from_, to_;
};

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", value);
    return text;
}

std::string line(double x1, double y1, double x2, double y2, const std::string& style) {
    return "<line x1=\"" + fixed(x1, 1) + "\" y1=\"" + fixed(y1, 1) + "\" x2=\"" + fixed(x2, 1) + "\" y2=\"" +
           fixed(y2, 1) + "\" " + style + "/>\n";
}

std::string text_at(double x, double y, const std::string& style, const std::string& text) {
    return "<text x=\"" + fixed(x, 1) + "\" y=\"" + fixed(y, 1) + "\" " + style + '>' + escape(text) +
           "</text>\n";
}

std::string draw_axes(const Axis& x, const Axis& y) {
    constexpr const char* GRID = R"(stroke="#dddddd")";
    constexpr const char* AXIS = R"(stroke="black")";
    constexpr const char* CENTRED = R"(text-anchor="middle")";
    constexpr double RIGHT_END = WIDTH - RIGHT, LOWER_END = HEIGHT - BOTTOM;
    std::string svg;
    for (const double tick : x.ticks()) {
        svg += line(x.place(tick), TOP, x.place(tick), LOWER_END, GRID);
        svg += text_at(x.place(tick), LOWER_END + 18, CENTRED, number(tick));
    }
    for (const double tick : y.ticks()) {
        svg += line(LEFT, y.place(tick), RIGHT_END, y.place(tick), GRID);
        svg += text_at(LEFT - 8, y.place(tick) + 4, R"(text-anchor="end")", number(tick));
    }
    svg += line(LEFT, LOWER_END, RIGHT_END, LOWER_END, AXIS);
    svg += line(LEFT, TOP, LEFT, LOWER_END, AXIS);
    svg += text_at((LEFT + RIGHT_END) / 2, HEIGHT - 16, CENTRED, "rendering time [s]");
    const std::string middle = fixed((TOP + LOWER_END) / 2, 1);
    svg += text_at(0, 0, CENTRED + (" transform=\"translate(22 " + middle + ") rotate(-90)\""),
                   "relative error (root of relMSE)");
    return svg;
}

std::string draw_curve(const Curve& curve, const std::string& colour, const Axis& x, const Axis& y) {
    std::string places, marks;
    for (const CurvePoint& point : curve.points) {
        const std::string px = fixed(x.place(point.seconds), 1), py = fixed(y.place(point.error), 1);
        places.append(px).append(1, ',').append(py).append(1, ' ');
        marks.append("<circle cx=\"").append(px).append("\" cy=\"").append(py);
        marks.append(R"(" r="3" stroke="none" fill=")").append(colour).append("\"/>\n");
    }
    return "<polyline points=\"" + places + R"(" fill="none" stroke-width="2" stroke=")" + colour + "\"/>\n" +
           marks;
}

// At the lower left, where falling curves leave room.
std::string draw_legend(const std::vector<Curve>& curves) {
    std::string svg;
    double y = HEIGHT - BOTTOM - 12 - LEGEND_LINE * double(curves.size() - 1);
    for (size_t i = 0; i < curves.size(); ++i, y += LEGEND_LINE) {
        const std::string colour = COLOURS[i % COLOURS.size()];
        svg += line(LEFT + 12, y - 4, LEFT + 36, y - 4, R"(stroke-width="2" stroke=")" + colour + '"');
        svg += text_at(LEFT + 42, y, R"(text-anchor="start")", curves[i].name);
    }
    return svg;
}

}  // namespace

std::string draw_curves(const std::vector<Curve>& curves) {
    CurvePoint min{INFINITY, INFINITY}, max{};
    for (const Curve& curve : curves) {
        for (const CurvePoint& point : curve.points) {
            min = {std::min(min.seconds, point.seconds), std::min(min.error, point.error)};
            max = {std::max(max.seconds, point.seconds), std::max(max.error, point.error)};
        }
    }
    const Axis x(min.seconds, max.seconds, LEFT, WIDTH - RIGHT);
    const Axis y(min.error, max.error, HEIGHT - BOTTOM, TOP);
    const std::string size = fixed(WIDTH, 0) + ' ' + fixed(HEIGHT, 0);
    std::string svg = R"(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 )" + size + "\" width=\"" +
                      fixed(WIDTH, 0) + "\" height=\"" + fixed(HEIGHT, 0) +
                      "\" font-family=\"sans-serif\" font-size=\"13\">\n"
                      "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
    svg += draw_axes(x, y);
    for (size_t i = 0; i < curves.size(); ++i)
        svg += draw_curve(curves[i], COLOURS[i % COLOURS.size()], x, y);
    return svg + draw_legend(curves) + "</svg>\n";
}

}  // namespace candela

// Convergence curves as a drawing: error against time, both logarithmic, as SVG.
#pragma once

#include <string>
#include <vector>

namespace candela {

struct CurvePoint {
    double seconds = 0.0;  // Wall time of rendering; more than 0.
    double error = 0.0;    // Relative error of the image; more than 0.
};

struct Curve {
    std::string name;  // For the legend.
    std::vector<CurvePoint> points;
};

// An SVG document that shows each curve as a line with marks, with labelled axes and a legend. There must be
// at least one point. The colours are distinct to the colour-blind, too, and repeat after eight curves. Ref:
// Okabe and Ito, "Color Universal Design" (2008).
std::string draw_curves(const std::vector<Curve>& curves);

}  // namespace candela

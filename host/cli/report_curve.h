// The convergence curve of a report by `candela render --reference`.
#pragma once

#include <string>
#include <string_view>

#include "cli/curve_chart.h"

namespace candela {

// The points of a report that a chart can show, whose time and error are above 0. The report is the file
// `path` with the contents `text`. Throws Error if it is not a report or has no such points.
Curve curve_of_report(std::string_view text, const std::string& path);

}  // namespace candela

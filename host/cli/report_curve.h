// The convergence curve of a report by `candela render --reference`.
#pragma once

#include <string>
#include <string_view>

#include "cli/curve_chart.h"

namespace candela {

// The points of the report in the file `path`, with the contents `text`, that a chart can show: those whose
// time and error are above 0. Throws Error if it is not a report or has no such points.
Curve curve_of_report(std::string_view text, const std::string& path);

}  // namespace candela

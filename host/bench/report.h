// The results of a benchmark: rows of figures, with every single run, and the statistics in a table.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace candela {

// One line of the table. All lists have one value per run, in the order of the runs, or a single value if all
// runs must agree; values of ours and of the rival form pairs, since the two take turns. Speeds and times are
// by CPU time if a CPU does the work.
struct Row {
    std::string subject{};             // The task: "Cornell box, 32 triangles".
    std::string what{};                // "primary rays".
    std::string unit{};                // "Mrays/s"; empty for a plain number.
    std::vector<double> ours{};        // Not empty.
    std::vector<double> rival{};       // Embree's; empty if there is none.
    std::vector<double> ours_wall{};   // The same runs by wall time; empty if that is the same.
    std::vector<double> rival_wall{};  // Likewise.
};

struct Spread {
    double median, min, largest;
};

// For at least one value. The median of an even number of values is the mean of the two in the middle.
Spread spread(std::span<const double> values);

// Median over the runs of ours / rival; none without a rival.
std::optional<double> ratio(const Row& row);

}  // namespace candela

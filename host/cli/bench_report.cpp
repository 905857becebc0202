// See bench_report.h.
#include "cli/bench_report.h"

#include <algorithm>
#include <cstdio>

#include "base/printable.h"

namespace candela {
namespace {

using Json = nlohmann::ordered_json;

// Four digits, which is more than any benchmark is good for.
std::string number_text(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", value);
    return text;
}

// "21.3 (20.1 .. 22.0)"; a single run has no spread.
std::string spread_text(const std::vector<double>& values) {
    if (values.empty()) return "";
    const Spread s = spread(values);
    if (values.size() == 1) return number_text(s.median);
    return number_text(s.median) + " (" + number_text(s.min) + " .. " + number_text(s.largest) + ')';
}

std::string median_text(const std::vector<double>& values) {
    return values.empty() ? "" : number_text(spread(values).median);
}

std::string line(const std::vector<std::string>& cells) {
    // Widths of: what, unit, ours, wall, rival's, wall, ratio.
    constexpr size_t WIDTHS[] = {25, 12, 26, 9, 26, 9, 5};
    std::string text;
    for (size_t i = 0; i < cells.size(); ++i) {
        text += cells[i];
        text.append(cells[i].size() < WIDTHS[i] ? WIDTHS[i] - cells[i].size() : 1, ' ');
    }
    text.erase(text.find_last_not_of(' ') + 1);
    return text + '\n';
}

Json runs_json(const std::vector<double>& values, const std::vector<double>& wall) {
    if (values.empty()) return nullptr;
    return {{"runs", values}, {"wall", wall.empty() ? Json(nullptr) : Json(wall)}};
}

}  // namespace

std::string table_text(const BenchTable& table) {
    const bool rival = std::ranges::any_of(table.rows, [](const Row& row) { return !row.rival.empty(); });
    std::vector<std::string> cells{table.group, "", "candela", "wall"};
    if (rival) cells.insert(cells.end(), {"Embree", "wall", "ratio"});
    std::string text = line(cells);
    std::string subject;
    for (const Row& row : table.rows) {
        if (row.subject != subject) text += printable(row.subject, MAX_PATH_BYTES) + '\n';
        subject = row.subject;
        cells = {"  " + row.what, row.unit, spread_text(row.ours), median_text(row.ours_wall)};
        if (const auto r = ratio(row))
            cells.insert(cells.end(), {spread_text(row.rival), median_text(row.rival_wall), number_text(*r)});
        text += line(cells);
    }
    return text;
}

Json to_json(const BenchTable& table) {
    Json rows = Json::array();
    for (const Row& row : table.rows) {
        const auto r = ratio(row);
        rows.push_back({{"subject", row.subject},
                        {"what", row.what},
                        {"unit", row.unit},
                        {"candela", runs_json(row.ours, row.ours_wall)},
                        {"embree", runs_json(row.rival, row.rival_wall)},
                        {"ratio", r ? Json(*r) : Json(nullptr)}});
    }
    return {{"group", table.group}, {"rows", rows}};
}

}  // namespace candela

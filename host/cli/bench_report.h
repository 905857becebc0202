// How `candela bench` shows its figures: a table for people, JSON for programs.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "bench/report.h"

namespace candela {

// The rows of one group of benchmarks.
struct BenchTable {
    std::string group;
    std::vector<Row> rows;
};

// A line of headings, then the rows, below a line for each subject: what, unit, ours as median and (least ..
// largest), its median by wall time, and, if any row has a rival, the same for the rival and the ratio.
std::string table_text(const BenchTable& table);

// {"group": ..., "rows": [...]}: per row subject, what, unit, and all runs of `candela` and `embree` as
// {"runs": [...], "wall": [...]}, null where there are none, and their ratio.
nlohmann::ordered_json to_json(const BenchTable& table);

}  // namespace candela

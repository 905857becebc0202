// See report_curve.h.
#include "cli/report_curve.h"

#include <cmath>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "base/error.h"

namespace candela {
namespace {

using Json = nlohmann::ordered_json;

}  // namespace

Curve curve_of_report(std::string_view text, const std::string& path) {
    const auto refuse = [&](const std::string& why) {
        throw Error("cannot plot \"" + path + "\": " + why +
                    "; give a report of candela render --reference REF.exr --report FILE");
    };
    Curve curve{.name = std::filesystem::path(path).stem().string(), .points = {}};
    const Json report = Json::parse(text, nullptr, false);
    if (!report.is_object()) refuse("it is not a report");
    if (!report.contains("convergence") || !report.contains("reference"))
        refuse("it has no errors against a reference");
    try {
        for (const Json& point : report["convergence"]) {
            const double seconds = point.at("seconds"), relmse = point.at("relmse");
            if (seconds > 0.0 && relmse > 0.0) curve.points.push_back({seconds, std::sqrt(relmse)});
        }
    } catch (const Json::exception&) {
        refuse("its points are damaged");
    }
    if (curve.points.empty()) refuse("none of its points has both a time and an error above 0");
    return curve;
}

}  // namespace candela

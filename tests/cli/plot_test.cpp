// `candela plot`: the drawing is XML, has what a reader needs, and puts points where they belong.
#include <cmath>
#include <regex>
#include <utility>

#include "cli/cli_fixture.h"

namespace candela {
namespace {

using Points = std::vector<std::pair<double, double>>;

class PlotTest : public CliTest {
  protected:
    // A report with these pairs of seconds and relMSE.
    std::string report(const std::string& name, const Points& points) const {
        nlohmann::json json = {{"reference", "r.exr"}, {"convergence", nlohmann::json::array()}};
        for (const auto& [seconds, relmse] : points)
            json["convergence"].push_back({{"spp", 1}, {"seconds", seconds}, {"relmse", relmse}});
        return write(name, json.dump());
    }
    // The drawing of some reports.
    std::string plot(const Words& reports) const {
        const ProcessResult result = candela(Words{"plot"} + reports + Words{"-o", file("curves.svg")});
        EXPECT_EQ(result.exit_code, 0) << result.err;
        EXPECT_EQ(result.err + result.out, "");
        return read_file(file("curves.svg"));
    }
    // x and y of everything that matches `pattern`, whose first two groups they are.
    static Points places(const std::string& svg, const std::string& pattern) {
        const std::regex regex(pattern);
        Points places;
        for (std::sregex_iterator i(svg.begin(), svg.end(), regex), end; i != end; ++i)
            places.emplace_back(std::stod((*i)[1]), std::stod((*i)[2]));
        return places;
    }
    static size_t count(const std::string& text, const std::string& part) {
        size_t found = 0;
        for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
            ++found;
        return found;
    }
    const std::string circle_ = R"re(<circle cx="([0-9.]+)" cy="([0-9.]+)")re";
};

TEST_F(PlotTest, CurvesHaveAxesUnitsAndALegend) {
    const std::string svg = plot({report("sobol.json", {{1, 0.01}, {10, 0.001}}),
                                  report("random.json", {{1, 0.02}, {4, 0.01}, {16, 0.005}})});
    EXPECT_EQ(svg.rfind("<svg xmlns=\"http://www.w3.org/2000/svg\"", 0), 0u);
    EXPECT_CONTAINS(svg, ">rendering time [s]</text>");
    EXPECT_CONTAINS(svg, ">relative error (root of relMSE)</text>");
    EXPECT_CONTAINS(svg, ">sobol</text>");
    EXPECT_CONTAINS(svg, ">random</text>");
    EXPECT_EQ(count(svg, "<polyline "), 2u);
    EXPECT_EQ(count(svg, "<circle "), 5u);
    EXPECT_EQ(count(svg, "\"#0072b2\""), 4u);  // The first colour: curve, two marks, legend.
    EXPECT_EQ(count(svg, "\"#d55e00\""), 5u);
}

// On logarithmic axes equal factors are equal distances, and a mark of 10 s lies above the label 10. The
// places have one digit after the point.
TEST_F(PlotTest, PointsLieWhereTheAxesSay) {
    const std::string svg = plot({report("a.json", {{1, 0.04}, {10, 0.0004}, {100, 0.000004}})});
    const Points marks = places(svg, circle_);
    ASSERT_EQ(marks.size(), 3u);
    EXPECT_LT(marks[0].first, marks[1].first);
    EXPECT_NEAR(marks[2].first - marks[1].first, marks[1].first - marks[0].first, 0.2);
    EXPECT_LT(marks[0].second, marks[1].second);  // y points down.
    EXPECT_NEAR(marks[2].second - marks[1].second, marks[1].second - marks[0].second, 0.2);
    const Points ten = places(svg, R"re(<text x="([0-9.]+)" y="([0-9.]+)" text-anchor="middle">10<)re");
    ASSERT_EQ(ten.size(), 1u);
    EXPECT_NEAR(ten[0].first, marks[1].first, 0.1);
    const Points root = places(svg, R"re(<text x="([0-9.]+)" y="([0-9.]+)" text-anchor="end">0.02<)re");
    ASSERT_EQ(root.size(), 1u);
    EXPECT_NEAR(root[0].second - 4, marks[1].second, 0.1);  // A label's baseline is below its middle.
}

TEST_F(PlotTest, ASinglePointAndNamesThatXmlWouldTakeForItsOwn) {
    const std::string svg = plot({report("<a & \"b\">.json", {{3, 0.5}})});
    EXPECT_CONTAINS(svg, ">&lt;a &amp; &quot;b&quot;&gt;</text>");
    EXPECT_EQ(places(svg, circle_).size(), 1u);
    EXPECT_GE(count(svg, "text-anchor=\"end\""), 3u);
    EXPECT_EQ(svg.find("nan"), std::string::npos);
}

TEST_F(PlotTest, ReportsOfRenderCanBePlotted) {
    ASSERT_EQ(render({"-o", file("reference.exr"), "--spp", "16", "--seed", "1"}).exit_code, 0);
    ASSERT_EQ(render({"-o", file("a.png"), "--reference", file("reference.exr"), "--report", file("r.json")})
                  .exit_code,
              0);
    EXPECT_EQ(places(plot({file("r.json")}), circle_).size(), 3u);
}

TEST_F(PlotTest, WhatCannotBePlottedIsRefused) {
    const auto expect_refused = [&](const std::string& path, const std::string& reason) {
        const ProcessResult result = candela({"plot", path, "-o", file("a.svg")});
        EXPECT_EQ(result.exit_code, 1);
        EXPECT_CONTAINS(result.err, "candela: error: cannot plot \"" + path + "\": " + reason +
                                        "; give a report of candela render --reference REF.exr --report "
                                        "FILE\n");
        EXPECT_FALSE(std::filesystem::exists(file("a.svg")));
    };
    expect_refused(write("text.json", "no JSON"), "it is not a report");
    expect_refused(write("none.json", "{}"), "it has no errors against a reference");
    expect_refused(write("bad.json", R"({"reference": "r", "convergence": [{"seconds": "1"}]})"),
                   "its points are damaged");
    expect_refused(report("zero.json", {{0, 1}, {1, 0}}),
                   "none of its points has both a time and an error above 0");
    EXPECT_CONTAINS(candela({"plot", file("missing.json"), "-o", file("a.svg")}).err,
                    "missing.json\": the file does not exist");
    const ProcessResult png = candela({"plot", file("none.json"), "-o", "a.png"});
    EXPECT_EQ(png.exit_code, 2);
    EXPECT_EQ(png.err, "candela: error: -o: cannot use \"a.png\"; expected a file name ending in .svg\n");
    EXPECT_EQ(candela({"plot", file("none.json")}).exit_code, 2);
}

}  // namespace
}  // namespace candela

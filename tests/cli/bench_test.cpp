// `candela bench` as a user calls it, at the smallest sizes: every figure is there, and every mistake is
// named. Nothing here says how fast anything is.
#include <array>

#include "cli/cli_fixture.h"

namespace candela {
namespace {

class BenchCommand : public CliTest {
  protected:
    // The program's own words tell whether it was built with Embree.
    static bool has_rival(const ProcessResult& result) {
        return result.out.find("rival    none") == std::string::npos;
    }

    static void expect_usage_error(const Words& arguments, const std::string& message) {
        const ProcessResult result = candela(Words{"bench"} + arguments);
        EXPECT_EQ(result.exit_code, 2) << message;
        EXPECT_EQ(result.out, "");
        EXPECT_CONTAINS(result.err, "candela: error: " + message);
    }
};

TEST_F(BenchCommand, MeasuresEverythingByDefault) {
    const ProcessResult result =
        candela({"bench", "--runs", "2", "--triangles", "72", "--trees", "2", "--instances", "2000", "--rays",
                 "64", "--spp", "2", "--size", "16x16", "--json", file("bench.json")});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    for (const char* part : {"\ndevice   ",
                             "\ndriver   ",
                             "\nsystem   ",
                             " cores\n",
                             "\nrival    ",
                             "\ntraversal  ",
                             "\nCornell box, 32 triangles\n",
                             "\n72 triangles\n",
                             "\n  primary rays           Mrays/s ",
                             "\n  first bounce           Mrays/s ",
                             "\n  second bounce          Mrays/s ",
                             "\n  shadow rays            Mrays/s ",
                             "\ninstances  ",
                             "\n2 trees, 200 k triangles\n",
                             "\n  device memory          MiB ",
                             "\nscattered, 2000 instances\n",
                             "\n  build                  s ",
                             "\n  device memory          B/instance ",
                             "\nbuild  ",
                             "Mtri/s ",
                             "\n  SAH cost",
                             "\n  device memory          B/triangle ",
                             "\nrender  ",
                             "\nCornell box\n",
                             "\n  samples                Msamples/s ",
                             "\n  rays per sample ",
                             "\nfirst-pixel  ",
                             "\n  first image, cold      s ",
                             "\n  first image, warm      s ",
                             " (",
                             " .. "})
        EXPECT_CONTAINS(result.out, part);
    EXPECT_EQ(result.out.find("relMSE") == std::string::npos, true);
    EXPECT_EQ(has_rival(result), result.out.find("  rays with another hit") != std::string::npos);
    if (!has_rival(result)) {
        EXPECT_CONTAINS(
            result.out,
            "none; to compare with Embree, install libembree-dev and build with cmake -DCANDELA_EMBREE=ON");
    }

    const auto report = nlohmann::json::parse(read_file(file("bench.json")));
    for (const char* key : {"version", "device", "type", "driver", "vulkan", "system", "clock"})
        EXPECT_NE(report[key], "") << key;
    EXPECT_GE(report["cores"], 1);
    EXPECT_EQ(report["embree"].is_null(), !has_rival(result));
    const auto& settings = report["settings"]["Cornell box"];
    EXPECT_EQ(settings["runs"], 2);
    EXPECT_EQ(settings["rays"], 64);
    EXPECT_EQ(settings["triangles"], nlohmann::json({72}));
    EXPECT_EQ(settings["trees"], 2);
    EXPECT_EQ(settings["instances"], 2000);
    EXPECT_EQ(settings["spp"], 2);
    EXPECT_TRUE(settings["seconds"].is_null());
    EXPECT_EQ(settings["width"], 16);
    EXPECT_EQ(settings["sampler"], "sobol");
    for (const auto& group : report["groups"]) {
        for (const auto& row : group["rows"]) {
            // The rival traces rays and builds trees, but no records of instances.
            const bool rivalled = has_rival(result) &&
                                  (group["group"] == "traversal" || group["group"] == "instances" ||
                                   group["group"] == "build") &&
                                  row["what"] != "build";
            const bool timed = !row["candela"]["wall"].is_null();
            for (const double value : row["candela"]["runs"])
                EXPECT_TRUE(value > 0.0 || row["what"] == "rays with another hit") << row;
            if (timed) {
                EXPECT_EQ(row["candela"]["runs"].size(), 2u) << row;
                EXPECT_EQ(row["embree"].is_null(), !rivalled) << row;
            }
            EXPECT_EQ(row["embree"].is_null(), row["ratio"].is_null()) << row;
        }
    }
}

// Each run has the next seed, and renders what `render` renders with that.
TEST_F(BenchCommand, RaysAndRelativeErrorsAreThoseOfTheImagesOfRender) {
    const Words settings{"--size", "24x16",      "--spp", "4",         "--max-depth",
                         "3",      "--rr-depth", "1",     "--sampler", "independent"};
    const auto render_as = [&](const std::string& name, const Words& more) {
        const Words words =
            Words{"render", CORNELL_BOX, "-o", file(name), "--aov", "none", "--report", file("report.json")} +
            settings + more;
        EXPECT_EQ(candela(words).exit_code, 0);
        return read_exr(file(name));
    };
    const Image reference = render_as("reference.exr", {"--spp", "64", "--seed", "9"});
    const ProcessResult result =
        candela(Words{"bench", CORNELL_BOX, "--only", "render", "--runs", "2", "--seed", "5", "--json", "-",
                      "--reference", file("reference.exr")} +
                settings);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_CONTAINS(result.err, "render: " + CORNELL_BOX);
    const auto report = nlohmann::json::parse(result.out);
    const auto& rows = report["groups"][0]["rows"];
    const auto& row = rows[2];
    ASSERT_EQ(rows[1]["what"], "rays per sample");
    ASSERT_EQ(row["what"], "relMSE");

    double mean = 0.0;
    for (const char* channel : {"R", "G", "B"}) {
        for (const float value : reference.find(channel)->values)
            mean += double(value) / (3.0 * 24.0 * 16.0);
    }
    for (const size_t run : {0u, 1u}) {
        const Image image = render_as("image.exr", {"--seed", std::to_string(5 + run)});
        const auto figures = nlohmann::json::parse(read_file(file("report.json")));
        EXPECT_DOUBLE_EQ(rows[1]["candela"]["runs"][run], figures["rays_per_sample"]);
        double error = 0.0;
        for (const char* channel : {"R", "G", "B"}) {
            for (size_t i = 0; i < image.pixel_count(); ++i) {
                const auto r = double(reference.find(channel)->values[i]);
                const double difference = double(image.find(channel)->values[i]) - r;
                error += difference * difference / (r * r + 0.01 * mean * mean) / (3.0 * 24.0 * 16.0);
            }
        }
        // The same terms in another order, in double precision.
        EXPECT_NEAR(row["candela"]["runs"][run].get<double>(), error, 1e-12 * error);
    }
}

TEST_F(BenchCommand, ARunMayEndByTheClock) {
    const ProcessResult result = candela(
        {"bench", "--only", "render", "--runs", "1", "--seconds", "0.05", "--size", "16x16", "--json", "-"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const auto report = nlohmann::json::parse(result.out);
    EXPECT_EQ(report["settings"]["Cornell box"]["seconds"], 0.05);
    EXPECT_TRUE(report["settings"]["Cornell box"]["spp"].is_null());
    EXPECT_EQ(report["groups"].size(), 1u);
}

TEST_F(BenchCommand, HelpListsEveryOptionAndWhatIsMeasured) {
    const ProcessResult help = candela({"bench", "--help"});
    EXPECT_EQ(help.exit_code, 0);
    for (const char* part :
         {"--only",      "--runs",    "--json",    "--triangles",     "--trees",
          "--instances", "--rays",    "--seconds", "--reference",     "--size",
          "--crop",      "--spp",     "--seed",    "--max-depth",     "--rr-depth",
          "--estimator", "--sampler", "--device",  "--scene-buffers", "traversal:",
          "instances:",  "build:",    "render:",   "first-pixel:",    "(x - r)^2 / (r^2 + 0.01 m^2)"})
        EXPECT_CONTAINS(help.out, part);
}

TEST_F(BenchCommand, BadValuesAreNamedWithWhatIsExpected) {
    const std::string groups = "a list of traversal, instances, build, render and first-pixel";
    const std::string triangles = "a list of numbers such as 190k, 1M, 10M, each from 72 to 100M";
    const std::vector<std::array<std::string, 3>> cases = {
        {"--only", "rays", groups},
        {"--only", "render,", groups},
        {"--only", "render;traversal", groups},
        {"--runs", "0", "a whole number from 1 to 1000"},
        {"--triangles", "71", triangles},
        {"--triangles", "1k,", triangles},
        {"--triangles", "101M", triangles},
        {"--triangles", "1G", triangles},
        {"--triangles", "k", triangles},
        {"--trees", "0", "a whole number from 1 to 40000"},
        {"--instances", "1999", "a whole number from 2000 to 10000000"},
        {"--rays", "63", "a whole number from 64 to 16777216"},
        {"--seconds", "0", "a duration such as 5, 5s or 1.5m"},
        {"--spp", "0", "a whole number from 1 to 16777216"},
    };
    for (const auto& [option, value, expected] : cases)
        expect_usage_error({option, value}, option + ": cannot use \"" + value + "\"; expected " + expected);
    expect_usage_error({"--faster"}, "unknown argument \"--faster\"; see candela bench --help");
}

TEST_F(BenchCommand, ReferencesThatDoNotFitAreNamed) {
    expect_usage_error({CORNELL_BOX, MESH, "--reference", "r.exr"},
                       "--reference: one image cannot be the reference of 2 scenes; give one scene");

    const auto message = [&](const std::string& reference, const Words& size) {
        const ProcessResult result =
            candela(Words{"bench", "--only", "render", "--reference", reference} + size);
        EXPECT_EQ(result.exit_code, 1);
        EXPECT_EQ(result.out, "");
        return result.err;
    };
    EXPECT_CONTAINS(message("nowhere.exr", {}), "nowhere.exr");
    const std::string small = file("small.exr");
    ASSERT_EQ(render({"--spp", "1", "--aov", "none", "-o", small}).exit_code, 0);
    EXPECT_CONTAINS(
        message(small, {"--size", "64x48"}),
        small +
            ": the reference has 32x32 pixels, but Cornell box is rendered with 64x48; use --size or "
            "--crop as for the reference");
    Image depth{.full = {8, 8}, .data = {0, 0, 8, 8}, .channels = {}, .attributes = {}};
    depth.add("Z");
    write_exr(file("depth.exr"), depth);
    EXPECT_CONTAINS(
        message(file("depth.exr"), {"--size", "8x8"}),
        file("depth.exr") + ": the reference lacks the channels R, G and B; render it with candela render");
}

TEST_F(BenchCommand, WhatCannotBeReadOrWrittenIsFoundBeforeAnyWork) {
    const ProcessResult scene = candela({"bench", "nowhere.json"});
    EXPECT_EQ(scene.exit_code, 1);
    EXPECT_CONTAINS(scene.err, "nowhere.json");
    const ProcessResult json = candela({"bench", "--json", "/nonexistent/bench.json"});
    EXPECT_EQ(json.exit_code, 1);
    EXPECT_EQ(json.out, "");
    EXPECT_CONTAINS(json.err, "/nonexistent/bench.json");
    EXPECT_EQ(candela({"bench"}, NO_DRIVER).exit_code, 3);
}

}  // namespace
}  // namespace candela

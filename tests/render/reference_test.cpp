// Scenes compared with references by Mitsuba 3 (references/make_references.py), an independent renderer: one
// scene for each thing that could be wrong.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <ostream>

#include "image/develop.h"
#include "image/image_io.h"
#include "load/load.h"
#include "render_fixture.h"
#include "unit/base/base_fixture.h"

namespace candela {
namespace {

namespace fs = std::filesystem;

struct Reference {
    const char* name;
    uint32_t spp;                 // Samples per pixel, for largest_pixel_error().
    const char* image = nullptr;  // Image of the scene with the same picture, if it has none of its own.
    // With fewer samples, the mean of a pixel is not nearly normal, as the test of pixels takes it.
    uint32_t min_spp = 128;
};

void PrintTo(const Reference& reference, std::ostream* os) {
    *os << reference.name;
}

constexpr std::array REFERENCES{
    Reference{"cornell-box", 1280},
    Reference{"colour-bleeding", 832},
    Reference{"mirror", 1760},
    Reference{"glass", 896},
    Reference{"absorbing-glass", 512},
    Reference{"nested-glass", 512},
    Reference{"rough-metal", 1536},
    Reference{"phong", 1600},
    Reference{"depth-of-field", 1024},
    Reference{"environment", 640},
    Reference{"small-sphere-light", 832},
    Reference{"many-lights", 2560},
    Reference{"mesh-light", 2688},
    Reference{"smooth-normals", 256},
    Reference{"textured-diffuse", 1024, nullptr, 1024},  // A little of a bright texel in a black one.
    Reference{"normal-map", 256},
    Reference{"textured-roughness", 256},
    Reference{"textured-emitter", 1152},
    Reference{"mask", 768},
    Reference{"brushed-metal", 512},
    Reference{"frosted-glass", 512},
    Reference{"thin-glass", 768},
    Reference{"coated-plastic", 256},
    Reference{"punctual-lights", 768},
    Reference{"hundred-lights", 1280},
    Reference{"orthographic", 512},
    Reference{"smoke", 512},
    Reference{"haze", 2048},
    Reference{"milk", 512},
    Reference{"principled-nested-glass", 512, "nested-glass"},
};

// The median over pixels of the standard error over the mean may not be larger: else the test would accept
// anything.
double largest_pixel_error() {
    return 15.0 * largest_error();
}

// Each scene is tested three times (pixels, blocks, mean); the probability that a correct renderer fails any
// of all these tests is TEST_ALPHA.
const CompareOptions OPTIONS{.alpha = sidak_level(TEST_ALPHA, 3 * REFERENCES.size())};

// The scene of a reference: beside it, or one of those that users see.
fs::path scene_file(const std::string& name) {
    const fs::path beside = fs::path(CANDELA_REFERENCES) / (name + ".json");
    return fs::exists(beside) ? beside : fs::path(CANDELA_SCENES) / (name + ".json");
}

// Median over pixels and channels of the standard error over the mean; of those with light.
double median_relative_error(const Image& image) {
    std::vector<double> errors;
    for (size_t c = 0; c < 3; ++c) {
        for (size_t i = 0; i < image.pixel_count(); ++i) {
            const double mean = plane(image, "", c)[i];
            if (mean > 0.0) errors.push_back(std::sqrt(double(plane(image, "Variance", c)[i])) / mean);
        }
    }
    const auto middle = errors.begin() + std::ptrdiff_t(errors.size() / 2);
    std::nth_element(errors.begin(), middle, errors.end());
    return *middle;
}

// Differences image - reference, or the probabilities of differences at least as large if both images have
// the same expectation, of each pixel and channel.
Image differences(const Image& image, const Image& reference, bool p_values) {
    Image result;
    result.full = image.full;
    result.data = image.data;
    for (size_t c = 0; c < 3; ++c) {
        Channel& channel = result.add(std::string(1, "RGB"[c]));
        for (size_t i = 0; i < image.pixel_count(); ++i) {
            const double difference = double(plane(image, "", c)[i]) - double(plane(reference, "", c)[i]);
            const double variance =
                double(plane(image, "Variance", c)[i]) + double(plane(reference, "Variance", c)[i]);
            const double p = difference == 0.0 ? 1.0 : normal_p_value(difference / std::sqrt(variance));
            channel.values[i] = float(p_values ? p : difference);
        }
    }
    return result;
}

// Writes what one needs to see why a comparison failed: image, reference, error and p-values, each as numbers
// (.exr) and as a picture (.png); the latter two as compare.h's heatmaps of relative error and of |z|.
void leave_pictures(const fs::path& folder, const Image& image, const Image& reference) {
    fs::create_directories(folder);
    const auto write = [&](const std::string& name, const Image& numbers,
                           const std::vector<uint8_t>& picture) {
        write_exr(folder / (name + ".exr"), numbers);
        write_png(folder / (name + ".png"), image.data.width(), image.data.height(), picture);
    };
    for (const auto& [name, numbers] : {std::pair("image", &image), std::pair("reference", &reference)}) {
        write_exr(folder / (std::string(name) + ".exr"), *numbers);
        write_picture(folder / (std::string(name) + ".png"), develop(*numbers, {}));
    }
    CompareOptions by_error = OPTIONS;
    by_error.relmse = DEFAULT_RELMSE;
    write("error", differences(image, reference, false), heatmap(image, reference, by_error));
    write("p-value", differences(image, reference, true), heatmap(image, reference, OPTIONS));
}

std::string describe(const ZTests& tests) {
    const auto text = [](const char* what, const WorstDeviation& worst) {
        return std::string(what) + ": worst z " + std::to_string(worst.z) + " in " + worst.channel + " at " +
               std::to_string(worst.place.x0) + ',' + std::to_string(worst.place.y0) + ", at most " +
               std::to_string(worst.critical) + '\n';
    };
    return std::to_string(100.0 * tests.passing_pixels) + " % of the pixels pass\n" +
           text("pixels", tests.pixel) + text("blocks", tests.block) + text("mean", tests.mean);
}

// Tests two images of one expectation; on failure leaves pictures in the folder and says so.
testing::AssertionResult agree(const Image& image, const Image& reference, const fs::path& folder) {
    const Comparison comparison = compare(image, reference, OPTIONS);
    if (!comparison.tests) return testing::AssertionFailure() << "the reference has no variance";
    if (comparison.passed) return testing::AssertionSuccess();
    leave_pictures(folder, image, reference);
    return testing::AssertionFailure() << describe(*comparison.tests) << "pictures: " << folder.string();
}

class ReferenceTest : public RenderTest, public testing::WithParamInterface<Reference> {};

TEST_P(ReferenceTest, AnIndependentRendererMakesTheSamePicture) {
    const auto [name, spp, same, min_spp] = GetParam();
    const Image reference =
        read_exr(fs::path(CANDELA_REFERENCES) / (std::string(same ? same : name) + ".exr"));
    // Some show meshes and skies of the gallery.
    const Scene scene = load_scene(scene_file(name), {.reach = {.folders = {CANDELA_SCENES}}});
    RenderSettings settings = independent_settings(reference.full.x, Estimator::mis, 1);
    settings.max_depth = scene.integrator.max_depth.value_or(DEPTH_SAFETY_LIMIT);
    settings.terminator = scene.integrator.terminator;
    const Image image = image_of(render(scene, settings, std::max(samples(spp), min_spp)));
    EXPECT_LE(median_relative_error(image), largest_pixel_error());
    EXPECT_TRUE(agree(image, reference, fs::path(CANDELA_FAILURES) / name));
}

INSTANTIATE_TEST_SUITE_P(Mitsuba, ReferenceTest, testing::ValuesIn(REFERENCES), [](const auto& reference) {
    std::string name = reference.param.name;
    std::replace(name.begin(), name.end(), '-', '_');  // GoogleTest takes letters, digits and underscores.
    return name;
});

// Grey, with a standard error of 1 %.
Image grey_picture(float value) {
    Image image;
    image.full = {16, 8};
    image.data = {0, 0, 16, 8};
    for (const char* name : {"R", "G", "B"})
        image.add(name, value);
    for (const char* name : {"Variance.R", "Variance.G", "Variance.B"})
        image.add(name, 1e-4f * value * value);
    return image;
}

TEST(ReferencePictures, AreLeftWhenTheImagesDiffer) {
    const TemporaryDirectory folder;
    const Image reference = grey_picture(0.5f);
    EXPECT_TRUE(agree(reference, reference, folder / "same"));
    EXPECT_FALSE(fs::exists(folder / "same"));

    const testing::AssertionResult result = agree(grey_picture(0.52f), reference, folder / "other");
    EXPECT_FALSE(result);
    EXPECT_NE(std::string(result.message()).find("pictures: " + (folder / "other").string()),
              std::string::npos);
    for (const char* name : {"image", "reference", "error", "p-value"}) {
        EXPECT_TRUE(fs::exists(folder / "other" / (std::string(name) + ".png"))) << name;
        EXPECT_NO_THROW(read_exr(folder / "other" / (std::string(name) + ".exr"))) << name;
    }
    // A difference of 0.02, of which float rounds 2^-25, over the standard errors of both: less than 3, and
    // yet the blocks of 64 pixels reveal it.
    const double z = 0.02 / std::hypot(0.0052, 0.005);
    const double rounding = 0x1p-25 / 0.02;
    EXPECT_NEAR(plane(read_exr(folder / "other" / "error.exr"), "", 1)[7], 0.02, 0.02 * rounding);
    EXPECT_NEAR(plane(read_exr(folder / "other" / "p-value.exr"), "", 1)[7], std::erfc(z * M_SQRT1_2),
                2 * z * rounding);
}

}  // namespace
}  // namespace candela

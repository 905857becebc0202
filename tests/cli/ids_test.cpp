// Pictures of ids: layers of EXR files, labels in colours, depths for programs, and what things are called.
#include <algorithm>
#include <cstring>

#include "cli/cli_fixture.h"
#include "image/texel_io.h"

namespace candela {
namespace {

// A wall 4 m away on the left, two balls in front of it and beside it, and a tower 74 m away at the bottom
// right; each of them has its own material but for the tower, which shares that of the wall.
const std::string THINGS = R"({
    "cameras": { "main": { "position": [0, 0, 4], "look_at": [0, 0, 0], "vertical_fov": 53.13010235415598 } },
    "film": { "size": [48, 32] },
    "materials": { "chalk": { "type": "diffuse", "reflectance": 0.7 },
                   "rubber": { "type": "diffuse", "reflectance": [0.7, 0.1, 0.1] } },
    "objects": { "ball": [ { "type": "sphere", "radius": 0.4, "material": "rubber" } ] },
    "shapes": [
        { "type": "quad", "name": "wall \"A\"", "material": "chalk",
          "vertices": [[-3, -2, 0], [0, -2, 0], [0, 2, 0], [-3, 2, 0]] },
        { "type": "instance", "object": "ball", "transforms": [[{ "translate": [-1.5, 0, 0.5] }],
                                                               [{ "translate": [1.5, 1, 0.5] }]] },
        { "type": "quad", "material": "chalk",
          "vertices": [[20, -50, -70], [90, -50, -70], [90, -20, -70], [20, -20, -70]] } ],
    "environment": { "radiance": 1 } })";

class Ids : public CliTest {
  protected:
    ProcessResult render_things(const Words& arguments, const std::string& scene = THINGS) const {
        return candela(Words{"render", write("things.json", scene), "--spp", "4", "--quiet"} + arguments);
    }
    // Renders into an EXR with these layers.
    Image layers(const std::string& list, const Words& arguments = {}) const {
        const ProcessResult result = render_things(Words{"-o", file("a.exr"), "--aov", list} + arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        EXPECT_EQ(result.err, "");
        return read_exr(file("a.exr"));
    }
    TexelImage texels(const std::string& name) const {
        std::vector<std::string> warnings;
        return decode_texels(read_file(file(name)), file(name), warnings);
    }
};

std::string text_of(const Image& image, const std::string& attribute) {
    const auto found = image.attributes.find(attribute);
    return found == image.attributes.end() ? "" : std::get<std::string>(found->second);
}

// In the middles of: the wall, the ball before it, the other ball, the tower, nothing.
constexpr size_t WALL = 4 * 48 + 4, BALL = 15 * 48 + 9, OTHER_BALL = 6 * 48 + 38, TOWER = 28 * 48 + 40,
                 SKY = 47;

TEST_F(Ids, AreLayersWithNames) {
    const Image image = layers("ids,depth");
    std::string names;
    for (const Channel& channel : image.channels)
        names += channel.name + ' ';
    EXPECT_EQ(names, "A B Depth.V G InstanceId.V MaterialId.V ObjectId.V R ");
    const auto at = [&](const char* channel, size_t i) { return image.find(channel)->values[i]; };
    EXPECT_EQ(at("ObjectId.V", WALL), 1.0f);
    EXPECT_EQ(at("ObjectId.V", BALL), 2.0f);
    EXPECT_EQ(at("ObjectId.V", OTHER_BALL), 2.0f);
    EXPECT_EQ(at("ObjectId.V", TOWER), 3.0f);
    EXPECT_EQ(at("ObjectId.V", SKY), 0.0f);
    EXPECT_EQ(at("InstanceId.V", BALL), 2.0f);
    EXPECT_EQ(at("InstanceId.V", OTHER_BALL), 3.0f);
    EXPECT_EQ(at("InstanceId.V", TOWER), 4.0f);
    EXPECT_EQ(at("MaterialId.V", TOWER), 1.0f);
    EXPECT_EQ(at("MaterialId.V", BALL), 2.0f);
    EXPECT_TRUE(std::isinf(at("Depth.V", SKY)));
    // The pixel's centre is at (4.5 - 24, 16 - 4.5) / 8 m in the plane of the wall.
    EXPECT_NEAR(at("Depth.V", WALL), std::sqrt(16.0 + (19.5 * 19.5 + 11.5 * 11.5) / 64.0), 2e-6);
    EXPECT_EQ(nlohmann::json::parse(text_of(image, "candela.ids")),
              nlohmann::json::parse(R"({"objects": {"wall \"A\"": 1, "ball": 2, "quad 2": 3},
                                        "instances": {"wall \"A\"": [1], "ball": [2, 3], "quad 2": [4]},
                                        "materials": {"chalk": 1, "rubber": 2}})"));
}

// The ids are those that the plug-ins of the specification's authors compute.
TEST_F(Ids, AreRanksOfCryptomatte) {
    const Image image = layers("cryptomatte");
    EXPECT_EQ(image.channels.size(), 4u + 24u);
    EXPECT_EQ(text_of(image, "cryptomatte/3ae39a5/name"), "CryptoObject");
    EXPECT_EQ(text_of(image, "cryptomatte/3ae39a5/hash"), "MurmurHash3_32");
    EXPECT_EQ(text_of(image, "cryptomatte/3ae39a5/conversion"), "uint32_to_float32");
    EXPECT_EQ(text_of(image, "cryptomatte/be359d6/name"), "CryptoMaterial");
    const auto manifest = nlohmann::json::parse(text_of(image, "cryptomatte/3ae39a5/manifest"));
    EXPECT_EQ(manifest.size(), 3u);
    EXPECT_EQ(manifest["ball"], "645d3bc4");
    const auto id = [&](size_t i) {
        uint32_t bits = 0;
        std::memcpy(&bits, &image.find("CryptoObject00.R")->values[i], sizeof bits);
        return bits;
    };
    EXPECT_EQ(id(BALL), 0x645D3BC4u);
    EXPECT_EQ(id(OTHER_BALL), 0x645D3BC4u);
    EXPECT_EQ(id(SKY), 0u);
    EXPECT_EQ(image.find("CryptoObject00.G")->values[BALL], 1.0f);
    EXPECT_EQ(image.find("CryptoObject00.A")->values[BALL], 0.0f);
    EXPECT_EQ(image.attributes.count("candela.ids"), 0u);
}

TEST_F(Ids, ChangeNoColour) {
    const Words settings = {"--size", "16x16", "--spp", "2"};
    EXPECT_EQ(report_of(settings + Words{"-o", file("a.exr"), "--aov", "all"})["image_hash"],
              report_of(settings + Words{"-o", file("b.exr"), "--aov", "none"})["image_hash"]);
}

TEST_F(Ids, LabelsAreColoursOfNumbers) {
    ASSERT_EQ(render_things({"--labels", file("l.png"), "-o", file("a.png")}).exit_code, 0);
    ASSERT_EQ(render_things({"--labels", file("i.png"), "--labels-of", "instances"}).exit_code, 0);
    ASSERT_EQ(render_things({"--labels", file("m.png"), "--labels-of", "materials"}).exit_code, 0);
    const auto colour = [](const TexelImage& image, size_t i) {
        EXPECT_EQ(image.size, uvec2(48, 32));
        EXPECT_EQ(image.channels, 3u);
        std::array<int, 3> rgb{};
        for (size_t c = 0; c < 3; ++c)
            rgb[c] = std::to_integer<int>(image.texels[3 * i + c]);
        return rgb;
    };
    using Rgb = std::array<int, 3>;
    const TexelImage objects = texels("l.png"), instances = texels("i.png"), materials = texels("m.png");
    EXPECT_EQ(colour(objects, SKY), (Rgb{0, 0, 0}));
    EXPECT_EQ(colour(objects, WALL), (Rgb{128, 0, 0}));
    EXPECT_EQ(colour(objects, BALL), (Rgb{0, 128, 0}));
    EXPECT_EQ(colour(objects, OTHER_BALL), (Rgb{0, 128, 0}));
    EXPECT_EQ(colour(objects, TOWER), (Rgb{128, 128, 0}));
    EXPECT_EQ(colour(instances, OTHER_BALL), (Rgb{128, 128, 0}));
    EXPECT_EQ(colour(instances, TOWER), (Rgb{0, 0, 128}));
    EXPECT_EQ(colour(materials, TOWER), (Rgb{128, 0, 0}));
    EXPECT_EQ(read_file(file("a.png")).find("wall"), std::string::npos) << "no picture holds the names";
}

TEST_F(Ids, DepthsAreMillimetresOrMicrometres) {
    const auto depth = [&](const std::string& name, size_t i) {
        const TexelImage image = texels(name);
        EXPECT_EQ(image.channels, 1u);
        EXPECT_EQ(image.type, TexelType::unorm16);
        uint16_t value = 0;
        std::memcpy(&value, &image.texels[2 * i], sizeof value);
        return value;
    };
    const ProcessResult far = render_things({"--depth-png", file("mm.png")});
    EXPECT_EQ(far.exit_code, 0);
    EXPECT_EQ(depth("mm.png", WALL), 4000);
    EXPECT_EQ(depth("mm.png", TOWER), 0);
    EXPECT_EQ(depth("mm.png", SKY), 0);
    EXPECT_CONTAINS(far.err, "mm.png\": ");
    EXPECT_CONTAINS(
        far.err,
        " pixels show what is not between 1 and 65535 mm away, and is 0 there; the layer Z of an EXR "
        "has no limit\n");
    const std::string small = [] {
        std::string scene = THINGS;
        for (const auto& [from, to] :
             {std::pair("[0, 0, 4]", "[0, 0, 0.04]"), std::pair("[-3, -2, 0]", "[-3, -2, 0.0025]"),
              std::pair("[0, -2, 0]", "[0, -2, 0.0025]"), std::pair("[0, 2, 0]", "[0, 2, 0.0025]"),
              std::pair("[-3, 2, 0]", "[-3, 2, 0.0025]")})
            scene.replace(scene.find(from), std::strlen(from), to);
        return scene;
    }();
    const ProcessResult near = render_things({"--depth-png", file("um.png"), "--depth-unit", "um"}, small);
    EXPECT_EQ(near.exit_code, 0);
    EXPECT_NEAR(depth("um.png", WALL), 37500,
                8);  // Floats around 90 m, the size of the scene: 2^-24 * 128 m.
    EXPECT_CONTAINS(near.err,
                    "between 1 and 65535 um away, and is 0 there; --depth-unit mm reaches up to 65.535 m");
}

TEST_F(Ids, ManifestIsJson) {
    ASSERT_EQ(render_things({"--manifest", file("m.json"), "-o", file("a.exr")}).exit_code, 0);
    const Image image = read_exr(file("a.exr"));
    EXPECT_EQ(nlohmann::json::parse(read_file(file("m.json"))),
              nlohmann::json::parse(text_of(image, "candela.ids")));
    EXPECT_NE(image.find("ObjectId.V"), nullptr) << "the layers that it is about";
}

TEST_F(Ids, PartsMergeIfTheyAreEqual) {
    const Words aovs = {"--aov", "ids,cryptomatte,depth,z", "--quiet"};
    const std::string scene = write("things.json", THINGS);
    for (const std::string samples : {"0..2", "2..8"}) {
        ASSERT_EQ(candela(Words{"render", scene, "--samples", samples, "-o", file(samples + ".exr")} + aovs)
                      .exit_code,
                  0);
    }
    const ProcessResult merged =
        candela({"merge", file("0..2.exr"), file("2..8.exr"), "-o", file("m.exr"), "--labels", file("m.png"),
                 "--depth-png", file("d.png"), "--manifest", file("m.json")});
    EXPECT_EQ(merged.exit_code, 0) << merged.err;
    ASSERT_EQ(
        candela(Words{"render", scene, "--spp", "8", "-o", file("w.exr"), "--labels", file("w.png")} + aovs)
            .exit_code,
        0);
    const Image image = read_exr(file("m.exr")), whole = read_exr(file("w.exr"));
    EXPECT_EQ(image.channels.size(), whole.channels.size());
    for (const Channel& channel : image.channels) {
        if (channel.name.size() == 1 && channel.name != "Z") continue;
        EXPECT_EQ(channel.values, whole.find(channel.name)->values) << channel.name;
    }
    for (const char* name : {"candela.ids", "cryptomatte/3ae39a5/manifest", "cryptomatte/be359d6/manifest"})
        EXPECT_EQ(image.attributes.at(name), whole.attributes.at(name)) << name;
    EXPECT_EQ(texels("m.png").texels, texels("w.png").texels);
    EXPECT_TRUE(std::filesystem::exists(file("d.png")));
    EXPECT_TRUE(std::filesystem::exists(file("m.json")));

    ASSERT_EQ(
        candela({"render", scene, "--spp", "1", "-o", file("n.exr"), "--aov", "none", "--quiet"}).exit_code,
        0);
    for (const auto& [option, name, needs] :
         {std::array{"--labels", "x.png",
                     "ObjectId.V, which the parts lack; render them with --aov ids among others"},
          std::array{"--manifest", "x.json",
                     "ObjectId.V, which the parts lack; render them with --aov ids among others"},
          std::array{"--depth-png", "x.png",
                     "Z, which the parts lack; render them with --aov z among others"}}) {
        const ProcessResult lacking = candela({"merge", file("n.exr"), option, file(name)});
        EXPECT_EQ(lacking.exit_code, 1);
        EXPECT_CONTAINS(lacking.err,
                        std::string(option) + ": \"" + file(name) + "\" is made of the channel " + needs);
    }
}

TEST_F(Ids, AResumedRenderingHasTheSame) {
    const Words checkpoint = {"--checkpoint", file("state.exr"), "--resume"};
    layers("ids,cryptomatte", checkpoint + Words{"--spp", "2"});
    const Image resumed = layers("ids,cryptomatte", checkpoint + Words{"--spp", "6"});
    const Image whole = layers("ids,cryptomatte", {"--spp", "6"});
    for (const Channel& channel : whole.channels)
        EXPECT_EQ(resumed.find(channel.name)->values, channel.values) << channel.name;
}

TEST_F(Ids, NamesOfFilesAreChecked) {
    const ProcessResult jpeg = render_things({"--labels", "l.jpg"});
    EXPECT_EQ(jpeg.exit_code, 2);
    EXPECT_CONTAINS(jpeg.err, "--labels: \"l.jpg\" must be a .png file");
    EXPECT_CONTAINS(render_things({"--depth-png", "-"}).err, "--depth-png: \"-\" must be a .png file");
    EXPECT_CONTAINS(render_things({"--manifest", "m.png"}).err, "--manifest: \"m.png\" must be a .json file");
    EXPECT_CONTAINS(render_things({"--labels", file("a.png"), "-o", file("a.png")}).err, "--labels");
    const ProcessResult two = candela({"render", write("a.json", THINGS), write("b.json", THINGS), "-o",
                                       file("{stem}.png"), "--labels", file("l.png")});
    EXPECT_EQ(two.exit_code, 2);
    EXPECT_CONTAINS(two.err, "--labels: ");
    EXPECT_CONTAINS(two.err, "would be two pictures");
}

TEST_F(Ids, OfSeveralPicturesHaveFilesOfTheirOwn) {
    const Words files = {"--labels", file("{stem}-ids.png"), "--manifest", file("{stem}.json"),
                         "--skip-existing"};
    const Words scenes = {"render", write("a.scene", THINGS), write("b.scene", THINGS), "--spp", "1",
                          "-o",     file("{stem}.png")};
    const ProcessResult first = candela(scenes + files);
    EXPECT_EQ(first.exit_code, 0) << first.err;
    for (const char* name : {"a-ids.png", "b-ids.png", "a.json", "b.json", "a.png", "b.png"})
        EXPECT_TRUE(std::filesystem::exists(file(name))) << name;
    std::filesystem::remove(file("b-ids.png"));
    EXPECT_CONTAINS(candela(scenes + files).err, "1 done, 1 skipped, 0 failed");
}

// These two names have the same hash.
TEST_F(Ids, NamesThatCryptomatteCannotTellApartAreAWarning) {
    std::string scene = THINGS;
    scene.replace(scene.find("wall \\\"A\\\""), std::strlen("wall \\\"A\\\""), "part71663");
    scene.replace(scene.find(R"("type": "quad", "material")"), std::strlen(R"("type": "quad", "material")"),
                  R"("type": "quad", "name": "part108007", "material")");
    const Words arguments = {"-o", file("a.exr"), "--aov"};
    EXPECT_CONTAINS(
        render_things(arguments + Words{"cryptomatte"}, scene).err,
        "the objects part71663, part108007 have the same Cryptomatte id, and are one matte; rename "
        "all but one");
    EXPECT_EQ(render_things(arguments + Words{"ids"}, scene).err, "");
}

}  // namespace
}  // namespace candela

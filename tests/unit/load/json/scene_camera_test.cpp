// Cameras of a scene file: their place, field of view and lens.
#include <cmath>

#include <gtest/gtest.h>

#include "unit/load/scene_fixture.h"

namespace candela {
namespace {

// A scene whose camera is under test.
std::string camera(const std::string& members) {
    return settings("\"film\": {\"size\": [200, 100]},\n\"cameras\": {\"main\": " + members + "}");
}

// A scene whose lens is under test.
std::string camera_with(const std::string& lens) {
    return camera(
        "{\"position\": [0, 0, 1], \"look_at\": [0, 0, 0], \"vertical_fov\": 40, \"lens\": " + lens + "}");
}

TEST(SceneCamera, KeepsTheirOrder) {
    SceneFolder folder;
    const std::string rest =
        R"({"position": [0, 0, 5], "look_at": [0, 0, 0], "up": [1, 0, 0], "vertical_fov": 90})";
    const Scene scene =
        folder.load("{\"cameras\": {\"z\": " + rest + ", \"a\": " + rest + "}, \"shapes\": []}");
    ASSERT_EQ(scene.cameras.size(), 2u);
    EXPECT_EQ(scene.cameras[0].name, "z");
    EXPECT_EQ(scene.cameras[1].name, "a");
    EXPECT_EQ(scene.cameras[0].up, vec3(1, 0, 0));
    EXPECT_FLOAT_EQ(scene.cameras[0].vertical_fov, PI / 2);
}

TEST(SceneCamera, ChecksItsPlace) {
    SceneFolder folder;
    const std::string lens = "\"vertical_fov\": 40}";
    folder.expect_error(camera("{\"position\": [1, 2, 3], \"look_at\": @[1, 2, 3], " + lens),
                        "the camera looks at its own position; move one of the two");
    folder.expect_error(
        camera("{\"position\": [0, 0, 0], \"look_at\": [0, 2, 0], \"up\": @[0, -1, 0], " + lens),
        "the camera's up direction is zero or parallel to its view; give another \"up\"");
    folder.expect_error(
        camera("{\"position\": [0, 0, 0], \"look_at\": [1, 0, 0], \"up\": @[0, 0, 0], " + lens),
        "the camera's up direction is zero or parallel to its view; give another \"up\"");
    folder.expect_error(camera("@{\"position\": [0, 0, 0], \"look_at\": [0, 5, 0], " + lens),
                        "the camera's up direction is zero or parallel to its view; give another \"up\"");
    folder.expect_error(camera("{\"position\": @[0, 0], \"look_at\": [0, 5, 0], " + lens),
                        "\"position\": expected three numbers, found [0, 0]");
    folder.expect_error(camera("{\"position\": [0, @1e39, 0], \"look_at\": [0, 5, 0], " + lens),
                        "\"position\": expected a number of at most 3.4e38 in size, found 1e+39");
    folder.expect_error(settings("\"cameras\": @{}"), "the scene has no camera; add one");
}

TEST(SceneCamera, ChecksItsFieldOfView) {
    SceneFolder folder;
    const auto lens = [](const std::string& members) {
        return camera("@{\"position\": [0, 0, 1], \"look_at\": [0, 0, 0]" + members + "}");
    };
    const auto marked = [](const std::string& members) {
        return camera("{\"position\": [0, 0, 1], \"look_at\": [0, 0, 0], " + members + "}");
    };
    for (const char* angle : {"0", "180", "-20", "179.9999999"}) {
        folder.expect_error(marked("\"vertical_fov\": @" + std::string(angle)),
                            "the vertical field of view must lie between 0 and 180 degrees");
    }
    const std::string either =
        "a camera needs either vertical_fov, or film_size and focal_length, or orthographic_height, or "
        "projection";
    folder.expect_error(lens(""), either);
    folder.expect_error(lens(", \"film_size\": [2, 1]"), either);
    folder.expect_error(lens(", \"focal_length\": 1"), either);
    folder.expect_error(lens(", \"focal_length\": 1, \"vertical_fov\": 40"), either);
    folder.expect_error(
        marked("\"film_size\": @[1, 1], \"focal_length\": 1"),
        "the aspect ratio of film_size must be that of the film's size, 200 by 100 pixels; pixels are "
        "square");
    folder.expect_error(marked("\"film_size\": [2, @0], \"focal_length\": 1"),
                        "\"film_size\": expected a number above 0, found 0");
    folder.expect_error(marked("\"film_size\": [2, 1], \"focal_length\": @-3"),
                        "\"focal_length\": expected a number above 0, found -3");
}

TEST(SceneCamera, ReadsFilmAndFocalLengthInAnyUnit) {
    SceneFolder folder;
    const Scene scene = folder.load(camera(
        R"({"position": [0, 0, 1], "look_at": [0, 0, 0], "film_size": [36.02, 18], "focal_length": 9})"));
    EXPECT_FLOAT_EQ(scene.cameras[0].vertical_fov, PI / 2);
}

TEST(SceneCamera, ReadsThePrincipalPointAndTwoFocalLengths) {
    SceneFolder folder;
    const auto film = [](const std::string& members) {
        return camera(R"({"position": [0, 0, 1], "look_at": [0, 0, 0], "film_size": [200, 100], )" + members +
                      "}");
    };
    const Scene scene = folder.load(film(R"("focal_length": [75, 50], "principal_point": [90, 70])"));
    EXPECT_FLOAT_EQ(scene.cameras[0].vertical_fov, PI / 2);
    EXPECT_EQ(scene.cameras[0].focal_ratio, 1.5f);
    EXPECT_EQ(scene.cameras[0].principal_offset, vec2(-0.1f, 0.2f));
    const Scene plain = folder.load(film(R"("focal_length": 50, "principal_point": [100, 50])"));
    EXPECT_EQ(plain.cameras[0].focal_ratio, 1.0f);
    EXPECT_EQ(plain.cameras[0].principal_offset, vec2(0.0f));

    const std::string lengths = "\"focal_length\": expected one number or two [x, y], found ";
    folder.expect_error(film(R"("focal_length": @[50, 50, 1])"), lengths + "[50, 50, 1]");
    folder.expect_error(film(R"("focal_length": @"50")"), lengths + "\"50\"");
    folder.expect_error(film(R"("focal_length": [50, @0])"),
                        "\"focal_length\": expected a number above 0, found 0");
    for (const char* both : {"@[50, 0.049]", "@[0.049, 50]"}) {
        folder.expect_error(
            film(R"("focal_length": )" + std::string(both)),
            "one focal length is more than 1000 times the other; both are in the unit of film_size");
    }
    folder.expect_error(film(R"("focal_length": 50, "principal_point": @[1])"),
                        "\"principal_point\": expected two numbers, found [1]");
    for (const char* point : {"@[0, 100051]", "@[-3e38, 0]"}) {
        folder.expect_error(
            film(R"("focal_length": 50, "principal_point": )" + std::string(point)),
            "the principal point is more than 1000 heights of the film off its middle; it is in the unit of "
            "film_size, from the upper left corner");
    }
    folder.expect_error(camera(R"({"position": [0, 0, 1], "look_at": [0, 0, 0], "vertical_fov": 40,
                                   "principal_point": @[100, 50]})"),
                        "a principal point is a place on the film; give film_size and focal_length instead "
                        "of vertical_fov");
}

TEST(SceneCamera, ReadsAnOrthographicView) {
    SceneFolder folder;
    const auto view = [](const std::string& members) {
        return camera(R"({"position": [0, 0, 1], "look_at": [0, 0, 0], "orthographic_height": )" + members +
                      "}");
    };
    const Scene scene = folder.load(view("2.5"));
    EXPECT_EQ(scene.cameras[0].ortho_height, 2.5);
    EXPECT_EQ(scene.cameras[0].lens.radius, 0.0f);
    EXPECT_FALSE(folder.load(settings(GOOD_CAMERA)).cameras[0].ortho_height.has_value());
    folder.expect_error(view("@0"), "\"orthographic_height\": expected a number above 0, found 0");
    folder.expect_error(view("@-1"), "\"orthographic_height\": expected a number above 0, found -1");
    const auto remove = [](const std::string& key) {
        return "a camera with orthographic_height is sharp everywhere and has no field of view; remove \"" +
               key + "\" or orthographic_height";
    };
    folder.expect_error(view("1, \"vertical_fov\": @40"), remove("vertical_fov"));
    folder.expect_error(view("1, \"film_size\": @[2, 1]"), remove("film_size"));
    folder.expect_error(view("1, \"focal_length\": @1"), remove("focal_length"));
    folder.expect_error(view("1, \"principal_point\": @[1, 1]"), remove("principal_point"));
    folder.expect_error(view("1, \"shift\": @[0, 0]"), remove("shift"));
    folder.expect_error(view("1, \"lens\": @{\"radius\": 0}"), remove("lens"));
}

TEST(SceneCamera, ReadsAViewToAllSides) {
    SceneFolder folder;
    const auto view = [](const std::string& members) {
        return camera(R"({"position": [0, 0, 1], "look_at": [0, 0, 0], )" + members + "}");
    };
    const auto panorama = [&](const std::string& members) {
        return folder.load(view("\"projection\": " + members)).cameras[0].panorama.value();
    };
    EXPECT_EQ(panorama("\"equirectangular\"").mapping, Mapping::equirectangular);
    EXPECT_EQ(panorama("\"fisheye\""), (Panorama{Mapping::fisheye, PI}));
    EXPECT_EQ(panorama("\"equisolid\", \"fisheye_fov\": 360"), (Panorama{Mapping::equisolid, 2.0f * PI}));
    EXPECT_EQ(panorama("\"fisheye\", \"fisheye_fov\": 1").fisheye_fov, float(M_PI / 180.0));
    EXPECT_FALSE(folder.load(settings(GOOD_CAMERA)).cameras[0].panorama);
    const auto fisheye = [&](const std::string& members) {
        return view("\"projection\": \"fisheye\", " + members);
    };
    for (const char* angle : {"400", "0", "-90", "360.001"}) {
        folder.expect_error(fisheye("\"fisheye_fov\": @" + std::string(angle)),
                            "\"fisheye_fov\": expected a number from 1 to 360, found " + std::string(angle));
    }
    folder.expect_error(view("\"projection\": @\"cubic\""),
                        "unknown projection \"cubic\" (known: equirectangular, fisheye, equisolid)");
    folder.expect_error(
        view("\"vertical_fov\": 40, \"fisheye_fov\": @180"),
        "fisheye_fov is the angle of a fisheye; add \"projection\": \"fisheye\" or \"equisolid\"");
    const auto remove = [](const std::string& key) {
        return "a camera with a projection to all sides is sharp everywhere and has no other field of view; "
               "remove "
               "\"" +
               key + "\" or projection";
    };
    folder.expect_error(fisheye("\"vertical_fov\": @40"), remove("vertical_fov"));
    folder.expect_error(fisheye("\"focal_length\": @1"), remove("focal_length"));
    folder.expect_error(fisheye("\"orthographic_height\": @1"), remove("orthographic_height"));
    folder.expect_error(fisheye("\"lens\": @{\"radius\": 0}"), remove("lens"));
    const std::string all = "\"projection\": \"equirectangular\", ";
    folder.expect_error(view(all + "\"shift\": @[0, 0]"),
                        "an equirectangular camera sees all around; remove \"shift\" or projection");
    folder.expect_error(view(all + "\"fisheye_fov\": @90"),
                        "an equirectangular camera sees all around; remove \"fisheye_fov\" or projection");
}

// The picture is twice as wide as high, and what was 0.1 of its width to the right is in the middle.
TEST(SceneCamera, ReadsAShift) {
    SceneFolder folder;
    const auto view = [](const std::string& members) {
        return camera(R"({"position": [0, 0, 1], "look_at": [0, 0, 0], )" + members + "}");
    };
    for (const char* members : {R"("vertical_fov": 40)", R"("film_size": [2, 1], "focal_length": 1)",
                                R"("projection": "fisheye")"}) {
        const std::string text = members + std::string(R"(, "shift": [0.1, 0.25])");
        EXPECT_EQ(folder.load(view(text)).cameras[0].principal_offset, vec2(-0.2f, 0.5f)) << members;
    }
    folder.expect_error(view("\"vertical_fov\": 40, \"shift\": @[0]"),
                        "\"shift\": expected two numbers, found [0]");
    folder.expect_error(
        view("\"vertical_fov\": 40, \"shift\": @[0, -501]"),
        "the shift is more than 1000 heights of the picture; it is in its longer sides, such as 0.1");
    folder.expect_error(
        view(R"("film_size": [2, 1], "focal_length": 1, "principal_point": [1, 1], "shift": @[0, 0])"),
        "a shift moves the principal point, which the camera has; remove one of the two");
}

TEST(SceneCamera, ReadsItsLens) {
    SceneFolder folder;
    const auto lens = [&](const std::string& text) { return folder.load(camera_with(text)).cameras[0].lens; };
    const Lens full = lens(R"({"radius": 0.05, "focal_distance": 2.5, "blades": 6, "rotation": 30})");
    EXPECT_EQ(full.radius, 0.05f);
    EXPECT_EQ(full.focal_distance, 2.5f);
    EXPECT_EQ(full.blades, 6u);
    EXPECT_FLOAT_EQ(full.rotation, PI / 6);
    const Lens disk = lens(R"({"radius": 1e-3, "focal_distance": 1e5})");
    EXPECT_EQ(disk.blades, 0u);
    EXPECT_EQ(disk.rotation, 0.0f);
    EXPECT_EQ(lens(R"({"radius": 0})").radius, 0.0f);
    EXPECT_EQ(lens(R"({"radius": 0, "blades": 3})").blades, 3u);
    EXPECT_EQ(lens(R"({"radius": 0, "blades": 64})").blades, 64u);
    EXPECT_FLOAT_EQ(lens(R"({"radius": 0, "blades": 5, "rotation": 150})").rotation, PI * 5 / 6);
    // Whole turns are removed before the angle becomes a float, which would lose the rest.
    EXPECT_FLOAT_EQ(lens(R"({"radius": 0, "blades": 5, "rotation": 3600000030})").rotation, PI / 6);
    EXPECT_FLOAT_EQ(lens(R"({"radius": 0, "blades": 5, "rotation": -390})").rotation, -PI / 6);
    EXPECT_EQ(folder.load(settings(GOOD_CAMERA)).cameras[0].lens.radius, 0.0f);  // A pinhole.
}

TEST(SceneCamera, ChecksItsLens) {
    SceneFolder folder;
    folder.expect_error(camera_with(R"({"radius": @-0.01, "focal_distance": 1})"),
                        "\"radius\": expected a number of at least 0, found -0.01");
    folder.expect_error(camera_with(R"(@{"focal_distance": 1})"),
                        "the key \"radius\" is missing here; add it");
    folder.expect_error(
        camera_with(R"(@{"radius": 0.01})"),
        "a lens with a radius above 0 needs \"focal_distance\", the distance at which it is sharp");
    for (const char* radius : {"0", "0.01"}) {
        const std::string begin = std::string("{\"radius\": ") + radius + ", \"focal_distance\": @";
        folder.expect_error(camera_with(begin + "0}"),
                            "\"focal_distance\": expected a number above 0, found 0");
        folder.expect_error(camera_with(begin + "-2}"),
                            "\"focal_distance\": expected a number above 0, found -2");
    }
    folder.expect_error(camera_with(R"({"radius": 0.01, "focal_distance": @1e-39})"),
                        "\"focal_distance\": expected a number of at least 1.2e-38, found 1e-39");
    const std::string blades = "\"blades\": expected a whole number from 3 to 64, found ";
    folder.expect_error(camera_with(R"({"radius": 0, "blades": @2})"), blades + "2");
    folder.expect_error(camera_with(R"({"radius": 0, "blades": @65})"), blades + "65");
    folder.expect_error(camera_with(R"({"radius": 0, "blades": @5.5})"), blades + "5.5");
    folder.expect_error(camera_with(R"({"radius": 0, "rotation": @30})"),
                        "rotation turns the polygon of an aperture; it needs \"blades\"");
    folder.expect_error(
        camera_with(R"({"radius": 0, @"blade": 5})"),
        "unknown key \"blade\" (did you mean \"blades\"? known: radius, focal_distance, blades, "
        "rotation)");
}

}  // namespace
}  // namespace candela

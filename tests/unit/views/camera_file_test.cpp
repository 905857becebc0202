// Files of cameras: both conventions show known points where their own formulas say, come back as they were
// written, and their errors tell place, cause and remedy.
#include "views/camera_file.h"

#include <fstream>

#include <nlohmann/json.hpp>

#include "base/file.h"
#include "unit/load/scene_fixture.h"
#include "unit/views/views_fixture.h"

namespace candela {
namespace {

constexpr uvec2 DEFAULT_SIZE(100, 50);

class CameraFile : public testing::Test {
  protected:
    std::vector<Camera> read(const std::string& text) {
        folder_.write("cameras.json", text);
        return read_camera_file(folder_.path() / "cameras.json", DEFAULT_SIZE);
    }
    // Reads a file that has an error at its '@', and checks the message after `cameras.json:line:column: `.
    void expect_error(std::string text, const std::string& message) {
        SCOPED_TRACE(text);
        const std::string place = take_mark(text);
        EXPECT_EQ(folder_.without_folder(error_of([&] { read(text); })),
                  "cameras.json:" + place + ": " + message);
    }
    std::vector<Camera> reread(const std::string& name, const std::vector<PictureCamera>& pictures) {
        folder_.write(name, camera_file_text(folder_.path() / name, pictures));
        return read_camera_file(folder_.path() / name, DEFAULT_SIZE);
    }
    SceneFolder folder_;
};

void expect_shown(const Camera& camera, dvec3 point, glm::dvec2 pixel) {
    const glm::dvec2 at = pixel_of(camera, camera.film_size.value_or(DEFAULT_SIZE), point);
    EXPECT_NEAR(at.x, pixel.x, 1e-4);
    EXPECT_NEAR(at.y, pixel.y, 1e-4);
}

// A camera at (1, 2, 3) that looks along +X, with its right towards +Z: the columns of the matrix are right,
// up and backwards.
const std::string ALONG_X = "[[0, 0, -1, 1], [0, 1, 0, 2], [1, 0, 0, 3], [0, 0, 0, 1]]";

std::string one_frame(const std::string& members, const std::string& shared = "") {
    return "{" + shared + "\"frames\": [{" + members + "\"transform_matrix\": " + ALONG_X + "}]}";
}

// In pixels, the point that is x to the right, y down and z forwards is at fx x / z + cx, fy y / z + cy from
// the corner of the first pixel.
TEST_F(CameraFile, TransformsHaveTheAxesOfOpenGl) {
    const auto cameras =
        read(one_frame("", R"("w": 640, "h": 480, "fl_x": 500, "fl_y": 600, "cx": 300, "cy": 250, )"));
    ASSERT_EQ(cameras.size(), 1u);
    EXPECT_EQ(cameras[0].film_size, uvec2(640, 480));
    EXPECT_EQ(cameras[0].position, dvec3(1, 2, 3));
    expect_shown(cameras[0], dvec3(1 + 10, 2, 3), {300, 250});
    expect_shown(cameras[0], dvec3(1 + 10, 2 - 2, 3 + 1), {300 + 500 * 0.1, 250 + 600 * 0.2});
}

TEST_F(CameraFile, TransformsMayGiveAnglesAndNoSize) {
    // 90 degrees across 100 pixels: a focal length of 50.
    const auto plain = read(one_frame("", "\"camera_angle_x\": 1.5707963267948966, "));
    EXPECT_EQ(plain[0].film_size, DEFAULT_SIZE);
    expect_shown(plain[0], dvec3(11, 2 - 2, 3 + 4), {50 + 50 * 0.4, 25 + 50 * 0.2});
    const auto both =
        read(one_frame("", R"("camera_angle_x": 1.5707963267948966, "camera_angle_y": 2.2142974355881810,)"));
    // Half of it has the tangent 2: 25 / 2.
    expect_shown(both[0], dvec3(11, 2 - 2, 3 + 4), {50 + 50 * 0.4, 25 + 12.5 * 0.2});
}

TEST_F(CameraFile, FramesMayHaveIntrinsicsOfTheirOwn) {
    const std::string place = ", \"transform_matrix\": " + ALONG_X + "}";
    const auto cameras = read(R"({"camera_angle_x": 1, "w": 10, "h": 10, "frames": [
        {"file_path": "a/one.png", "fl_x": 100, "w": 200, "h": 100)" +
                              place + R"(,
        {"file_path": "./b/two.jpg", "fl_x": 100, "cy": 7)" +
                              place + "]}");
    ASSERT_EQ(cameras.size(), 2u);
    EXPECT_EQ(cameras[0].name, "one");
    EXPECT_EQ(cameras[1].name, "two");
    EXPECT_EQ(cameras[0].film_size, uvec2(200, 100));
    EXPECT_EQ(cameras[1].film_size, uvec2(10, 10));
    expect_shown(cameras[0], dvec3(11, 2, 3 + 1), {100 + 10, 50});
    expect_shown(cameras[1], dvec3(11, 2, 3 + 1), {5 + 10, 7});
}

TEST_F(CameraFile, FramesAreNamedByTheirPictures) {
    const auto names = [&](const std::vector<std::string>& paths) {
        std::string frames;
        for (const std::string& path : paths)
            frames += (frames.empty() ? "{" : ", {") + path + "\"transform_matrix\": " + ALONG_X + "}";
        std::vector<std::string> result;
        for (const Camera& camera : read("{\"camera_angle_x\": 1, \"frames\": [" + frames + "]}"))
            result.push_back(camera.name);
        return result;
    };
    using Names = std::vector<std::string>;
    EXPECT_EQ(names({"\"file_path\": \"./train/r_0\", ", "\"file_path\": \"./train/r_1.png\", "}),
              (Names{"r_0", "r_1"}));
    EXPECT_EQ(names({"\"file_path\": \"./left/0.png\", ", "\"file_path\": \"right/0.png\", "}),
              (Names{"left_0", "right_0"}));
    EXPECT_EQ(names({"", ""}), (Names{"0", "1"}));
    // What is not the name of a file cannot become one.
    EXPECT_EQ(names({"\"file_path\": \"../..\", ", "\"file_path\": \"\", ", "\"file_path\": \"a/\", "}),
              (Names{"0", "1", "2"}));
    EXPECT_EQ(names({"\"file_path\": \"/x/0\", ", "\"file_path\": \"../y/0\", "}), (Names{"_x_0", ".._y_0"}));
}

const std::string K = "[[500, 0, 300], [0, 600, 250], [0, 0, 1]]";
// The same camera as ALONG_X: the rows of R are right, down and forwards.
const std::string R_ALONG_X = "[[0, 0, 1], [0, -1, 0], [1, 0, 0]]";

std::string one_camera(const std::string& members) {
    return "{\"width\": 640, \"height\": 480, \"cameras\": [{" + members + "}]}";
}

// In OpenCV, u = fx x / z + cx with (x, y, z) = R X + t, from the centre of the first pixel.
TEST_F(CameraFile, OpenCvLooksAlongZWithYDown) {
    const auto cameras = read(
        one_camera("\"name\": \"left\", \"K\": " + K + ", \"R\": " + R_ALONG_X + ", \"t\": [-3, 2, -1]"));
    ASSERT_EQ(cameras.size(), 1u);
    EXPECT_EQ(cameras[0].name, "left");
    EXPECT_EQ(cameras[0].film_size, uvec2(640, 480));
    expect_close(cameras[0].position, dvec3(1, 2, 3), 1e-12);
    // R X + t for X = (11, 0, 4) is (1, 2, 10).
    expect_shown(cameras[0], dvec3(11, 0, 4), {0.5 + 300 + 500 * 0.1, 0.5 + 250 + 600 * 0.2});
    const auto corner =
        read(one_camera("\"pixel_center\": 0.5, \"distortion\": [0, 0, 0, 0, 0], \"K\": " + K +
                        ", \"R\": " + R_ALONG_X + ", \"t\": [[-3], [2], [-1]]"));
    EXPECT_EQ(corner[0].name, "0");
    expect_shown(corner[0], dvec3(11, 0, 4), {300 + 500 * 0.1, 250 + 600 * 0.2});
}

TEST_F(CameraFile, BothConventionsComeBackAsTheyWereWritten) {
    Camera one;
    one.name = "one";
    one.position = dvec3(1.0 / 3, -2e-3, 700);
    one.look_at = dvec3(0.2, 7, 3);
    one.up = vec3(0.1f, 1, 0.3f);
    one.vertical_fov = 0.7f;
    one.principal_offset = vec2(0.1f, -0.3f);
    one.focal_ratio = 1.1f;
    Camera two = one;
    two.name = "two \"b\"";
    two.position.x = 5;
    Camera wide = two;
    wide.vertical_fov = 2.5f;
    const uvec2 size(320, 200);
    for (const char* name : {"cameras.json", "OpenCV.json"}) {
        for (const Camera& second : {two, wide}) {
            const auto cameras =
                reread(name, {{one, size, "../images/one.png"}, {second, size, "../images/two \"b\".exr"}});
            ASSERT_EQ(cameras.size(), 2u) << name;
            for (size_t i = 0; i < 2; ++i) {
                const Camera& written = i == 0 ? one : second;
                EXPECT_EQ(cameras[i].name, written.name);
                EXPECT_EQ(cameras[i].film_size, size);
                expect_close(cameras[i].position, written.position, 1e-12 * 700);
                for (const dvec3 point : {dvec3(0.2, 7, 3), dvec3(30, 5, -50), dvec3(-100, 40, 100)}) {
                    const glm::dvec2 at = pixel_of(cameras[i], size, point),
                                     was = pixel_of(written, size, point);
                    EXPECT_LT(length(at - was), 1e-4) << name;
                }
            }
        }
    }
}

// What other programs read: where all cameras agree, it is stated once.
TEST_F(CameraFile, TheFilesHaveTheKeysOfTheirConventions) {
    Camera camera;
    camera.name = "front";
    camera.position = dvec3(0, 0, 4);
    camera.look_at = dvec3(0);
    camera.vertical_fov = PI / 2;
    const auto nerf = nlohmann::json::parse(
        camera_file_text("t.json", std::vector<PictureCamera>{{camera, {40, 20}, "a.png"}}));
    EXPECT_NEAR(double(nerf.at("camera_angle_x")), 2.0 * std::atan(2.0), 1e-6);
    EXPECT_NEAR(double(nerf.at("fl_x")), 10.0, 1e-5);
    EXPECT_EQ(nerf.at("cx"), 20.0);
    EXPECT_EQ(nerf.at("w"), 40);
    EXPECT_EQ(nerf.at("frames").at(0).at("file_path"), "a.png");
    EXPECT_EQ(nerf.at("frames").at(0).at("transform_matrix"),
              nlohmann::json::parse("[[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 4], [0, 0, 0, 1]]"));
    const auto opencv = nlohmann::json::parse(
        camera_file_text("dir/opencv.json", std::vector<PictureCamera>{{camera, {40, 20}, "a.png"}}));
    const auto& first = opencv.at("cameras").at(0);
    EXPECT_EQ(first.at("name"), "front");
    EXPECT_EQ(first.at("K").at(0).at(2), 19.5);
    EXPECT_EQ(first.at("R"), nlohmann::json::parse("[[1, 0, 0], [0, -1, 0], [0, 0, -1]]"));
    EXPECT_EQ(first.at("t"), nlohmann::json::parse("[0, 0, 4]"));
    const auto differ = nlohmann::json::parse(camera_file_text(
        "t.json", std::vector<PictureCamera>{{camera, {40, 20}, "a.png"}, {camera, {40, 30}, "b.png"}}));
    EXPECT_FALSE(differ.contains("w"));
    EXPECT_EQ(differ.at("frames").at(1).at("h"), 30);

    camera.ortho_height = 1.0;
    EXPECT_EQ(error_of([&] {
                  camera_file_text("t.json", std::vector<PictureCamera>{{camera, {40, 20}, "a.png"}});
              }),
              "\"t.json\" cannot hold the orthographic camera \"front\"; give it a field of view, or choose "
              "another "
              "camera");
    camera.ortho_height.reset();
    camera.panorama = Panorama{Mapping::fisheye};
    EXPECT_EQ(
        error_of([&] {
            camera_file_text("t.json", std::vector<PictureCamera>{{camera, {40, 20}, "a.png"}});
        }),
        "\"t.json\" cannot hold the fisheye camera \"front\"; give it a field of view, or choose another "
        "camera");
}

TEST_F(CameraFile, SaysWhatAFileLacks) {
    expect_error(
        "@{\"images\": []}",
        "a file of cameras has the key \"frames\" (NeRF's transforms.json), or \"cameras\" (K, R and t of "
        "OpenCV); add one of them");
    expect_error("@[1]", "\"the file\": expected an object { ... }, found [1]");
    expect_error(R"({"frames": @{}})", "\"frames\": expected an array [ ... ], found an object");
    expect_error(R"({"frames": @[]})", "there are no frames; add one for each camera");
    expect_error(R"({"cameras": @[]})", "there are no cameras; add one");
    expect_error(R"({"camera_angle_x": 1, "frames": [@{}]})",
                 "the key \"transform_matrix\" is missing here; add it");
    expect_error(R"({"frames": [@{}]})",
                 "there is no focal length; add fl_x [pixels] or camera_angle_x [rad]");
    expect_error("{\"width\": 640, \"height\": 480, \"cameras\": [@{}]}",
                 "the key \"K\" is missing here; add it");
    expect_error("{\"width\": 640, \"cameras\": [@{\"K\": " + K + "}]}",
                 "the key \"height\" is missing here; add it");
    expect_error("{\"width\": 640, \"height\": 480, \"cameras\": [@{\"K\": " + K + "}]}",
                 "the key \"R\" is missing here; add it");
}

TEST_F(CameraFile, ChecksIntrinsics) {
    const std::string square = "\"fl_x\": 10, \"w\": 20, \"h\": 20, ";
    expect_error(one_frame("\"fl_x\": @-1, \"w\": 2, \"h\": 2, "),
                 "\"fl_x\": expected a number above 0, found -1");
    expect_error(one_frame("\"fl_x\": 1, \"w\": @0, \"h\": 2, "),
                 "\"w\": expected a whole number from 1 to 65536, found 0");
    expect_error(one_frame("\"fl_x\": 1, \"w\": @2, "),
                 "w and h are the size of a picture in pixels; give both or neither");
    expect_error(one_frame("\"camera_angle_x\": 1, \"cx\": @2, "),
                 "\"cx\" is in pixels of a picture; also give its size, w and h");
    for (const char* angle : {"0", "-1", "3.1416"}) {
        expect_error(
            one_frame("\"camera_angle_x\": @" + std::string(angle) + ", "),
            "\"camera_angle_x\": expected an angle between 0 and pi [rad], found " + std::string(angle));
    }
    expect_error(
        "{\"frames\": [@{\"fl_x\": 1e-30, \"w\": 20, \"h\": 20, \"transform_matrix\": " + ALONG_X + "}]}",
        "the vertical field of view must lie between 0 and 180 degrees; correct the focal length");
    expect_error("{\"frames\": [@{" + square + "\"fl_y\": 0.009, \"transform_matrix\": " + ALONG_X + "}]}",
                 "one focal length is more than 1000 times the other; both are in pixels");
    expect_error(
        "{\"frames\": [@{" + square + "\"cx\": 1e30, \"transform_matrix\": " + ALONG_X + "}]}",
        "the principal point is more than 1000 heights of the picture off its middle; it is in pixels, from "
        "the upper left corner");
    expect_error(one_frame("\"fl_x\": @1e39, \"w\": 2, \"h\": 2, "),
                 "\"fl_x\": expected a number of at most 3.4e38 in size, found 1e+39");
    EXPECT_NE(error_of([&] { read(one_frame("\"fl_x\": NaN, \"w\": 2, \"h\": 2, ")); }), "");

    const auto with_k = [](const std::string& k) {
        return one_camera("\"K\": " + k + ", \"R\": " + R_ALONG_X + ", \"t\": [0, 0, 0]");
    };
    expect_error(with_k("[[500, @1, 300], [0, 600, 250], [0, 0, 1]]"),
                 "K has a skew, which candela's cameras do not; set it to 0");
    expect_error(with_k("@[[500, 0, 300], [0, 600, 250], [0, 0, 2]]"),
                 "K must be [[fx, 0, cx], [0, fy, cy], [0, 0, 1]]; write its rows in this order");
    expect_error(with_k("@[[500, 0, 300], [0, 600, 250]]"),
                 "\"K\": expected 3 rows of 3 numbers, found an array of 2");
    expect_error(with_k("[[@-500, 0, 300], [0, 600, 250], [0, 0, 1]]"),
                 "\"K\": expected a number above 0, found -500");
    expect_error(
        one_camera("\"pixel_center\": @0.25, \"K\": " + K),
        "\"pixel_center\": expected 0 or 0.5, the coordinates of the first pixel's centre, found 0.25");
    expect_error(one_camera("@\"rvec\": [0, 0, 0], \"K\": " + K),
                 "unknown key \"rvec\" (known: name, R, t, width, height, K, distortion, pixel_center)");
}

TEST_F(CameraFile, RefusesLensesThatDistort) {
    const std::string bends =
        " bends straight lines, which candela's lenses do not; undistort images and cameras first (colmap "
        "image_undistorter, or cv2.undistort), and remove it";
    expect_error(one_frame("", "\"camera_angle_x\": 1, \"k1\": @0.01, "),
                 "the coefficient 0.01 of \"k1\"" + bends);
    expect_error(one_frame("\"p2\": @-1e-5, ", "\"camera_angle_x\": 1, \"k1\": 0, "),
                 "the coefficient -1e-05 of \"p2\"" + bends);
    expect_error(one_camera("\"distortion\": [[0, @0.5, 0]]"),
                 "the coefficient 0.5 of \"distortion\"" + bends);
    const std::string pinhole =
        "; undistort images and cameras to a pinhole's first (colmap image_undistorter)";
    expect_error(one_frame("", "\"camera_angle_x\": 1, \"is_fisheye\": @true, "),
                 "candela has no fisheye lens" + pinhole);
    expect_error(one_frame("", "\"camera_angle_x\": 1, \"camera_model\": @\"OPENCV_FISHEYE\", "),
                 "candela has no lens of the camera model \"OPENCV_FISHEYE\"" + pinhole);
    EXPECT_EQ(read(one_frame("",
                             "\"camera_angle_x\": 1, \"k1\": 0.0, \"is_fisheye\": false, "
                             "\"camera_model\": \"OPENCV\", \"aabb_scale\": 16, "))
                  .size(),
              1u);
}

TEST_F(CameraFile, ChecksMatrices) {
    const auto frame = [](const std::string& matrix) {
        return "{\"camera_angle_x\": 1, \"frames\": [{\"transform_matrix\": " + matrix + "}]}";
    };
    const std::string last = ", [0, 0, 0, 1]]";
    expect_error(
        frame("@[[2, 0, 0, 0], [0, 2, 0, 0], [0, 0, 2, 0]" + last),
        "the matrix scales by 2 along an axis of the camera, where a rotation has 1; divide its axes by "
        "their lengths");
    expect_error(
        frame("@[[0, 0, 0, 0], [0, 0, 0, 0], [0, 0, 0, 0]" + last),
        "the matrix scales by 0 along an axis of the camera, where a rotation has 1; divide its axes by "
        "their lengths");
    expect_error(frame("@[[1, 0.6, 0, 0], [0, 0.8, 0, 0], [0, 0, 1, 0]" + last),
                 "the camera's axes are not at right angles to each other; give a rotation without shear");
    expect_error(
        frame("@[[-1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]" + last),
        "the matrix mirrors the picture: its determinant is -1; turn the sign of one of the camera's axes");
    expect_error(frame("[[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], @[5, 5, 5, 1]]"),
                 "the last row of a camera-to-world matrix must be 0 0 0 1; the position is the last column");
    expect_error(frame("[@1, 0, 0, 0]"), "\"transform_matrix\": expected four numbers, found 1");
    expect_error(frame("@[[1, 0, 0, 0]]"),
                 "\"transform_matrix\": expected 4 rows of 4 numbers, found an array of 1");
    EXPECT_EQ(read(frame("[[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]]")).size(), 1u);
    // As the last digits of three.
    EXPECT_EQ(read(frame("[[0.707, 0, 0.707, 0], [0, 1, 0, 0], [-0.707, 0, 0.707, 0]]")).size(), 1u);
    expect_error(
        one_camera("\"K\": " + K + ", \"R\": @[[1, 0, 0], [0, 0, 1], [0, 1, 0]], \"t\": [0, 0, 0]"),
        "the matrix mirrors the picture: its determinant is -1; turn the sign of one of the camera's axes");
    expect_error(one_camera("\"K\": " + K + ", \"R\": " + R_ALONG_X + ", \"t\": @[0, 0]"),
                 "\"t\": expected three numbers, found [0, 0]");
    // So far away that a step of one metre is lost.
    const Camera far = read(frame("[[1, 0, 0, 1e30], [0, 1, 0, 0], [0, 0, 1, -3e38]" + last)).at(0);
    EXPECT_NE(far.position, far.look_at);
}

TEST_F(CameraFile, NamesAreUnique) {
    const std::string frame = "{\"file_path\": \"a/b.png\", \"transform_matrix\": " + ALONG_X + "}";
    expect_error(
        "{\"camera_angle_x\": 1, \"frames\": [" + frame + ", @" + frame + "]}",
        "another frame has the same name \"a_b\", after its file_path; give each a file_path of its own");
    const std::string camera = ", \"K\": " + K + ", \"R\": " + R_ALONG_X + ", \"t\": [0, 0, 0]}";
    expect_error("{\"width\": 4, \"height\": 4, \"cameras\": [{\"name\": \"a\"" + camera +
                     ", {\"name\": @\"a\"" + camera + "]}",
                 "two cameras have the name \"a\"; give each its own");
}

}  // namespace
}  // namespace candela

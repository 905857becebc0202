// What happens to the files of a command: none overwrites another, and what cannot be written is reported
// beforehand.
#include <csignal>

#include "cli/cli_fixture.h"

namespace candela {
namespace {

namespace fs = std::filesystem;

class FilesOfACommand : public CliTest {
  protected:
    FilesOfACommand() {
        fs::copy_file(CORNELL_BOX, scene_);
        EXPECT_EQ(render_scene({"-o", picture_, "--spp", "2"}).exit_code, 0);
    }

    ProcessResult render_scene(const Words& arguments) const {
        return candela(Words{"render", scene_, "--size", "16x8", "--quiet"} + arguments);
    }
    // The command ends with 2 and this message before anything is written.
    void expect_refused(const Words& arguments, const std::string& message) const {
        const auto before = bytes();
        const ProcessResult result = candela(arguments);
        EXPECT_EQ(result.exit_code, 2) << message;
        EXPECT_EQ(result.err, "candela: error: " + message + "; give it a name of its own\n");
        EXPECT_EQ(bytes(), before) << message;
    }
    void expect_render_refused(const Words& arguments, const std::string& message) const {
        expect_refused(Words{"render", scene_, "--size", "8x8", "--spp", "1"} + arguments, message);
    }

    const std::string scene_ = file("scene.json"), picture_ = file("a.exr");

  private:
    // The bytes of all files.
    std::map<std::string, std::string> bytes() const {
        std::map<std::string, std::string> all;
        for (const fs::directory_entry& entry : fs::directory_iterator(directory_.path()))
            all[entry.path().string()] = entry.exists() ? read_file(entry.path()) : "";
        return all;
    }
};

std::string same(const std::string& role, const std::string& path, const std::string& other,
                 const std::string& other_path) {
    return role + ": " + candela::quoted(path) + " is the same file as " + other + ' ' +
           candela::quoted(other_path);
}

TEST_F(FilesOfACommand, NoOutputOfARenderingIsAnotherOfItsFiles) {
    const std::string png = file("a.png"), link = file("link.json"), hard = file("hard.exr");
    fs::create_symlink(scene_, link);
    fs::create_hard_link(picture_, hard);
    expect_render_refused({"-o", png, "--report", scene_}, same("--report", scene_, "SCENE", scene_));
    expect_render_refused({"-o", png, "--report", link}, same("--report", link, "SCENE", scene_));
    expect_render_refused({"-o", picture_, "--report", file("r.json"), "--reference", picture_},
                          same("-o", picture_, "--reference", picture_));
    expect_render_refused({"-o", hard, "--report", file("r.json"), "--reference", picture_},
                          same("-o", hard, "--reference", picture_));
    // Files that do not exist yet.
    fs::create_symlink("b.exr", file("dangling.exr"));
    expect_render_refused({"-o", png, "--report", png}, same("--report", png, "-o", png));
    expect_render_refused({"-o", png, "-o", file("./a.png")}, same("-o", file("./a.png"), "-o", png));
    expect_render_refused({"-o", file("b.exr"), "--checkpoint", file("dangling.exr")},
                          same("--checkpoint", file("dangling.exr"), "-o", file("b.exr")));
    const std::string around = file("../" + directory_.path().filename().string() + "/b.exr");
    expect_render_refused({"-o", file("b.exr"), "--checkpoint", around},
                          same("--checkpoint", around, "-o", file("b.exr")));
}

TEST_F(FilesOfACommand, NoOutputIsAFileThatTheSceneNames) {
    const std::string obj =
        write("quad.obj", "mtllib quad.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n");
    const std::string mtl = write("quad.mtl", "newmtl a\nKe 1 1 1\n");
    const std::string ply =
        write("tri.ply",
              "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
              "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
              "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    const std::string sky = file("sky.exr");
    fs::copy_file(picture_, sky);
    const std::string scene = write("files.json", R"({
        "cameras": {"main": {"position": [0, 0, 4], "look_at": [0, 0, 0], "vertical_fov": 40}},
        "materials": {"grey": {"type": "diffuse", "reflectance": [0.5, 0.5, 0.5]}},
        "shapes": [{"type": "obj", "file": "quad.obj"}, {"type": "ply", "file": "tri.ply", "material": "grey"}],
        "environment": {"file": "sky.exr"}})");
    const Words render{"render", scene, "-o", file("b.png")};
    for (const std::string& named : {obj, mtl, ply, sky})
        expect_refused(render + Words{"--report", named}, same("the scene's file", named, "--report", named));
    expect_refused({"bench", scene, "--only", "render", "--json", obj},
                   same("the scene's file", obj, "--json", obj));
    expect_refused({"view", scene, "--frames", "1", "--screenshot", sky},
                   same("the scene's file", sky, "--screenshot", sky));
}

TEST_F(FilesOfACommand, NoOutputOfAnotherCommandIsOneOfItsInputs) {
    const std::string named_png = file("picture.png"), report = write("report.svg", "{}");
    fs::copy_file(picture_, named_png);
    expect_refused({"compare", picture_, named_png, "--heatmap", named_png},
                   same("--heatmap", named_png, "B", named_png));
    expect_refused({"plot", report, "-o", report}, same("-o", report, "REPORT", report));
    expect_refused({"bench", scene_, "--only", "render", "--json", scene_},
                   same("--json", scene_, "SCENE", scene_));
    expect_refused({"merge", picture_, "-o", file("b.exr"), "-o", file("./b.exr")},
                   same("-o", file("./b.exr"), "-o", file("b.exr")));
}

TEST_F(FilesOfACommand, WhatIsMeantIsAllowed) {
    const std::string state = file("state.exr"), other = file("b.exr");
    for (const char* spp : {"1", "2"})
        EXPECT_EQ(
            render_scene({"-o", file("c.exr"), "--checkpoint", state, "--resume", "--spp", spp}).exit_code,
            0);
    EXPECT_EQ(render_scene({"-o", other, "--samples", "2..3"}).exit_code, 0);
    EXPECT_EQ(candela({"merge", picture_, other, "-o", other}).exit_code, 0);
    EXPECT_EQ(candela({"compare", other, other}).exit_code, 0);
}

// Calls a program in a name space where it is root and may mount; the test is skipped where there are none.
class MountedFiles : public FilesOfACommand {
  protected:
    void SetUp() override {
        if (run_process({"/usr/bin/unshare", "-rm", "/bin/true"}).exit_code != 0)
            GTEST_SKIP() << "this system lets no test mount anything";
    }
    static ProcessResult after_mounting(const std::string& mount, const Words& arguments,
                                        std::map<std::string, std::string> environment = {}) {
        return run_process(
            Words{"/usr/bin/unshare", "-rm", "/bin/sh", "-c", mount + " && exec \"$@\"", "sh"} +
                call(arguments),
            options(std::move(environment)));
    }
};

TEST_F(MountedFiles, AFileThatIsMountedByItselfIsRefusedBeforehand) {
    const std::string target = write("mounted.exr", "old");
    const ProcessResult result =
        after_mounting("mount --bind '" + scene_ + "' '" + target + "'",
                       {"render", scene_, "-o", target, "--size", "8x8", "--spp", "1"});
    EXPECT_EQ(result.exit_code, 2);
    const ProcessResult other =
        after_mounting("mount --bind '" + picture_ + "' '" + target + "'",
                       {"render", scene_, "-o", target, "--size", "8x8", "--spp", "1"});
    EXPECT_EQ(other.exit_code, 1);
    EXPECT_EQ(other.err, "candela: error: cannot write " + candela::quoted(target) +
                             ": the file is a mount point, and cannot be replaced; mount the folder that "
                             "holds it\n");
}

// SIGBUS would end drivers that write to their caches through memory.
TEST_F(MountedFiles, ACacheOnAFullDiskIsNotUsed) {
    const std::string cache = file("cache");
    fs::create_directory(cache);
    const ProcessResult result =
        after_mounting("mount -t tmpfs -o size=40k none '" + cache + "' && dd if=/dev/zero of='" + cache +
                           "/full' status=none bs=1k count=40",
                       {"render", scene_, "-o", file("b.png"), "--size", "8x8", "--spp", "1", "--quiet"},
                       {{"XDG_CACHE_HOME", cache}});
    EXPECT_EQ(result.signal, 0);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(fs::exists(file("b.png")));
}

}  // namespace
}  // namespace candela

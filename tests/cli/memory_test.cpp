// Where the address space is small, or that for data, the program ends with a message. (Sanitizers need more
// of it.)
#include <filesystem>
#include <fstream>

#include "cli/cli_fixture.h"

#ifndef CANDELA_SANITIZE

namespace candela {
namespace {

class LittleMemory : public CliTest {
  protected:
    // Runs candela after a command of the shell, which counts in KiB.
    static ProcessResult run(const Words& arguments, const std::string& limit = "ulimit -v 400000") {
        return run_process(Words{"/bin/sh", "-c", limit + "; exec \"$0\" \"$@\""} + call(arguments),
                           options());
    }
};

// Drivers would end the program without a message, or wait for ever.
TEST_F(LittleMemory, IsAnErrorBeforeADriverFindsOut) {
    for (const char* limit : {"ulimit -v 400000", "ulimit -d 100000", "ulimit -d 300000",
                              "ulimit -v 4000000; ulimit -d 250000"}) {
        const ProcessResult result =
            run({"render", CORNELL_BOX, "--size", "16x16", "-o", file("a.png")}, limit);
        EXPECT_EQ(result.exit_code, 5) << limit << result.err;
        EXPECT_CONTAINS(result.err,
                        "candela: error: cannot use Vulkan: its drivers need 768 MiB of address space and "
                        "data, and less is left; raise the limit (ulimit -v, ulimit -d)");
    }
}

// Twenty million vertices, all zero, in a file that takes no room on the disk.
TEST_F(LittleMemory, IsAnErrorWhereAMeshDoesNotFit) {
    std::ofstream(file("a.ply"))
        << "ply\nformat binary_little_endian 1.0\nelement vertex 20000000\nproperty float x\n"
           "property float y\nproperty float z\nelement face 1\n"
           "property list uchar int vertex_indices\nend_header\n";
    std::filesystem::resize_file(file("a.ply"), std::filesystem::file_size(file("a.ply")) + 240000013);
    std::ofstream(file("a.json")) << R"({"cameras": {"main": {"position": [0, 0, 1], "look_at": [0, 0, 0],
        "vertical_fov": 40}}, "shapes": [{"type": "ply", "file": "a.ply", "emission": 1}]})";
    const ProcessResult result = run({"info", file("a.json")});
    EXPECT_EQ(result.exit_code, 5) << result.err;
    EXPECT_CONTAINS(
        result.err,
        "a.ply: there is not enough memory for the mesh; make it smaller, or use a larger machine");
}

}  // namespace
}  // namespace candela

#endif

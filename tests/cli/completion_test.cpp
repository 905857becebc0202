// `candela completion` and `candela manual`: what they print is made from the options, and shells and man
// read it.
#include <sstream>

#include "cli/cli_fixture.h"

namespace candela {
namespace {

class Completion : public CliTest {
  protected:
    // What bash offers for the last of these words, the first of which is candela.
    Words offered(const Words& line) const {
        write("candela.bash", candela({"completion", "bash"}).out);
        const ProcessResult result = run_process(
            Words{
                "/usr/bin/env", "bash", "-c",
                "cd \"$1\"; . ./candela.bash; shift; COMP_WORDS=(\"$@\"); COMP_CWORD=$(($# - 1)); _candela; "
                "printf '%s\\n' \"${COMPREPLY[@]}\"",
                "bash", file("")} +
            line);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        EXPECT_EQ(result.err, "");
        Words words;
        std::istringstream lines(result.out);
        for (std::string word; std::getline(lines, word);)
            if (!word.empty()) words.push_back(word);
        return words;
    }
};

TEST_F(Completion, BashOffersCommandsOptionsValuesAndFiles) {
    write("a scene.json", "");
    EXPECT_EQ(offered({"candela", "de"}), (Words{"devices", "denoise"}));
    EXPECT_EQ(offered({"candela", "--v"}), Words{"--version"});
    EXPECT_EQ(offered({"candela", "render", "--denoise"}), (Words{"--denoise", "--denoise-quality"}));
    EXPECT_EQ(offered({"candela", "render", "--denoise", ""}), (Words{"auto", "oidn", "variance", "none"}));
    EXPECT_EQ(offered({"candela", "render", "--exposure", ""}), (Words{"auto", "first"}));
    EXPECT_EQ(offered({"candela", "render", "a"}), Words{"a scene.json"});
    EXPECT_EQ(offered({"candela", "render", "-o", "a"}), Words{"a scene.json"});
    EXPECT_EQ(offered({"candela", "render", "--spp", ""}), Words{});
    EXPECT_EQ(offered({"candela", "completion", ""}), (Words{"bash", "zsh", "fish"}));
    EXPECT_EQ(offered({"candela", "devices", ""}), Words{});
}

// The long names of the options in a text of help, without their dashes.
Words long_names(const std::string& help) {
    Words names;
    std::istringstream lines(help);
    for (std::string line; std::getline(lines, line);) {
        const size_t begin = line.find("--");  // After a short name, or first.
        if (line.starts_with("  -") && begin <= 5)
            names.push_back(line.substr(begin + 2, line.find_first_of(" \n", begin) - begin - 2));
    }
    return names;
}

bool has_line_with(const std::string& text, const std::string& a, const std::string& b) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);)
        if (line.find(a) != std::string::npos && line.find(b) != std::string::npos) return true;
    return false;
}

TEST_F(Completion, ScriptsAndPagesHaveEveryOptionOfHelp) {
    const std::string zsh = candela({"completion", "zsh"}).out, fish = candela({"completion", "fish"}).out;
    for (const std::string command : {"render", "view", "info", "compare", "merge", "serve"}) {
        const Words names = long_names(candela({command, "--help"}).out);
        EXPECT_GT(names.size(), 1u);
        const size_t begin = zsh.find("        " + command + ")");
        ASSERT_NE(begin, std::string::npos);
        const std::string zsh_part = zsh.substr(begin, zsh.find(";;", begin) - begin);
        std::string page = candela({"manual", command}).out;
        std::erase(page, '\\');
        for (const std::string& name : names) {
            EXPECT_TRUE(
                has_line_with(fish, "'__fish_seen_subcommand_from " + command + "'", " -l " + name + " "))
                << command << ' ' << name;
            EXPECT_CONTAINS(zsh_part, "--" + name);
            EXPECT_CONTAINS(page, "fB--" + name + "fR");
        }
    }
}

TEST_F(Completion, ManualPagesBeginWithTheirNames) {
    EXPECT_TRUE(candela({"manual"}).out.starts_with(".TH candela 1 \"\" \"candela 0.1.0\"\n.SH NAME\n"));
    EXPECT_TRUE(
        candela({"manual", "render"})
            .out.starts_with(".TH candela\\-render 1 \"\" \"candela 0.1.0\"\n.SH NAME\ncandela\\-render \\- "
                             "Render a scene to image files\n"));
    const ProcessResult unknown = candela({"manual", "trace"});
    EXPECT_EQ(unknown.exit_code, 2);
    EXPECT_CONTAINS(unknown.err, "COMMAND: there is no command \"trace\"; see candela --help");
}

}  // namespace
}  // namespace candela

// What --report writes: for one picture an object, for several a line with an object for each.
#pragma once

#include <fstream>
#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "base/error.h"
#include "cli/picture_plan.h"
#include "cli/picture_renderer.h"

namespace candela {

class Report {
  public:
    // Throws Error if the file could not be written. A batch, and a file *.jsonl, gets lines, which replace
    // an old file at once.
    Report(const std::optional<std::string>& target, bool is_batch);

    // Whether the name of a file asks for lines.
    static bool is_lines(const std::string& target);

    // Adds a picture that was rendered, or one that was not, with the words of --progress json for how it
    // ended. The latter makes a line, but no report of one picture. Throws Error if that fails; of lines,
    // only once.
    void add(const RenderedPicture& rendered, const std::optional<Error>& failure);
    void add(const Picture& picture, const std::string& state, const std::optional<Error>& failure = {});

  private:
    void write(const nlohmann::ordered_json& entry);

    std::optional<std::string> target_;  // "-": stdout.
    bool has_lines_;
    std::ofstream lines_;
    bool failed_ = false;
};

}  // namespace candela

// See message_options.h.
#include "cli/message_options.h"

#include "cli/arguments.h"

namespace candela {

void MessageOptions::add_to(CLI::App& app) {
    app.option_defaults()->group("Messages");
    CLI::Option* const quiet_flag =
        app.add_flag("-q,--quiet", quiet, "No progress, no summary, only warnings and errors");
    add_choice(app, "--progress", progress, PROGRESS_NAMES,
               "Progress on stderr: for people, as JSON, or none (default: auto)")
        ->excludes(quiet_flag);
    app.add_flag("-v,--verbose", verbose, "Also describe device, scene and memory")->excludes(quiet_flag);
}

}  // namespace candela

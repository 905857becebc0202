// `candela serve`: answers the requests of another program.
#include <memory>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "cli/command.h"
#include "cli/loading.h"
#include "cli/rendering_options.h"
#include "cli/vulkan.h"
#include "os/interrupt.h"
#include "os/process.h"
#include "os/stream.h"
#include "serve/methods.h"
#include "serve/server.h"
#include "serve/shared_memory.h"

namespace candela {
namespace {

struct ServeArguments {
    bool stdio = false;
    std::optional<std::string> device;
    LoadingOptions loading;
};

ExitCode serve_client(const ServeArguments& arguments, const std::string& command_line) {
    const os::Interrupts interrupts;
    const int out = os::take_standard_output();
    if (out < 0)
        throw Error("there is no standard output; connect it to the program that reads the messages");
    const int client = os::parent_process_id();
    remove_abandoned_memory();
    serve::Methods methods({.device = arguments.device,
                            .kernel_cache = pipeline_cache_folder(),
                            .instance = instance_options,
                            .loading = load_options(arguments.loading),
                            .command_line = command_line});
    serve::Server server(
        os::STANDARD_INPUT, out,
        [&](const serve::Request& request, const serve::Call& call) { return methods(request, call); },
        [&interrupts] { return interrupts.noted(); });
    const serve::Server::End end = server.run();
    remove_abandoned_memory_of(client);  // If it was killed.
    if (end == serve::Server::End::given_up)
        throw Error(
            "serve: the client does not read the answers, and more wait than memory is set aside for");
    if (methods.validation_messages() > 0) throw Error("serve: the Vulkan validation layer reported errors");
    return end == serve::Server::End::stopped ? ExitCode::interrupted : ExitCode::done;
}

}  // namespace

Command add_serve_command(CLI::App& app, const std::string& command_line) {
    CLI::App* const command =
        app.add_subcommand("serve", "Answer the requests of another program, which keeps scenes loaded");
    const auto arguments = std::make_shared<ServeArguments>();
    command
        ->add_flag("--stdio", arguments->stdio,
                   "Requests come from standard input, and answers go to standard output")
        ->required();
    command->option_defaults()->group("Device");
    command
        ->add_option("--device", arguments->device,
                     "Index or part of the name (default: the best; see candela devices)")
        ->type_name("D");
    arguments->loading.add_limits_to(*command);
    command->footer(
        "Requests are JSON-RPC 2.0, one a line; docs/protocol.md describes them, and the Python package\n"
        "in integrations/python speaks them.\n\n"
        "Example:\n"
        "  echo '{\"jsonrpc\": \"2.0\", \"id\": 1, \"method\": \"version\"}' | candela serve --stdio");
    return {command, [arguments, command_line] { return serve_client(*arguments, command_line); }};
}

}  // namespace candela

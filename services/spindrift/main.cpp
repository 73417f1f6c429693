/// @file
/// The program: its command line and its exit status.

#include <fmt/format.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <memory>
#include <string>

#include "services/processor/version.h"
#include "services/spindrift/process.h"
#include "services/spindrift/replay.h"
#include "services/spindrift/serve.h"

namespace {

using spindrift::ErrorCode;
using spindrift::Expected;

constexpr int kFailed = 1;
constexpr int kBadInput = 2;

/// What the command line asks for.
struct Request {
  spindrift::ProcessOptions process;
  spindrift::ServeOptions serve;
  spindrift::ReplayOptions replay;
  std::function<Expected<void>()> run;
};

void add_bus_options(CLI::App& command, std::uint32_t& domain, std::string& partition) {
  command.add_option("--domain", domain, "DDS domain")
      ->check(CLI::Range(0U, 230U))
      ->capture_default_str();
  command.add_option("--partition", partition, "DDS partition")->capture_default_str();
}

void add_process(CLI::App& app, Request& request) {
  spindrift::ProcessOptions& options = request.process;
  CLI::App& command = *app.add_subcommand("process", "Process recorded telemetry into an archive");
  command.add_option("--mission", options.mission, "Mission file")->required();
  command.add_option("--telemetry", options.telemetry, "CSV files, or directories of them")
      ->required();
  command.add_option("--db", options.db, "Archive to write, made where there is none")->required();
  command.add_flag("--strict", options.strict, "A bad row of telemetry is an error");
  command.add_flag("--json", options.json, "Print one JSON object");
  command.callback([&] { request.run = [&] { return process(request.process); }; });
}

void add_serve(CLI::App& app, Request& request) {
  spindrift::ServeOptions& options = request.serve;
  CLI::App& command = *app.add_subcommand("serve", "Process telemetry from DDS as it arrives");
  command.add_option("--mission", options.missions, "Mission file of each spacecraft")->required();
  command.add_option("--db", options.db, "Archive to write, made where there is none")->required();
  add_bus_options(command, options.domain, options.partition);
  command.add_flag("--json", options.json, "Print one JSON object at the end");
  command.callback([&] { request.run = [&] { return serve(request.serve); }; });
}

void add_replay(CLI::App& app, Request& request) {
  spindrift::ReplayOptions& options = request.replay;
  CLI::App& command = *app.add_subcommand("replay", "Publish recorded telemetry on DDS");
  command.add_option("--mission", options.mission, "Mission file")->required();
  command.add_option("--telemetry", options.telemetry, "CSV files, or directories of them")
      ->required();
  command.add_option("--speed", options.speed, "Times real time; 0: as fast as it is taken")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  add_bus_options(command, options.domain, options.partition);
  command.add_flag("--json", options.json, "Print one JSON object");
  command.callback([&] { request.run = [&] { return replay(request.replay); }; });
}

int run(int argc, char** argv) {
  Request request;
  CLI::App app{"spindrift: the attitude of satellites from their telemetry"};
  app.set_version_flag("--version", std::string{"spindrift "} + spindrift::kSoftwareVersion);
  app.require_subcommand(1);
  add_process(app, request);
  add_serve(app, request);
  add_replay(app, request);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? EXIT_SUCCESS : kBadInput;
  }

  const auto done = request.run();
  if (done) {
    return EXIT_SUCCESS;
  }
  fmt::print(stderr, "spindrift: {}\n", done.error().message);
  return done.error().code == ErrorCode::InvalidConfiguration ? kBadInput : kFailed;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    // Standard output is for results, standard error for people.
    spdlog::set_default_logger(spdlog::stderr_color_mt("spindrift"));
    spdlog::set_pattern("%Y-%m-%dT%H:%M:%S.%eZ %^%l%$ %v", spdlog::pattern_time_type::utc);
    return run(argc, argv);
  } catch (const std::exception& exception) {
    std::fputs("spindrift: ", stderr);
    std::fputs(exception.what(), stderr);
    std::fputs("\n", stderr);
    return kFailed;
  }
}

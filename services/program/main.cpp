/// @file
/// The program entry: standard streams, log and exit status.

#include <fcntl.h>
#include <fmt/format.h>
#include <spdlog/details/os.h>
#include <spdlog/sinks/ansicolor_sink.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <system_error>

#include "services/base/json_line.h"
#include "services/base/progress_bar.h"
#include "services/base/standard_error.h"
#include "services/base/warning.h"
#include "services/processor/version.h"
#include "services/program/command_line.h"
#include "services/serving/background_solving.h"

namespace {

using spindrift::ErrorCode;
using spindrift::kBadInput;
using spindrift::kFailed;

/// Prints the message for people on standard error; with --json, which even a bad command line may
/// contain, also an object on standard output.
void tell_failure(const std::string& message, std::span<char* const> arguments) {
  fmt::print(stderr, "spindrift: {}\n", message);
  const auto is_json = [](const char* argument) { return std::string_view{argument} == "--json"; };
  if (std::any_of(arguments.begin(), arguments.end(), is_json)) {
    fmt::print("{}", spindrift::json_line(spindrift::with_warnings({{"error", message}})));
  }
}

int run(int argc, char** argv) {
  const std::span<char* const> arguments{argv, static_cast<std::size_t>(argc)};
  spindrift::Request request;
  CLI::App app{"spindrift: the attitude of satellites from their telemetry"};
  app.set_version_flag("--version", std::string{"spindrift "} + spindrift::kSoftwareVersion);
  spindrift::add_commands(app, request);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help) {
    return app.exit(help);
  } catch (const CLI::ParseError& error) {
    tell_failure(spindrift::what_is_wrong(app, error), arguments);
    return kBadInput;
  }

  const auto done = request.run();
  if (done) {
    return request.status;
  }
  tell_failure(done.error().message, arguments);
  return done.error().code == ErrorCode::InvalidConfiguration ? kBadInput : kFailed;
}

int run_safely(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& exception) {
    tell_failure(exception.what(), {argv, static_cast<std::size_t>(argc)});
    return kFailed;
  }
}

/// Opens /dev/null on closed standard streams, since their numbers would otherwise go to a file or
/// socket that messages would then be written into. Writing to such a stream still fails.
void reserve_standard_streams() {
  int descriptor = STDIN_FILENO;
  while (descriptor >= 0 && descriptor <= STDERR_FILENO) {
    descriptor = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  }
  ::close(descriptor);
}

void log_to_standard_error(bool in_terminal) {
  const bool in_colour = in_terminal && spdlog::details::os::is_color_terminal();
  spdlog::set_default_logger(std::make_shared<spdlog::logger>(
      "spindrift", std::make_shared<spdlog::sinks::ansicolor_stderr_sink_mt>(
                       in_colour ? spdlog::color_mode::always : spdlog::color_mode::never)));
  const std::string begin_line = in_terminal ? spindrift::kEraseLine : "";
  spdlog::set_pattern(begin_line + "%Y-%m-%dT%H:%M:%S.%eZ %^%l%$ %v",
                      spdlog::pattern_time_type::utc);
}

/// Calls `run_safely` and treats a failure to write its results as a failure of the run.
int run_and_flush(int argc, char** argv) {
  const int status = run_safely(argc, argv);
  if (std::fflush(stdout) != 0) {
    fmt::print(stderr, "spindrift: standard output: {}\n", std::generic_category().message(errno));
    return status == EXIT_SUCCESS ? kFailed : status;
  }
  return status;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    // A full disk or a reader that is gone must fail the write, not kill the process.
    std::signal(SIGXFSZ, SIG_IGN);
    std::signal(SIGPIPE, SIG_IGN);
    reserve_standard_streams();
    spindrift::StandardError standard_error;
    log_to_standard_error(isatty(STDERR_FILENO) == 1);
    const int status = run_and_flush(argc, argv);
    const bool all_is_out = standard_error.close();
    if (!all_is_out || spindrift::is_solution_given_up()) {
      ::_exit(status);  // Abandoned solution threads may still run and cannot be joined.
    }
    return status;
  } catch (const std::exception& exception) {
    std::fputs("spindrift: ", stderr);
    std::fputs(exception.what(), stderr);
    std::fputs("\n", stderr);
    return kFailed;
  }
}

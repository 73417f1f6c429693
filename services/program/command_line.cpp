#include "services/program/command_line.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string_view>
#include <system_error>
#include <thread>
#include <vector>

#include "services/mission/mission_schema.h"
#include "services/operator/parse_action.h"

namespace spindrift {
namespace {

// Limits of --speed, multiples of real time.
constexpr double kSlowest = 0.001;
constexpr double kFastest = 1e6;

/// A partition must be a plain name: a pattern would let a rehearsal reach live subscribers.
std::string check_partition(const std::string& name) {
  return name.empty() || name.find_first_of("*?[") != std::string::npos
             ? fmt::format("'{}': must be a name, not empty and without * ? [", name)
             : std::string{};
}

/// An unset variable in a script yields an empty path.
std::string check_path(const std::string& path) {
  return path.empty() ? "must be a path, not empty" : std::string{};
}

/// Any suffix but .svg would promise a format that is not written.
std::string check_svg(const std::string& path) {
  return std::filesystem::path{path}.extension() == ".svg"
             ? std::string{}
             : fmt::format("'{}': must end in .svg: plots are written as SVG", path);
}

std::string check_count(const std::string& text) {
  const char* const end = text.data() + text.size();
  std::int64_t count = 0;
  const auto [rest, error] = std::from_chars(text.data(), end, count);
  return error == std::errc{} && rest == end && count > 0
             ? std::string{}
             : fmt::format("'{}': must be a positive integer", text);
}

/// The condition is written so that NaN fails.
void check_speed(double speed) {
  if (!(speed == 0.0 || (speed >= kSlowest && speed <= kFastest))) {
    throw CLI::ValidationError{
        "--speed", fmt::format("{}: must be 0, or {} to {}", speed, kSlowest, kFastest)};
  }
}

/// Sets the exit status: a command that ran to its end may still have found problems.
Expected<void> with_status(const Expected<bool>& is_well, Request& request) {
  return is_well.map([&](bool yes) { request.status = yes ? EXIT_SUCCESS : kFailed; });
}

void add_bus_options(CLI::App& command, std::uint32_t& domain, std::string& partition) {
  command.add_option("--domain", domain, "DDS domain")
      ->check(CLI::Range(0U, 230U))
      ->capture_default_str();
  command.add_option("--partition", partition, "DDS partition")
      ->check(check_partition)
      ->capture_default_str();
}

void add_mission_option(CLI::App& command, std::filesystem::path& mission) {
  command.add_option("--mission", mission, "Mission file")->check(check_path)->required();
}

void add_plot_option(CLI::App& command, std::filesystem::path& plot) {
  command.add_option("--plot", plot, "SVG file to write, its name ending in .svg")
      ->check(check_svg);
}

void add_recording_options(CLI::App& command, std::filesystem::path& mission,
                           std::vector<std::filesystem::path>& telemetry) {
  add_mission_option(command, mission);
  command.add_option("--telemetry", telemetry, "CSV files, or directories of them")
      ->check(check_path)
      ->required();
}

void add_archive_option(CLI::App& command, std::filesystem::path& db) {
  command.add_option("--db", db, "Archive to write, made where there is none")
      ->check(check_path)
      ->required();
}

void add_process(CLI::App& app, Request& request) {
  ProcessOptions& options = request.process;
  CLI::App& command = *app.add_subcommand("process", "Process recorded telemetry into an archive");
  add_recording_options(command, options.mission, options.telemetry);
  add_archive_option(command, options.db);
  command.add_option("--label", options.label, "Name of the run in the archive");
  command.add_flag("--strict", options.strict, "A bad row of telemetry is an error");
  command.add_flag("--json", options.json, "Print one JSON object");
  command.callback(
      [&] { request.run = [&] { return with_status(process(request.process), request); }; });
}

void add_batch(CLI::App& app, Request& request) {
  BatchOptions& options = request.batch;
  CLI::App& command =
      *app.add_subcommand("batch", "Solve a stored run as a whole, with biases and bound");
  add_mission_option(command, options.mission);
  command.add_option("--db", options.db, "Archive; it is only read")->check(check_path)->required();
  command.add_option("--run", options.run, "Run; without, the newest of the spacecraft");
  command.add_option("--last", options.last_revolutions, "Only so many of the last revolutions")
      ->check(check_count);
  command.add_flag("--json", options.json, "Print one JSON object");
  command.callback([&] { request.run = [&] { return batch(request.batch); }; });
}

void add_serve(CLI::App& app, Request& request) {
  ServeOptions& options = request.serve;
  CLI::App& command = *app.add_subcommand("serve", "Process telemetry from DDS as it arrives");
  command.add_option("--mission", options.missions, "Mission file of each spacecraft")
      ->check(check_path)
      ->required();
  add_archive_option(command, options.db);
  add_bus_options(command, options.domain, options.partition);
  command.add_option("--webhook", options.webhook,
                     "Alertmanager to tell the alerts: http://127.0.0.1:9093/api/v2/alerts");
  CLI::Option* const console =
      command.add_option("--console", options.console, "Console for browsers at HOST:PORT");
  command.add_option("--console-host", options.console_hosts, "Name by which browsers call it")
      ->needs(console);
  command.add_flag(
      "--json", options.json,
      "Print one JSON object at the end; the log, where it is no terminal, as JSON lines");
  command.callback([&] { request.run = [&] { return serve(request.serve); }; });
}

void add_replay(CLI::App& app, Request& request) {
  ReplayOptions& options = request.replay;
  CLI::App& command = *app.add_subcommand("replay", "Publish recorded telemetry on DDS");
  add_recording_options(command, options.mission, options.telemetry);
  CLI::Option* const speed =
      command.add_option("--speed", options.speed, "Times real time; 0: as fast as it is taken")
          ->capture_default_str();
  command
      .add_flag("--now", options.now, "Rehearse: late and outdated are judged as if it were now")
      ->excludes(speed);
  add_bus_options(command, options.domain, options.partition);
  command.add_flag("--json", options.json, "Print one JSON object");
  command.callback([&] {
    check_speed(options.speed);
    request.run = [&] { return replay(request.replay); };
  });
}

void add_simulate(CLI::App& app, Request& request) {
  SimulateOptions& options = request.simulate;
  CLI::App& command = *app.add_subcommand("simulate", "Make a pass from a scenario");
  command.add_option("scenario", options.scenario, "Scenario file")->check(check_path)->required();
  CLI::Option_group& where = *command.add_option_group("Output", "At least one of these is needed");
  CLI::Option* const out =
      where.add_option("--out", options.out, "Folder to write, made where there is none")
          ->check(check_path);
  CLI::Option* const publish = where.add_flag("--publish", options.publish, "Onto DDS");
  where.require_option(1, 2);
  CLI::Option* const speed =
      command.add_option("--speed", options.speed, "Times real time; 0: as fast as it is taken")
          ->capture_default_str()
          ->needs(publish);
  command
      .add_flag("--now", options.now,
                "Rehearse: the pass begins now, whatever pass.start says, on its orbit "
                "seen from the Earth; serve the mission file of --out")
      ->needs(publish)
      ->excludes(speed);
  add_bus_options(command, options.domain, options.partition);
  command.get_option("--domain")->needs(publish);
  command.get_option("--partition")->needs(publish);
  CLI::Option* const runs =
      command
          .add_option("--runs", options.runs,
                      "Make and process so many passes, of seeds and [[dispersions]]")
          ->check(check_count)
          ->needs(out)
          ->excludes(publish);
  options.jobs = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  command.add_option("--jobs", options.jobs, "Runs at the same time; without, one a processor")
      ->check(CLI::Range(1, 64))
      ->needs(runs);
  command
      .add_flag("--plots", options.plots, "Plots (SVG) of a three-axis spacecraft's flight, too")
      ->needs(out)
      ->excludes(runs);
  command.add_flag("--json", options.json, "Print one JSON object");
  command.callback([&] {
    check_speed(options.speed);
    request.run = [&] { return simulate(request.simulate); };
  });
}

void add_doctor(CLI::App& app, Request& request) {
  DoctorOptions& options = request.doctor;
  CLI::App& command =
      *app.add_subcommand("doctor", "Say what is wrong before a pass, and what to do about it");
  command.add_option("--mission", options.missions, "Mission file of each spacecraft")
      ->check(check_path);
  command.add_option("--db", options.db, "Archive of the pass")->check(check_path);
  CLI::Option* const from = command.add_option(
      "--from", options.from, "Beginning of the coming pass, UTC; without, now is judged");
  CLI::Option* const to = command.add_option("--to", options.to, "End, UTC")->needs(from);
  from->needs(to);
  command.add_flag("--verbose", options.verbose, "Say what is sound, too");
  add_bus_options(command, options.domain, options.partition);
  command.add_flag("--json", options.json, "Print one JSON object");
  command.callback(
      [&] { request.run = [&] { return with_status(run_doctor(request.doctor), request); }; });
}

void add_date_option(CLI::App& command, double& year) {
  command.add_option("--date", year, "Year with decimals, 1900 to 2030: 2026.5")->required();
}

void add_degree_option(CLI::App& command, int& degree) {
  command.add_option("--degree", degree, "Degree of the field, 1 to 13")->capture_default_str();
}

void add_kind_option(CLI::App& command, std::string& kind) {
  command.add_option("--kind", kind, "uniform, curvature or chebyshev")->required();
}

void add_geomag_field(CLI::App& geomag, Request& request) {
  GeomagFieldOptions& options = request.geomag_field;
  CLI::App& command = *geomag.add_subcommand("field", "The field at points, as CSV");
  add_date_option(command, options.year);
  command
      .add_option("--points", options.points,
                  "CSV file: lat_deg,lon_deg,height_km, geodetic WGS-84")
      ->check(check_path)
      ->required();
  command.add_flag("--json", options.json, "Print one JSON object");
  command.callback([&] { request.run = [&] { return geomag_field(request.geomag_field); }; });
}

void add_geomag_table(CLI::App& geomag, Request& request) {
  GeomagTableOptions& options = request.geomag_table;
  CLI::App& command = *geomag.add_subcommand(
      "table", "A table of the field along one revolution, for a spacecraft to carry");
  add_mission_option(command, options.mission);
  add_date_option(command, options.year);
  add_degree_option(command, options.degree);
  add_kind_option(command, options.kind);
  command.add_option("--points", options.points, "Points, or Chebyshev coefficients")->required();
  command.add_option("--out", options.out, "Table to write")->check(check_path)->required();
  command.add_option("--header", options.header, "C header to write, with table and lookup")
      ->check(check_path);
  command.add_flag("--json", options.json, "Print one JSON object");
  command.callback([&] { request.run = [&] { return geomag_table(request.geomag_table); }; });
}

void add_geomag_lookup(CLI::App& geomag, Request& request) {
  GeomagLookupOptions& options = request.geomag_lookup;
  CLI::App& command = *geomag.add_subcommand("lookup", "The field that a table gives, as CSV");
  command.add_option("--table", options.table, "Table")->check(check_path)->required();
  add_kind_option(command, options.kind);
  command.add_option("--points", options.points, "CSV file: anomaly_deg, behind the first")
      ->check(check_path)
      ->required();
  command.add_flag("--json", options.json, "Print one JSON object");
  command.callback([&] { request.run = [&] { return geomag_lookup(request.geomag_lookup); }; });
}

void add_geomag_study(CLI::App& geomag, Request& request) {
  GeomagStudyOptions& options = request.geomag_study;
  CLI::App& command = *geomag.add_subcommand(
      "study", "Compare tables of all kinds and sizes, and what they cost an attitude");
  add_mission_option(command, options.mission);
  add_date_option(command, options.year);
  add_degree_option(command, options.degree);
  command.add_option("--out", options.out, "Folder for plots")
      ->check(CLI::ExistingDirectory)
      ->required();
  command.add_flag("--json", options.json, "Print one JSON object");
  command.callback([&] { request.run = [&] { return geomag_study(request.geomag_study); }; });
}

void add_geomag(CLI::App& app, Request& request) {
  CLI::App& geomag =
      *app.add_subcommand("geomag", "The Earth's main magnetic field, IGRF-14, and tables of it");
  geomag.require_subcommand(1);
  add_geomag_field(geomag, request);
  add_geomag_table(geomag, request);
  add_geomag_lookup(geomag, request);
  add_geomag_study(geomag, request);
}

void add_geometry(CLI::App& app, Request& request) {
  GeometryOptions& options = request.geometry;
  CLI::App& command = *app.add_subcommand(
      "geometry", "Plan a coming pass: what each sensor will see, and the accuracy to expect");
  add_mission_option(command, options.mission);
  command.add_option("--from", options.from, "Beginning, UTC: 2026-11-20T03:00:00Z")->required();
  command.add_option("--to", options.to, "End, UTC")->required();
  command.add_option("--attitude", options.attitude, "Spin axis RA,DEC in deg, ICRF: 100,-55")
      ->required();
  command.add_option("--rpm", options.rate_rpm, "Spin rate, 5 to 200; without it 60 is assumed");
  command.add_option("--step", options.step_s, "Seconds between rows; without it about 60 rows");
  add_plot_option(command, options.plot);
  command.add_flag("--json", options.json, "Print one JSON object");
  command.callback([&] { request.run = [&] { return geometry(request.geometry); }; });
}

void add_reconstruct(CLI::App& app, Request& request) {
  ReconstructOptions& options = request.reconstruct;
  CLI::App& command = *app.add_subcommand(
      "reconstruct", "Reconstruct the attitude at separation, backwards from the star fixes");
  command
      .add_option("--mission", options.mission,
                  "Mission file; without, that of the newest run in the archive")
      ->check(check_path);
  command
      .add_option("--telemetry", options.telemetry,
                  "CSV files, or directories of them; without, the samples in the archive")
      ->check(check_path);
  add_archive_option(command, options.db);
  using Method = ReconstructionMethod;
  static const std::map<std::string, Method> kMethods{{"batch", Method::Batch},
                                                      {"sequential", Method::Sequential}};
  command.add_option("--method", options.method, "batch or sequential; without, both")
      ->transform(CLI::CheckedTransformer(kMethods));
  add_plot_option(command, options.plot);
  command.add_flag("--json", options.json, "Print one JSON object");
  command.callback([&] {
    request.run = [&] { return with_status(reconstruct(request.reconstruct), request); };
  });
}

void add_compare(CLI::App& app, Request& request) {
  CompareOptions& options = request.compare;
  CLI::App& command = *app.add_subcommand(
      "compare", "Hold flight against the ground model, and say since when it is away");
  add_mission_option(command, options.mission);
  CLI::Option_group& flight = *command.add_option_group("Flight", "One of these is needed");
  flight.add_option("--telemetry", options.telemetry, "CSV files, or directories of them")
      ->check(check_path);
  flight
      .add_option("--db", options.db,
                  "Archive with the telemetry; what departs is stored there as alerts")
      ->check(check_path);
  flight.require_option(1);
  command.add_option("--model", options.model, "Scenario file, by which flight should go")
      ->check(check_path)
      ->required();
  add_plot_option(command, options.plot);
  command.add_flag("--json", options.json, "Print one JSON object");
  command.callback([&] { request.run = [&] { return compare(request.compare); }; });
}

void add_alert_change(CLI::App& alerts, Request& request, const char* name, const char* about) {
  AlertsOptions& options = request.alerts;
  CLI::App& command = *alerts.add_subcommand(name, about);
  command.add_option("id", options.alert_id, "Alert, as `spindrift alerts` lists it")->required();
  command.add_option("--by", options.by, "Who says so")->required();
  command.add_option("--note", options.note, "Why")->required();
  command.add_option("--db", options.db, "Archive, if not said before")->check(check_path);
  command.add_flag("--json", options.json, "Print the alert as one JSON object");
  if (std::string_view{name} == "shelve") {
    command.add_option("--minutes", options.minutes, "For so long")
        ->check(CLI::Range(1, 10080))
        ->required();
  }
  command.callback([&] { request.run = [&] { return change_alert(request.alerts); }; });
}

/// `--db` may precede or follow `ack` and `shelve`.
void add_alerts(CLI::App& app, Request& request) {
  AlertsOptions& options = request.alerts;
  CLI::App& command = *app.add_subcommand("alerts", "List the alerts of an archive");
  command.add_option("--db", options.db, "Archive")->check(check_path);
  command.add_flag("--json", options.json, "Print one JSON object");
  command.add_flag("--follow", options.follow,
                   "Go on and print each change, with --json as one JSON object a line");
  command.require_subcommand(0, 1);
  add_alert_change(command, request, "ack", "Acknowledge an open alert");
  add_alert_change(command, request, "shelve", "Silence an open alert for a while");
  command.callback([&] {
    if (request.alerts.db.empty()) {
      throw CLI::RequiredError{"--db"};
    }
    if (!request.run) {
      request.run = [&] {
        return request.alerts.follow ? follow_alerts(request.alerts) : list_alerts(request.alerts);
      };
    }
  });
}

/// Returns for example "exclude_channel, choose_root or set_target".
std::string any_action() {
  std::vector<std::string_view> names = action_names();
  const std::string_view last = names.back();
  names.pop_back();
  return fmt::format("{} or {}", fmt::join(names, ", "), last);
}

/// Gives each limit that some alert of the mission file has its option.
void add_limits(CLI::App& command, std::map<std::string, double>& limits) {
  std::map<std::string, KeyRule> rules;
  const TableRule schema = mission_schema().value();
  for (const auto& [key, alert] : schema.tables.at("alerts").tables) {
    rules.insert(alert.keys.begin(), alert.keys.end());
  }
  for (const auto& [name, rule] : rules) {
    command.add_option_function<double>(
        "--" + name, [&limits, name = name](double limit) { limits[name] = limit; },
        fmt::format("Limit of an alert that has it{}{}", rule.unit.empty() ? "" : ", ", rule.unit));
  }
}

void add_act(CLI::App& app, Request& request) {
  ActOptions& options = request.act;
  CLI::App& command = *app.add_subcommand(
      "act", "Tell the running service what to make of a spacecraft's telemetry");
  command.add_option("--db", options.db, "Archive of the service")->check(check_path)->required();
  command.add_option("--spacecraft", options.spacecraft, "Whose telemetry")->required();
  command.add_option("--action", options.action, any_action())->required();
  command.add_option("--by", options.by, "Who says so")->required();
  command.add_option("--note", options.note, "Why");
  command.add_option("--at", options.at,
                     "UTC from which it applies; without it as far as "
                     "telemetry has come, of a segment from its beginning on");
  command.add_option("--channel", options.channel, "Channel, or gyro, star, sun, magnetometer");
  command.add_option("--ra", options.ra_deg, "Right ascension, deg, ICRF");
  command.add_option("--dec", options.dec_deg, "Declination, deg");
  command.add_option("--sigma", options.sigma_deg, "One standard deviation, deg");
  command.add_option("--from", options.from, "Beginning of a segment, UTC");
  command.add_option("--to", options.to, "End of a segment, UTC");
  command.add_option("--key", options.key,
                     "Alert whose limits are set: key without what it is about");
  add_limits(command, options.limits);
  command.add_flag("--json", options.json, "Print one JSON object");
  command.callback([&] { request.run = [&] { return act(request.act); }; });
}

std::string subcommands_of(const CLI::App& app) {
  std::string names;
  for (const CLI::App* const command : app.get_subcommands({})) {
    names += (names.empty() ? "" : ", ") + command->get_name();
  }
  return names;
}

}  // namespace

void add_commands(CLI::App& app, Request& request) {
  app.require_subcommand(1);
  add_process(app, request);
  add_batch(app, request);
  add_serve(app, request);
  add_replay(app, request);
  add_simulate(app, request);
  add_doctor(app, request);
  add_geomag(app, request);
  add_geometry(app, request);
  add_reconstruct(app, request);
  add_compare(app, request);
  add_alerts(app, request);
  add_act(app, request);
}

/// Names unknown arguments first: one may be a misspelling of an argument that is missing.
std::string what_is_wrong(const CLI::App& app, const CLI::ParseError& error) {
  std::string wrong;
  if (const auto unknown = app.remaining(true); !unknown.empty()) {
    wrong = fmt::format("not known: {}\n", fmt::join(unknown, " "));
  }
  if (app.get_subcommands().empty()) {
    wrong += fmt::format("A subcommand is required: {}\n", subcommands_of(app));
  } else if (wrong.empty() ||
             error.get_exit_code() != static_cast<int>(CLI::ExitCodes::ExtrasError)) {
    wrong += fmt::format("{}\n", error.what());
  }
  return wrong + "Run with --help for more information.";
}

}  // namespace spindrift

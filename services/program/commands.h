/// @file
/// The subcommands: what each is given on the command line, and the function that carries it out.

#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/geomagnetism/main_field.h"
#include "pipelines/reconstruction/reconstruction.h"

namespace spindrift {

/// `spindrift process`: runs the pipelines over recorded telemetry into an archive.
struct ProcessOptions {
  std::filesystem::path mission;
  std::vector<std::filesystem::path> telemetry;
  std::filesystem::path db;
  std::optional<std::string> label;  ///< Label of the run in the archive.
  bool strict = false;               ///< A bad row is an error.
  bool json = false;
};

/// Prints the summary of the run on standard output. SIGINT and SIGTERM interrupt the run: what was
/// taken is stored and summarised, and the run stays unfinished. A second signal ends the program
/// at once.
/// @return whether the run came to its end; InvalidConfiguration for bad input, before anything is
///         written; Unavailable for a failure while running.
Expected<bool> process(const ProcessOptions& options);

/// `spindrift batch`: computes the maximum-likelihood solution of a stored run on demand. It only
/// reads the archive, so it works while a service writes it.
struct BatchOptions {
  std::filesystem::path mission;
  std::filesystem::path db;
  std::optional<std::string> run;                ///< Empty means the newest run of the spacecraft.
  std::optional<std::int64_t> last_revolutions;  ///< Empty means all revolutions.
  bool json = false;
};

/// Prints the solution on standard output.
/// @return InvalidConfiguration for bad input; Unobservable where the edges do not suffice.
Expected<void> batch(const BatchOptions& options);

/// `spindrift serve`: the service from bus telemetry to archived and published results.
struct ServeOptions {
  std::vector<std::filesystem::path> missions;
  std::filesystem::path db;
  std::uint32_t domain = 0;
  std::string partition = "live";
  std::string webhook;  ///< URL of an Alertmanager to notify of alerts; empty means none.
  std::string console;  ///< HOST:PORT to listen on; empty means no console.
  std::vector<std::string> console_hosts;  ///< Host names under which browsers may reach it.
  bool json = false;
};

/// Runs until SIGINT, SIGTERM or SIGHUP, then stores everything that was taken and prints the
/// summary.
/// @return InvalidConfiguration for bad input; Unavailable when the bus or the archive failed.
Expected<void> serve(const ServeOptions& options);

/// `spindrift replay`: publishes recorded telemetry on the bus as the front-end sent it.
struct ReplayOptions {
  std::filesystem::path mission;
  std::vector<std::filesystem::path> telemetry;
  double speed = 1.0;  ///< Multiple of real time; 0 means as fast as subscribers take it.
  bool now = false;    ///< Tell subscribers how far sample times lie in the past.
  std::uint32_t domain = 0;
  std::string partition = "replay";
  bool json = false;
};

/// Waits for a subscriber, publishes, waits until everything has arrived.
/// @return InvalidConfiguration for bad input; Unavailable when nobody subscribes, the bus fails or
///         a subscriber does not take what it was sent.
Expected<void> replay(const ReplayOptions& options);

/// `spindrift simulate`: simulates a pass from a scenario, into files or onto the bus.
struct SimulateOptions {
  std::filesystem::path scenario;
  std::filesystem::path out;  ///< Folder for the files, written before anything is published.
  bool publish = false;
  double speed = 1.0;  ///< Multiple of real time; 0 means as fast as subscribers take it.
  bool now = false;    ///< Shift the pass to the present.
  std::uint32_t domain = 0;
  std::string partition = "replay";
  std::int64_t runs = 0;  ///< Number of Monte Carlo runs; 0 means one pass without dispersions.
  int jobs = 1;           ///< Number of threads for Monte Carlo runs.
  bool plots = false;     ///< Also write plots; only for one pass of a three-axis spacecraft.
  bool json = false;
};

/// Prints a summary of the pass on standard output.
/// @return InvalidConfiguration for a bad scenario; Unavailable when the files cannot be written,
///         nobody subscribes or the bus fails.
Expected<void> simulate(const SimulateOptions& options);

/// `spindrift doctor`: reports what is wrong before a pass, and what to do about it.
struct DoctorOptions {
  std::vector<std::filesystem::path> missions;
  std::filesystem::path db;  ///< Empty means that neither archive nor disk is checked.
  std::uint32_t domain = 0;
  std::string partition = "live";
  std::string from;  ///< Start of the coming pass, UTC; empty means now.
  std::string to;
  bool verbose = false;  ///< Also print the checks that passed.
  bool json = false;
};

/// Prints its findings on standard output. Call it before any thread is started.
/// @return whether a pass can be taken; InvalidConfiguration when a mission file or a time is bad.
Expected<bool> run_doctor(const DoctorOptions& options);

/// `spindrift geomag field`: evaluates the Earth's main magnetic field at points.
struct GeomagFieldOptions {
  double year = 0.0;             ///< The year with its fraction.
  std::filesystem::path points;  ///< CSV: lat_deg,lon_deg,height_km, geodetic WGS-84.
  bool json = false;
};

/// Prints the points with the north, east and down components of the field on standard output.
/// @return InvalidConfiguration for a year outside the model and for a malformed points file,
///         naming line, column and what is allowed; Unavailable when reading fails.
Expected<void> geomag_field(const GeomagFieldOptions& options);

/// `spindrift geomag table`: makes a table of the field for a spacecraft to carry.
struct GeomagTableOptions {
  std::filesystem::path mission;
  double year = 0.0;  ///< The year with its fraction.
  int degree = kHighestDegree;
  std::string kind;
  int points = 0;
  std::filesystem::path out;
  std::filesystem::path header;  ///< Path of a C header to write; empty means none.
  bool json = false;
};

/// @return InvalidConfiguration for a mission without orbit elements, a date, degree, kind or
/// number
///         of points that cannot be; Unavailable when writing fails.
Expected<void> geomag_table(const GeomagTableOptions& options);

/// `spindrift geomag lookup`: what a table gives at anomalies behind its first.
struct GeomagLookupOptions {
  std::filesystem::path table;
  std::string kind;
  std::filesystem::path points;  ///< CSV: anomaly_deg.
  bool json = false;
};

/// Prints the field at the anomalies, CSV, on standard output.
/// @return InvalidConfiguration for a file that is no table of the kind and for a malformed points
///         file; Unavailable when reading fails.
Expected<void> geomag_lookup(const GeomagLookupOptions& options);

/// `spindrift geomag study`: compares tables of all kinds and sizes.
struct GeomagStudyOptions {
  std::filesystem::path mission;
  double year = 0.0;
  int degree = kHighestDegree;
  std::filesystem::path out;  ///< Folder for the plots; it must exist.
  bool json = false;
};

/// Prints the comparison on standard output and writes its plots.
/// @return As `geomag_table`.
Expected<void> geomag_study(const GeomagStudyOptions& options);

/// `spindrift geometry`: predicts a coming pass and how well it determines the spin axis.
struct GeometryOptions {
  std::filesystem::path mission;
  std::string from;      ///< UTC, ISO 8601 ending in Z.
  std::string to;        ///< UTC, ISO 8601 ending in Z.
  std::string attitude;  ///< "RA,DEC" of the spin axis in deg, ICRF.
  std::optional<double> rate_rpm;
  std::optional<double> step_s;
  std::filesystem::path plot;  ///< Path of an SVG to write; empty means none.
  bool json = false;
};

/// Prints the plan on standard output.
/// @return InvalidConfiguration for a bad mission file, an orbit that does not cover the pass, or
///         bad arguments, every one of them named; Unavailable where the plot cannot be written.
Expected<void> geometry(const GeometryOptions& options);

/// `spindrift reconstruct`: computes the attitude at separation backwards from the star fixes, from
/// files or from the samples in the archive.
struct ReconstructOptions {
  std::optional<std::filesystem::path> mission;  ///< Empty: that of the archive's newest run.
  std::vector<std::filesystem::path> telemetry;  ///< Empty means the samples in the archive.
  std::filesystem::path db;
  std::optional<ReconstructionMethod> method;  ///< Empty means both methods.
  std::filesystem::path plot;                  ///< Empty means no plot.
  bool json = false;
};

/// Reconstructs the separation and stores a run, here or through the service that holds the
/// archive, and prints the answer on standard output.
/// @return whether each method gave an attitude; InvalidConfiguration for bad input, before
///         anything is written; Unavailable for a failure while running.
Expected<bool> reconstruct(const ReconstructOptions& options);

/// `spindrift compare`: compares recorded or archived telemetry with the ground model.
struct CompareOptions {
  std::filesystem::path mission;
  std::vector<std::filesystem::path> telemetry;  ///< Empty means the telemetry in the archive.
  std::filesystem::path db;                      ///< Empty when telemetry files are given.
  std::filesystem::path model;                   ///< Path of a scenario file.
  std::filesystem::path plot;                    ///< Empty means no plot.
  bool json = false;
};

/// Prints the residuals of each channel and when it departed from the model. Of archived telemetry
/// it stores a run with both, and an alert for each departure.
/// @return InvalidConfiguration for bad input, and where nothing can be compared; Unavailable for a
///         failure while running.
Expected<void> compare(const CompareOptions& options);

/// `spindrift alerts`: lists, acknowledges and shelves the alerts of an archive.
struct AlertsOptions {
  std::filesystem::path db;
  bool json = false;
  bool follow = false;
  std::string alert_id = {};  ///< Used by `ack` and `shelve` only, as are the members below.
  std::string by = {};
  std::string note = {};
  int minutes = 0;  ///< Duration of shelving; 0 means acknowledge.
};

/// Prints the open alerts as text, or with `json` all alerts as one object.
Expected<void> list_alerts(const AlertsOptions& options);

/// Prints the open alerts, then one line for each change as it is stored, until SIGINT or SIGTERM
/// arrives or the reader of standard output is gone.
Expected<void> follow_alerts(const AlertsOptions& options);

/// Changes one alert, through the service that holds the archive or else directly.
Expected<void> change_alert(const AlertsOptions& options);

/// `spindrift act`: sends an operator's action for a spacecraft to the running service.
struct ActOptions {
  std::filesystem::path db;
  std::string spacecraft;
  std::string action;
  std::string by;
  std::string note = {};
  bool json = false;
  std::optional<std::string> at = {};  ///< UTC.
  /// @name Arguments of some actions
  /// @{
  std::optional<std::string> channel = {};
  std::optional<double> ra_deg = {};
  std::optional<double> dec_deg = {};
  std::optional<double> sigma_deg = {};
  std::optional<std::string> from = {};       ///< UTC.
  std::optional<std::string> to = {};         ///< UTC.
  std::optional<std::string> key = {};        ///< Of alerts.
  std::map<std::string, double> limits = {};  ///< By name, as under [alerts].
  /// @}
};

/// Prints the id under which the service stored the action. @return InvalidConfiguration with the
/// reason of a refusal; Unavailable when no service holds the archive.
Expected<void> act(const ActOptions& options);

}  // namespace spindrift

#include "services/spindrift/telemetry_input.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstddef>
#include <utility>

#include "services/telemetry_files/telemetry_rows.h"

namespace spindrift {
namespace {

constexpr std::size_t kRowsShown = 5;

template <class Value>
Expected<void> find_bad_rows_of(const std::filesystem::path& path, BadRows& bad) {
  auto rows = TelemetryRows<Value>::open(path, {});
  if (!rows) {
    return Unexpected{std::move(rows.error())};
  }
  while (true) {
    const auto row = rows->next();
    if (!row) {
      return Unexpected{row.error()};
    }
    if (!*row) {
      return {};
    }
    if (const auto* const rejected = std::get_if<RejectedInput>(&**row)) {
      bad.add(*rejected);
    }
  }
}

bool is_processed(TelemetryKind kind) {
  return kind == TelemetryKind::Pulses || kind == TelemetryKind::Coded;
}

/// A front-end that was stopped before its first line leaves such a file.
RejectedInput empty_file(const TelemetryFile& file) {
  return {.source = file.path.string(),
          .line = 1,
          .reason = "the file is empty: must begin with a header line"};
}

Error nothing_in(std::span<const TelemetryFile> files) {
  std::string text =
      "no row of pulses or coded frames in the telemetry: files with the header "
      "'t_tai_ns,channel' or 't_tai_ns,period_s,...' and rows are needed";
  for (const TelemetryFile& file : files) {
    text += fmt::format("\n  {}: {}", file.path.string(),
                        !file.kind                 ? "empty, without a header"
                        : is_processed(*file.kind) ? "no rows"
                                                   : "other telemetry");
  }
  return {ErrorCode::InvalidConfiguration, text};
}

}  // namespace

void BadRows::add(const RejectedInput& row) {
  ++count;
  if (first.size() < kRowsShown) {
    first.push_back(row);
  }
}

std::string BadRows::text() const {
  std::string text = fmt::format("{} bad rows of telemetry", count);
  for (const RejectedInput& row : first) {
    text += fmt::format("\n  {}:{}: {}", row.source, row.line, row.reason);
  }
  return count > first.size() ? text + "\n  ..." : text;
}

Expected<BadRows> find_bad_rows(std::span<const TelemetryFile> files) {
  BadRows bad;
  for (const TelemetryFile& file : files) {
    Expected<void> looked;
    if (!file.kind) {
      bad.add(empty_file(file));
    } else if (file.kind == TelemetryKind::Pulses) {
      looked = find_bad_rows_of<Pulse>(file.path, bad);
    } else if (file.kind == TelemetryKind::Coded) {
      looked = find_bad_rows_of<CodedFrame>(file.path, bad);
    }
    if (!looked) {
      return Unexpected{std::move(looked.error())};
    }
  }
  return bad;
}

Expected<TelemetryInput> TelemetryInput::open(std::span<const std::filesystem::path> paths,
                                              const std::string& spacecraft, bool strict) {
  auto files = scan_telemetry(paths);
  if (!files) {
    return Unexpected{std::move(files.error())};
  }
  for (const TelemetryFile& file : *files) {
    if (file.kind && !is_processed(*file.kind)) {
      spdlog::warn("{}: {} telemetry is left out: this version processes pulses and coded frames",
                   file.path.string(), name_of(*file.kind));
    }
  }
  if (strict) {
    const auto bad = find_bad_rows(*files);
    if (!bad) {
      return Unexpected{bad.error()};
    }
    if (bad->count > 0) {
      return Unexpected{{ErrorCode::InvalidConfiguration, bad->text()}};
    }
  }
  auto stream = TelemetryStream::open(*files, spacecraft);
  if (!stream) {
    return Unexpected{std::move(stream.error())};
  }
  auto first = stream->next();
  if (!first) {
    return Unexpected{std::move(first.error())};
  }
  if (is_empty(*first)) {
    return Unexpected{nothing_in(*files)};
  }
  for (const TelemetryFile& file : *files) {
    if (!file.kind) {
      first->rejected.push_back(empty_file(file));
    }
  }
  return TelemetryInput{std::move(*files), std::move(*stream), std::move(*first)};
}

Expected<SampleBatch> TelemetryInput::next() {
  auto batch = is_empty(first_) ? stream_.next() : Expected<SampleBatch>{std::exchange(first_, {})};
  if (batch) {
    for (const RejectedInput& row : batch->rejected) {
      bad_rows_.add(row);
    }
  }
  return batch;
}

bool TelemetryInput::holds(TelemetryKind kind) const {
  return std::any_of(files_.begin(), files_.end(),
                     [kind](const TelemetryFile& file) { return file.kind == kind; });
}

}  // namespace spindrift

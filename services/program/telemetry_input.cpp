#include "services/program/telemetry_input.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <utility>
#include <variant>

#include "pipelines/core/shown.h"
#include "services/base/counted.h"
#include "services/base/sha256.h"
#include "services/processor/told.h"
#include "services/program/outcome.h"
#include "services/telemetry/telemetry_rows.h"

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
      bad.collect(*rejected);
    }
  }
}

/// A front-end that was stopped before it wrote a line leaves an empty file.
RejectedInput empty_file(const TelemetryFile& file) {
  return {.source = shown(file.path.string()),
          .line = 1,
          .reason = "the file is empty: must begin with a header line"};
}

Unexpected nothing_in(std::span<const TelemetryFile> files) {
  std::string text = "no row of telemetry: files with a header line and rows are needed";
  for (const TelemetryFile& file : files) {
    text += fmt::format("\n  {}: {}", shown(file.path.string()),
                        file.kind ? "no rows" : "empty, without a header");
  }
  return refused(text);
}

}  // namespace

void BadRows::collect(const RejectedInput& row) {
  ++count;
  if (first.size() < kRowsShown) {
    first.push_back(row);
  }
}

std::string BadRows::text() const {
  std::string text = counted(count, "bad rows") + " of telemetry";
  for (const RejectedInput& row : first) {
    text += fmt::format("\n  {}:{}: {}", row.source, row.line, row.reason);
  }
  return count > first.size() ? text + "\n  ..." : text;
}

std::optional<RunNotice> told_bad_rows(const BadRows& bad) {
  return bad.count == 0 ? std::nullopt
                        : std::optional{told("bad_rows", {{"rows", bad.count}}, bad.text())};
}

std::vector<std::string> absolute_texts(std::span<const std::filesystem::path> paths) {
  std::vector<std::string> texts;
  for (const std::filesystem::path& path : paths) {
    texts.push_back(std::filesystem::absolute(path).lexically_normal().string());
  }
  return texts;
}

Expected<BadRows> find_bad_rows(std::span<const TelemetryFile> files) {
  BadRows bad;
  for (const TelemetryFile& file : files) {
    Expected<void> looked;
    if (!file.kind) {
      bad.collect(empty_file(file));
    } else {
      looked = std::visit(
          [&]<class Value>(Kind<Value>) { return find_bad_rows_of<Value>(file.path, bad); },
          *file.kind);
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
  if (strict) {
    const auto bad = find_bad_rows(*files);
    if (!bad) {
      return Unexpected{bad.error()};
    }
    if (bad->count > 0) {
      return refused(bad->text());
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
    return nothing_in(*files);
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
      bad_rows_.collect(row);
    }
    has_read_ = has_read_ || count_of(batch->samples) > 0;
  }
  return batch;
}

Expected<void> TelemetryInput::check_read() const {
  if (has_read_ || bad_rows_.count == 0) {
    return {};
  }
  const RejectedInput& row = bad_rows_.first.front();
  return refused(fmt::format("nothing of the telemetry can be read: {}:{}: {}", row.source,
                             row.line, row.reason));
}

std::optional<RunNotice> TelemetryInput::find_preferred(Mission& mission) const {
  std::string& preferred = mission.preferred_source;
  if (preferred.empty()) {
    return std::nullopt;
  }
  std::optional<RunNotice> notice;
  std::string source = find_source(files_, preferred);
  if (source.empty()) {
    std::vector<std::string> sources;
    for (const TelemetryFile& file : files_) {
      sources.push_back(file.source);
    }
    notice =
        told("no_preferred_source", {{"spacecraft", mission.spacecraft_id}, {"prefer", preferred}},
             fmt::format("{}: sources.prefer = \"{}\" is not one of the files, which are {}: "
                         "where samples contradict each other none is used",
                         mission.spacecraft_id, preferred, fmt::join(sources, ", ")));
  }
  preferred = std::move(source);
  return notice;
}

Expected<std::string> TelemetryInput::sha256() const {
  std::vector<std::filesystem::path> paths;
  for (const TelemetryFile& file : files_) {
    paths.push_back(file.path);
  }
  return sha256_hex(paths);
}

std::vector<TelemetryKind> TelemetryInput::kinds() const {
  std::vector<TelemetryKind> kinds;
  for (const TelemetryFile& file : files_) {
    if (file.kind && std::find(kinds.begin(), kinds.end(), *file.kind) == kinds.end()) {
      kinds.push_back(*file.kind);
    }
  }
  return kinds;
}

}  // namespace spindrift

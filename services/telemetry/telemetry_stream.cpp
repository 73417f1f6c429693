#include "services/telemetry/telemetry_stream.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <system_error>

namespace spindrift {
namespace {

// The shortest row: a time of the allowed years, a comma and a line feed.
constexpr std::uint64_t kShortestRow = 19;
constexpr std::size_t kFewestRowsHeld = 64;

struct Opening {
  std::filesystem::path path;
  std::string source;
  TelemetryKind kind;
  std::uint64_t bytes;
  std::size_t rows_held;
};

std::size_t row_bytes(const TelemetryKind& kind) {
  return std::visit([]<class Value>(Kind<Value>) { return sizeof(TelemetryRow<Value>); }, kind);
}

std::vector<Opening> openings_of(std::span<const TelemetryFile> files) {
  std::vector<Opening> openings;
  for (const TelemetryFile& file : files) {
    if (file.kind) {
      std::error_code gone;  // A missing file is reported on opening.
      const auto bytes = std::filesystem::file_size(file.path, gone);
      openings.push_back({.path = file.path,
                          .source = file.source,
                          .kind = *file.kind,
                          .bytes = gone ? 0 : bytes,
                          .rows_held = 0});
    }
  }
  return openings;
}

/// Holds small files whole and lets large ones share the remaining buffer.
void share_out(std::vector<Opening>& openings, std::size_t buffer_bytes) {
  std::vector<Opening*> by_size(openings.size());
  std::transform(openings.begin(), openings.end(), by_size.begin(),
                 [](Opening& opening) { return &opening; });
  std::stable_sort(by_size.begin(), by_size.end(),
                   [](const Opening* a, const Opening* b) { return a->bytes < b->bytes; });
  std::size_t files_left = by_size.size();
  for (Opening* opening : by_size) {
    const std::size_t row = row_bytes(opening->kind);
    const std::size_t share = buffer_bytes / files_left / row;
    const std::size_t whole = opening->bytes / kShortestRow + 1;
    opening->rows_held = std::max(std::min(share, whole), kFewestRowsHeld);
    buffer_bytes -= std::min(buffer_bytes, opening->rows_held * row);
    --files_left;
  }
}

template <class Value>
Expected<SortedRows<Value>> opened(const Opening& opening, const std::string& spacecraft) {
  return TelemetryRows<Value>::open(opening.path, spacecraft)
      .map([&opening](TelemetryRows<Value>&& rows) {
        return SortedRows<Value>{std::move(rows), opening.source, opening.rows_held};
      });
}

template <class Value>
TelemetrySample<Value> head_of(const SortedRows<Value>& rows, BatchPlace place) {
  return {.spacecraft = rows.spacecraft(),
          .origin = {.source = rows.source(), .session = 0, .seq = rows.line()},
          .value = *rows.head(),
          .place = place};
}

}  // namespace

Expected<TelemetryStream> TelemetryStream::open(std::span<const TelemetryFile> files,
                                                const std::string& spacecraft,
                                                std::size_t buffer_bytes) {
  std::vector<Opening> openings = openings_of(files);
  share_out(openings, buffer_bytes);
  std::vector<File> open_files;
  std::uint64_t bytes_total = 0;
  for (const Opening& opening : openings) {
    Expected<void> added;
    const auto add = [&open_files](auto&& rows) {
      open_files.emplace_back(std::forward<decltype(rows)>(rows));
    };
    added = std::visit(
        [&]<class Value>(Kind<Value>) { return opened<Value>(opening, spacecraft).map(add); },
        opening.kind);
    if (!added) {
      return Unexpected{std::move(added.error())};
    }
    bytes_total += opening.bytes;
  }
  return TelemetryStream{std::move(open_files), bytes_total};
}

TelemetryStream::TelemetryStream(std::vector<File> files, std::uint64_t bytes_total)
    : files_{std::move(files)}, without_head_(files_.size()), bytes_total_{bytes_total} {
  // Reversed, since files are taken from the back and the first is to be read first.
  std::iota(without_head_.rbegin(), without_head_.rend(), 0U);
}

Expected<SampleBatch> TelemetryStream::next() {
  SampleBatch batch;
  bool after_stray = false;
  for (std::size_t taken = 0;; ++taken) {
    const auto found = find_heads(batch);
    if (!found) {
      return Unexpected{found.error()};
    }
    if (!*found || heads_.empty()) {
      break;
    }
    const std::size_t first = heads_.top().second;
    const bool is_stray =
        std::visit([](const auto& rows) { return rows.is_stray(); }, files_[first]);
    if (taken >= kBatch && !after_stray && !is_stray) {
      break;
    }
    after_stray = is_stray;
    std::visit(
        [&]<class Value>(SortedRows<Value>& rows) {
          batch.samples.of<Value>().push_back(head_of(rows, {static_cast<std::int64_t>(taken)}));
          rows.pop();
        },
        files_[first]);
    heads_.pop();
    without_head_.push_back(first);
  }
  return batch;
}

// Returns false when rejected rows fill the batch. The earliest head needs the head of every file.
Expected<bool> TelemetryStream::find_heads(SampleBatch& batch) {
  while (!without_head_.empty()) {
    const std::size_t file = without_head_.back();
    auto filled =
        std::visit([&](auto& rows) { return rows.fill(batch.rejected, kBatch); }, files_[file]);
    if (!filled || !*filled) {
      return filled;
    }
    without_head_.pop_back();
    std::visit(
        [&](const auto& rows) {
          if (rows.head() != nullptr) {
            heads_.emplace(rows.order(), file);
          }
        },
        files_[file]);
  }
  return true;
}

std::uint64_t TelemetryStream::bytes_given() const {
  return std::accumulate(
      files_.begin(), files_.end(), std::uint64_t{0}, [](std::uint64_t sum, const File& file) {
        return sum + std::visit([](const auto& rows) { return rows.bytes_given(); }, file);
      });
}

}  // namespace spindrift

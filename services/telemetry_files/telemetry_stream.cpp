#include "services/telemetry_files/telemetry_stream.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <system_error>

namespace spindrift {
namespace {

// No row of telemetry is shorter: a time of the years that are allowed, a comma and a line feed.
constexpr std::uint64_t kShortestRow = 19;
constexpr std::size_t kFewestRowsHeld = 64;

struct Opening {
  TelemetryFile file;
  std::uint64_t bytes;
  std::size_t rows_held;
};

bool is_read(std::optional<TelemetryKind> kind) {
  return kind == TelemetryKind::Pulses || kind == TelemetryKind::Coded;
}

std::size_t row_bytes(std::optional<TelemetryKind> kind) {
  return kind == TelemetryKind::Pulses ? sizeof(TelemetryRow<Pulse>)
                                       : sizeof(TelemetryRow<CodedFrame>);
}

std::vector<Opening> openings_of(std::span<const TelemetryFile> files) {
  std::vector<Opening> openings;
  for (const TelemetryFile& file : files) {
    if (is_read(file.kind)) {
      std::error_code gone;  // Opening it then says so.
      const auto bytes = std::filesystem::file_size(file.path, gone);
      openings.push_back({.file = file, .bytes = gone ? 0 : bytes, .rows_held = 0});
    }
  }
  return openings;
}

/// Small files are held whole; the large ones share what is left.
void share_out(std::vector<Opening>& openings, std::size_t buffer_bytes) {
  std::vector<Opening*> by_size(openings.size());
  std::transform(openings.begin(), openings.end(), by_size.begin(),
                 [](Opening& opening) { return &opening; });
  std::stable_sort(by_size.begin(), by_size.end(),
                   [](const Opening* a, const Opening* b) { return a->bytes < b->bytes; });
  std::size_t files_left = by_size.size();
  for (Opening* opening : by_size) {
    const std::size_t row = row_bytes(opening->file.kind);
    const std::size_t share = buffer_bytes / files_left / row;
    const std::size_t whole = opening->bytes / kShortestRow + 1;
    opening->rows_held = std::max(std::min(share, whole), kFewestRowsHeld);
    buffer_bytes -= std::min(buffer_bytes, opening->rows_held * row);
    --files_left;
  }
}

template <class Value>
Expected<SortedRows<Value>> opened(const Opening& opening, const std::string& spacecraft) {
  return TelemetryRows<Value>::open(opening.file.path, spacecraft)
      .map([&opening](TelemetryRows<Value>&& rows) {
        return SortedRows<Value>{std::move(rows), opening.rows_held};
      });
}

template <class Value>
Origin origin_of(const SortedRows<Value>& rows) {
  return {.source = rows.file_name(), .session = 0, .seq = rows.line()};
}

void add_head(const SortedRows<Pulse>& rows, SampleBatch& batch) {
  batch.pulses.push_back(
      {.spacecraft = rows.spacecraft(), .origin = origin_of(rows), .pulse = *rows.head()});
}

void add_head(const SortedRows<CodedFrame>& rows, SampleBatch& batch) {
  batch.coded.push_back(
      {.spacecraft = rows.spacecraft(), .origin = origin_of(rows), .frame = *rows.head()});
}

bool holds_other_kind(const SortedRows<Pulse>& /*rows*/, const SampleBatch& batch) {
  return !batch.coded.empty();
}

bool holds_other_kind(const SortedRows<CodedFrame>& /*rows*/, const SampleBatch& batch) {
  return !batch.pulses.empty();
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
    if (opening.file.kind == TelemetryKind::Pulses) {
      added = opened<Pulse>(opening, spacecraft).map(add);
    } else {
      added = opened<CodedFrame>(opening, spacecraft).map(add);
    }
    if (!added) {
      return Unexpected{std::move(added.error())};
    }
    bytes_total += opening.bytes;
  }
  return TelemetryStream{std::move(open_files), bytes_total};
}

TelemetryStream::TelemetryStream(std::vector<File> files, std::uint64_t bytes_total)
    : files_{std::move(files)}, without_head_(files_.size()), bytes_total_{bytes_total} {
  // Taken from the back: the first file is read first.
  std::iota(without_head_.rbegin(), without_head_.rend(), 0U);
}

Expected<SampleBatch> TelemetryStream::next() {
  SampleBatch batch;
  for (std::size_t taken = 0; taken < kBatch; ++taken) {
    const auto found = find_heads(batch);
    if (!found) {
      return Unexpected{found.error()};
    }
    if (!*found || heads_.empty()) {
      break;
    }
    const std::size_t first = heads_.top().second;
    const bool added = std::visit(
        [&batch](auto& rows) {
          if (holds_other_kind(rows, batch)) {
            return false;
          }
          add_head(rows, batch);
          rows.pop();
          return true;
        },
        files_[first]);
    if (!added) {
      break;
    }
    heads_.pop();
    without_head_.push_back(first);
  }
  return batch;
}

// False: rejected rows fill the batch. Only when every file shows its head is one the earliest.
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
          if (const auto* const head = rows.head()) {
            heads_.emplace(order_of(*head), file);
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

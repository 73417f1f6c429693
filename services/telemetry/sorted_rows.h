/// @file
/// Gives the rows of one telemetry file in order of time, in bounded memory.

#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "services/telemetry/by_kind.h"
#include "services/telemetry/stray_rows.h"
#include "services/telemetry/telemetry_rows.h"

namespace spindrift {

/// Orders by time; rows of equal time keep the order of their lines.
template <class Value>
bool comes_before(const TelemetryRow<Value>& a, const TelemetryRow<Value>& b) {
  const auto order = order_of(a.value) <=> order_of(b.value);
  return order != 0 ? order < 0 : a.line < b.line;
}

/// Sorts a file of up to `capacity` rows completely. In a longer file a row is sorted into its
/// place if that is fewer than half as many rows away; other rows come as soon as they are read.
/// Stray rows (find_stray_rows) keep their place in the file: sorted, they would gather behind the
/// others, as if the pass went on there. Each is given after another row in order, so that no
/// number of strays looks like a continuing pass either.
template <class Value>
class SortedRows {
 public:
  SortedRows(TelemetryRows<Value> rows, std::string source, std::size_t capacity);

  /// Reads until the head is known. Returns false when there is more to read, but `rejected` has
  /// `most_rejected` rows and must be emptied first.
  /// @return The errors of TelemetryRows::next.
  Expected<bool> fill(std::vector<RejectedInput>& rejected, std::size_t most_rejected);

  /// Null at the end of the file. Call it after `fill` has returned true.
  const Value* head() const { return next_ < ready_ || is_stray() ? &head_row().value : nullptr; }
  /// Place of the head among the rows of all files; a stray row takes that of the row before it.
  TelemetryOrder order() const { return is_stray() ? given_ : order_of(head_row().value); }
  /// Whether the head is a stray row.
  bool is_stray() const {
    return !strays_.empty() &&
           (next_ < ready_ ? gave_one_in_order_ && strays_.front().after <= given_.t : ended_);
  }
  std::uint64_t line() const { return head_row().line; }
  const std::string& spacecraft() const { return file_.spacecraft_of(head_row()); }
  void pop();

  const std::string& source() const { return source_; }
  /// Bytes of the file read so far, without those of the rows still held.
  std::uint64_t bytes_given() const;

 private:
  struct Stray {
    TelemetryRow<Value> row;
    TaiTime after;
  };

  const TelemetryRow<Value>& head_row() const {
    return is_stray() ? strays_.front().row : rows_[next_];
  }
  void drop_popped();
  Expected<void> read(std::vector<RejectedInput>& rejected, std::size_t most_rejected);
  void set_strays_aside();
  void sort();

  TelemetryRows<Value> file_;
  std::string source_;
  std::size_t capacity_;
  std::vector<TelemetryRow<Value>> rows_;
  std::size_t next_ = 0;    ///< Index of the head.
  std::size_t ready_ = 0;   ///< No unread row belongs before here.
  std::size_t sorted_ = 0;  ///< Rows before here are in order.
  std::uint64_t read_ = 0;  ///< Good rows read so far.
  bool ended_ = false;
  std::deque<Stray> strays_;        ///< Strays in the order of the file.
  TelemetryOrder given_{};          ///< Order of the last row in order.
  bool gave_one_in_order_ = false;  ///< Since the last stray.
};

template <class Value>
SortedRows<Value>::SortedRows(TelemetryRows<Value> rows, std::string source, std::size_t capacity)
    : file_{std::move(rows)}, source_{std::move(source)}, capacity_{capacity} {
  rows_.reserve(capacity_);
}

template <class Value>
Expected<bool> SortedRows<Value>::fill(std::vector<RejectedInput>& rejected,
                                       std::size_t most_rejected) {
  if (head() != nullptr) {
    return true;
  }
  drop_popped();
  if (const auto done = read(rejected, most_rejected); !done) {
    return Unexpected{done.error()};
  }
  if (!ended_ && rows_.size() < capacity_) {
    return false;
  }
  sort();
  ready_ = ended_ ? rows_.size() : rows_.size() - rows_.size() / 2;
  return true;
}

template <class Value>
void SortedRows<Value>::drop_popped() {
  if (next_ > 0) {
    rows_.erase(rows_.begin(), rows_.begin() + static_cast<std::ptrdiff_t>(next_));
    next_ = ready_ = 0;
    sorted_ = rows_.size();
  }
}

template <class Value>
Expected<void> SortedRows<Value>::read(std::vector<RejectedInput>& rejected,
                                       std::size_t most_rejected) {
  while (!ended_ && rows_.size() < capacity_ && rejected.size() < most_rejected) {
    auto row = file_.next();
    if (!row) {
      return Unexpected{std::move(row.error())};
    }
    if (!*row) {
      ended_ = true;
    } else if (const auto* const good = std::get_if<TelemetryRow<Value>>(&**row)) {
      rows_.push_back(*good);
      ++read_;
    } else {
      rejected.push_back(std::get<RejectedInput>(std::move(**row)));
    }
  }
  return {};
}

template <class Value>
void SortedRows<Value>::pop() {
  if (is_stray()) {
    strays_.pop_front();
    gave_one_in_order_ = false;
  } else {
    given_ = order_of(rows_[next_++].value);
    gave_one_in_order_ = true;
  }
}

/// Moves stray rows among the added ones to `strays_`. In a file of several spacecraft it finds
/// none, since each may have a time of its own.
template <class Value>
void SortedRows<Value>::set_strays_aside() {
  const std::span<const TelemetryRow<Value>> added = std::span{rows_}.subspan(sorted_);
  if (std::any_of(added.begin(), added.end(), [&](const TelemetryRow<Value>& row) {
        return row.spacecraft != added.front().spacecraft;
      })) {
    return;
  }
  std::vector<TaiTime> times(added.size());
  std::transform(added.begin(), added.end(), times.begin(),
                 [](const TelemetryRow<Value>& row) { return row.value.t; });
  const std::vector<StrayRow> strays = find_stray_rows(times);
  for (const auto& [row, after] : strays) {
    strays_.push_back({.row = added[row], .after = times[after]});
  }
  auto stray = strays.begin();
  std::size_t kept = sorted_;
  for (std::size_t row = sorted_; row < rows_.size(); ++row) {
    if (stray != strays.end() && sorted_ + stray->row == row) {
      ++stray;
    } else {
      rows_[kept++] = rows_[row];
    }
  }
  rows_.resize(kept);
}

// The check first is cheap, and telemetry is mostly in order already.
template <class Value>
void SortedRows<Value>::sort() {
  const auto before = &comes_before<Value>;
  if (!std::is_sorted(rows_.begin() + static_cast<std::ptrdiff_t>(sorted_), rows_.end(), before)) {
    set_strays_aside();
  }
  const auto added = rows_.begin() + static_cast<std::ptrdiff_t>(sorted_);
  if (!std::is_sorted(added, rows_.end(), before)) {
    std::sort(added, rows_.end(), before);
  }
  if (!std::is_sorted(rows_.begin(), rows_.end(), before)) {
    std::inplace_merge(rows_.begin(), added, rows_.end(), before);
  }
}

template <class Value>
std::uint64_t SortedRows<Value>::bytes_given() const {
  const auto held = static_cast<double>(rows_.size() - next_ + strays_.size());
  const double given = read_ == 0 ? 1.0 : 1.0 - held / static_cast<double>(read_);
  return static_cast<std::uint64_t>(given * static_cast<double>(file_.bytes_read()));
}

}  // namespace spindrift

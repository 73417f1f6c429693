/// @file
/// The rows of one telemetry file in the order of their time, in bounded memory.

#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "services/telemetry/by_kind.h"
#include "services/telemetry_files/telemetry_rows.h"

namespace spindrift {

/// In order of time, and of the lines of the file where that is the same.
template <class Value>
bool comes_before(const TelemetryRow<Value>& a, const TelemetryRow<Value>& b) {
  const auto order = order_of(a.value) <=> order_of(b.value);
  return order != 0 ? order < 0 : a.line < b.line;
}

/// Sorts a file of up to `capacity` rows completely. In a longer one every row finds its place that
/// stands fewer than half as many rows from it; others come as soon as they are read.
template <class Value>
class SortedRows {
 public:
  SortedRows(TelemetryRows<Value> rows, std::size_t capacity);

  /// Reads until the head is known. False: there is more to read, but as many as `most_rejected`
  /// rejected rows stand in `rejected` and want to be taken away first.
  /// @return as TelemetryRows::next.
  Expected<bool> fill(std::vector<RejectedInput>& rejected, std::size_t most_rejected);

  /// Null at the end of the file. To be asked for when filled.
  const Value* head() const { return next_ < ready_ ? &rows_[next_].value : nullptr; }
  std::uint64_t line() const { return rows_[next_].line; }
  const std::string& spacecraft() const { return file_.spacecraft_of(rows_[next_]); }
  void pop() { ++next_; }

  const std::string& file_name() const { return file_name_; }
  /// Of the file, up to the rows that are still held.
  std::uint64_t bytes_given() const;

 private:
  void drop_popped();
  Expected<void> read(std::vector<RejectedInput>& rejected, std::size_t most_rejected);
  void sort();

  TelemetryRows<Value> file_;
  std::string file_name_;
  std::size_t capacity_;
  std::vector<TelemetryRow<Value>> rows_;
  std::size_t next_ = 0;    ///< The head.
  std::size_t ready_ = 0;   ///< Up to here nothing that is still to be read belongs.
  std::size_t sorted_ = 0;  ///< Up to here they are in order.
  std::uint64_t read_ = 0;  ///< Good rows of the file so far.
  bool ended_ = false;
};

template <class Value>
SortedRows<Value>::SortedRows(TelemetryRows<Value> rows, std::size_t capacity)
    : file_{std::move(rows)},
      file_name_{shown(file_.path().filename().string())},
      capacity_{capacity} {
  rows_.reserve(capacity_);
}

template <class Value>
Expected<bool> SortedRows<Value>::fill(std::vector<RejectedInput>& rejected,
                                       std::size_t most_rejected) {
  if (next_ < ready_) {
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
  ready_ = ended_ ? rows_.size() : rows_.size() - capacity_ / 2;
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

// Telemetry mostly stands in order already, and to see that costs little.
template <class Value>
void SortedRows<Value>::sort() {
  const auto before = &comes_before<Value>;
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
  const auto held = static_cast<double>(rows_.size() - next_);
  const double given = read_ == 0 ? 1.0 : 1.0 - held / static_cast<double>(read_);
  return static_cast<std::uint64_t>(given * static_cast<double>(file_.bytes_read()));
}

}  // namespace spindrift

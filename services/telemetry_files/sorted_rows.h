/// @file
/// The rows of one telemetry file in the order of their time, in bounded memory.

#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "services/telemetry_files/telemetry_rows.h"

namespace spindrift {

/// Where a sample stands among all telemetry: pulses as everywhere, behind them the coded frame of
/// the same time.
struct TelemetryOrder {
  TaiTime t;
  std::size_t place;
  friend constexpr auto operator<=>(const TelemetryOrder&, const TelemetryOrder&) = default;
};
constexpr TelemetryOrder order_of(const Pulse& pulse) {
  return {.t = pulse.t, .place = index_of(pulse.channel)};
}
constexpr TelemetryOrder order_of(const CodedFrame& frame) {
  return {.t = frame.t, .place = kPulseChannels};
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

extern template class SortedRows<Pulse>;
extern template class SortedRows<CodedFrame>;

}  // namespace spindrift

#include "services/telemetry_files/sorted_rows.h"

#include <algorithm>
#include <utility>

namespace spindrift {
namespace {

template <class Value>
bool comes_before(const TelemetryRow<Value>& a, const TelemetryRow<Value>& b) {
  const auto order = order_of(a.value) <=> order_of(b.value);
  return order != 0 ? order < 0 : a.line < b.line;
}

}  // namespace

template <class Value>
SortedRows<Value>::SortedRows(TelemetryRows<Value> rows, std::size_t capacity)
    : file_{std::move(rows)}, file_name_{file_.path().filename().string()}, capacity_{capacity} {
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

template class SortedRows<Pulse>;
template class SortedRows<CodedFrame>;

}  // namespace spindrift

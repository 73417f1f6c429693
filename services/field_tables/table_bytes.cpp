#include "services/field_tables/table_bytes.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>

#include "pipelines/frames/angle.h"

namespace spindrift {
namespace {

constexpr std::size_t kHead = 8;
constexpr std::size_t kNumber = 4;
// Coefficients of the field along an orbit have fallen below a tenth of the largest here.
constexpr std::size_t kFallenOff = 16;
constexpr float kTenth = 0.1F;

Unexpected not_a_table(std::string message) {
  return Unexpected{{ErrorCode::InvalidInput, std::move(message)}};
}

void append(std::string& bytes, std::uint32_t number) {
  for (unsigned shift = 0; shift < 32; shift += 8) {
    bytes.push_back(static_cast<char>((number >> shift) & 0xFFU));
  }
}

void append(std::string& bytes, float number) {
  append(bytes, std::bit_cast<std::uint32_t>(number));
}

/// Reads numbers one behind the other.
class Reader {
 public:
  explicit Reader(std::string_view bytes) : left_{bytes} {}

  std::uint32_t count() {
    std::uint32_t number = 0;
    for (unsigned i = 0; i < kNumber; ++i) {
      number |= std::uint32_t{static_cast<unsigned char>(left_[i])} << (8U * i);
    }
    left_.remove_prefix(kNumber);
    return number;
  }
  float number() { return std::bit_cast<float>(count()); }

 private:
  std::string_view left_;
};

bool is_finite(const FieldTable& table) {
  return std::isfinite(table.first_anomaly_rad) &&
         std::all_of(table.rows.begin(), table.rows.end(),
                     [](const Eigen::Vector3f& row) { return row.allFinite(); });
}

bool rises_over_a_turn(const std::vector<float>& knots_rad) {
  return knots_rad.front() == 0.0F && knots_rad.back() == static_cast<float>(kTurn_rad) &&
         std::adjacent_find(knots_rad.begin(), knots_rad.end(), std::greater_equal<>{}) ==
             knots_rad.end();
}

/// Returns empty if the rows may be of the kind: at both ends of a revolution the field is about as
/// strong, and coefficients fall off.
std::string why_of_another_kind(const FieldTable& table) {
  const float first = table.rows.front().norm();
  const float last = table.rows.back().norm();
  if (table.kind != TableKind::Chebyshev) {
    return std::min(first, last) < kTenth * std::max(first, last)
               ? fmt::format(
                     "its first row is {:.4g} nT, its last {:.4g} nT: these look like "
                     "coefficients, of --kind chebyshev",
                     first, last)
               : std::string{};
  }
  const float most =
      std::max_element(table.rows.begin(), table.rows.end(), [](const auto& a, const auto& b) {
        return a.norm() < b.norm();
      })->norm();
  return table.rows.size() >= kFallenOff && last > kTenth * most
             ? fmt::format(
                   "its last row of {:.4g} nT is no coefficient beside {:.4g} nT: these "
                   "look like fields, of --kind uniform",
                   last, most)
             : std::string{};
}

/// @return Empty, or why the values are those of no table of the kind.
std::string why_no_table(const FieldTable& table) {
  if (!is_finite(table)) {
    return "it has values that are no numbers";
  }
  if (!(table.first_anomaly_rad >= 0.0F &&
        table.first_anomaly_rad <= static_cast<float>(kTurn_rad))) {
    return fmt::format("its first anomaly is {:.4g} rad, which must lie in [0, 2 pi]",
                       table.first_anomaly_rad);
  }
  if (table.kind == TableKind::Curvature && !rises_over_a_turn(table.knots_rad)) {
    return "its knots do not rise from 0 to 2 pi";
  }
  return why_of_another_kind(table);
}

}  // namespace

std::string bytes_of(const FieldTable& table) {
  std::string bytes;
  append(bytes, table.first_anomaly_rad);
  append(bytes, static_cast<std::uint32_t>(table.rows.size()));
  for (const Eigen::Vector3f& row : table.rows) {
    for (const float value_nt : row) {
      append(bytes, value_nt);
    }
  }
  for (const float knot_rad : table.knots_rad) {
    append(bytes, knot_rad);
  }
  return bytes;
}

Expected<FieldTable> table_of(std::string_view bytes, TableKind kind) {
  const bool has_knots = kind == TableKind::Curvature;
  if (bytes.size() < kHead) {
    return not_a_table(fmt::format("{} bytes: a table has at least {}", bytes.size(), kHead));
  }
  Reader reader{bytes};
  FieldTable table{.kind = kind, .first_anomaly_rad = reader.number()};
  const std::size_t count = reader.count();
  const std::size_t expected = kHead + count * kNumber * (has_knots ? 4 : 3);
  if (count < kFewestTablePoints || count > kMostTablePoints || expected != bytes.size()) {
    return not_a_table(
        fmt::format("{} bytes that name {} rows: a table of --kind {} with N rows, {} to {}, has "
                    "{} bytes; it is of another kind or length",
                    bytes.size(), count, name_of(kind), kFewestTablePoints, kMostTablePoints,
                    has_knots ? "8 + 16 N" : "8 + 12 N"));
  }
  for (std::size_t i = 0; i < count; ++i) {
    Eigen::Vector3f row;
    for (float& value_nt : row) {
      value_nt = reader.number();
    }
    table.rows.push_back(row);
  }
  for (std::size_t i = 0; has_knots && i < count; ++i) {
    table.knots_rad.push_back(reader.number());
  }
  if (const std::string why = why_no_table(table); !why.empty()) {
    return not_a_table(fmt::format("no table of --kind {}: {}", name_of(kind), why));
  }
  return table;
}

}  // namespace spindrift

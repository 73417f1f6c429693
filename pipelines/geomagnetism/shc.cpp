#include "pipelines/geomagnetism/shc.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <optional>
#include <set>
#include <system_error>
#include <utility>
#include <vector>

namespace spindrift {
namespace {

struct Row {
  int line = 0;
  std::vector<double> numbers;
};

Unexpected refused(int line, std::string_view what) {
  return Unexpected{{ErrorCode::InvalidConfiguration,
                     fmt::format("field coefficients, line {}: {}", line, what)}};
}

std::optional<std::vector<double>> numbers_of(std::string_view line) {
  constexpr std::string_view kBlank = " \t\r";
  std::vector<double> numbers;
  while (true) {
    line.remove_prefix(std::min(line.find_first_not_of(kBlank), line.size()));
    if (line.empty()) {
      return numbers;
    }
    const std::string_view word = line.substr(0, line.find_first_of(kBlank));
    double number = 0.0;
    const auto [rest, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error != std::errc{} || rest != word.data() + word.size() || !std::isfinite(number)) {
      return std::nullopt;
    }
    numbers.push_back(number);
    line.remove_prefix(word.size());
  }
}

/// Returns the rows of numbers, without comments and blank lines.
Expected<std::vector<Row>> rows_of(std::string_view text) {
  std::vector<Row> rows;
  for (int line = 1; !text.empty(); ++line) {
    const std::string_view here = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(here.size() + 1, text.size()));
    auto numbers = numbers_of(here.substr(0, here.find('#')));
    if (!numbers) {
      return refused(line, "must hold numbers");
    }
    if (!numbers->empty()) {
      rows.push_back({.line = line, .numbers = std::move(*numbers)});
    }
  }
  return rows;
}

Expected<void> check_head(const Row& head, const Row& epochs) {
  const std::vector<double>& numbers = head.numbers;
  // Lowest and highest degree, epochs, order and steps; the years that they span may follow.
  if (numbers.size() < 5) {
    return refused(head.line, "must begin with degrees, number of epochs, order and steps");
  }
  if (numbers[0] != 1.0 || numbers[1] != kHighestDegree) {
    return refused(head.line, fmt::format("degrees {} to {}: must be 1 to {}", numbers[0],
                                          numbers[1], kHighestDegree));
  }
  if (numbers[3] != 2.0 || numbers[4] != 1.0) {
    return refused(head.line, fmt::format("spline of order {}, {} steps: must be 2 and 1",
                                          numbers[3], numbers[4]));
  }
  if (numbers[2] != static_cast<double>(epochs.numbers.size())) {
    return refused(epochs.line,
                   fmt::format("{} epochs: the head says {}", epochs.numbers.size(), numbers[2]));
  }
  return {};
}

/// Adds a row's coefficient to the epochs.
Expected<void> take_in(const Row& row, std::set<std::pair<int, int>>& seen,
                       std::vector<FieldEpoch>& epochs) {
  if (row.numbers.size() != epochs.size() + 2) {
    return refused(row.line, fmt::format("{} numbers: must be degree, order and {} values",
                                         row.numbers.size(), epochs.size()));
  }
  if (!(row.numbers[0] >= 1.0 && row.numbers[0] <= kHighestDegree &&
        std::abs(row.numbers[1]) <= row.numbers[0])) {
    return refused(row.line,
                   fmt::format("degree {}, order {}: must be 1 to {}, and an order within",
                               row.numbers[0], row.numbers[1], kHighestDegree));
  }
  const int degree = static_cast<int>(row.numbers[0]);
  const int order = static_cast<int>(row.numbers[1]);
  if (!seen.insert({degree, order}).second) {
    return refused(row.line, fmt::format("degree {}, order {}: is there twice", degree, order));
  }
  const std::size_t i = GaussCoefficients::index(degree, std::abs(order));
  for (std::size_t epoch = 0; epoch < epochs.size(); ++epoch) {
    GaussCoefficients& coefficients = epochs[epoch].coefficients;
    (order < 0 ? coefficients.h_nt : coefficients.g_nt).at(i) = row.numbers[epoch + 2];
  }
  return {};
}

}  // namespace

Expected<MainFieldModel> parse_shc(std::string_view text) {
  const auto rows = rows_of(text);
  if (!rows) {
    return Unexpected{rows.error()};
  }
  constexpr std::size_t kDegree{kHighestDegree};
  constexpr std::size_t kCoefficients = kDegree * (kDegree + 2);
  if (rows->size() != kCoefficients + 2) {
    return refused(rows->empty() ? 1 : rows->back().line,
                   fmt::format("{} rows: must be a head, the epochs and {} coefficients",
                               rows->size(), kCoefficients));
  }
  if (auto sound = check_head(rows->front(), (*rows)[1]); !sound) {
    return Unexpected{sound.error()};
  }
  std::vector<FieldEpoch> epochs;
  for (const double year : (*rows)[1].numbers) {
    epochs.push_back({.year = year, .coefficients = {}});
  }
  std::set<std::pair<int, int>> seen;
  for (auto row = rows->begin() + 2; row != rows->end(); ++row) {
    if (auto taken = take_in(*row, seen, epochs); !taken) {
      return Unexpected{taken.error()};
    }
  }
  return MainFieldModel::make(std::move(epochs));
}

}  // namespace spindrift

/// @file
/// A notice about a run that its numbers do not show, as a kind of product.

#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>

#include "pipelines/time/tai_time.h"
#include "services/products/product_kind.h"

namespace spindrift {

/// A warning with the members of `--json` output.
struct RunNotice {
  std::optional<TaiTime> t = {};  ///< When it became true; empty: for the whole run.
  std::string code = {};          ///< Name such as "late_edges".
  std::string arguments = {};     ///< A JSON object.
  std::string says = {};          ///< A sentence for people.
};

struct NoticeTable {
  static constexpr std::string_view kName = "notice";
  static constexpr std::array<std::string_view, 2> kKey{"code", "arguments"};
  static constexpr auto kColumns = columns(
      ProductColumn{"t_tai_ns",
                    [](const RunNotice& notice) {
                      return notice.t ? std::optional{tai_ns(*notice.t)} : std::nullopt;
                    }},
      ProductColumn{"code", &RunNotice::code}, ProductColumn{"arguments", &RunNotice::arguments},
      ProductColumn{"says", &RunNotice::says});
};

template <>
struct ProductKind<RunNotice> {
  static constexpr ProductWeight kWeight = ProductWeight::Result;
  using Tables = std::tuple<NoticeTable>;
};

}  // namespace spindrift

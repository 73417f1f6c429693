#include "services/base/filled.h"

#include <fmt/args.h>
#include <fmt/format.h>

#include <variant>
#include <vector>

#include "pipelines/time/utc.h"

namespace spindrift {
namespace {

using Arguments = fmt::dynamic_format_arg_store<fmt::format_context>;

/// Adds one value to the arguments of a pattern.
class Argument {
 public:
  Argument(Arguments& all, const std::string& name, int utc_decimals)
      : all_{all}, name_{name}, utc_decimals_{utc_decimals} {}

  void operator()(std::int64_t number) const {
    if (name_.ends_with("_tai_ns")) {
      push(format_utc(tai_from_ns(number), utc_decimals_));
    } else {
      push(number);
    }
  }
  void operator()(double number) const { push(number); }
  void operator()(const std::string& word) const { push(word); }
  void operator()(const std::vector<std::string>& several) const {
    push(fmt::format("{}", fmt::join(several, ", ")));
  }

 private:
  template <class Shown>
  void push(const Shown& shown) const {
    all_.push_back(fmt::arg(name_.c_str(), shown));
  }

  Arguments& all_;
  const std::string& name_;
  int utc_decimals_;
};

}  // namespace

std::string filled(std::string_view pattern, std::span<const NamedValue> values, int utc_decimals) {
  Arguments arguments;
  for (const NamedValue& value : values) {
    std::visit(Argument{arguments, value.name, utc_decimals}, value.value);
  }
  try {
    return fmt::vformat(fmt::string_view{pattern.data(), pattern.size()}, arguments);
  } catch (const fmt::format_error&) {
    return std::string{pattern};
  }
}

}  // namespace spindrift

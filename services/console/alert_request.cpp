#include "services/console/alert_request.h"

#include <nlohmann/json.hpp>

#include "services/base/parsed_json.h"

namespace spindrift {
namespace {

constexpr std::string_view kAlerts = "/api/v1/alerts/";
constexpr int kWeek_min = 10'080;

Unexpected bad(const char* why) { return Unexpected{{ErrorCode::InvalidInput, why}}; }

}  // namespace

std::optional<AlertPath> alert_path(std::string_view path) {
  const auto verb = path.rfind('/');
  if (!path.starts_with(kAlerts) || verb <= kAlerts.size()) {
    return std::nullopt;
  }
  const std::string_view alert_id = path.substr(kAlerts.size(), verb - kAlerts.size());
  const bool shelves = path.substr(verb) == "/shelve";
  return shelves || path.substr(verb) == "/ack"
             ? std::optional{AlertPath{.alert_id = std::string{alert_id}, .shelves = shelves}}
             : std::nullopt;
}

Expected<OperatorWord> operator_word(const AlertPath& path, std::string_view body) {
  const auto json = parsed_json(body);
  if (!json.is_object()) {
    return bad(R"(the body must be a JSON object: {"by":"...","note":"...","minutes":N})");
  }
  const auto by = json.find("by");
  if (by == json.end() || !by->is_string()) {
    return bad("by: must be a text: who says so");
  }
  const auto note = json.find("note");
  if (note != json.end() && !note->is_string()) {
    return bad("note: must be a text");
  }
  OperatorWord word{.alert_id = path.alert_id,
                    .by = by->get<std::string>(),
                    .note = note == json.end() ? "" : note->get<std::string>()};
  if (path.shelves) {
    const auto minutes = json.find("minutes");
    if (minutes == json.end() || !minutes->is_number_integer() || *minutes < 1 ||
        *minutes > kWeek_min) {
      return bad("minutes: must be an integer from 1 to 10080");
    }
    word.minutes = minutes->get<int>();
  }
  return word;
}

}  // namespace spindrift

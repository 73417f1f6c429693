#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pipelines/core/shown.h"
#include "pipelines/ephemeris/oem.h"
#include "pipelines/ephemeris/oem_holes.h"
#include "pipelines/ephemeris/state_jump.h"
#include "pipelines/time/utc.h"

namespace spindrift {
namespace {

constexpr std::string_view kBlank = " \t\r";
constexpr std::string_view kMetaStart = "META_START";
constexpr std::string_view kMetaStop = "META_STOP";
constexpr std::string_view kCovarianceStart = "COVARIANCE_START";
constexpr std::string_view kCovarianceStop = "COVARIANCE_STOP";
constexpr std::size_t kStateNumbers = 6;
constexpr std::size_t kStateAndAccelerationNumbers = 9;
constexpr std::size_t kCovarianceRows = 6;
constexpr std::size_t kDefaultHermitePoints = 4;

/// One that says something: not blank, not a comment.
struct Line {
  int number;
  std::string text;
};

struct KeyRule {
  std::string_view key;
  bool required;
};
constexpr std::array kHeaderRules = {
    KeyRule{"CCSDS_OEM_VERS", true}, KeyRule{"CLASSIFICATION", false},
    KeyRule{"CREATION_DATE", true},  KeyRule{"ORIGINATOR", true},
    KeyRule{"MESSAGE_ID", false},
};
constexpr std::array kMetaRules = {
    KeyRule{"OBJECT_NAME", true},        KeyRule{"OBJECT_ID", true},
    KeyRule{"CENTER_NAME", true},        KeyRule{"REF_FRAME", true},
    KeyRule{"REF_FRAME_EPOCH", false},   KeyRule{"TIME_SYSTEM", true},
    KeyRule{"START_TIME", true},         KeyRule{"USEABLE_START_TIME", false},
    KeyRule{"USEABLE_STOP_TIME", false}, KeyRule{"STOP_TIME", true},
    KeyRule{"INTERPOLATION", false},     KeyRule{"INTERPOLATION_DEGREE", false},
};
constexpr std::array kCovarianceRules = {
    KeyRule{"EPOCH", true},
    KeyRule{"COV_REF_FRAME", false},
};

struct Entry {
  int line;
  std::string value;
};
/// By the key of its rule.
using Entries = std::map<std::string_view, Entry>;

using ReadTime = Expected<TaiTime> (*)(std::string_view);

struct Meta {
  std::string object_name;
  std::string object_id;
  ReadTime read_time = nullptr;
  TaiTime start;
  TaiTime stop;
  TaiTime usable_start;
  TaiTime usable_stop;
  std::optional<Interpolation> interpolation;
  int degree = 0;  ///< Of `interpolation`.
};

Unexpected refused(int line, std::string_view what) {
  return Unexpected{
      {ErrorCode::InvalidConfiguration, fmt::format("orbit ephemeris, line {}: {}", line, what)}};
}

Unexpected refused(std::string_view key, const Entry& entry, std::string_view what) {
  return refused(entry.line, fmt::format("{} = {}: {}", shown(key), shown(entry.value), what));
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) {
    return {};
  }
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

std::vector<std::string_view> words_of(std::string_view text) {
  std::vector<std::string_view> words;
  for (text = trimmed(text); !text.empty(); text = trimmed(text)) {
    const std::string_view word = text.substr(0, text.find_first_of(kBlank));
    words.push_back(word);
    text.remove_prefix(word.size());
  }
  return words;
}

std::string upper_case(std::string_view text) {
  std::string upper{text};
  std::transform(upper.begin(), upper.end(), upper.begin(), [](char c) {
    return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  });
  return upper;
}

bool is_meaningful(std::string_view line) {
  return !line.empty() && line != "COMMENT" && !line.starts_with("COMMENT ");
}

std::optional<double> number_from(std::string_view word) {
  if (word.starts_with('+')) {
    word.remove_prefix(1);
  }
  double number = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  const bool whole = error == std::errc{} && end == word.data() + word.size();
  return whole && std::isfinite(number) ? std::optional{number} : std::nullopt;
}

/// `words` as finite numbers.
Expected<std::vector<double>> numbers_of(std::span<const std::string_view> words, int line) {
  std::vector<double> numbers;
  for (const std::string_view word : words) {
    const std::optional<double> number = number_from(word);
    if (!number) {
      return refused(line, fmt::format("'{}' is not a number", shown(word)));
    }
    numbers.push_back(*number);
  }
  return numbers;
}

/// The value of `key` in capitals, if it is one of `allowed`.
Expected<std::string> choice_of(const Entries& entries, std::string_view key,
                                std::span<const std::string_view> allowed) {
  const Entry& entry = entries.at(key);
  std::string value = upper_case(entry.value);
  if (std::find(allowed.begin(), allowed.end(), value) == allowed.end()) {
    return refused(key, entry, fmt::format("must be {}", fmt::join(allowed, " or ")));
  }
  return value;
}

Expected<TaiTime> time_of(const Entries& entries, std::string_view key, ReadTime read_time) {
  const Entry& entry = entries.at(key);
  return read_time(entry.value).map_error([&](const Error& error) {
    return refused(key, entry, error.message).value();
  });
}

/// The time of `key`, or `otherwise` where it does not stand; it must not lie outside the span.
Expected<TaiTime> time_within(const Entries& entries, std::string_view key, const Meta& meta,
                              TaiTime otherwise) {
  if (!entries.contains(key)) {
    return otherwise;
  }
  Expected<TaiTime> time = time_of(entries, key, meta.read_time);
  if (time && (*time < meta.start || *time > meta.stop)) {
    return refused(key, entries.at(key), "must lie between START_TIME and STOP_TIME");
  }
  return time;
}

Expected<void> check_frame(const Entries& entries) {
  constexpr std::array<std::string_view, 1> kCenters = {"EARTH"};
  constexpr std::array<std::string_view, 4> kFrames = {"EME2000", "J2000", "GCRF", "ICRF"};
  if (const auto center = choice_of(entries, "CENTER_NAME", kCenters); !center) {
    return Unexpected{center.error()};
  }
  if (const auto frame = choice_of(entries, "REF_FRAME", kFrames); !frame) {
    return Unexpected{frame.error()};
  }
  return {};
}

Expected<ReadTime> read_time_of(const Entries& entries) {
  constexpr std::array<std::string_view, 2> kTimeSystems = {"UTC", "TAI"};
  return choice_of(entries, "TIME_SYSTEM", kTimeSystems).map([](const std::string& system) {
    return system == "UTC" ? ReadTime{parse_utc} : ReadTime{parse_tai};
  });
}

Expected<void> set_times(const Entries& entries, Meta& meta) {
  if (entries.contains("REF_FRAME_EPOCH")) {
    if (const auto epoch = time_of(entries, "REF_FRAME_EPOCH", meta.read_time); !epoch) {
      return Unexpected{epoch.error()};
    }
  }
  const Expected<TaiTime> start = time_of(entries, "START_TIME", meta.read_time);
  if (!start) {
    return Unexpected{start.error()};
  }
  const Expected<TaiTime> stop = time_of(entries, "STOP_TIME", meta.read_time);
  if (!stop) {
    return Unexpected{stop.error()};
  }
  meta.start = *start;
  meta.stop = *stop;
  const auto usable_start = time_within(entries, "USEABLE_START_TIME", meta, meta.start);
  if (!usable_start) {
    return Unexpected{usable_start.error()};
  }
  const auto usable_stop = time_within(entries, "USEABLE_STOP_TIME", meta, meta.stop);
  if (!usable_stop) {
    return Unexpected{usable_stop.error()};
  }
  meta.usable_start = *usable_start;
  meta.usable_stop = *usable_stop;
  return {};
}

Expected<void> set_interpolation(const Entries& entries, Meta& meta) {
  constexpr std::array<std::string_view, 2> kInterpolations = {"LAGRANGE", "HERMITE"};
  const auto degree = entries.find("INTERPOLATION_DEGREE");
  if (!entries.contains("INTERPOLATION")) {
    if (degree != entries.end()) {
      return refused(degree->first, degree->second, "needs INTERPOLATION beside it");
    }
    return {};
  }
  const auto interpolation = choice_of(entries, "INTERPOLATION", kInterpolations);
  if (!interpolation) {
    return Unexpected{interpolation.error()};
  }
  if (degree == entries.end()) {
    return refused("INTERPOLATION", entries.at("INTERPOLATION"),
                   "needs INTERPOLATION_DEGREE beside it");
  }
  const std::optional<double> number = number_from(degree->second.value);
  if (!number || *number != std::floor(*number) || *number < 1 ||
      *number > kMaxInterpolationDegree) {
    return refused(degree->first, degree->second,
                   fmt::format("must be a whole number from 1 to {}", kMaxInterpolationDegree));
  }
  meta.interpolation =
      *interpolation == "LAGRANGE" ? Interpolation::Lagrange : Interpolation::Hermite;
  meta.degree = static_cast<int>(*number);
  return {};
}

Expected<Meta> meta_from(const Entries& entries) {
  Meta meta;
  meta.object_name = entries.at("OBJECT_NAME").value;
  meta.object_id = entries.at("OBJECT_ID").value;
  return check_frame(entries)
      .and_then([&] { return read_time_of(entries); })
      .and_then([&](ReadTime read_time) {
        meta.read_time = read_time;
        return set_times(entries, meta);
      })
      .and_then([&] { return set_interpolation(entries, meta); })
      .map([&] { return meta; });
}

/// What the metadata and the data lines agree on.
OemSegment segment_from(const Meta& meta, std::vector<EphemerisPoint> points) {
  const int most_hermite = 2 * static_cast<int>(std::min(points.size(), kDefaultHermitePoints)) - 1;
  return {.usable_from = std::max(meta.usable_start, points.front().t),
          .usable_to = std::min(meta.usable_stop, points.back().t),
          .interpolation = meta.interpolation.value_or(Interpolation::Hermite),
          .degree = meta.interpolation ? meta.degree : most_hermite,
          .points = std::move(points),
          .object_name = meta.object_name,
          .object_id = meta.object_id};
}

/// Takes lines from the front of what is left over.
class OemReader {
 public:
  explicit OemReader(const OemLines& next_line) : next_line_{next_line} { advance(); }

  /// No line is left, or none can be had.
  bool done() const { return !front_; }

  /// Why no more lines were to be had.
  const std::optional<Error>& failure() const { return failure_; }

  /// The first data line read that is not later than the one before it: told of what is otherwise
  /// well formed.
  const std::optional<Error>& disorder() const { return disorder_; }

  Expected<void> read_header() {
    if (done() || !front_->text.starts_with("CCSDS_OEM_VERS")) {
      return refused(line_number(), "an OEM in KVN form must begin with CCSDS_OEM_VERS");
    }
    const Expected<Entries> entries = read_entries(kHeaderRules);
    if (!entries) {
      return Unexpected{entries.error()};
    }
    constexpr std::array<std::string_view, 3> kVersions = {"1.0", "2.0", "3.0"};
    if (const auto version = choice_of(*entries, "CCSDS_OEM_VERS", kVersions); !version) {
      return Unexpected{version.error()};
    }
    return time_of(*entries, "CREATION_DATE", parse_utc).map([](TaiTime) {});
  }

  Expected<OemSegment> read_segment() {
    const Expected<Meta> meta = read_meta();
    if (!meta) {
      return Unexpected{meta.error()};
    }
    std::vector<EphemerisPoint> points;
    while (!done() && !at(kMetaStart) && !at(kCovarianceStart)) {
      const Expected<EphemerisPoint> point = read_point(*meta);
      if (!point) {
        return Unexpected{point.error()};
      }
      const bool in_order = points.empty() || points.back().t < point->t;
      if (!in_order && !disorder_) {
        disorder_ = refused(last_line_, fmt::format("the time must be later than that of the data "
                                                    "line before it, {}",
                                                    format_utc(points.back().t, 9)))
                        .value();
      }
      const bool judged = last_point_ && in_order;
      if (const auto jump = judged ? jump_km(*last_point_, *point) : std::nullopt) {
        return refused(last_line_,
                       fmt::format("the orbit jumps: {:.0f} km from where the data line before it, "
                                   "{}, leads to",
                                   *jump, format_utc(last_point_->t)));
      }
      last_point_ = *point;
      points.push_back(*point);
    }
    if (points.empty()) {
      return refused(line_number(), "data lines must stand here");
    }
    if (at(kCovarianceStart)) {
      if (const auto covariances = read_covariances(*meta); !covariances) {
        return Unexpected{covariances.error()};
      }
    }
    return segment_from(*meta, std::move(points));
  }

 private:
  bool at(std::string_view marker) const { return !done() && front_->text == marker; }

  int line_number() const { return done() ? last_line_ : front_->number; }

  void advance() {
    front_.reset();
    while (true) {
      const auto line = next_line_();
      if (!line) {
        failure_ = line.error();
        return;
      }
      if (!*line) {
        return;
      }
      if (const std::string_view text = trimmed((*line)->text); is_meaningful(text)) {
        front_ = Line{.number = (*line)->number, .text = std::string{text}};
        return;
      }
    }
  }

  Line take() {
    Line taken = *std::move(front_);
    last_line_ = taken.number;
    advance();
    return taken;
  }

  Expected<void> take_marker(std::string_view marker) {
    if (!at(marker)) {
      return refused(line_number(), fmt::format("{} must stand here", marker));
    }
    take();
    return {};
  }

  /// Takes `KEY = value` lines until one that is none, and holds them against the rules.
  Expected<Entries> read_entries(std::span<const KeyRule> rules) {
    Entries entries;
    while (!done() && front_->text.find('=') != std::string::npos) {
      const Line taken = take();
      const std::string_view text = taken.text;
      const std::size_t equals = text.find('=');
      const std::string_view key = trimmed(text.substr(0, equals));
      const Entry entry{taken.number, std::string{trimmed(text.substr(equals + 1))}};
      const auto rule = std::find_if(rules.begin(), rules.end(),
                                     [key](const KeyRule& one) { return one.key == key; });
      if (rule == rules.end()) {
        return refused(key, entry, "this key is not allowed here");
      }
      if (entry.value.empty()) {
        return refused(key, entry, "a value must follow");
      }
      if (!entries.emplace(rule->key, entry).second) {
        return refused(key, entry, "this key stands here twice");
      }
    }
    for (const KeyRule& rule : rules) {
      if (rule.required && !entries.contains(rule.key)) {
        return refused(line_number(), fmt::format("{} is missing before this line", rule.key));
      }
    }
    return entries;
  }

  Expected<Meta> read_meta() {
    return take_marker(kMetaStart)
        .and_then([this] { return read_entries(kMetaRules); })
        .and_then([this](const Entries& entries) {
          return take_marker(kMetaStop).and_then([&] { return meta_from(entries); });
        });
  }

  Expected<EphemerisPoint> read_point(const Meta& meta) {
    const Line line = take();
    const std::vector<std::string_view> words = words_of(line.text);
    const Expected<TaiTime> time = meta.read_time(words.front());
    if (!time) {
      return refused(line.number,
                     fmt::format("a data line must begin with its time: {}", time.error().message));
    }
    if (*time < meta.start || *time > meta.stop) {
      return refused(line.number, fmt::format("the time {} must lie between START_TIME and "
                                              "STOP_TIME",
                                              shown(words.front())));
    }
    const auto numbers = numbers_of(std::span{words}.subspan(1), line.number);
    if (!numbers) {
      return Unexpected{numbers.error()};
    }
    if (numbers->size() != kStateNumbers && numbers->size() != kStateAndAccelerationNumbers) {
      return refused(line.number,
                     fmt::format("a data line must hold {} numbers, or {} with accelerations, "
                                 "behind its time; there are {}",
                                 kStateNumbers, kStateAndAccelerationNumbers, numbers->size()));
    }
    return EphemerisPoint{.t = *time,
                          .state = {.position_icrf_km = Eigen::Vector3d{numbers->data()},
                                    .velocity_icrf_km_s = Eigen::Vector3d{numbers->data() + 3}},
                          .line = line.number};
  }

  Expected<void> read_covariances(const Meta& meta) {
    take();
    do {
      if (const auto covariance = read_covariance(meta); !covariance) {
        return Unexpected{covariance.error()};
      }
    } while (!done() && !at(kCovarianceStop));
    return take_marker(kCovarianceStop);
  }

  /// A lower triangle: one number in the first row, six in the sixth.
  Expected<void> read_covariance(const Meta& meta) {
    const Expected<Entries> entries = read_entries(kCovarianceRules);
    if (!entries) {
      return Unexpected{entries.error()};
    }
    if (const auto epoch = time_of(*entries, "EPOCH", meta.read_time); !epoch) {
      return Unexpected{epoch.error()};
    }
    for (std::size_t row = 1; row <= kCovarianceRows; ++row) {
      const std::vector<std::string_view> words =
          done() ? std::vector<std::string_view>{} : words_of(front_->text);
      const auto numbers = numbers_of(words, line_number());
      if (!numbers) {
        return Unexpected{numbers.error()};
      }
      if (numbers->size() != row) {
        return refused(line_number(), fmt::format("row {} of a covariance must hold {} numbers; "
                                                  "there are {}",
                                                  row, row, numbers->size()));
      }
      take();
    }
    return {};
  }

  const OemLines& next_line_;
  std::optional<Line> front_;
  std::optional<Error> failure_;
  int last_line_ = 1;
  std::optional<Error> disorder_;
  std::optional<EphemerisPoint> last_point_;  ///< Of this segment or the one before.
};

Expected<OrbitEphemeris> message_from(OemReader& reader) {
  if (const auto header = reader.read_header(); !header) {
    return Unexpected{header.error()};
  }
  std::vector<OemSegment> segments;
  while (!reader.done()) {
    Expected<OemSegment> segment = reader.read_segment();
    if (!segment) {
      return Unexpected{segment.error()};
    }
    segments.push_back(std::move(*segment));
  }
  if (reader.disorder()) {
    return Unexpected{*reader.disorder()};
  }
  return OrbitEphemeris::make(std::move(segments)).and_then(cut_at_holes);
}

}  // namespace

Expected<OrbitEphemeris> parse_oem(const OemLines& next_line) {
  OemReader reader{next_line};
  auto ephemeris = message_from(reader);
  // What else seems wrong then only lacks the lines that could not be had.
  return reader.failure() ? Expected<OrbitEphemeris>{Unexpected{*reader.failure()}}
                          : std::move(ephemeris);
}

Expected<OrbitEphemeris> parse_oem(std::string_view text) {
  int number = 0;
  return parse_oem([&]() -> Expected<std::optional<OemLine>> {
    if (text.empty()) {
      return std::nullopt;
    }
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    return OemLine{.number = ++number, .text = line};
  });
}

}  // namespace spindrift

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pipelines/core/shown.h"
#include "pipelines/ephemeris/oem.h"
#include "pipelines/ephemeris/oem_entries.h"
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

/// A line that is neither blank nor a comment.
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

bool is_meaningful(std::string_view line) {
  return !line.empty() && line != "COMMENT" && !line.starts_with("COMMENT ");
}

Expected<std::vector<double>> numbers_of(std::span<const std::string_view> words, int line) {
  std::vector<double> numbers;
  for (const std::string_view word : words) {
    const std::optional<double> number = oem_number(word);
    if (!number) {
      return oem_refused(line, fmt::format("'{}' is not a number", shown(word)));
    }
    numbers.push_back(*number);
  }
  return numbers;
}

/// Makes a segment, usable where its metadata and its data lines overlap.
OemSegment segment_from(const OemMetadata& meta, std::vector<EphemerisPoint> points) {
  const int most_hermite = 2 * static_cast<int>(std::min(points.size(), kDefaultHermitePoints)) - 1;
  return {.usable_from = std::max(meta.usable_start, points.front().t),
          .usable_to = std::min(meta.usable_stop, points.back().t),
          .interpolation = meta.interpolation.value_or(Interpolation::Hermite),
          .degree = meta.interpolation ? meta.degree : most_hermite,
          .points = std::move(points),
          .object_name = meta.object_name,
          .object_id = meta.object_id};
}

/// Reads the message line by line.
class OemReader {
 public:
  explicit OemReader(const OemLines& next_line) : next_line_{next_line} { advance(); }

  /// Returns whether no line is left, or the next could not be read.
  bool done() const { return !front_; }

  /// Returns why the next line could not be read.
  const std::optional<Error>& failure() const { return failure_; }

  /// Returns the error of the first data line that is not later than the one before it. It is
  /// reported only when the message is otherwise well formed.
  const std::optional<Error>& disorder() const { return disorder_; }

  Expected<void> read_header() {
    if (done() || !front_->text.starts_with("CCSDS_OEM_VERS")) {
      return oem_refused(line_number(), "an OEM in KVN form must begin with CCSDS_OEM_VERS");
    }
    const Expected<OemEntries> entries = read_entries(kHeaderRules);
    if (!entries) {
      return Unexpected{entries.error()};
    }
    constexpr std::array<std::string_view, 3> kVersions = {"1.0", "2.0", "3.0"};
    if (const auto version = oem_choice(*entries, "CCSDS_OEM_VERS", kVersions); !version) {
      return Unexpected{version.error()};
    }
    return oem_time(*entries, "CREATION_DATE", parse_utc).map([](TaiTime) {});
  }

  Expected<OemSegment> read_segment() {
    const Expected<OemMetadata> meta = read_meta();
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
        disorder_ =
            oem_refused(last_line_, fmt::format("the time must be later than that of the data "
                                                "line before it, {}",
                                                format_utc(points.back().t, 9)))
                .value();
      }
      const bool judged = last_point_ && in_order;
      if (const auto jump = judged ? jump_km(*last_point_, *point) : std::nullopt) {
        return oem_refused(
            last_line_,
            fmt::format("the orbit jumps: {:.0f} km from where the data line before it, "
                        "{}, leads to",
                        *jump, format_utc(last_point_->t)));
      }
      last_point_ = *point;
      points.push_back(*point);
    }
    if (points.empty()) {
      return oem_refused(line_number(), "data lines must stand here");
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
      return oem_refused(line_number(), fmt::format("{} must stand here", marker));
    }
    take();
    return {};
  }

  /// Reads `KEY = value` lines up to the first other line, and checks them against the rules.
  Expected<OemEntries> read_entries(std::span<const KeyRule> rules) {
    OemEntries entries;
    while (!done() && front_->text.find('=') != std::string::npos) {
      const Line taken = take();
      const std::string_view text = taken.text;
      const std::size_t equals = text.find('=');
      const std::string_view key = trimmed(text.substr(0, equals));
      const OemEntry entry{taken.number, std::string{trimmed(text.substr(equals + 1))}};
      const auto rule = std::find_if(rules.begin(), rules.end(),
                                     [key](const KeyRule& one) { return one.key == key; });
      if (rule == rules.end()) {
        return oem_refused(key, entry, "this key is not allowed here");
      }
      if (entry.value.empty()) {
        return oem_refused(key, entry, "a value must follow");
      }
      if (!entries.emplace(rule->key, entry).second) {
        return oem_refused(key, entry, "this key stands here twice");
      }
    }
    for (const KeyRule& rule : rules) {
      if (rule.required && !entries.contains(rule.key)) {
        return oem_refused(line_number(), fmt::format("{} is missing before this line", rule.key));
      }
    }
    return entries;
  }

  Expected<OemMetadata> read_meta() {
    return take_marker(kMetaStart)
        .and_then([this] { return read_entries(kMetaRules); })
        .and_then([this](const OemEntries& entries) {
          return take_marker(kMetaStop)
              .and_then([&] { return check_object(entries.at("OBJECT_ID")); })
              .and_then([&] { return oem_metadata_from(entries); });
        });
  }

  /// Checks that all segments are of one object.
  Expected<void> check_object(const OemEntry& id) {
    object_id_ = object_id_.value_or(id.value);
    if (id.value != *object_id_) {
      return oem_refused("OBJECT_ID", id,
                         fmt::format("must be {}, as in the segments before: one orbit file, one "
                                     "spacecraft",
                                     shown(*object_id_)));
    }
    return {};
  }

  Expected<EphemerisPoint> read_point(const OemMetadata& meta) {
    const Line line = take();
    const std::vector<std::string_view> words = words_of(line.text);
    const Expected<TaiTime> time = meta.read_time(words.front());
    if (!time) {
      return oem_refused(line.number, fmt::format("a data line must begin with its time: {}",
                                                  time.error().message));
    }
    if (*time < meta.start || *time > meta.stop) {
      return oem_refused(line.number, fmt::format("the time {} must lie between START_TIME and "
                                                  "STOP_TIME",
                                                  shown(words.front())));
    }
    const auto numbers = numbers_of(std::span{words}.subspan(1), line.number);
    if (!numbers) {
      return Unexpected{numbers.error()};
    }
    if (numbers->size() != kStateNumbers && numbers->size() != kStateAndAccelerationNumbers) {
      return oem_refused(line.number,
                         fmt::format("a data line must hold {} numbers, or {} with accelerations, "
                                     "behind its time; there are {}",
                                     kStateNumbers, kStateAndAccelerationNumbers, numbers->size()));
    }
    return EphemerisPoint{.t = *time,
                          .state = {.position_icrf_km = Eigen::Vector3d{numbers->data()},
                                    .velocity_icrf_km_s = Eigen::Vector3d{numbers->data() + 3}},
                          .line = line.number};
  }

  Expected<void> read_covariances(const OemMetadata& meta) {
    take();
    do {
      if (const auto covariance = read_covariance(meta); !covariance) {
        return Unexpected{covariance.error()};
      }
    } while (!done() && !at(kCovarianceStop));
    return take_marker(kCovarianceStop);
  }

  /// Reads the lower triangle of a covariance: one number in the first row, six in the sixth.
  Expected<void> read_covariance(const OemMetadata& meta) {
    const Expected<OemEntries> entries = read_entries(kCovarianceRules);
    if (!entries) {
      return Unexpected{entries.error()};
    }
    if (const auto epoch = oem_time(*entries, "EPOCH", meta.read_time); !epoch) {
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
        return oem_refused(line_number(),
                           fmt::format("row {} of a covariance must hold {} numbers; "
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
  std::optional<std::string> object_id_;
  /// Last point read, in this segment or the one before.
  std::optional<EphemerisPoint> last_point_;
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
  // Any other error may only follow from the lines that could not be read.
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

#include "services/publisher/to_idl.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "services/base/assessment_words.h"
#include "services/base/degrees.h"
#include "services/products/attitude.h"

namespace spindrift {
namespace {

constexpr double kNotAvailable = std::numeric_limits<double>::quiet_NaN();

/// Copies text; cuts long text between words or UTF-8 characters and ends it in "...".
void put_text(std::span<char> field, std::string_view text) {
  constexpr std::string_view kCut = "...";
  const std::size_t room = field.size() - 1;
  std::size_t length = text.size() <= room ? text.size() : room - kCut.size();
  if (length < text.size()) {
    const std::size_t blank = text.substr(0, length + 1).rfind(' ');
    const bool long_word = blank == std::string_view::npos || 2 * blank < length;
    length = long_word ? length : text.find_last_not_of(", ", blank) + 1;
  }
  while (length < text.size() && length > 0 &&
         (static_cast<unsigned char>(text[length]) & 0xC0U) == 0x80U) {
    --length;
  }
  std::copy_n(text.begin(), length, field.begin());
  if (length < text.size()) {
    std::copy(kCut.begin(), kCut.end(), field.begin() + static_cast<std::ptrdiff_t>(length));
  }
}

/// The generated types have no const, but a message that is written is only read.
char* only_read(const std::string& text) {
  return const_cast<char*>(text.c_str());  // NOLINT(*-pro-type-const-cast)
}

template <class Result>
Expected<void> put_origin(Result& result, const ResultOrigin& origin) {
  return put_name(result.spacecraft, origin.spacecraft, "spacecraft")
      .and_then([&] { return put_name(result.run_id, origin.run_id, "run_id"); })
      .and_then([&] { return put_name(result.service, origin.service, "service"); });
}

/// The message points into `health`, which must outlive it.
Expected<spindrift_SpacecraftHealth> to_idl(const SpacecraftHealth& health) {
  static const std::string kNone;
  const PassVerdict& verdict = health.verdict;
  spindrift_SpacecraftHealth out{
      .spacecraft = {},
      .link = static_cast<spindrift_LinkState>(health.link),
      .last_sample_tai_ns = health.last_sample ? tai_ns(*health.last_sample) : 0,
      .data_age_s = health.data_age_s.value_or(kNotAvailable),
      .estimator = {},
      .quality = {},
      .sigma_deg = verdict.sigma_deg.value_or(kNotAvailable),
      .why = only_read(verdict.why),
      .against = only_read(verdict.against),
      .answer_tai_ns = verdict.t ? tai_ns(*verdict.t) : 0,
      .separation = only_read(verdict.separation ? verdict.separation->says : kNone)};
  return put_name(out.spacecraft, health.spacecraft, "spacecraft")
      .and_then([&] { return put_name(out.estimator, verdict.estimator, "estimator"); })
      .and_then([&] {
        return put_name(out.quality, verdict.quality ? name_of(*verdict.quality) : "", "quality");
      })
      .map([&out] { return out; });
}

}  // namespace

Expected<void> put_name(std::span<char> field, std::string_view name, std::string_view what) {
  if (name.size() >= field.size()) {
    return Unexpected{Error{ErrorCode::InvalidInput,
                            fmt::format("{} = \"{}\": {} bytes, at most {} go on the bus", what,
                                        name, name.size(), field.size() - 1)}};
  }
  std::copy(name.begin(), name.end(), field.begin());
  return {};
}

Expected<spindrift_SpinFix> to_idl(const ResultOrigin& origin, const SpinFix& fix) {
  const auto [ra_deg, dec_deg] = place_deg(fix.axis_icrf);
  spindrift_SpinFix out{.spacecraft = {},
                        .t_tai_ns = tai_ns(fix.t),
                        .revolution = fix.revolution,
                        .geometry_case = fix.geometry_case,
                        .ra_deg = ra_deg,
                        .dec_deg = dec_deg,
                        .sigma_deg = sigma_deg(fix.covariance_rad2),
                        .alternate_ra_deg = kNotAvailable,
                        .alternate_dec_deg = kNotAvailable,
                        .resolution = static_cast<spindrift_Resolution>(said_resolution(fix)),
                        .run_id = {},
                        .service = {}};
  if (!fix.alternates.empty()) {
    const PlaceDeg alternate = place_deg(fix.alternates.front().axis_icrf);
    out.alternate_ra_deg = alternate.ra_deg;
    out.alternate_dec_deg = alternate.dec_deg;
  }
  return put_origin(out, origin).map([&out] { return out; });
}

Expected<spindrift_SpinEstimate> to_idl(const ResultOrigin& origin, const SpinEstimate& estimate) {
  const auto [ra_deg, dec_deg] = place_deg(estimate.axis_icrf);
  const Eigen::Matrix2d covariance_deg2 = estimate.covariance_rad2 * (kDegPerRad * kDegPerRad);
  spindrift_SpinEstimate out{
      .spacecraft = {},
      .estimator = {},
      .t_tai_ns = tai_ns(estimate.t),
      .ra_deg = ra_deg,
      .dec_deg = dec_deg,
      .sigma_deg = sigma_deg(estimate.covariance_rad2),
      .covariance_deg2 = {covariance_deg2(0, 0), covariance_deg2(0, 1), covariance_deg2(1, 1)},
      .spin_rate_rpm = estimate.spin_rate_rad_s * kRpmPerRad_s,
      .sigma_rpm = estimate.spin_rate_sigma_rad_s * kRpmPerRad_s,
      .status = {},
      .quality = static_cast<spindrift_Quality>(estimate.assessment.quality),
      .run_id = {},
      .service = {}};
  put_text(out.status, sentence_of(estimate.assessment));
  return put_origin(out, origin)
      .and_then([&] { return put_name(out.estimator, name_of(estimate.estimator), "estimator"); })
      .map([&out] { return out; });
}

Expected<spindrift_AttitudeEstimate> to_idl(const ResultOrigin& origin,
                                            const AttitudeEstimate& estimate) {
  const Eigen::Quaterniond& q = estimate.q_icrf_body;
  const Eigen::Vector3d rate_rad_s =
      estimate.rate_body_rad_s.value_or(Eigen::Vector3d::Constant(kNotAvailable));
  spindrift_AttitudeEstimate out{
      .spacecraft = {},
      .estimator = {},
      .t_tai_ns = tai_ns(estimate.t),
      .qx = q.x(),
      .qy = q.y(),
      .qz = q.z(),
      .qw = q.w(),
      .rate_body_rad_s = {rate_rad_s.x(), rate_rad_s.y(), rate_rad_s.z()},
      .sigma_deg = estimate.sigma_rad() * kDegPerRad,
      .status = {},
      .quality = static_cast<spindrift_Quality>(estimate.assessment.quality),
      .run_id = {},
      .service = {}};
  put_text(out.status, sentence_of(estimate.assessment));
  return put_origin(out, origin)
      .and_then([&] { return put_name(out.estimator, name_of(estimate.source), "estimator"); })
      .map([&out] { return out; });
}

Expected<spindrift_RehearsalClock> to_idl(std::string_view spacecraft, const Origin& origin,
                                          std::chrono::nanoseconds offset) {
  spindrift_RehearsalClock out{};
  out.session = origin.session;
  out.offset_ns = offset.count();
  return put_name(out.spacecraft, spacecraft, "spacecraft")
      .and_then([&] { return put_name(out.source, origin.source, "source"); })
      .map([&out] { return out; });
}

Expected<spindrift_Alert> to_idl(const ResultOrigin& origin, const Alert& alert) {
  spindrift_Alert out{};
  out.revision = static_cast<std::uint32_t>(alert.revision);
  out.severity = static_cast<spindrift_Severity>(alert.severity);
  out.state = static_cast<spindrift_AlertState>(alert.state);
  out.raised_tai_ns = tai_ns(alert.raised);
  out.updated_tai_ns = tai_ns(alert.updated);
  out.message = only_read(alert.message);
  out.evidence_json = only_read(alert.evidence);
  return put_name(out.spacecraft, origin.spacecraft, "spacecraft")
      .and_then([&] { return put_name(out.dedupe_key, alert.key, "alert key"); })
      .and_then([&] { return put_name(out.alert_id, alert.alert_id, "alert id"); })
      .map([&out] { return out; });
}

Expected<HealthSample> to_idl(std::string_view service, const Health& health) {
  HealthSample out;
  for (const SpacecraftHealth& one : health.spacecraft) {
    const auto sample = to_idl(one);
    if (!sample) {
      return Unexpected{sample.error()};
    }
    out.spacecraft.push_back(*sample);
  }
  const auto count = static_cast<std::uint32_t>(out.spacecraft.size());
  out.sample = {.service = {},
                .t_tai_ns = tai_ns(health.t),
                .samples_received = health.samples_received,
                .samples_committed = health.samples_committed,
                .gaps = health.gaps,
                .duplicates = health.duplicates,
                .queue_depth = health.queue_depth,
                .commit_p99_ms = health.commit_p99_ms,
                .status = {},
                .message = only_read(health.message),
                .spacecraft = {._maximum = count,
                               ._length = count,
                               ._buffer = out.spacecraft.data(),
                               ._release = false}};
  put_text(out.sample.status, health.status);
  if (const auto named = put_name(out.sample.service, service, "service"); !named) {
    return Unexpected{named.error()};
  }
  return out;
}

}  // namespace spindrift

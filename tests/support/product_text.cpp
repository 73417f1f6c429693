#include "tests/support/product_text.h"

#include <cmath>
#include <iterator>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

#include "pipelines/frames/celestial.h"
#include "pipelines/spin/types/products.h"
#include "services/base/assessment_words.h"

namespace spindrift::testing {
namespace {

/// Joins words with blanks and writes doubles in hexadecimal, which is exact.
class Line {
 public:
  Line() { text_ << std::hexfloat; }

  template <class Word>
  Line& operator<<(const Word& word) {
    text_ << word << ' ';
    return *this;
  }
  Line& operator<<(TaiTime t) { return *this << tai_ns(t); }
  Line& operator<<(const Eigen::Vector3d& v) { return *this << v.x() << v.y() << v.z(); }
  Line& operator<<(const Eigen::Matrix2d& m) {
    return *this << m(0, 0) << m(0, 1) << m(1, 0) << m(1, 1);
  }
  Line& operator<<(SpinQuantity quantity) { return *this << name_of(quantity); }
  Line& operator<<(Rejection rejection) { return *this << name_of(rejection); }
  Line& operator<<(const std::vector<SpinAlternate>& alternates) {
    for (const SpinAlternate& alternate : alternates) {
      *this << alternate.axis_icrf << alternate.covariance_rad2;
    }
    return *this;
  }
  Line& operator<<(Resolution resolution) { return *this << name_of(resolution); }
  template <class Value>
  Line& operator<<(const std::optional<Value>& value) {
    return value ? *this << *value : *this << "-";
  }

  std::string text() const { return text_.str(); }

 private:
  std::ostringstream text_;
};

Line line_of(const PulseUse& use) {
  Line line;
  line << "use" << use.pulse.t << name_of(use.pulse.channel) << use.revolution << use.rejected_by;
  if (use.said) {
    line << use.said->residual.value << use.said->residual.sigma << use.said->limit
         << use.said->rejected_by;
  }
  return line;
}

Line line_of(const RevolutionProduct& revolution) {
  Line line;
  line << "revolution" << revolution.revolution << revolution.t_sun1 << revolution.period_s;
  return line;
}

Line line_of(const SpinMeasurement& measurement) {
  Line line;
  line << "measurement" << measurement.revolution << measurement.quantity << measurement.value
       << measurement.sigma << measurement.rejected_by;
  return line;
}

Line line_of(const SpinFix& fix) {
  Line line;
  line << "fix" << fix.revolution << fix.t << fix.geometry_case << fix.axis_icrf
       << fix.covariance_rad2 << fix.alternates << fix.resolution << fix.norm << fix.accepted;
  return line;
}

Line line_of(const SpinEstimate& estimate) {
  Line line;
  line << "estimate" << estimate.t << name_of(estimate.estimator) << estimate.axis_icrf
       << estimate.covariance_rad2 << estimate.spin_rate_rad_s << estimate.spin_rate_sigma_rad_s
       << sentence_of(estimate.assessment);
  return line;
}

Line line_of(const SampleContradiction& contradiction) {
  Line line;
  line << "contradiction" << contradiction.t << contradiction.kind << contradiction.late;
  for (const SampleContradiction::By& by : contradiction.by) {
    line << by.name << by.used;
  }
  return line;
}

Line line_of(const AxisChoice& choice) {
  Line line;
  line << "choice" << choice.axis_icrf << choice.other_icrf << choice.delta_chi_square
       << name_of(choice.settled_by);
  return line;
}

Line line_of(const SensorsCompared& sensors) {
  Line line;
  line << "sensors" << sensors.t;
  if (const auto& found = sensors.contradiction) {
    line << culprit_name_of(*found) << opponents_text(*found) << found->sigmas << found->since;
  }
  return line;
}

template <class Sample>
SpinOutput run_whole(SpinPass pass, const std::vector<Sample>& arrivals) {
  SpinOutput all;
  const auto collect = [&](SpinOutput some) {
    std::move(some.products.begin(), some.products.end(), std::back_inserter(all.products));
    std::move(some.notices.begin(), some.notices.end(), std::back_inserter(all.notices));
  };
  for (const Sample& sample : arrivals) {
    collect(pass.push(sample));
  }
  collect(pass.finish());
  return all;
}

}  // namespace

std::string text_of(const SpinProduct& product) {
  return std::visit([](const auto& value) { return line_of(value).text(); }, product);
}

SpinOutput run(SpinPass pass, const std::vector<Pulse>& arrivals) {
  return run_whole(std::move(pass), arrivals);
}

SpinOutput run(SpinPass pass, const std::vector<CodedFrame>& arrivals) {
  return run_whole(std::move(pass), arrivals);
}

SpinOutput run(const RecordedPass& pass) {
  SpinPass spin{pass.config, pass.orbit};
  return pass.frames.empty() ? run(std::move(spin), pass.pulses)
                             : run(std::move(spin), pass.frames);
}

std::vector<SpinEstimate> estimates_of(const SpinOutput& output, SpinEstimator estimator) {
  std::vector<SpinEstimate> estimates = all_of<SpinEstimate>(output);
  std::erase_if(estimates, [&](const SpinEstimate& one) { return one.estimator != estimator; });
  return estimates;
}

SpinEstimate last_estimate(const SpinOutput& output, SpinEstimator estimator) {
  const std::vector<SpinEstimate> estimates = estimates_of(output, estimator);
  return estimates.at(estimates.size() - 1);
}

double sigma_rad(const SpinEstimate& estimate) {
  return std::sqrt(estimate.covariance_rad2.trace());
}

double error_sigmas(const SpinEstimate& estimate, const Eigen::Vector3d& true_icrf) {
  return angle_between_rad(estimate.axis_icrf, true_icrf) / sigma_rad(estimate);
}

std::vector<std::string> texts_of(const SpinOutput& output) {
  std::vector<std::string> texts;
  for (const SpinProduct& product : output.products) {
    texts.push_back(text_of(product));
  }
  return texts;
}

}  // namespace spindrift::testing

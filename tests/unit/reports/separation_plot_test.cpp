#include "pipelines/frames/rotation_vector.h"
#include "services/reports/separation_report.h"
#include "tests/support/made_separation.h"
#include "tests/support/matchers.h"
#include "tests/support/well_formed.h"

namespace spindrift::testing::separation_plot_test {

int count_of(const std::string& text, const std::string& part) {
  int count = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++count;
  }
  return count;
}

std::string plot_after(void (*change)(Reconstruction&)) {
  SeparationReport report = report_after([&](auto& separation) { change(separation.solution); });
  report.spacecraft_id = "A&B";
  return plot_of(report);
}

TEST(SeparationPlot, HasAnglesWithBandsEventsUnitsAndTime) {
  const std::string plot = plot_of(made_report());
  EXPECT_EQ(xml_problem(plot), "");
  for (const char* const part :
       {">phi</text>", ">theta</text>", ">psi</text>", ">batch, 1 sigma</text>",
        ">sequential, 1 sigma</text>", "deg", ">2026-03-01 UTC</text>", ">04:01</text>"}) {
    EXPECT_THAT(plot, HasSubstr(part));
  }
  for (const char* const event : {">T1</text>", ">T2</text>", ">T3</text>", ">T4</text>"}) {
    EXPECT_EQ(count_of(plot, event), 2) << event;
  }
  EXPECT_EQ(count_of(plot, "<polygon"), 3);
}

/// `sequential` ends at T4, whereas `batch` continues to the last star fix.
TEST(SeparationPlot, ComparesNothingBehindTheEndOfTheOther) {
  SeparationReport report = made_report();
  ReconstructedSeparation shorter = made_separation(ReconstructionMethod::Sequential);
  shorter.solution.history.resize(20);
  for (ReconstructedAttitude& attitude : shorter.solution.history) {
    attitude.q_icrf_body = attitude.q_icrf_body * quaternion_by({0.01, 0.0, 0.0});
  }
  report.methods[1] = std::make_shared<const ReconstructedSeparation>(shorter);
  const std::string plot = plot_of(report);
  const std::string points = plot.substr(0, plot.find("stroke-dasharray=\"4 3\""));
  EXPECT_EQ(count_of(points.substr(points.rfind("points=")), ","), 20);
}

TEST(SeparationPlot, OfOneMethodHasNoOther) {
  const std::string plot = plot_after([](Reconstruction& /*same*/) {});
  EXPECT_EQ(xml_problem(plot), "");
  EXPECT_THAT(plot, HasSubstr("A&amp;B"));
  EXPECT_THAT(plot, Not(HasSubstr("sequential")));
}

TEST(SeparationPlot, BreaksACurveWhereItGoesOnAtTheOtherEnd) {
  const std::string plot = plot_after([](Reconstruction& solution) {
    for (std::size_t i = 0; i < solution.history.size(); ++i) {
      const double psi_rad = (170.0 + static_cast<double>(i)) * kRadPerDeg;
      solution.history[i].q_icrf_body =
          quaternion_of({.phi_rad = 0.1, .theta_rad = 0.2, .psi_rad = psi_rad});
    }
  });
  EXPECT_EQ(count_of(plot, "<polygon"), 4);
}

TEST(SeparationPlot, IsEmptyWhereTheHistoryIsOfOneInstant) {
  EXPECT_EQ(plot_after([](Reconstruction& solution) { solution.history.resize(1); }), "");
}

}  // namespace spindrift::testing::separation_plot_test

// Figures of deformable objects in the metrics.
#include "app/report/metrics_tissue.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/app_tissue/sample_report.hpp"

namespace cellmirror::app {
namespace {

using testing::HasSubstr;

class Idle final : public Cycle {
 public:
  void run(const CycleContext&) CELL_RT override {}
};

class TissueMetrics : public testing::Test {
 protected:
  std::string metrics(std::shared_ptr<const TissueReport> report) {
    const LiveSources sources{.instance = "default",
                              .cell = "trainer",
                              .now = test::kNow,
                              .loop = loop_,
                              .cell_state = cell_,
                              .tick = tick_,
                              .robots = {},
                              .poses = poses_,
                              .proximity = nullptr,
                              .ranges = nullptr,
                              .forces = nullptr,
                              .queues = {},
                              .tissue = std::move(report)};
    MetricsText out;
    add_tissue_metrics(out, sources);
    return out.take();
  }

  Idle idle_;
  CyclicThread loop_{idle_, {}};
  CellState cell_ = test::sample_cell();
  engine::TickState tick_{8};
  CellPoses poses_;
};

TEST_F(TissueMetrics, AreNotThereWithoutDeformableObjects) { EXPECT_EQ(metrics(nullptr), ""); }

TEST_F(TissueMetrics, TellSpeedSizeEventsAndExcesses) {
  const std::string sut = metrics(std::make_shared<const TissueReport>(test::sample_report()));
  for (const char* line :
       {"cellmirror_tissue_calculating 1\n", "cellmirror_tissue_rate_hertz 999\n",
        "# TYPE cellmirror_tissue_late_steps_total counter\ncellmirror_tissue_late_steps_total 5\n",
        "cellmirror_tissue_step_seconds_count 1\n", "cellmirror_tissue_nodes{object=\"liver\"} 2200\n",
        "cellmirror_tissue_contacts{object=\"liver\"} 3\n", "cellmirror_tissue_parts{object=\"liver\"} 2\n",
        "cellmirror_tissue_instrument_force_newtons{robot=\"GRASPER\"} 5\n",
        "cellmirror_tissue_events_total{kind=\"clip\"} 1\n", "cellmirror_tissue_events_total{kind=\"cut\"} 0\n",
        "cellmirror_tissue_excesses_total{limit=\"CONTACT_FORCE\"} 7\n",
        "cellmirror_tissue_bleeding_milliliters_per_minute 12.5\n", "cellmirror_tissue_blood_loss_milliliters 3.25\n"})
    EXPECT_THAT(sut, HasSubstr(line));
}

}  // namespace
}  // namespace cellmirror::app

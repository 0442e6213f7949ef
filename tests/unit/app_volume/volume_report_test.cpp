// What status, its table, the page and the metrics say of voxel volumes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "app/owner/volume/volume_service.hpp"
#include "app/report/live_volumes.hpp"
#include "app/report/status_volumes.hpp"
#include "app/subcommands/status_table_volumes.hpp"
#include "tests/unit/app_volume/volume_cell.hpp"

namespace cellmirror::app {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

class VolumeReport : public ::testing::Test {
 protected:
  void SetUp() override {
    auto made = test::volume_cell();
    ASSERT_TRUE(made);
    cell_.emplace(*std::move(made));
    service_.emplace(*cell_, VolumeTableReader());
    ASSERT_TRUE(service_->set_plane_mode(1, VolumePlaneMode::reverse, "Part"));
    ASSERT_TRUE(service_->set_plane_mode(1, VolumePlaneMode::visible, "Part"));
    ASSERT_TRUE(service_->set_plane_mode(3, VolumePlaneMode::visible, "Part"));
    ASSERT_TRUE(service_->set_plane_position(1, {0.5, -0.25, 0.0125}, "Part"));
    ASSERT_TRUE(cell_->deactivate("Table.Head"));
    state_.cell = cell_->compile();
    state_.volumes = service_->states();
  }
  json live(void (*add)(JsonWriter&, const CellState&)) {
    JsonWriter out;
    out.begin_object();
    add(out, state_);
    return json::parse(out.end_object().take()).at("volumes");
  }

  std::optional<Cell> cell_;
  std::optional<VolumeService> service_;
  CellState state_;
};

TEST_F(VolumeReport, StatusHasWhatIsLoadedAndWhatIsInForce) {
  const json sut = volumes_json(state_);
  ASSERT_EQ(sut.size(), 2U);
  EXPECT_EQ(sut[1]["name"], "Table.Head");
  EXPECT_EQ(sut[1]["shown"], false);
  EXPECT_EQ(sut[1]["table"], "EXP_LUT");
  const json& part = sut[0];
  EXPECT_EQ(part["name"], "Part");
  EXPECT_EQ(part["shown"], true);
  EXPECT_EQ(part["voxels"], json({4, 3, 2}));
  EXPECT_EQ(part["spacing_m"], json({0.001, 0.002, 0.003}));
  EXPECT_EQ(part["bytes"], 48);
  EXPECT_EQ(part["hounsfield"], true);
  EXPECT_EQ(part["values"], json({-1024.0, -896.0}));
  EXPECT_EQ(part["parameters"]["MEDICAL_LUT"]["fat"], 0.1);
  EXPECT_EQ(part["parameters"]["LIN_LUT"]["level"], 2.0);
  EXPECT_EQ(part["planes"].size(), 6U);
  EXPECT_EQ(part["planes"][1], json({{"plane", "CLP2"},
                                     {"side", "reverse"},
                                     {"framed", true},
                                     {"elevation_rad", 0.5},
                                     {"azimuth_rad", -0.25},
                                     {"distance_m", 0.0125}}));
  EXPECT_EQ(part["user_tables"], json::array());
  EXPECT_EQ(part["isosurface"], false);
}

TEST_F(VolumeReport, TheTableSaysThePlanesThatDoSomething) {
  const std::string sut = volumes_table(json{{"volumes", volumes_json(state_)}});
  EXPECT_THAT(sut, HasSubstr("volume Table.Head: 4 x 3 x 2 voxels of 1 x 2 x 3 mm, 0 MiB, -1024 to -896 HU, hidden"));
  EXPECT_THAT(sut, HasSubstr("\n  EXP_LUT gain 1 level 2 opacity 1 window 0.785398\n"));
  EXPECT_THAT(sut, HasSubstr("CLP2 reverse, visible: ELE 28.6479 AZI -14.3239 DIST 12.5 mm"));
  EXPECT_THAT(sut, HasSubstr("CLP4 visible: ELE 0 AZI 0 DIST 0 mm"));
  EXPECT_THAT(sut, Not(HasSubstr("CLP1")));
  EXPECT_EQ(volumes_table(json{{"volumes", json::array()}}), "");
  EXPECT_EQ(volumes_table(json::object()), "") << "an older gateway";
}

TEST_F(VolumeReport, ThePageGetsWhatIsInForceOftenAndTheRestWithTheTree) {
  const json now = live(add_volumes);
  ASSERT_EQ(now.size(), 2U);
  EXPECT_EQ(now[0]["table"], "MEDICAL_LUT");
  EXPECT_EQ(now[0]["parameters"]["MEDICAL_LUT"], json({0.0, 0.1, 0.3, 1.0}));
  EXPECT_EQ(now[0]["planes"][1]["side"], "reverse");
  const json content = live(add_volume_contents);
  ASSERT_EQ(content.size(), 2U);
  EXPECT_EQ(content[0]["name"], "Part");
  EXPECT_EQ(content[0]["unit"], "HU");
  EXPECT_EQ(content[0]["half_extent_m"], json({0.002, 0.003, 0.003}));
  EXPECT_EQ(content[0]["histogram"]["counts"].size(), 128U);
  EXPECT_EQ(content[0]["histogram"]["counts"][127], 1);
  EXPECT_EQ(content[0]["histogram"]["low"], -1024.0);
}

TEST_F(VolumeReport, ACellWithoutVolumesSaysSo) {
  state_.volumes = std::make_shared<const VolumeStates>();
  EXPECT_TRUE(live(add_volumes).is_null());
  EXPECT_EQ(live(add_volume_contents), json::array());
  EXPECT_EQ(volumes_json(state_), json::array());
}

}  // namespace
}  // namespace cellmirror::app

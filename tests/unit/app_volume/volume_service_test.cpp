// The VV_ commands as a message brings them: names, what is in force afterwards, remarks and refusals.
#include "app/owner/volume/volume_service.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "app/owner/hosts.hpp"
#include "scripts/commands/execute.hpp"
#include "scripts/lang/reader.hpp"
#include "tests/golden/scripts/quiet_host.hpp"
#include "tests/unit/app_volume/volume_cell.hpp"

namespace cellmirror::app {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

struct Answer {
  bool done = false;
  std::string text;  // the remark, or why not
};

class VolumeServiceTest : public ::testing::Test {
 protected:
  VolumeServiceTest() { use(true); }

  void use(bool with_volumes) {
    sut_.reset();
    names_.reset();
    reads_ = 0;
    auto made = test::volume_cell(with_volumes);
    ASSERT_TRUE(made);
    cell_.emplace(*std::move(made));
    names_.emplace(*cell_);
    sut_.emplace(*cell_, [this]() -> Result<VolumeUserTables> {
      ++reads_;
      if (!problem_.empty()) return fail(problem_);
      return tables_;
    });
  }
  Answer send(const std::string& text) {
    CommandHost host{*names_, quiet_, quiet_, quiet_, quiet_, quiet_, quiet_, quiet_, quiet_, *sut_, quiet_};
    Diagnostics findings;
    script::ParsedCommand command;
    script::CommandReader reader(text, "message", script::TextKind::message);
    if (reader.next(&*names_, command, findings) != script::CommandReader::Step::command)
      return {false, findings.text()};
    script::Outcome outcome = script::execute(command, host);
    if (outcome.kind == script::Outcome::Kind::refused) return {false, outcome.error.text()};
    return {outcome.kind == script::Outcome::Kind::done, outcome.remark};
  }
  void do_it(const std::string& text) {
    const Answer answer = send(text);
    EXPECT_TRUE(answer.done) << text << ": " << answer.text;
    EXPECT_EQ(answer.text, "") << text;
  }
  const VolumeState& state(std::string_view name) {
    for (const VolumeState& each : *sut_->states()) {
      if (each.name == name) return each;
    }
    ADD_FAILURE() << "no volume " << name;
    static const VolumeState none;
    return none;
  }
  std::vector<std::string> names() {
    std::vector<std::string> all;
    for (const VolumeState& each : *sut_->states()) all.push_back(each.name);
    return all;
  }

  VolumeUserTables tables_;
  std::string problem_;
  int reads_ = 0;
  std::optional<Cell> cell_;
  std::optional<CellNames> names_;
  std::optional<VolumeService> sut_;
  cellmirror::testing::QuietHost quiet_;
};

TEST_F(VolumeServiceTest, VolumesBeginAsTheirFilesHaveThem) {
  EXPECT_THAT(names(), ElementsAre("Part", "Table.Head"));
  EXPECT_EQ(state("Table.Head").settings.table, VolumeTable::exponential);
  EXPECT_EQ(state("Part").settings, VolumeSettings());
}

TEST_F(VolumeServiceTest, ACommandWithoutANameActsOnAllVolumes) {
  do_it("VV_SET_LUT RAINBOW_LUT");
  EXPECT_EQ(state("Table.Head").settings.table, VolumeTable::rainbow);
  EXPECT_EQ(state("Part").settings.table, VolumeTable::rainbow);
}

TEST_F(VolumeServiceTest, ACommandWithANameActsOnThatVolumeAlone) {
  do_it("VV_SET_LUT RAINBOW_LUT Table.Head");
  EXPECT_EQ(state("Part").settings.table, VolumeTable::medical);
  do_it("VV_CLIP CLP1 reverse Head");  // shorter, as everywhere
  EXPECT_EQ(state("Table.Head").settings.planes[0].side, VolumePlaneSide::before);
  EXPECT_EQ(state("Part").settings.planes[0].side, VolumePlaneSide::none);
}

TEST_F(VolumeServiceTest, UnknownNamesAreRefusedWithTheNearest) {
  const auto before = sut_->states();
  EXPECT_THAT(send("VV_SET_LUT LIN_LUT Table.Hed").text,
              HasSubstr("no voxel volume Table.Hed; did you mean Table.Head"));
  EXPECT_THAT(send("VV_SET_LUT LIN_LUT Hed").text, HasSubstr("did you mean Head?"));
  EXPECT_THAT(send("VV_SET_LUT LIN_LUT Box").text, HasSubstr("Box has no voxel volume; the cell has Part, Table.Head"));
  EXPECT_FALSE(send("VV_RELOAD_LUTS Box").done);
  EXPECT_EQ(sut_->states(), before);
}

TEST_F(VolumeServiceTest, WithoutAVolumeEachCommandIsRefused) {
  use(false);
  for (const char* command :
       {"VV_CLIP CLP1", "VV_CLIP_POS CLP1 ELE 0 AZI 0 DIST 0", "VV_SET_LUT LIN_LUT", "VV_SET_LUT_PAR LIN_LUT 1 1 1 1",
        "VV_SET_LUT_PAR MEDICAL_LUT 0 0 0 1", "VV_RELOAD_LUTS", "VV_SET_LUT LIN_LUT Head"}) {
    const Answer answer = send(command);
    EXPECT_FALSE(answer.done) << command;
    EXPECT_THAT(answer.text, HasSubstr("the cell has no voxel volume")) << command;
  }
  EXPECT_EQ(reads_, 0) << "tables are read where there is a volume";
}

TEST_F(VolumeServiceTest, PlanesAreWhatTheWordSays) {
  const auto plane = [&]() -> const VolumePlane& { return state("Part").settings.planes[2]; };
  do_it("VV_CLIP CLP3 visible Part");
  EXPECT_EQ(plane().side, VolumePlaneSide::none);
  EXPECT_TRUE(plane().framed);
  do_it("VV_CLIP CLP3");
  EXPECT_EQ(plane().side, VolumePlaneSide::beyond);
  EXPECT_TRUE(plane().framed) << "visible stays";
  do_it("VV_CLIP CLP3 reverse");
  EXPECT_EQ(plane().side, VolumePlaneSide::before);
  do_it("VV_CLIP CLP3 visible");
  EXPECT_EQ(plane().side, VolumePlaneSide::before) << "visible changes nothing else";
  do_it("VV_CLIP CLP3 off");
  EXPECT_EQ(plane(), VolumePlane());
}

TEST_F(VolumeServiceTest, PositionsAreInSi) {
  do_it("VV_CLIP CLP6 active Part");
  do_it("VV_CLIP_POS CLP6 DIST -12.5 AZI 90 ELE -45 Part");
  const VolumePlane& plane = state("Part").settings.planes[5];
  EXPECT_DOUBLE_EQ(plane.elevation_rad, -std::numbers::pi / 4);
  EXPECT_DOUBLE_EQ(plane.azimuth_rad, std::numbers::pi / 2);
  EXPECT_DOUBLE_EQ(plane.distance_m, -0.0125);
  EXPECT_EQ(plane.side, VolumePlaneSide::beyond) << "the mode stays";
  const Answer idle = send("VV_CLIP_POS CLP1 DIST 1 AZI 0 ELE 0 Part");
  EXPECT_TRUE(idle.done);
  EXPECT_EQ(idle.text, "CLP1 of Part is off, so this is seen after VV_CLIP CLP1");
}

TEST_F(VolumeServiceTest, EachTableKeepsItsParameters) {
  do_it("VV_SET_LUT_PAR MEDICAL_LUT 0.1 0.2 0.3 0.4 Part");
  EXPECT_EQ(state("Part").settings.medical, (MedicalTableParameters{0.1, 0.2, 0.3, 0.4}));
  const Answer idle = send("VV_SET_LUT_PAR USER2_LUT 3 20 1 1.57 Part");
  EXPECT_TRUE(idle.done);
  EXPECT_EQ(idle.text, "Part is drawn with MEDICAL_LUT, so this is seen after VV_SET_LUT USER2_LUT");
  EXPECT_EQ(state("Part").settings.parameters[5], (VolumeTableParameters{3, 20, 1, 1.57}));
  EXPECT_EQ(state("Part").settings.parameters[4], VolumeTableParameters());
  EXPECT_EQ(state("Part").settings.table, VolumeTable::medical) << "the active table stays";
}

TEST_F(VolumeServiceTest, ATableOfUsersWithoutAFileIsRemarked) {
  EXPECT_THAT(send("VV_SET_LUT USER1_LUT").text, HasSubstr("no envlib/USER1_LUT.lut"));
  tables_[0] = std::make_shared<const VolumeUserTable>();
  do_it("VV_RELOAD_LUTS");
  do_it("VV_SET_LUT USER1_LUT");
  EXPECT_THAT(send("VV_SET_LUT USER2_LUT").text, HasSubstr("no envlib/USER2_LUT.lut"));
}

TEST_F(VolumeServiceTest, ASurfaceIsDrawnAtItsValue) {
  do_it("VV_ISO on VALUE -950.5 Part");
  EXPECT_TRUE(state("Part").settings.isosurface);
  EXPECT_EQ(state("Part").settings.iso_value, -950.5);
  EXPECT_FALSE(state("Table.Head").settings.isosurface);
  do_it("VV_ISO off");
  EXPECT_FALSE(state("Part").settings.isosurface);
  EXPECT_EQ(state("Part").settings.iso_value, -950.5) << "kept for the next on";
  EXPECT_EQ(send("VV_ISO on VALUE 300 Part").text, "the values of Part are -1024 to -896, so 300 has no surface");
}

TEST_F(VolumeServiceTest, ReloadedTablesAreOthersAndARefusedFileChangesNothing) {
  EXPECT_EQ(reads_, 1) << "at the start";
  EXPECT_EQ(state("Part").user_tables, VolumeUserTables());
  EXPECT_THAT(send("VV_RELOAD_LUTS").text, HasSubstr("neither envlib/USER1_LUT.lut nor envlib/USER2_LUT.lut"));
  tables_[1] = std::make_shared<const VolumeUserTable>();
  const auto revision = state("Part").tables_revision;
  do_it("VV_RELOAD_LUTS Part");
  EXPECT_EQ(state("Part").user_tables, tables_);
  EXPECT_GT(state("Part").tables_revision, revision);
  EXPECT_EQ(state("Table.Head").user_tables, VolumeUserTables()) << "only the one that was named";
  const auto before = sut_->states();
  problem_ = "envlib/USER2_LUT.lut:3:1: error: no table";
  const Answer refused = send("VV_RELOAD_LUTS");
  EXPECT_FALSE(refused.done);
  EXPECT_EQ(refused.text, problem_);
  EXPECT_EQ(sut_->states(), before);
}

TEST_F(VolumeServiceTest, AVolumeThatIsLoadedBeginsAsItsFileHasItAndOthersStay) {
  do_it("VV_SET_LUT LIN_LUT");
  const auto before = sut_->states();
  ASSERT_TRUE(cell_->activate("Later"));
  EXPECT_THAT(names(), ElementsAre("Part", "Later", "Table.Head"));
  EXPECT_EQ(state("Part").settings.table, VolumeTable::linear);
  EXPECT_EQ(state("Later").settings.table, VolumeTable::medical);
  ASSERT_TRUE(cell_->delete_node("Part"));
  EXPECT_THAT(names(), ElementsAre("Later", "Table.Head"));
  EXPECT_EQ(state("Table.Head").settings.table, VolumeTable::linear);
  EXPECT_EQ(before->size(), 2U) << "what was published stays as it was";
}

TEST_F(VolumeServiceTest, StatesAreTheSameObjectWhileNothingChanges) {
  const auto before = sut_->states();
  ASSERT_TRUE(cell_->set_placement("Table", Pose::Identity()));
  EXPECT_EQ(sut_->states(), before);
  do_it("VV_SET_LUT RAINBOW_LUT");
  EXPECT_NE(sut_->states(), before);
}

TEST_F(VolumeServiceTest, CompletionKnowsTheVolumes) {
  EXPECT_THAT(names_->all(NameKind::volume), ElementsAre("Part", "Table.Head"));
  EXPECT_TRUE(names_->knows(NameKind::volume, "Part"));
  EXPECT_FALSE(names_->knows(NameKind::volume, "Table"));
}

}  // namespace
}  // namespace cellmirror::app

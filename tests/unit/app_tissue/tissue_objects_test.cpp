// Commands that concern deformable objects as a whole: attributes, limits, connections, effects, calculation.
#include <fmt/format.h>

#include "tests/unit/app_tissue/tissue_desk.hpp"

namespace cellmirror::app {
namespace {

struct TissueObjectCommands : TissueDesk {};

TEST_F(TissueObjectCommands, EachAttributeByItsToken) {
  for (std::size_t i = 0; i < kTissueAttributeWords.size(); ++i) {
    const auto bit = static_cast<std::uint16_t>(1U << i);
    const std::uint16_t before = settings().objects[0].attributes;
    do_it(fmt::format("eladyn_geo_def liver.mpo {} off", kTissueAttributeWords.at(i)));
    EXPECT_EQ(last<tissue::SetAttributes>().object, 0);
    EXPECT_EQ(last<tissue::SetAttributes>().mask, bit);
    EXPECT_EQ(last<tissue::SetAttributes>().values, 0);
    EXPECT_EQ(settings().objects[0].attributes, before & ~bit);
    do_it(fmt::format("eladyn_geo_def liver.mpo {} on", kTissueAttributeWords.at(i)));
    EXPECT_EQ(last<tissue::SetAttributes>().mask, bit);
    EXPECT_EQ(last<tissue::SetAttributes>().values, bit);
    EXPECT_EQ(settings().objects[0].attributes, before | bit);
  }
  EXPECT_EQ(settings().objects[0].attributes, kAllTissueAttributes);
  EXPECT_EQ(settings().objects[1].attributes, kDefaultTissueAttributes);
}

TEST_F(TissueObjectCommands, FlagsSetExactlyTheirAttributes) {
  for (std::size_t i = 0; i < kTissueAttributeWords.size(); ++i) {
    const unsigned bit = 1U << i;
    do_it(fmt::format("eladyn_geo_def gallbladder.mpo {:#x}", bit));
    EXPECT_EQ(last<tissue::SetAttributes>().object, 1);
    EXPECT_EQ(last<tissue::SetAttributes>().mask, kAllTissueAttributes);
    EXPECT_EQ(last<tissue::SetAttributes>().values, bit);
    EXPECT_EQ(settings().objects[1].attributes, bit);
  }
  do_it("eladyn_geo_def gallbladder.mpo 0 1 2 3 4");
  EXPECT_EQ(settings().objects[1].attributes, 0);
  EXPECT_EQ(settings().objects[0].attributes, kDefaultTissueAttributes);
}

TEST_F(TissueObjectCommands, AllMeansEveryObject) {
  do_it("eladyn_geo_def all GRAVITY on");
  ASSERT_EQ(port_.taken.size(), 1U);
  EXPECT_EQ(last<tissue::SetAttributes>().object, -1);
  for (const TissueObjectSettings& object : settings().objects)
    EXPECT_TRUE(has(object.attributes, TissueAttribute::gravity)) << object.name;
}

TEST_F(TissueObjectCommands, TheExtensionOfAnObjectMayBeLeftOut) {
  do_it("eladyn_geo_def gallbladder CUT off");
  EXPECT_EQ(last<tissue::SetAttributes>().object, 1);
  EXPECT_FALSE(has(settings().objects[1].attributes, TissueAttribute::cut));
  EXPECT_TRUE(has(settings().objects[0].attributes, TissueAttribute::cut));
}

TEST_F(TissueObjectCommands, AnUnknownObjectIsAnsweredWithTheNearestOnes) {
  const Answer near = send("eladyn_geo_def livre.mpo CUT off");
  EXPECT_FALSE(near.done);
  EXPECT_EQ(near.text, "there is no deformable object livre.mpo; did you mean liver.mpo?");
  const Answer far = send("eladyn_geo_def X_17 CUT off");
  EXPECT_FALSE(far.done);
  EXPECT_EQ(far.text, "there is no deformable object X_17; the cell has liver.mpo, gallbladder.mpo");
  EXPECT_TRUE(port_.taken.empty());
}

TEST_F(TissueObjectCommands, EachLimitInItsUnitWithEachAction) {
  const double si[] = {0.25, 0.25, 250, 250, 0.25, 250};
  for (std::size_t limit = 0; limit < kTissueLimits; ++limit) {
    for (std::size_t action = 0; action < kTissueLimitActionWords.size(); ++action) {
      do_it(fmt::format("eladyn_plaus_param {} {} 250", kTissueLimitWords.at(limit), 1U << action));
      EXPECT_EQ(last<tissue::SetLimit>().limit, static_cast<TissueLimit>(limit));
      EXPECT_EQ(last<tissue::SetLimit>().actions, 1U << action);
      EXPECT_DOUBLE_EQ(last<tissue::SetLimit>().value, si[limit]);
      EXPECT_EQ(settings().limits.at(limit).actions, 1U << action);
      EXPECT_DOUBLE_EQ(settings().limits.at(limit).value, si[limit]);
    }
    do_it(fmt::format("eladyn_plaus_param {} 0 0", kTissueLimitWords.at(limit)));
    EXPECT_EQ(last<tissue::SetLimit>().actions, 0);
  }
}

TEST_F(TissueObjectCommands, LimitsAreAtTheStartThoseOfTheSimulation) {
  for (std::size_t limit = 0; limit < kTissueLimits; ++limit) {
    EXPECT_EQ(settings().limits.at(limit).actions, kDefaultTissueLimits.at(limit).actions);
    EXPECT_EQ(settings().limits.at(limit).value, kDefaultTissueLimits.at(limit).value);
  }
  EXPECT_NE(settings().limits.at(std::to_underlying(TissueLimit::instrument_speed)).actions, 0);
}

TEST_F(TissueObjectCommands, ALimitOfZeroIsOffAndSaysSo) {
  const Answer answer = send("eladyn_plaus_param GRIP_FORCE 3 0");
  EXPECT_TRUE(answer.done);
  EXPECT_EQ(answer.text, "a limit of 0 is off, whatever the flags are");
  EXPECT_EQ(settings().limits.at(std::to_underlying(TissueLimit::grip_force)).actions, 0);
}

TEST_F(TissueObjectCommands, CalculationStopsAndGoesOn) {
  EXPECT_TRUE(settings().calculating);
  do_it("eladyn_calc off");
  EXPECT_FALSE(last<tissue::SetCalculation>().on);
  EXPECT_FALSE(settings().calculating);
  do_it("eladyn_calc on");
  EXPECT_TRUE(last<tissue::SetCalculation>().on);
  EXPECT_TRUE(settings().calculating);
}

TEST_F(TissueObjectCommands, TheNetworkIsShownToWhoReadsTheSettings) {
  const auto before = sut_->settings();
  do_it("eladyn_show_def 1");
  EXPECT_TRUE(settings().network_shown);
  EXPECT_FALSE(before->network_shown) << "a published object is never changed";
  do_it("eladyn_show_def 0");
  EXPECT_FALSE(settings().network_shown);
  EXPECT_TRUE(port_.taken.empty());
}

// What the simulation has frozen is as commands have set it again.
TEST_F(TissueObjectCommands, AResetSetsTheAttributesAnew) {
  do_it("eladyn_geo_def gallbladder.mpo 0x3");
  port_.taken.clear();
  do_it("eladyn_model_reset");
  ASSERT_EQ(port_.taken.size(), 3U);
  EXPECT_TRUE(std::holds_alternative<tissue::ResetModel>(port_.taken[0]));
  EXPECT_EQ(std::get<tissue::SetAttributes>(port_.taken[1]).values, kDefaultTissueAttributes);
  EXPECT_EQ(std::get<tissue::SetAttributes>(port_.taken[2]).object, 1);
  EXPECT_EQ(std::get<tissue::SetAttributes>(port_.taken[2]).mask, kAllTissueAttributes);
  EXPECT_EQ(std::get<tissue::SetAttributes>(port_.taken[2]).values, 0x3);
}

TEST_F(TissueObjectCommands, EffectsThatHaveWhatTheyNeed) {
  use({{.name = "liver.mpo", .artery = true, .blood_vessel = true, .pool = true}});
  for (const TissueEffect effect : {TissueEffect::pulse, TissueEffect::bleeding, TissueEffect::pool_ripples}) {
    for (const bool on : {true, false}) {
      do_it(fmt::format("EFFECTS {} {}", word(effect), on ? "ON" : "OFF"));
      EXPECT_EQ(last<tissue::SetEffect>().effect, effect);
      EXPECT_EQ(last<tissue::SetEffect>().on, on);
      EXPECT_EQ(settings().effects.at(std::to_underlying(effect)).on, on);
    }
  }
  do_it("EFFECTS RESET_POOL");
  EXPECT_TRUE(std::holds_alternative<tissue::ResetPool>(port_.taken.back()));
  do_it("EFFECTS CLEAN_ENDOSCOPIC_LENSE");
  EXPECT_TRUE(std::holds_alternative<tissue::CleanLens>(port_.taken.back()));
}

TEST_F(TissueObjectCommands, AnEffectWithoutAnythingToActOnIsDoneWithARemark) {
  const std::pair<const char*, const char*> remarks[] = {{"PULSE ON", "no deformable object has an artery"},
                                                         {"BLEEDING ON", "no deformable object has a blood vessel"},
                                                         {"POOL_RIPPLES ON", "no deformable object has a pool"},
                                                         {"SUCTION ON", "only smoke is cleared"},
                                                         {"IRRIGATION ON", "no deformable object has a pool"},
                                                         {"RESET_POOL", "no deformable object has a pool"}};
  for (const auto& [effect, remark] : remarks) {
    const Answer answer = send(fmt::format("EFFECTS {}", effect));
    EXPECT_TRUE(answer.done) << effect;
    EXPECT_NE(answer.text.find(remark), std::string::npos) << effect << ": " << answer.text;
  }
  EXPECT_EQ(port_.taken.size(), std::size(remarks));
  do_it("EFFECTS PULSE OFF");
}

TEST_F(TissueObjectCommands, ConnectionsOfAFileReplaceThoseThatThereAre) {
  hyper_ = std::vector<tissue::Connection>{{.name = "bed", .object_a = "gallbladder.mpo", .object_b = "liver.mpo"},
                                           {.name = "wall", .object_a = "liver.mpo", .object_b = ""}};
  do_it("eladyn_hyper_name bed.hyper");
  EXPECT_EQ(read_, "bed.hyper");
  ASSERT_EQ(last<tissue::SetConnections>().connections.size(), 2U);
  EXPECT_EQ(last<tissue::SetConnections>().connections[1].name, "wall");
  EXPECT_EQ(settings().hyper_file, "bed.hyper");
  EXPECT_EQ(settings().connections, 2U);
}

TEST_F(TissueObjectCommands, AHyperFileThatIsWrongChangesNothing) {
  const auto before = sut_->settings();
  hyper_ = fail("bed.hyper:3:1: the radius is negative", "give 0 or more");
  EXPECT_EQ(send("eladyn_hyper_name bed.hyper").text, "bed.hyper:3:1: the radius is negative; give 0 or more");

  EXPECT_TRUE(port_.taken.empty());
  EXPECT_EQ(sut_->settings(), before);
}

TEST_F(TissueObjectCommands, WhatTheSimulationHasNoRoomForIsRefusedAndChangesNothing) {
  port_.full = true;
  const auto before = sut_->settings();
  for (const char* command : {"eladyn_geo_def ALL 3", "eladyn_calc off", "eladyn_model_reset", "EFFECTS SUCTION ON",
                              "eladyn_plaus_param STRAIN 1 2", "rob_ela_interact 3 1 10 0 0"}) {
    const Answer answer = send(command);
    EXPECT_FALSE(answer.done) << command;
    EXPECT_NE(answer.text.find("queue of the simulation of tissue is full"), std::string::npos) << answer.text;
  }
  EXPECT_EQ(sut_->settings(), before);
}

TEST_F(TissueObjectCommands, WithoutASimulationSettingsAreKept) {
  use({object_named("liver.mpo")}, false);
  do_it("eladyn_geo_def liver.mpo 0x3");
  do_it("eladyn_calc off");
  EXPECT_EQ(settings().objects[0].attributes, 0x3);
  EXPECT_FALSE(settings().calculating);
}

TEST_F(TissueObjectCommands, ACellWithoutObjectsTakesSettingsAndRefusesNames) {
  use({});
  for (const char* command :
       {"eladyn_calc off", "eladyn_show_def 1", "eladyn_model_reset", "eladyn_plaus_param STRAIN 1 2",
        "EFFECTS PULSE ON", "EFFECTS SUCTION ON", "EFFECTS RESET_POOL", "EFFECTS CLEAN_ENDOSCOPIC_LENSE",
        "rob_ela_interact 3 1 10 0 0", "ela_clip_def clip.mpo 0 0 0 0 0 0", "eladyn_geo_def JAW 0 5 4 0 0"}) {
    const Answer answer = send(command);
    EXPECT_TRUE(answer.done) << command << ": " << answer.text;
    EXPECT_EQ(answer.text, "the cell has no deformable object, so this has no effect") << command;
  }
  for (const char* command : {"eladyn_geo_def ALL CUT on", "eladyn_geo_def ALL 0", "eladyn_geo_def liver.mpo CUT on",
                              "eladyn_hyper_name bed.hyper"}) {
    const Answer answer = send(command);
    EXPECT_FALSE(answer.done) << command;
    EXPECT_NE(answer.text.find("the cell has no deformable object"), std::string::npos) << answer.text;
    EXPECT_NE(answer.text.find("cell file"), std::string::npos) << answer.text;
  }
  EXPECT_TRUE(port_.taken.empty());
  EXPECT_FALSE(settings().calculating);
}

TEST_F(TissueObjectCommands, AFileThatIsMissingOrNamesOtherObjectsIsRefusedWithTheNearestNames) {
  write("envlib/bed.hyper",
        "format = 1\n[[connection]]\nname = \"bed\"\nobject_a = \"liver.mpo\"\npoint_a_m = [0, 0, 0]\n"
        "point_b_m = [0, 0, 0.1]\n");
  write("envlib/clip.mpo", "format = 1\n");
  TissueSetup setup;
  setup.objects.resize(1);
  setup.hyper_file = "/a/folder/first.hyper";
  setup.connections.resize(3);
  for (const char* name : {"liver.mpo", "colon.mpo"}) {
    setup.objects[0].name = name;
    TissueParts parts = tissue_parts(setup, KismetHome::open(folder_).value(), &port_);
    sut_.emplace(*cell_, *names_, std::move(parts));
    EXPECT_EQ(settings().hyper_file, "first.hyper");
    EXPECT_EQ(settings().connections, 3U);
    if (settings().objects[0].name == "liver.mpo") {
      do_it("eladyn_hyper_name bed");
      EXPECT_EQ(last<tissue::SetConnections>().connections.at(0).object_a, "liver.mpo");
      EXPECT_EQ(settings().hyper_file, "bed.hyper");
      EXPECT_EQ(settings().connections, 1U);
    } else {
      const Answer other = send("eladyn_hyper_name bed.hyper");
      EXPECT_FALSE(other.done);
      EXPECT_NE(other.text.find("liver.mpo"), std::string::npos) << other.text;
      EXPECT_NE(other.text.find("bed.hyper:4"), std::string::npos) << other.text;
    }
    const std::pair<const char*, const char*> missing[] = {{"eladyn_hyper_name bet.hyper", "bed.hyper"},
                                                           {"ela_clip_def clap.mpo 0 0 0 0 0 0", "clip.mpo"}};
    for (const auto& [command, near] : missing) {
      const Answer answer = send(command);
      EXPECT_FALSE(answer.done) << command;
      EXPECT_NE(answer.text.find(std::string("did you mean ") + near), std::string::npos) << answer.text;
    }
    EXPECT_FALSE(send("eladyn_hyper_name ../cell.toml").done);
    const Answer empty = send("ela_clip_def clip.mpo 0 0 0 0 0 0");
    EXPECT_FALSE(empty.done);
    EXPECT_NE(empty.text.find("clip.mpo"), std::string::npos) << empty.text;
  }
  EXPECT_EQ(port_.taken.size(), 1U);
}

TEST(TissueObject, KnowsWhatItsDescriptionHas) {
  tissue::ObjectDescription description;
  description.name = "liver.mpo";
  description.attributes = 0x21;
  description.vessels.push_back({.name = "duct", .kind = tissue::VesselKind::duct, .centre_line = {}});
  const TissueObject duct = TissueObject::of(description);
  EXPECT_EQ(duct.name, "liver.mpo");
  EXPECT_EQ(duct.attributes, 0x21);
  EXPECT_FALSE(duct.artery || duct.blood_vessel || duct.pool);
  description.vessels.push_back({.name = "vein", .kind = tissue::VesselKind::vein, .centre_line = {}});
  EXPECT_TRUE(TissueObject::of(description).blood_vessel);
  EXPECT_FALSE(TissueObject::of(description).artery);
  description.vessels.push_back({.name = "artery", .kind = tissue::VesselKind::artery, .centre_line = {}});
  description.pools.emplace_back();
  const TissueObject all = TissueObject::of(description);
  EXPECT_TRUE(all.artery && all.blood_vessel && all.pool);
}

}  // namespace
}  // namespace cellmirror::app

// What a master may do to the PDOs and the communication objects of a drive, with the abort codes of CiA 301, table 22.
#include "drivers/can/canopen/slave.hpp"

#include <gtest/gtest.h>

#include "tests/unit/can_device/master.hpp"

namespace cellmirror::can {
namespace {

struct Slave : testing::Test {
  DriveMaster master;
  std::uint32_t write(std::uint16_t index, std::uint8_t subindex, std::int64_t value, std::size_t bytes) {
    return master.write(index, subindex, value, bytes);
  }
};

constexpr std::uint32_t kInvalidTpdo4 = 0x8000'0485;

TEST_F(Slave, BootsAndShowsItsIdentity) {
  ASSERT_FALSE(master.frames.empty());
  EXPECT_EQ(master.frames.front(), frame(0x705, {0x00}));
  EXPECT_EQ(master.object(0x1000) & 0xFFFF, 402);
  EXPECT_EQ(master.object(0x1018, 4), 5);
}

TEST_F(Slave, AMasterMapsATpdo) {
  EXPECT_EQ(write(0x1803, 1, kInvalidTpdo4, 4), 0U);
  EXPECT_EQ(write(0x1803, 2, 1, 1), 0U);
  EXPECT_EQ(write(0x1A03, 0, 0, 1), 0U);
  EXPECT_EQ(write(0x1A03, 1, 0x60FD'0020, 4), 0U);
  EXPECT_EQ(write(0x1A03, 2, 0x6061'0008, 4), 0U);
  EXPECT_EQ(write(0x1A03, 0, 2, 1), 0U);
  EXPECT_EQ(write(0x1803, 1, 0x0000'0485, 4), 0U);
  EXPECT_EQ(write(0x6060, 0, 8, 1), 0U);
  master.receive(frame(0x000, {0x01, 0x05}));
  master.take();
  master.receive(frame(0x080, {}));
  const auto sent = master.take();
  EXPECT_NE(std::ranges::find(sent, frame(0x485, {0, 0, 0, 0, 8})), sent.end());
}

// Frames beyond the list need not be given to it: they change nothing.
TEST_F(Slave, ListsEveryIdentifierThatItTakes) {
  EXPECT_EQ(write(0x1400, 1, 0x8000'0205, 4), 0U);
  EXPECT_EQ(write(0x1400, 1, 0x0000'0333, 4), 0U);
  EXPECT_EQ(write(0x1016, 1, 0x0021'0064, 4), 0U);  // the heartbeat of node 33
  master.receive(frame(0x000, {0x01, 0x05}));
  std::vector<std::uint32_t> listed;
  master.drive.list_identifiers(listed);
  for (const std::uint32_t id : {0x000U, 0x080U, 0x605U, 0x705U, 0x721U, 0x333U, 0x305U, 0x405U, 0x7E5U})
    EXPECT_NE(std::ranges::find(listed, id), listed.end()) << std::hex << id;
  EXPECT_EQ(std::ranges::find(listed, 0x205U), listed.end());

  master.take();
  const auto before = master.drive.objects().entries();
  for (std::uint32_t id = 0; id < 0x800; ++id) {
    if (std::ranges::find(listed, id) != listed.end()) continue;
    for (int length = 0; length <= 8; ++length) {
      CanFrame other = frame(id, {0x23, 0x40, 0x60, 0, 0x0F, 0, 0, 0});
      other.length = static_cast<std::uint8_t>(length);
      master.receive(other);
      other.remote = true;
      master.receive(other);
    }
  }
  EXPECT_TRUE(master.take().empty());
  for (const auto& [address, entry] : before)
    EXPECT_EQ(master.drive.objects().find(address)->value, entry.value) << text(address);
}

TEST_F(Slave, TellsThatItMayTakeOtherIdentifiers) {
  auto changes = [&, last = master.drive.identifiers_revision()]() mutable {
    return std::exchange(last, master.drive.identifiers_revision()) != last;
  };
  EXPECT_EQ(write(0x6060, 0, 8, 1), 0U);
  EXPECT_FALSE(changes());
  EXPECT_EQ(write(0x1400, 1, 0x8000'0205, 4), 0U);
  EXPECT_TRUE(changes());
  EXPECT_EQ(write(0x1016, 1, 0x0021'0064, 4), 0U);
  EXPECT_TRUE(changes());
  master.receive(frame(0x000, {0x82, 0x05}));
  EXPECT_TRUE(changes());
}

TEST_F(Slave, RefusesRubbishInMappings) {
  EXPECT_EQ(write(0x1A00, 0, 0, 1), 0x0800'0022U) << "the PDO exists";
  EXPECT_EQ(write(0x1800, 1, 0x8000'0185, 4), 0U);
  EXPECT_EQ(write(0x1A00, 1, 0x6041'0010, 4), 0x0601'0000U) << "subindex 0 is not 0";
  EXPECT_EQ(write(0x1A00, 0, 0, 1), 0U);
  EXPECT_EQ(write(0x1A00, 1, 0x5FFF'0010, 4), 0x0602'0000U) << "no such object";
  EXPECT_EQ(write(0x1A00, 1, 0x607D'0520, 4), 0x0609'0011U) << "no such subindex";
  EXPECT_EQ(write(0x1A00, 1, 0x6041'0020, 4), 0x0604'0041U) << "wrong length";
  EXPECT_EQ(write(0x1A00, 1, 0x1008'0020, 4), 0x0604'0041U) << "not to be mapped";
  EXPECT_EQ(write(0x1A00, 0, 9, 1), 0x0609'0031U);
  for (std::uint8_t i = 1; i <= 3; ++i) EXPECT_EQ(write(0x1A00, i, 0x6064'0020, 4), 0U);
  EXPECT_EQ(write(0x1A00, 0, 3, 1), 0x0604'0042U) << "96 bits";
  EXPECT_EQ(write(0x1A00, 0, 4, 1), 0x0609'0030U) << "entry 4 is empty";
  EXPECT_EQ(write(0x1A00, 0, 2, 1), 0U);
  EXPECT_EQ(write(0x1400, 1, 0x8000'0205, 4), 0U);
  EXPECT_EQ(write(0x1600, 0, 0, 1), 0U);
  EXPECT_EQ(write(0x1600, 1, 0x6041'0010, 4), 0x0604'0041U) << "a master cannot write the statusword";
}

TEST_F(Slave, RefusesIdentifiersAndTypesThatAPdoCannotHave) {
  EXPECT_EQ(write(0x1800, 1, 0x0000'0285, 4), 0x0800'0022U) << "another identifier while it exists";
  EXPECT_EQ(write(0x1803, 1, 0x0000'0585, 4), 0x0609'0030U) << "an SDO's";
  EXPECT_EQ(write(0x1803, 1, 0x0000'0000, 4), 0x0609'0030U) << "NMT's";
  EXPECT_EQ(write(0x1803, 1, 0x2000'0485, 4), 0x0609'0030U) << "29 bits";
  EXPECT_EQ(write(0x1803, 2, 245, 1), 0x0609'0030U);
  EXPECT_EQ(write(0x1803, 2, 252, 1), 0x0609'0030U) << "on request only";
  EXPECT_EQ(write(0x1803, 9, 0, 1), 0x0609'0011U);
  EXPECT_EQ(write(0x1404, 1, 0, 4), 0x0602'0000U);
}

TEST_F(Slave, RefusesWritesThatDoNotFit) {
  EXPECT_EQ(write(0x6040, 0, 0, 4), 0x0607'0012U);
  EXPECT_EQ(write(0x6081, 0, 0, 2), 0x0607'0013U);
  EXPECT_EQ(write(0x6041, 0, 0, 2), 0x0601'0002U);
  EXPECT_EQ(write(0x1005, 0, 0x81, 4), 0x0609'0030U);
  EXPECT_EQ(write(0x1016, 1, 0x00FF'0064, 4), 0x0609'0030U) << "node 255";
  EXPECT_EQ(master.read_abort(0x5000, 0), 0x0602'0000U);
  EXPECT_EQ(master.read_abort(0x6040, 1), 0x0609'0011U);
}

TEST_F(Slave, CountsSyncsFromTheStartValue) {
  EXPECT_EQ(write(0x1801, 1, 0x8000'0285, 4), 0U);
  EXPECT_EQ(write(0x1801, 2, 2, 1), 0U);
  EXPECT_EQ(write(0x1801, 6, 3, 1), 0U);
  EXPECT_EQ(write(0x1019, 0, 10, 1), 0U);
  EXPECT_EQ(write(0x1801, 1, 0x0000'0285, 4), 0U);
  master.receive(frame(0x000, {0x01, 0x05}));
  std::vector<int> answered;
  for (int counter = 1; counter <= 8; ++counter) {
    master.take();
    master.receive(frame(0x080, {counter}));
    for (const CanFrame& sent : master.frames) {
      if (sent.id == 0x285) answered.push_back(counter);
    }
  }
  EXPECT_EQ(answered, (std::vector<int>{3, 5, 7}));
}

TEST_F(Slave, ShortPdosAreToldOnce) {
  master.receive(frame(0x000, {0x01, 0x05}));
  master.take();
  for (int i = 0; i < 100; ++i) master.receive(frame(0x205, {0x06}));
  EXPECT_EQ(master.emergencies(), (std::vector<std::uint16_t>{0x8210}));
  EXPECT_EQ(master.object(0x1001), 0x11);
  master.receive(frame(0x205, {0x06, 0x00}));
  EXPECT_EQ(master.object(0x1001), 0);
  master.receive(frame(0x205, {0x06}));
  EXPECT_EQ(master.emergencies(), (std::vector<std::uint16_t>{0x8210, 0x0000, 0x8210}));
  EXPECT_EQ(master.object(0x1003, 0), 2);
}

TEST_F(Slave, ReportsASyncOfWrongLengthOnceUntilOneIsCorrect) {
  master.receive(frame(0x000, {0x01, 0x05}));
  master.take();
  for (int i = 0; i < 100; ++i) master.receive(frame(0x080, {0x01}));
  EXPECT_EQ(master.emergencies(), (std::vector<std::uint16_t>{0x8240}));
  EXPECT_EQ(master.object(0x1001), 0x11);
  EXPECT_EQ(std::ranges::count(master.frames, 0x285U, &CanFrame::id), 100) << "the frame still counts as a SYNC";
  master.take();
  master.receive(frame(0x080, {}));
  EXPECT_EQ(master.emergencies(), (std::vector<std::uint16_t>{0x0000}));
  EXPECT_EQ(master.object(0x1001), 0);
  EXPECT_EQ(write(0x1019, 0, 10, 1), 0U);
  master.take();
  master.receive(frame(0x080, {}));
  master.receive(frame(0x080, {0, 0, 0, 0, 0, 0, 0, 0}));
  master.receive(frame(0x080, {0x01}));
  EXPECT_EQ(master.emergencies(), (std::vector<std::uint16_t>{0x8240, 0x0000}));
}

TEST_F(Slave, SendsATpdoOnRequestIfItAllowsRtr) {
  CanFrame request = frame(0x285, {});
  request.remote = true;
  master.receive(request);
  EXPECT_EQ(std::ranges::count(master.take(), 0x285U, &CanFrame::id), 0) << "not operational";
  master.receive(frame(0x000, {0x01, 0x05}));
  std::vector<std::uint32_t> listed;
  master.drive.list_identifiers(listed);
  EXPECT_NE(std::ranges::find(listed, 0x285U), listed.end());
  master.take();
  master.receive(request);
  const Frames answer = master.take();
  ASSERT_EQ(answer.size(), 1U);
  EXPECT_EQ(answer[0].id, 0x285U);
  EXPECT_EQ(answer[0].length, 6);
  EXPECT_EQ(write(0x1801, 1, 0xC000'0285, 4), 0U);
  EXPECT_EQ(write(0x1801, 1, 0x4000'0285, 4), 0U) << "bit 30: no RTR";
  master.take();
  master.receive(request);
  EXPECT_TRUE(master.take().empty());
}

TEST_F(Slave, ReportsALateRpdo) {
  EXPECT_EQ(write(0x1400, 5, 50, 2), 0U);
  master.receive(frame(0x000, {0x01, 0x05}));
  master.take();
  master.run(200ms);
  EXPECT_TRUE(master.emergencies().empty()) << "the timer starts with the first RPDO";
  for (int i = 0; i < 5; ++i) {
    master.receive(frame(0x205, {0x06, 0x00}));
    master.run(40ms);
  }
  EXPECT_TRUE(master.emergencies().empty());
  master.run(200ms);
  EXPECT_EQ(master.emergencies(), (std::vector<std::uint16_t>{0x8250}));
  EXPECT_EQ(master.object(0x1001), 0x11);
  master.receive(frame(0x205, {0x06, 0x00}));
  EXPECT_EQ(master.emergencies(), (std::vector<std::uint16_t>{0x8250, 0x0000}));
  EXPECT_EQ(master.object(0x1001), 0);
  master.receive(frame(0x000, {0x80, 0x05}));
  master.take();
  master.run(200ms);
  EXPECT_TRUE(master.emergencies().empty()) << "only operational nodes receive RPDOs";
}

TEST_F(Slave, APdoThatIsChangedLeavesTheOthersAsTheyAre) {
  EXPECT_EQ(write(0x1400, 5, 50, 2), 0U);
  master.receive(frame(0x000, {0x01, 0x05}));
  master.receive(frame(0x205, {0x06, 0x00}));
  master.take();
  master.run(30ms);
  EXPECT_EQ(write(0x1801, 3, 100, 2), 0U);
  master.run(30ms);
  EXPECT_EQ(master.emergencies(), (std::vector<std::uint16_t>{0x8250})) << "its timer went on";
  EXPECT_EQ(write(0x1402, 5, 500, 2), 0U);
  EXPECT_EQ(master.object(0x1001), 0x11) << "it is still late";
  EXPECT_EQ(write(0x1400, 5, 0, 2), 0U);
  EXPECT_EQ(master.emergencies(), (std::vector<std::uint16_t>{0x0000})) << "it is watched no more";
  EXPECT_EQ(master.object(0x1001), 0);
}

TEST_F(Slave, AFaultByAStopOrAResetOfCommunicationIsReported) {
  EXPECT_EQ(write(0x6007, 0, 1, 2), 0U) << "lost communication is a fault";
  master.enable();
  master.receive(frame(0x000, {0x02, 0x05}));
  master.run(5ms);  // the drive stops
  EXPECT_EQ(master.drive.state(), Cia402State::fault);
  EXPECT_TRUE(master.emergencies().empty()) << "a stopped node sends none";
  master.receive(frame(0x000, {0x80, 0x05}));
  EXPECT_EQ(master.object(0x1001), 0x11);
  EXPECT_EQ(master.object(0x1003, 1) & 0xFFFF, 0x8130);
  master.control(0x80);
  EXPECT_EQ(master.object(0x1001), 0);
  master.enable();
  master.take();
  master.receive(frame(0x000, {0x82, 0x05}));
  EXPECT_EQ(master.emergencies(), (std::vector<std::uint16_t>{0x8130}));
  EXPECT_EQ(master.object(0x1001), 0x11);
}

TEST_F(Slave, ResetCommunicationKeepsTheParametersOfTheDrive) {
  EXPECT_EQ(write(0x6081, 0, 1234, 4), 0U);
  EXPECT_EQ(write(0x6060, 0, 1, 1), 0U);
  EXPECT_EQ(write(0x1017, 0, 100, 2), 0U);
  EXPECT_EQ(write(0x1400, 1, 0x8000'0205, 4), 0U);
  master.receive(frame(0x000, {0x82, 0x05}));
  EXPECT_EQ(master.frames.back(), frame(0x705, {0x00}));
  EXPECT_EQ(master.object(0x6081), 1234);
  EXPECT_EQ(master.object(0x6061), 1);
  EXPECT_EQ(master.object(0x1017), 0);
  EXPECT_EQ(master.object(0x1400, 1), 0x205);
  master.receive(frame(0x000, {0x81, 0x05}));
  EXPECT_NE(master.object(0x6081), 1234);
  EXPECT_EQ(master.object(0x6061), 0);
}

TEST_F(Slave, StoresParametersOnCommandUntilTheyAreRestored) {
  const std::int64_t usual = master.object(0x6081);
  constexpr std::int64_t kSaveWord = 0x6576'6173;
  constexpr std::int64_t kLoadWord = 0x6461'6F6C;
  EXPECT_EQ(write(0x6081, 0, 1234, 4), 0U);
  EXPECT_EQ(write(0x1017, 0, 100, 2), 0U);
  EXPECT_EQ(write(0x607A, 0, 77, 4), 0U);
  EXPECT_EQ(write(0x1010, 1, 1, 4), 0x0800'0020U) << "no signature";
  EXPECT_EQ(write(0x1010, 1, kSaveWord, 4), 0U);
  EXPECT_EQ(master.object(0x1010, 1), 1) << "reading returns the capability, not the signature";
  master.receive(frame(0x000, {0x81, 0x05}));
  EXPECT_EQ(master.object(0x6081), 1234);
  EXPECT_EQ(master.object(0x1017), 100);
  EXPECT_EQ(master.object(0x607A), 0) << "a target is not a parameter";
  EXPECT_EQ(write(0x1011, 1, kSaveWord, 4), 0x0800'0020U);
  EXPECT_EQ(write(0x1011, 1, kLoadWord, 4), 0U);
  EXPECT_EQ(master.object(0x6081), 1234) << "in force after a reset";
  master.receive(frame(0x000, {0x82, 0x05}));
  EXPECT_EQ(master.object(0x1017), 100) << "of the node, not of its communication";
  master.receive(frame(0x000, {0x81, 0x05}));
  EXPECT_EQ(master.object(0x6081), usual);
  EXPECT_EQ(master.object(0x1017), 0);
}

TEST_F(Slave, SendsEmergenciesWithTheirInhibitTime) {
  EXPECT_EQ(write(0x1015, 0, 200, 2), 0U);  // 20 ms
  master.receive(frame(0x000, {0x01, 0x05}));
  master.run(30ms);
  master.take();
  master.receive(frame(0x205, {0x06}));
  master.receive(frame(0x205, {0x06, 0x00}));
  EXPECT_EQ(master.emergencies(), (std::vector<std::uint16_t>{0x8210}));
  master.run(15ms);
  EXPECT_EQ(master.emergencies().size(), 1U);
  master.run(10ms);
  EXPECT_EQ(master.emergencies(), (std::vector<std::uint16_t>{0x8210, 0x0000}));
}

TEST_F(Slave, HasTheObjectsThatMastersExpect) {
  for (const auto& [index, subindex] :
       {std::pair(0x1006, 0), std::pair(0x1009, 0), std::pair(0x100A, 0), std::pair(0x1010, 1), std::pair(0x1011, 1),
        std::pair(0x1015, 0), std::pair(0x1200, 1), std::pair(0x1200, 2), std::pair(0x6078, 0), std::pair(0x6079, 0),
        std::pair(0x607E, 0), std::pair(0x60FE, 1), std::pair(0x60FE, 2), std::pair(0x60B8, 0)}) {
    EXPECT_EQ(master.read_abort(static_cast<std::uint16_t>(index), static_cast<std::uint8_t>(subindex)), 0U)
        << std::hex << index;
  }
  EXPECT_EQ(master.object(0x1200, 1), 0x605);
  EXPECT_EQ(master.object(0x1200, 2), 0x585);
  EXPECT_EQ(write(0x1006, 0, 10'000, 4), 0U);
  EXPECT_EQ(write(0x1019, 0, 10, 1), 0x0800'0022U) << "the counter cannot change while SYNC has a period";
  EXPECT_EQ(write(0x60B8, 0, 0, 2), 0U);
  EXPECT_EQ(write(0x60B8, 0, 1, 2), 0x0609'0030U) << "there is no touch probe";
  EXPECT_EQ(write(0x607E, 0, 0x80, 1), 0x0609'0030U);
}

TEST_F(Slave, ListsErrorsAndForgetsThemWhenAsked) {
  EXPECT_EQ(master.read_abort(0x1003, 1), 0x0800'0024U) << "no data yet";
  master.receive(frame(0x000, {0x01, 0x05}));
  master.receive(frame(0x205, {0x06}));
  EXPECT_EQ(master.read_abort(0x1003, 1), 0U);
  EXPECT_EQ(write(0x1003, 0, 1, 1), 0x0609'0030U);
  EXPECT_EQ(write(0x1003, 0, 0, 1), 0U);
  EXPECT_EQ(master.object(0x1003, 1), 0);
}

TEST_F(Slave, AnswersNodeGuardingWithATogglingBit) {
  CanFrame request = frame(0x705, {});
  request.remote = true;
  master.take();
  for (const int state : {0x7F, 0xFF, 0x7F}) {
    master.receive(request);
    EXPECT_EQ(master.take(), (Frames{frame(0x705, {state})}));
  }
}

TEST_F(Slave, ANodeWithAHeartbeatIsNotGuarded) {
  CanFrame request = frame(0x705, {});
  request.remote = true;
  EXPECT_EQ(write(0x100C, 0, 50, 2), 0U);
  EXPECT_EQ(write(0x100D, 0, 2, 1), 0U);
  master.receive(request);
  EXPECT_EQ(write(0x1017, 0, 10'000, 2), 0U);
  master.take();
  master.receive(request);
  EXPECT_TRUE(master.take().empty());
  master.run(500ms);
  EXPECT_TRUE(master.emergencies().empty());
}

TEST_F(Slave, LifeGuardingEndsWhereTheMasterIsSilent) {
  EXPECT_EQ(write(0x100C, 0, 50, 2), 0U);
  EXPECT_EQ(write(0x100D, 0, 2, 1), 0U);
  CanFrame request = frame(0x705, {});
  request.remote = true;
  master.receive(request);
  master.take();
  master.run(90ms);
  EXPECT_TRUE(master.emergencies().empty());
  master.run(20ms);
  EXPECT_EQ(master.emergencies(), (std::vector<std::uint16_t>{0x8130}));
  EXPECT_EQ(master.object(0x1001), 0x11);
  master.receive(request);
  EXPECT_EQ(master.emergencies(), (std::vector<std::uint16_t>{0x8130, 0x0000}));
  EXPECT_EQ(master.object(0x1001), 0);
}

TEST_F(Slave, KeepsItsHeartbeatPeriod) {
  EXPECT_EQ(write(0x1017, 0, 20, 2), 0U);
  master.take();
  master.run(100ms);
  EXPECT_EQ(std::ranges::count(master.frames, frame(0x705, {0x7F})), 5);
}

}  // namespace
}  // namespace cellmirror::can

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <limits>

#include "config/cell_file.hpp"
#include "tests/unit/config/temporary_home.hpp"

namespace cellmirror {
namespace {

using testing::HasSubstr;

constexpr const char* kTwoJoints = R"(format = 1
[[node]]
name = "J_1"
joint = { type = "revolute", axis = [0, 0, 1], range_rad = [-1, 1], velocity_rad_s = 1 }
[[node]]
name = "J_2"
parent = "J_1"
joint = { type = "prismatic", axis = [0, 0, 1], range_m = [0, 1], velocity_m_s = 1 }
[robot]
id = "ARM"
flange = "J_2"
)";

struct CellFile : testing::Test {
  CellFile() { home.write("envlib/arm.mpc", kTwoJoints); }
  std::optional<LoadedCell> load(const std::string& text) {
    diagnostics = {};
    return load_cell(home.write("cell.toml", "format = 1\nname = \"c\"\n" + text), diagnostics);
  }
  std::string findings() const { return diagnostics.text(); }
  TemporaryHome home;
  Diagnostics diagnostics;
};

TEST_F(CellFile, hasDefaultsForEverythingButFormatAndName) {
  const auto sut = load("");
  ASSERT_TRUE(sut) << findings();
  EXPECT_EQ(sut->name, "c");
  EXPECT_EQ(sut->loop.rate_hz, 1000.0);
  EXPECT_EQ(sut->loop.real_time, RealTimePolicy::prefer);
  EXPECT_FALSE(sut->dds.enabled);
  EXPECT_FALSE(sut->queues.script_key);
  EXPECT_TRUE(sut->startup_script.empty());
  EXPECT_TRUE(sut->streams.empty());
}

TEST_F(CellFile, isFoundInItsFolder) {
  const std::filesystem::path file = home.write("cell.toml", "format = 1\nname = \"c\"\n");
  const auto sut = load_cell(file.parent_path(), diagnostics);
  ASSERT_TRUE(sut) << findings();
  EXPECT_EQ(sut->name, "c");
  EXPECT_FALSE(load_cell(file.parent_path() / "envlib", diagnostics));
  EXPECT_THAT(findings(), HasSubstr("no cell.toml in this folder"));
}

TEST_F(CellFile, readsGravity) {
  auto sut = load("");
  ASSERT_TRUE(sut) << findings();
  EXPECT_EQ(sut->gravity_m_s2, Eigen::Vector3d(0, 0, -9.80665));
  sut = load("gravity_m_s2 = [1.62, 0, 0]\n");
  ASSERT_TRUE(sut) << findings();
  EXPECT_EQ(sut->gravity_m_s2, Eigen::Vector3d(1.62, 0, 0));
  EXPECT_FALSE(load("gravity_m_s2 = [0, 0]\n"));
  EXPECT_FALSE(load("gravity_m_s2 = [0, 0, -1e6]\n"));
  EXPECT_FALSE(load("gravity_m_s2 = [0, 0, nan]\n"));
  EXPECT_FALSE(load("gravity_m_s2 = -9.8\n"));
}

TEST_F(CellFile, readsFootSwitches) {
  auto sut = load("");
  ASSERT_TRUE(sut) << findings();
  EXPECT_FALSE(sut->foot_switches.key);
  EXPECT_FALSE(sut->foot_switches.online);
  EXPECT_EQ(sut->foot_switches.debounce, std::chrono::milliseconds(10));
  sut = load("[foot_switches]\nkey = 0x57b\nbytes = 2\nmode = \"0660\"\ndebounce_s = 0.025\nonline = true\n");
  ASSERT_TRUE(sut) << findings();
  EXPECT_EQ(sut->foot_switches.key, 1403);
  EXPECT_EQ(sut->foot_switches.bytes, 2U);
  EXPECT_EQ(sut->foot_switches.mode, 0660U);
  EXPECT_EQ(sut->foot_switches.debounce, std::chrono::milliseconds(25));
  EXPECT_TRUE(sut->foot_switches.online);
}

TEST_F(CellFile, readsViewsAndTellsWhatIsWrongWithThem) {
  const auto sut =
      load("[[view]]\nid = 3\nviewpoint_m = [1, 2, 3]\nopening_angle_rad = 0.5\n[[view]]\nid = 0\nnear_m = 0.1\n");
  ASSERT_TRUE(sut) << findings();
  ASSERT_EQ(sut->views.size(), 2U);
  EXPECT_EQ(sut->views[0].id, 3);
  EXPECT_EQ(*sut->views[0].change.viewpoint, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(*sut->views[0].change.opening_angle, 0.5);
  EXPECT_FALSE(sut->views[0].change.lookpoint);
  EXPECT_EQ(*sut->views[1].change.near_distance, 0.1);
  EXPECT_FALSE(load("[[view]]\nid = 7\n"));
  EXPECT_FALSE(load("[[view]]\nviewpoint_m = [1, 2, 3]\n"));
  EXPECT_FALSE(load("[[view]]\nid = 1\nviewpoint_m = [1, 2, 3]\nlookpoint_m = [1, 2, 3]\n"));
  EXPECT_FALSE(load("[[view]]\nid = 1\nnear_m = 2\nfar_m = 1\n"));
  EXPECT_FALSE(load("[[view]]\nid = 1\nopening_angle_rad = 4\n"));
  EXPECT_FALSE(load("[[view]]\nid = 1\nviewpoint_mm = [1, 2, 3]\n"));
}

TEST_F(CellFile, readsHowPicturesAreTaken) {
  auto sut = load("");
  ASSERT_TRUE(sut) << findings();
  EXPECT_TRUE(sut->pictures.on);
  EXPECT_EQ(sut->pictures.rate_hz, 20.0);
  EXPECT_EQ(sut->pictures.width, 640);
  sut = load(
      "[display]\non = false\nrate_hz = 5\nsize = [320, 200]\nrenderer = \"egl\"\nthreads = 0\n[dds_output]\n"
      "picture_topic = \"rt/p\"\npicture_rate_hz = 2\npicture_camera = \"C\"\npicture_size = [16, 4096]\n"
      "picture_quality = 100\n");
  ASSERT_TRUE(sut) << findings();
  EXPECT_FALSE(sut->pictures.on);
  EXPECT_EQ(sut->pictures.rate_hz, 5.0);
  EXPECT_EQ(sut->pictures.width, 320);
  EXPECT_EQ(sut->pictures.height, 200);
  EXPECT_EQ(sut->pictures.renderer, PictureRenderer::egl);
  EXPECT_EQ(sut->pictures.threads, 0);
  EXPECT_EQ(sut->dds.pictures.topic, "rt/p");
  EXPECT_EQ(sut->dds.pictures.rate_hz, 2.0);
  EXPECT_EQ(sut->dds.pictures.camera, "C");
  EXPECT_EQ(sut->dds.pictures.height, 4096);
  EXPECT_EQ(sut->dds.pictures.quality, 100);
  for (const char* wrong : {"rate_hz = 0", "rate_hz = 61", "size = [640]", "size = [15, 480]", "size = [640, 4097]",
                            "size = [640.5, 480]", "renderer = \"gl\"", "threads = -1", "colour = 1"}) {
    EXPECT_FALSE(load("[display]\n" + std::string(wrong) + "\n")) << wrong;
  }
  EXPECT_FALSE(load("[dds_output]\npicture_view = 7\n"));
  EXPECT_FALSE(load("[dds_output]\npicture_view = 1\npicture_camera = \"C\"\n"));
}

TEST_F(CellFile, readsItsSettings) {
  home.write("scripts/start.spt", "# nothing\n");
  const auto sut = load(R"(
[loop]
rate_hz = 250
real_time = "require"
priority = 70
[dds_output]
domain = 3
joint_states_topic = "rt/x"
rate_hz = 20
[queues]
script_key = 5000
mode = "0660"
[web]
port = 9000
[startup]
script = "start"
)");
  ASSERT_TRUE(sut) << findings();
  EXPECT_EQ(sut->loop.rate_hz, 250.0);
  EXPECT_EQ(sut->loop.real_time, RealTimePolicy::require);
  EXPECT_EQ(sut->loop.priority, 70);
  EXPECT_TRUE(sut->dds.enabled) << "a table dds_output switches it on";
  EXPECT_EQ(sut->dds.domain, 3);
  EXPECT_EQ(sut->web.port, 9000);
  EXPECT_EQ(sut->startup_script, "start");
  QueueConfig queues;
  queues.sensor_key = 77;
  sut->queues.apply_to(queues);
  EXPECT_EQ(queues.script_key, 5000);
  EXPECT_EQ(queues.sensor_key, 77) << "the file does not say it";
  EXPECT_EQ(queues.mode, 0660U);
}

TEST_F(CellFile, readsCia402Streams) {
  home.write("robots/drive.eds", "[x]");
  const auto sut = load(R"(
[[node]]
name = "Arm"
abstract = "arm.mpc"
[[stream]]
robot = "ARM"
kind = "can-cia402"
channel = "socketcan:can0"
stale_after_s = 0.05
lost_after_s = 0.5
sync_period_s = 0.01
heartbeat_timeout_s = 0
[[stream.node]]
id = 5
joint = "J_2"
increments_per_m = 1000
sign = -1
offset_m = 0.5
force_n_per_unit = 0.1
[[stream.node]]
id = 4
joint = "J_1"
rad_per_increment = 0.001
eds = "drive.eds"
configure = true
tpdo = [{ number = 1, transmission_type = 1, event_timer_s = 0.01, entries = [{ index = 0x6041, bits = 16 }, { index = 0x6064, bits = 32 }] }]
)");
  ASSERT_TRUE(sut) << findings();
  const auto& stream = std::get<Cia402StreamConfig>(sut->streams.at(0).config);
  EXPECT_EQ(stream.ages.stale_after, std::chrono::milliseconds(50));
  EXPECT_EQ(stream.sync_period, std::chrono::milliseconds(10));
  EXPECT_EQ(stream.heartbeat_timeout.count(), 0);
  EXPECT_EQ(stream.nodes.at(0).joint, 1U);
  EXPECT_EQ(stream.nodes.at(0).scale, 0.001);
  EXPECT_EQ(stream.nodes.at(0).sign, -1.0);
  EXPECT_EQ(stream.nodes.at(0).torque_scale, 0.1);
  EXPECT_EQ(stream.nodes.at(1).eds_file, (home.root() / "robots/drive.eds").string());
  EXPECT_EQ(stream.nodes.at(1).tpdos.at(0).entries.at(1).index, 0x6064);
  EXPECT_EQ(stream.nodes.at(1).tpdos.at(0).event_timer_ms, 10);
}

TEST_F(CellFile, readsWhatIsPlausibleOfAStream) {
  const std::string head =
      "[[node]]\nname = \"Arm\"\nabstract = \"arm.mpc\"\n[[stream]]\nrobot = \"ARM\"\nkind = \"dds\"\n";
  auto sut = load(head + "stale_after_s = 0.2\n");
  ASSERT_TRUE(sut) << findings();
  PlausibilityConfig config = std::get<DdsStreamConfig>(sut->streams.at(0).config).plausibility;
  EXPECT_TRUE(config.enabled);
  EXPECT_EQ(config.arrival_jitter, std::chrono::milliseconds(100)) << "half of stale_after_s";
  EXPECT_EQ(config.frozen_after.count(), 0);
  EXPECT_EQ(config.plausible_after, 10);
  sut = load(head +
             "position_margin = 0\nvelocity_factor = 2\nacceleration_factor = 0\narrival_jitter_s = 0.01\n"
             "frozen_after_s = 3\nplausible_after = 1\n");
  ASSERT_TRUE(sut) << findings();
  config = std::get<DdsStreamConfig>(sut->streams.at(0).config).plausibility;
  EXPECT_EQ(config.position_margin, 0.0);
  EXPECT_EQ(config.velocity_factor, 2.0);
  EXPECT_EQ(config.acceleration_factor, 0.0);
  EXPECT_EQ(config.arrival_jitter, std::chrono::milliseconds(10));
  EXPECT_EQ(config.frozen_after, std::chrono::seconds(3));
  EXPECT_EQ(config.plausible_after, 1);
  EXPECT_FALSE(load(head + "plausibility = false\nvelocity_factor = 2\n"));
  EXPECT_THAT(findings(), testing::HasSubstr("velocity_factor has no effect with plausibility = false"));
  EXPECT_FALSE(load(head + "plausible_after = 0\n"));
}

TEST_F(CellFile, whatTheFilesOfRobotsDoNotSayIsNoBound) {
  const auto sut = load("[[node]]\nname = \"Arm\"\nabstract = \"arm.mpc\"\n");
  ASSERT_TRUE(sut) << findings();
  const RobotModel* robot = sut->cell.robot("ARM");
  ASSERT_NE(robot, nullptr);
  ASSERT_EQ(robot->known_limits().size(), robot->joint_count());
  for (std::size_t i = 0; i < robot->joint_count(); ++i) {
    EXPECT_EQ(robot->known_limits()[i].lower, robot->parameters().min_range[i]);
    EXPECT_EQ(robot->known_limits()[i].upper, robot->parameters().max_range[i]);
    EXPECT_EQ(robot->known_limits()[i].velocity, robot->parameters().max_velocity[i]);
    EXPECT_EQ(robot->known_limits()[i].acceleration, std::numeric_limits<double>::infinity()) << "it is a default";
  }
}

TEST_F(CellFile, readsProtectionsOfMessages) {
  home.write("robots/arm.dbc", "VERSION \"\"\n");
  const std::string head =
      "[[node]]\nname = \"Arm\"\nabstract = \"arm.mpc\"\n[[stream]]\nrobot = \"ARM\"\nkind = \"can-dbc\"\n"
      "channel = \"socketcan:can0\"\ndbc = \"arm.dbc\"\n"
      "[[stream.signal]]\nmessage = \"M\"\nsignal = \"A\"\njoint = \"J_1\"\n[[stream.e2e]]\nmessage = \"M\"\n";
  const auto protection = [&](const std::string& text) {
    const auto sut = load(head + text);
    EXPECT_TRUE(sut) << findings();
    return sut ? std::get<DbcStreamConfig>(sut->streams.at(0).config).protections.at(0) : E2eConfig();
  };
  const E2eConfig p01 = protection("profile = \"p01\"\ndata_id = 0x123\ndata_id_mode = \"nibble\"\nmax_delta = 3\n");
  EXPECT_EQ(p01.message, "M");
  EXPECT_EQ(p01.profile, E2eProfile::p01);
  EXPECT_THAT(p01.data_id, testing::ElementsAre(0x123));
  EXPECT_EQ(p01.data_id_mode, E2eDataIdMode::nibble);
  EXPECT_EQ(p01.max_delta, 3);
  EXPECT_EQ(p01.place.line, 15);
  EXPECT_EQ(protection("profile = \"p02\"\ndata_ids = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16]\n")
                .data_id.size(),
            16U);
  const E2eConfig described = protection(
      "profile = \"described\"\ncounter = \"C\"\ncrc = \"R\"\ncrc_bits = 16\ncrc_polynomial = 0x1021\n"
      "crc_initial = 0xFFFF\ncrc_xor = 1\ndata_id_bytes = 2\ndata_ids = [7, 8]\ndata_id_first = true\nlast_counter = "
      "14\n");
  EXPECT_EQ(described.counter_signal, "C");
  EXPECT_EQ(described.crc_signal, "R");
  EXPECT_EQ(described.crc.width, 16);
  EXPECT_EQ(described.crc.polynomial, 0x1021);
  EXPECT_EQ(described.crc.initial, 0xFFFF);
  EXPECT_EQ(described.crc.final_xor, 1);
  EXPECT_THAT(described.data_id, testing::ElementsAre(7, 8));
  EXPECT_TRUE(described.data_id_first);
  EXPECT_EQ(described.last_counter, 14);
  for (const char* wrong : {"profile = \"p03\"\n", "profile = \"p01\"\n", "profile = \"p05\"\ndata_id = 65536\n",
                            "profile = \"p02\"\ndata_ids = [1]\n", "profile = \"described\"\n",
                            "profile = \"p05\"\ndata_id = 1\ncounter = \"C\"\n"}) {
    EXPECT_FALSE(load(head + wrong)) << wrong;
  }
}

TEST_F(CellFile, namesJointsThatAStreamGivesNoPositionOf) {
  home.write("robots/arm.dbc", "VERSION \"\"\n");
  const std::string head = "[[node]]\nname = \"Arm\"\nabstract = \"arm.mpc\"\n[[stream]]\nrobot = \"ARM\"\n";
  const std::string dbc = "kind = \"can-dbc\"\nchannel = \"socketcan:can0\"\ndbc = \"arm.dbc\"\n";
  const std::string position = "[[stream.signal]]\nmessage = \"M\"\nsignal = \"A\"\njoint = \"J_1\"\n";
  const std::string velocity =
      "[[stream.signal]]\nmessage = \"M\"\nsignal = \"V\"\njoint = \"J_2\"\nquantity = \"velocity\"\n";
  const auto missing = [&](const std::string& text) {
    const auto sut = load(head + text);
    EXPECT_TRUE(sut) << findings();
    return sut ? sut->streams.at(0).joints_without_position : std::vector<std::string>{"?"};
  };
  EXPECT_THAT(missing(dbc + position + velocity), testing::ElementsAre("J_2"));
  EXPECT_EQ(diagnostics.text(), "") << "whoever mirrors the robot tells it";
  EXPECT_THAT(missing("kind = \"can-cia402\"\nchannel = \"socketcan:can0\"\n"
                      "node = [{ id = 1, joint = \"J_2\", increments_per_m = 1 }]\n"),
              testing::ElementsAre("J_1"));
  EXPECT_THAT(missing("kind = \"dds\"\njoint = [{ joint = \"J_2\" }]\n"), testing::ElementsAre("J_1"));
  EXPECT_THAT(missing("kind = \"dds\"\n"), testing::IsEmpty());
}

TEST_F(CellFile, knowsWhereTheSignalsAndNodesOfStreamsStand) {
  home.write("robots/arm.dbc", "VERSION \"\"\n");
  const std::string head = "[[node]]\nname = \"Arm\"\nabstract = \"arm.mpc\"\n[[stream]]\nrobot = \"ARM\"\n";
  const auto sut = load(head +
                        "kind = \"can-dbc\"\nchannel = \"socketcan:can0\"\ndbc = \"arm.dbc\"\n"
                        "[[stream.signal]]\nmessage = \"M\"\nsignal = \"A\"\njoint = \"J_1\"\nscale = 1\n");
  ASSERT_TRUE(sut) << findings();
  EXPECT_EQ(sut->streams.at(0).place.line, 6);
  const auto& dbc = std::get<DbcStreamConfig>(sut->streams.at(0).config);
  EXPECT_EQ(dbc.place.line, 6);
  EXPECT_EQ(dbc.signals.at(0).message_place.line, 12);
  EXPECT_EQ(dbc.signals.at(0).place.line, 13);
  EXPECT_EQ(dbc.signals.at(0).place.column, 10);
  EXPECT_TRUE(dbc.signals.at(0).scale_given);
  const auto drives = load(head +
                           "kind = \"can-cia402\"\nchannel = \"socketcan:can0\"\n"
                           "[[stream.node]]\nid = 1\njoint = \"J_1\"\nincrements_per_rad = 1\n");
  ASSERT_TRUE(drives) << findings();
  EXPECT_EQ(std::get<Cia402StreamConfig>(drives->streams.at(0).config).nodes.at(0).place.line, 10);
}

TEST_F(CellFile, streamsAreCheckedBesideOtherErrorsAndTheirFindingsAreSortedIn) {
  const std::string text = R"(colour = "red"
[[node]]
name = "Arm"
abstract = "arm.mpc"
[[stream]]
robot = "ARM"
kind = "dds"
[startup]
script = "missing.spt"
)";
  const auto path = home.write("cell.toml", "format = 1\nname = \"c\"\n" + text);
  diagnostics = {};
  EXPECT_FALSE(load_cell(path, diagnostics, {}, [&](const RobotStream& stream, Diagnostics& found) {
    found.error(stream.place, "of the stream of " + stream.robot);
    found.error({"drive.eds", 1, 1}, "of the bus");
  }));
  const std::string told = findings();
  EXPECT_THAT(told, HasSubstr("cell.toml:7:1: error: of the stream of ARM"));
  EXPECT_LT(told.find("cell.toml:3:1"), told.find("cell.toml:7:1"));
  EXPECT_LT(told.find("cell.toml:7:1"), told.find("cell.toml:11:10"));
  EXPECT_THAT(told, HasSubstr("drive.eds:1:1: error: of the bus"));
  EXPECT_EQ(diagnostics.errors(), 4U) << told;
}

TEST_F(CellFile, countersOfContinuousJointsAreMarkedAndMayHaveARange) {
  home.write(
      "envlib/turn.mpc",
      "format = 1\n[[node]]\nname = \"T\"\njoint = { type = \"continuous\", axis = [0, 0, 1], velocity_rad_s = 1 }\n"
      "[[node]]\nname = \"H\"\nparent = \"T\"\n"
      "joint = { type = \"revolute\", axis = [0, 0, 1], range_rad = [-1, 1], velocity_rad_s = 1 }\n"
      "[robot]\nid = \"TURN\"\nflange = \"H\"\n");
  const auto nodes = [&](const std::string& more, const std::string& joint = "T") {
    const auto sut = load(
        "[[node]]\nname = \"Turn\"\nabstract = \"turn.mpc\"\n[[stream]]\nrobot = \"TURN\"\n"
        "kind = \"can-cia402\"\nchannel = \"socketcan:can0\"\n[[stream.node]]\nid = 1\njoint = \"" +
        joint + "\"\nincrements_per_rad = 1000\n" + more);
    return sut ? std::get<Cia402StreamConfig>(sut->streams.at(0).config).nodes : std::vector<Cia402NodeConfig>();
  };
  const auto turning = nodes("position_range_min = 0\nposition_range_max = 3599\n");
  ASSERT_EQ(turning.size(), 1U) << findings();
  EXPECT_TRUE(turning[0].turns);
  EXPECT_EQ(turning[0].range_upper, 3599);
  const auto limited = nodes("", "H");
  ASSERT_EQ(limited.size(), 1U) << findings();
  EXPECT_FALSE(limited[0].turns);
  EXPECT_TRUE(nodes("position_range_min = 0\n").empty()) << "half of a range";
  EXPECT_TRUE(nodes("position_range_min = 5\nposition_range_max = 5\n").empty());
  EXPECT_TRUE(nodes("position_range_min = 0\nposition_range_max = 3599\n", "H").empty()) << "it has limits";
}

TEST_F(CellFile, channelsHaveTheirForms) {
  home.write("run.log", "(1.0) can0 123#00\n");
  const auto channel = [&](const std::string& endpoint, const std::string& more = "") {
    const auto sut = load(
        "[[node]]\nname = \"Arm\"\nabstract = \"arm.mpc\"\n[[stream]]\nrobot = \"ARM\"\n"
        "kind = \"can-cia402\"\nchannel = \"" +
        endpoint + "\"\n" + more + "node = [{ id = 1, joint = \"J_1\", increments_per_rad = 1 }]\n");
    return sut ? std::get<Cia402StreamConfig>(sut->streams[0].config).channel.endpoint : std::string();
  };
  EXPECT_EQ(channel("udp:239.74.163.2:43113"), "udp:239.74.163.2:43113");
  EXPECT_EQ(channel("udp:[ff15::1]:43113"), "udp:[ff15::1]:43113");
  EXPECT_EQ(channel("log:run.log", "log_repeat = true\n"), "log:" + (home.root() / "run.log").string());
  for (const char* faulty :
       {"", "can0", "socketcan:", "socketcan:a/b", "socketcan:0123456789abcdef", "udp:127.0.0.1:1", "udp:239.74.163.2",
        "udp:239.74.163.2:0", "udp:[::1]:5", "log:", "log:missing.log", "log:../x", "log:scripts", "tcp:1.2.3.4:5"}) {
    EXPECT_EQ(channel(faulty), "") << faulty;
    EXPECT_EQ(diagnostics.errors(), 1U) << faulty << "\n" << findings();
  }
}

TEST_F(CellFile, tenErrorsInSeveralFilesAreTenFindings) {
  home.write("envlib/faulty.mpc", "format = 1\n[[node]]\nname = \"A\"\nxyz_m = [0, 0]\n[[node]]\nname = \"A\"\n");
  EXPECT_FALSE(load(R"(
colour = "red"
[[node]]
name = "Arm"
abstract = "arm.mpc"
[[node]]
name = "Bad"
abstract = "faulty.mpc"
[[node]]
name = "Gone"
abstract = "gone.mpc"
[[node]]
name = "Lost"
predecessor = "Arm.J_9"
[loop]
rate_hz = 5000
real_time = "sometimes"
[[stream]]
robot = "ARMM"
kind = "dds"
[[stream]]
robot = "ARM"
kind = "dds"
topic = 5
[startup]
script = "missing.spt"
)"));
  EXPECT_EQ(diagnostics.errors(), 10U) << findings();
  for (const char* expected :
       {"cell.toml:4:1: error: the key colour", "cell.toml:13:12: error: the file envlib/gone.mpc",
        "cell.toml:14:1: error: there is no", "cell.toml:18:11: error: [loop]: rate_hz is 5000",
        "cell.toml:19:13: error: [loop]: real_time cannot be \"sometimes\"",
        "cell.toml:21:9: error: stream of ARMM: there is no robot ARMM; did you mean ARM?",
        "cell.toml:26:9: error: stream of ARM: topic must be a text", "cell.toml:28:10: error",
        "faulty.mpc:4:9: error: node A: xyz_m", "faulty.mpc:6:8: error: node A: there is another node A"}) {
    EXPECT_THAT(findings(), HasSubstr(expected));
  }
}

TEST_F(CellFile, refusesWhatIsNoReadableFile) {
  const auto refused = [&](const std::filesystem::path& path) {
    Diagnostics found;
    EXPECT_FALSE(load_cell(path, found));
    EXPECT_EQ(found.errors(), 1U);
    return found.text();
  };
  EXPECT_THAT(refused(home.root() / "none.toml"), HasSubstr("No such file"));
  EXPECT_THAT(refused(home.root()), HasSubstr("no cell.toml in this folder"));
  EXPECT_THAT(refused(home.write("noise.toml", std::string("\xff\xfe\x00\x01", 4))), HasSubstr("noise.toml"));
}

TEST_F(CellFile, pathsDoNotLeaveTheHome) {
  EXPECT_FALSE(
      load("[[node]]\nname = \"A\"\nabstract = \"../../other.mpc\"\n[[node]]\nname = \"B\"\n"
           "abstract = \"/etc/passwd\"\n[[node]]\nname = \"C\"\nabstract = \"meshes\"\n"));
  EXPECT_EQ(diagnostics.errors(), 3U) << findings();
}

TEST_F(CellFile, filesOfHiddenComponentsAreCheckedButNotKept) {
  home.write("envlib/later.mpc", "format = 1\nkey = 1\n");
  EXPECT_FALSE(load("[[node]]\nname = \"A\"\nabstract = \"later.mpc\"\nshown = \"hidden\"\n"));
  EXPECT_THAT(findings(), HasSubstr("later.mpc:2:1"));
  home.write("envlib/later.mpc", "format = 1\n[[node]]\nname = \"X\"\n");
  auto sut = load("[[node]]\nname = \"A\"\nabstract = \"later.mpc\"\nshown = \"hidden\"\n");
  ASSERT_TRUE(sut) << findings();
  EXPECT_FALSE(sut->cell.knows("A.X"));
  home.write("envlib/later.mpc", "format = 1\n[[node]]\nname = \"Y\"\n");
  ASSERT_TRUE(sut->cell.activate("A"));
  EXPECT_TRUE(sut->cell.knows("A.Y")) << "read again, because it was not kept";
  home.write("envlib/later.mpc", "format = 1\nkey = 1\n");
  ASSERT_TRUE(sut->cell.delete_node("A"));
  const auto refused = sut->cell.activate("A");
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().what, HasSubstr("later.mpc:2:1"));
}

TEST_F(CellFile, componentsThatContainEachOtherAreFoundWhenLoaded) {
  home.write("envlib/a.mpc", "format = 1\n[[node]]\nname = \"B\"\nabstract = \"b.mpc\"\n");
  home.write("envlib/b.mpc", "format = 1\n[[node]]\nname = \"A\"\nabstract = \"a.mpc\"\n");
  EXPECT_FALSE(load("[[node]]\nname = \"A\"\nabstract = \"a.mpc\"\n"));
  EXPECT_THAT(findings(), HasSubstr("would contain itself"));
}

TEST_F(CellFile, componentsThatMultiplyAreStopped) {
  for (int i = 0; i < 30; ++i) {
    std::string text = "format = 1\n";
    for (int k = 0; k < 4; ++k) {
      text += "[[node]]\nname = \"N" + std::to_string(k) + "\"\nabstract = \"m" + std::to_string(i + 1) + ".mpc\"\n";
    }
    home.write("envlib/m" + std::to_string(i) + ".mpc", text);
  }
  home.write("envlib/m30.mpc", "format = 1\n");
  EXPECT_FALSE(load("[[node]]\nname = \"A\"\nabstract = \"m0.mpc\"\n"));
  EXPECT_THAT(findings(), HasSubstr("more than 20000 nodes"));
}

TEST_F(CellFile, aUrdfMayStandWhereAComponentMay) {
  home.write("robots/r.urdf",
             "<robot name=\"u\"><link name=\"a\"/><link name=\"b\"/><joint name=\"j\" type=\"continuous\">"
             "<parent link=\"a\"/><child link=\"b\"/><limit velocity=\"1\" effort=\"1\"/></joint></robot>");
  auto sut = load("[[node]]\nname = \"U\"\nabstract = \"r.urdf\"\nrobot_id = \"URDF_1\"\nrobot_flange = \"a\"\n");
  ASSERT_TRUE(sut) << findings();
  const RobotModel* robot = sut->cell.robot("URDF_1");
  ASSERT_NE(robot, nullptr);
  EXPECT_EQ(sut->cell.path(robot->flange()), "U.a");
  EXPECT_FALSE(load("[[node]]\nname = \"U\"\nabstract = \"r.urdf\"\nrobot_flange = \"c\"\n"));
}

TEST_F(CellFile, theHomeMayBeGivenByTheEnvironment) {
  const TemporaryHome other;
  other.write("envlib/there.mpc", "format = 1\n");
  setenv("kis_home", other.root().c_str(), 1);
  EXPECT_TRUE(load("[[node]]\nname = \"A\"\nabstract = \"there.mpc\"\n")) << findings();
  unsetenv("kis_home");
  EXPECT_FALSE(load("[[node]]\nname = \"A\"\nabstract = \"there.mpc\"\n"));
}

// 200 components, 20 of them robots, each of a file of its own.
TEST_F(CellFile, aLargeCellLoadsInUnderTwoSeconds) {
  std::string cell;
  for (int i = 0; i < 200; ++i) {
    const std::string n = std::to_string(i);
    std::string text = "format = 1\ngeometry = [{ box_m = [1, 1, 1] }]\n";
    for (int k = 0; k < 10; ++k) {
      const std::string m = std::to_string(k);
      text += "[[node]]\nname = \"N" + m + "\"\nxyz_m = [0, 0, 0.1]\n" +
              (k == 0 ? "" : "parent = \"N" + std::to_string(k - 1) + "\"\n") +
              "geometry = [{ box_m = [0.1, 0.1, 0.1] }, { sphere_m = 0.2, xyz_m = [0, 0, 0.1] }]\n";
      if (i < 20 && k < 7)
        text += "joint = { type = \"revolute\", axis = [0, 0, 1], range_rad = [-3, 3], velocity_rad_s = 1 }\n";
    }
    if (i < 20) text += "[robot]\nid = \"R" + n + "\"\nflange = \"N9\"\n";
    home.write("envlib/c" + n + ".mpc", text);
    cell += "[[node]]\nname = \"C" + n + "\"\nabstract = \"c" + n + ".mpc\"\nxyz_m = [" + n + ", 0, 0]\n";
  }
  const auto start = std::chrono::steady_clock::now();
  const auto sut = load(cell);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  ASSERT_TRUE(sut) << findings();
  EXPECT_EQ(sut->cell.robot_ids().size(), 20U);
  EXPECT_EQ(sut->cell.node_count(), 2201U);
  EXPECT_LT(took.count(), 2.0);
}

TEST(CheckFile, knowsItsKinds) {
  EXPECT_TRUE(is_checkable("a/b.MPC"));
  EXPECT_FALSE(is_checkable("a.spt"));
  Diagnostics diagnostics;
  check_file("a.spt", diagnostics);
  EXPECT_EQ(diagnostics.errors(), 1U);
}

}  // namespace
}  // namespace cellmirror

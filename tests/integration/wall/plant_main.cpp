// Publishes the summaries of many gateways on DDS from one process: wall_plant CELLS ROBOTS RATE_HZ DOMAIN. Obeys lines
// of standard input, "WORD CELL [TEXT]", and ends with it; cells count from 1 and are called cell_001, ...
//   fault N WHY     ok N          quiet N (sends no more)   close N (its writer is closed)   start N (again, another
//   run) call N NAME     host N NAME   version N NUMBER          clock N SECONDS                  flood N PER_SECOND
//   raw N TEXT      touch N       gap N COUNT               jpeg N FILE (once, on rt/cell_N/picture)
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iterator>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "drivers/dds/image_output.hpp"
#include "drivers/dds/summary_output.hpp"
#include "ipc/wire/cell_summary_text.hpp"
#include "rt_core/base/time.hpp"

namespace {

using namespace cellmirror;

constexpr long kStep_ns = 5'000'000;

struct PlantCell {
  CellSummary summary;
  std::unique_ptr<SummaryOutput> output;
  std::unique_ptr<ImageOutput> pictures;
  bool quiet = false;
  double clock_s = 0;
  double flood_hz = 0;
  double flood_due = 0;
  Timestamp next;
};

class Plant {
 public:
  Plant(int cells, int robots, double rate_hz, int domain) : rate_hz_(rate_hz) {
    config_.enabled = true;
    config_.domain = domain;
    for (int i = 1; i <= cells; ++i) cells_.push_back(make(i, robots));
  }

  bool open() {
    for (PlantCell& cell : cells_) {
      auto made = dds::make_summary_output(config_);
      if (!made) {
        std::fprintf(stderr, "%s\n", made.error().text().c_str());
        return false;
      }
      cell.output = std::move(*made);
    }
    return true;
  }

  void step(Timestamp now) {
    for (PlantCell& cell : cells_) {
      if (cell.output == nullptr || cell.quiet) continue;
      if (now >= cell.next) {
        cell.next = std::max(cell.next + Nanoseconds(static_cast<std::int64_t>(1e9 / rate_hz_)), now);
        publish(cell, now);
      }
      cell.flood_due += cell.flood_hz * 1e-9 * static_cast<double>(kStep_ns);
      for (; cell.flood_due >= 1; cell.flood_due -= 1) publish(cell, now);
    }
  }

  void obey(const std::string& line) {
    std::istringstream in(line);
    std::string word;
    std::size_t number = 0;
    in >> word >> number >> std::ws;
    std::string text;
    std::getline(in, text);
    if (number < 1 || number > cells_.size()) return;
    PlantCell& cell = cells_[number - 1];
    if (word == "fault") {
      cell.summary.health = CellHealth::fault;
      cell.summary.reasons = {text};
    } else if (word == "ok") {
      cell.summary.health = CellHealth::ok;
      cell.summary.reasons = {};
    } else if (word == "touch") {
      cell.summary.health = CellHealth::attention;
      cell.summary.reasons = {"bodies touch"};
      cell.summary.touching = 1;
      cell.summary.touching_pairs = {{"robot_1/gripper", "table"}};
    } else if (word == "quiet") {
      cell.quiet = true;
    } else if (word == "close") {
      cell.output.reset();
    } else if (word == "start") {
      auto made = dds::make_summary_output(config_);
      if (made) cell.output = std::move(*made);
      cell.quiet = false;
      cell.summary.run += "+";
      cell.summary.sequence = 0;
    } else if (word == "call") {
      cell.summary.cell = text;
    } else if (word == "host") {
      cell.summary.host = text;
    } else if (word == "version") {
      cell.summary.version = std::atoi(text.c_str());
    } else if (word == "clock") {
      cell.clock_s = std::atof(text.c_str());
    } else if (word == "flood") {
      cell.flood_hz = std::atof(text.c_str());
    } else if (word == "gap") {
      cell.summary.sequence += static_cast<std::uint64_t>(std::atoll(text.c_str()));
    } else if (word == "raw" && cell.output != nullptr) {
      cell.output->publish(cell.summary, text);
    } else if (word == "jpeg") {
      picture(cell, number, text);
    }
    std::printf("done %s\n", line.c_str());
    std::fflush(stdout);
  }

 private:
  static PlantCell make(int number, int robots) {
    PlantCell cell;
    CellSummary& summary = cell.summary;
    summary.cell = fmt::format("cell_{:03}", number);
    summary.host = fmt::format("host-{:03}", number);
    summary.instance = "default";
    summary.run = fmt::format("{}-{}", getpid(), number);
    summary.loop = {.rate_hz = 1000, .missed = 0, .faults = 0, .on_time = true};
    for (int i = 1; i <= robots; ++i)
      summary.robots.push_back(
          {.id = fmt::format("robot_{}", i), .mirrored = true, .state = DataState::fresh, .age_s = 0.004});
    summary.nearest = NearestPair{{"robot_1/forearm", "robot_2/gripper"}, 0.25};
    summary.page_port = 8420;
    return cell;
  }

  void publish(PlantCell& cell, Timestamp now) {
    CellSummary& summary = cell.summary;
    ++summary.sequence;
    summary.time_ns = to_wall_clock_ns(now) + static_cast<std::int64_t>(1e9 * cell.clock_s);
    summary.uptime_s = static_cast<double>(summary.sequence) / rate_hz_;
    summary.nearest->distance_m = 0.25 + 0.1 * std::sin(static_cast<double>(summary.sequence));
    for (RobotSummary& robot : summary.robots) robot.age_s = 0.004 + 1e-3 * static_cast<double>(summary.sequence % 5);
    cell.output->publish(summary, cell_summary_text(summary));
  }

  void picture(PlantCell& cell, std::size_t number, const std::string& file) {
    if (cell.pictures == nullptr) {
      DdsOutputConfig config = config_;
      config.pictures.topic = fmt::format("rt/cell_{}/picture", number);
      auto made = dds::make_image_output(config);
      if (!made) return;
      cell.pictures = std::move(*made);
    }
    std::ifstream in(file, std::ios::binary);
    EncodedImage image;
    image.bytes.assign(std::istreambuf_iterator<char>(in), {});
    image.posture_time = SystemClock().now();
    cell.pictures->publish_image(image);
  }

  double rate_hz_;
  DdsOutputConfig config_;
  std::vector<PlantCell> cells_;
};

// False: standard input has ended.
bool obey_lines(Plant& plant, std::string& rest) {
  pollfd input{STDIN_FILENO, POLLIN, 0};
  if (::poll(&input, 1, 0) <= 0) return true;
  std::array<char, 65'536> bytes{};
  const ssize_t got = ::read(STDIN_FILENO, bytes.data(), bytes.size());
  if (got <= 0) return false;
  rest.append(bytes.data(), static_cast<std::size_t>(got));
  for (std::size_t end = rest.find('\n'); end != std::string::npos; end = rest.find('\n')) {
    plant.obey(rest.substr(0, end));
    rest.erase(0, end + 1);
  }
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) return 2;
  Plant plant(std::atoi(argv[1]), std::atoi(argv[2]), std::atof(argv[3]), std::atoi(argv[4]));
  if (!plant.open()) return 1;
  std::printf("ready\n");
  std::fflush(stdout);
  const SystemClock clock;
  std::string rest;
  while (obey_lines(plant, rest)) {
    plant.step(clock.now());
    const timespec step{0, kStep_ns};
    nanosleep(&step, nullptr);
  }
  return 0;
}

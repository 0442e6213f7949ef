#include "app/new_cell/questions.hpp"

#include <functional>
#include <optional>
#include <sstream>
#include <string>
#include <system_error>
#include <vector>

#include "rt_core/base/dds_topic.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror::app {

namespace fs = std::filesystem;

namespace {

constexpr int kMostTries = 5;

std::vector<std::string> words_of(const std::string& line) {
  std::istringstream in(line);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

class Interview {
 public:
  Interview(std::istream& in, std::ostream& out) : in_(in), out_(out) {}

  // Asks until `take` returns nothing; else what is wrong with the answer.
  bool ask(const std::string& question, const std::function<std::string(const std::string&)>& take) {
    for (int i = 0; i < kMostTries; ++i) {
      out_ << question << ": " << std::flush;
      std::string line;
      if (!std::getline(in_, line)) return false;
      const std::string wrong = take(std::string(trimmed(line)));
      if (wrong.empty()) return true;
      out_ << "  " << wrong << "\n";
    }
    return false;
  }

 private:
  std::istream& in_;
  std::ostream& out_;
};

std::string file_problem(const std::string& name) {
  std::error_code error;
  return fs::is_regular_file(name, error) ? std::string() : "there is no file " + printable(name);
}

std::string take_numbers(const std::string& answer, std::array<double, 3>& values) {
  const std::vector<std::string> words = words_of(answer);
  if (words.empty()) return {};
  std::array<double, 3> read{};
  for (std::size_t i = 0; i < 3 && words.size() == 3; ++i) {
    const auto value = parse_number(words[i]);
    if (!value) return "\"" + printable(words[i]) + "\" is not a number";
    read[i] = *value;
  }
  if (words.size() != 3) return "three numbers, e.g. 0 0 0.8";
  values = read;
  return {};
}

std::string take_nodes(const std::string& answer, std::vector<std::uint8_t>& nodes) {
  std::vector<std::uint8_t> read;
  for (const std::string& word : words_of(answer)) {
    const auto id = parse_integer(word);
    if (!id || *id < 1 || *id > 127) return "\"" + printable(word) + "\" is not a node id; they are 1 to 127";
    read.push_back(static_cast<std::uint8_t>(*id));
  }
  if (read.empty()) return "at least one, e.g. 1 2 3";
  nodes = std::move(read);
  return {};
}

bool ask_for_drives(NewCellRequest& request, Interview& interview) {
  const auto take_eds = [&](const std::string& answer) {
    if (answer.empty()) return std::string();
    const std::string wrong = file_problem(answer);
    if (wrong.empty()) request.eds.emplace_back(answer);
    return wrong;
  };
  if (request.eds.empty() && request.nodes.empty() &&
      !interview.ask("EDS or DCF file of CiA 402 drives on CAN (empty: no drives)", take_eds))
    return false;
  if (request.eds.empty() || !request.nodes.empty()) return true;
  return interview.ask("their CANopen node ids, in the order of the joints",
                       [&](const std::string& answer) { return take_nodes(answer, request.nodes); });
}

}  // namespace

bool ask_for_rest(NewCellRequest& request, Told told, std::istream& in, std::ostream& out) {
  Interview interview(in, out);
  const auto take_urdf = [&](const std::string& answer) {
    const std::string wrong = answer.empty() ? "a cell needs a robot" : file_problem(answer);
    if (wrong.empty()) request.urdf = answer;
    return wrong;
  };
  if (request.urdf.empty() && !interview.ask("URDF of the robot (a file)", take_urdf)) return false;
  const auto take_xyz = [&](const std::string& answer) { return take_numbers(answer, request.xyz_m); };
  if (!told.xyz && !interview.ask("where its base stands, x y z in metres [0 0 0]", take_xyz)) return false;
  if (!ask_for_drives(request, interview)) return false;
  const auto take_dbc = [&](const std::string& answer) {
    const std::string wrong = answer.empty() ? std::string() : file_problem(answer);
    if (wrong.empty()) request.dbc = answer;
    return wrong;
  };
  if (request.dbc.empty() && !interview.ask("DBC file with signals of joints (empty: none)", take_dbc)) return false;
  const bool bus = !request.nodes.empty() || !request.dbc.empty();
  const auto take_channel = [&](const std::string& answer) {
    if (!answer.empty()) request.channel = answer;
    return std::string();
  };
  if (bus && !told.channel && !interview.ask("CAN channel [" + request.channel + "]", take_channel)) return false;
  const auto take_topic = [&](const std::string& answer) {
    if (answer.empty()) return std::string();
    if (!is_ros_topic(dds_topic(answer))) return "\"" + printable(answer) + "\" is not a ROS 2 topic";
    request.topic = answer;
    return std::string();
  };
  const std::string none = bus ? " (empty: as the bus suggests)" : " [/joint_states]";
  return request.topic || interview.ask("ROS 2 topic of the robot's joint states" + none, take_topic);
}

}  // namespace cellmirror::app

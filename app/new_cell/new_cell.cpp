#include "app/new_cell/new_cell.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <set>

#include "app/io/robot_streams.hpp"
#include "app/new_cell/cell_text.hpp"
#include "app/new_cell/drive_source.hpp"
#include "app/new_cell/names.hpp"
#include "app/new_cell/new_folder.hpp"
#include "app/new_cell/robot_source.hpp"
#include "app/new_cell/signal_source.hpp"
#include "app/new_cell/simulation_text.hpp"
#include "drivers/can/dbc/dbc.hpp"
#include "rt_core/base/capacity.hpp"
#include "rt_core/base/counted.hpp"
#include "rt_core/base/dds_topic.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror::app {

namespace fs = std::filesystem;

namespace {

constexpr const char* kUsualTopic = "/joint_states";
constexpr double kFurthestPlace = 1e5;  // m

// ROS 2's way to write it.
std::string ros_name(const std::string& topic) { return dds_topic(topic).substr(2); }

class Planner {
 public:
  Planner(const NewCellRequest& request, Diagnostics& diagnostics) : request_(request), diagnostics_(diagnostics) {}

  std::optional<CellPlan> plan() {
    plan_.name = request_.folder.filename().string();
    plan_.channel = request_.channel;
    auto source = read_robot_source(request_, diagnostics_);
    if (!source) return std::nullopt;
    plan_.files = std::move(source->files);
    PlannedRobot arm = std::move(source->robot);
    if (plan_.name == arm.node) arm.node += "_1";  // the cell's name is that of its own geometry
    std::vector<PlannedRobot> others;
    bool driven = !request_.nodes.empty() && plan_drives(arm, others);
    driven = (!request_.dbc.empty() && plan_signals(arm, driven, others)) || driven;
    if (!driven) {
      arm.topic = ros_name(request_.topic.value_or(kUsualTopic));
      if (!request_.topic)
        guess("The joint values of `{}` come from `{}`, ROS 2's usual topic of joint states.", arm.id, arm.topic);
    }
    plan_.robots.push_back(std::move(arm));
    for (PlannedRobot& other : others) add_made_up(std::move(other));
    if (!diagnostics_.ok()) return std::nullopt;
    guess("The surroundings are a floor that is drawn and touches nothing.");
    add_texts();
    return std::move(plan_);
  }

 private:
  template <class... Values>
  void guess(fmt::format_string<Values...> text, Values&&... values) {
    plan_.guesses.push_back(fmt::format(text, std::forward<Values>(values)...));
  }

  // Whether a bus with so many joints is that of the robot: where nobody said that ROS 2 mirrors it, and the numbers
  // are equal.
  [[nodiscard]] bool is_of_arm(const PlannedRobot& arm, std::size_t joints) const {
    return !request_.topic && joints == arm.joints.size();
  }

  // A robot of its own for axes of which there is no model.
  [[nodiscard]] static PlannedRobot axes(const char* node, const char* id, std::size_t joints) {
    PlannedRobot robot;
    robot.node = node;
    robot.id = id;
    robot.joints = made_up_joints(joints);
    robot.made_up = true;
    return robot;
  }

  // True where the drives are those of the robot.
  bool plan_drives(PlannedRobot& arm, std::vector<PlannedRobot>& others) {
    const std::size_t count = request_.nodes.size();
    if (is_of_arm(arm, count)) {
      arm.drives = read_drive_sources(request_, arm, plan_.files, diagnostics_);
      guess("{} on CAN: those of `{}`, in the order of its joints.", number_of(count, "drive"), arm.id);
      return true;
    }
    PlannedRobot axis = axes("Axis", "AXIS", count);
    axis.drives = read_drive_sources(request_, axis, plan_.files, diagnostics_);
    guess("{} on CAN: a robot of its own, `{}`, since `{}` {}; its model is made up.", number_of(count, "drive"),
          axis.id, arm.id, request_.topic ? "comes from ROS 2" : "has " + number_of(arm.joints.size(), "joint"));
    others.push_back(std::move(axis));
    return false;
  }

  // The same for the signals of the DBC.
  bool plan_signals(PlannedRobot& arm, bool driven, std::vector<PlannedRobot>& others) {
    const std::size_t errors_before = diagnostics_.errors();
    const auto dbc = can::read_dbc(request_.dbc.string(), diagnostics_);
    if (!dbc || diagnostics_.errors() != errors_before) return false;
    GuessedSignals guessed = guess_signals(*dbc);
    const std::string file = add_description(request_.dbc, plan_.files);
    if (guessed.joints == 0) {
      arm.other_signals = std::move(guessed.others);
      guess("No signal of `{}` looks like the position of a joint; they are listed in `cell.toml`.", file);
      return false;
    }
    const bool of_arm = !driven && is_of_arm(arm, guessed.joints);
    if (!of_arm) others.push_back(axes("Axes", "DBC_AXES", guessed.joints));
    PlannedRobot& robot = of_arm ? arm : others.back();
    robot.dbc = file;
    robot.signals = std::move(guessed.signals);
    robot.other_signals = std::move(guessed.others);
    guess("{} of `{}`: positions of joints of `{}`, by their names and units.", number_of(guessed.joints, "signal"),
          file, robot.id);
    return of_arm;
  }

  void add_made_up(PlannedRobot robot) {
    std::set<std::string> nodes{plan_.name};
    std::set<std::string> ids;
    for (const PlannedRobot& other : plan_.robots) {
      nodes.insert(other.node);
      ids.insert(other.id);
    }
    while (nodes.contains(robot.node)) robot.node += "_1";
    while (ids.contains(robot.id)) robot.id += "_1";
    robot.file = lower_case(robot.node) + ".mpc";
    // Beside the robot, not in it.
    constexpr double kApart = 1.0;
    robot.xyz_m =
        plan_.robots.front().xyz_m + Eigen::Vector3d(0.0, -kApart * static_cast<double>(plan_.robots.size()), 0.0);
    plan_.files.push_back({{}, "envlib/" + robot.file, axes_text(robot)});
    plan_.robots.push_back(std::move(robot));
  }

  void add_texts() {
    for (const PlannedRobot& robot : plan_.robots) plan_.files.push_back({{}, motion_file(robot), motion_text(robot)});
    plan_.files.push_back({{}, "cell.toml", cell_text(plan_)});
    plan_.files.push_back({{}, "scripts/startup.spt", startup_text(plan_)});
    plan_.files.push_back({{}, "simulators.txt", simulators_text(plan_)});
    plan_.files.push_back({{}, "README.md", readme_text(plan_)});
  }

  const NewCellRequest& request_;
  Diagnostics& diagnostics_;
  CellPlan plan_;
};

// The folder replaces its temporary name in texts.
Diagnostic renamed(Diagnostic diagnostic, const std::string& from, const std::string& to) {
  for (std::string* text : {&diagnostic.place.file, &diagnostic.message, &diagnostic.remedy}) {
    for (std::size_t at = text->find(from); at != std::string::npos; at = text->find(from, at + to.size()))
      text->replace(at, from.size(), to);
  }
  return diagnostic;
}

// As `cellmirror check` does.
bool check_written(const NewFolder& folder, const NewCellRequest& request, const LoadProgress& progress,
                   Diagnostics& diagnostics) {
  ::unsetenv("kis_home");  // it would take the place of the new folder
  Diagnostics found;
  const bool loaded = load_cell(folder.path() / "cell.toml", found, progress, check_robot_stream).has_value();
  std::error_code error;
  const std::string canonical = fs::canonical(folder.path(), error).string();
  for (const Diagnostic& diagnostic : found.all()) {
    if (diagnostic.severity == Severity::note) continue;  // repairs of meshes: `check` tells them at any time
    diagnostics.add(renamed(renamed(diagnostic, canonical, request.folder.string()), folder.path().string(),
                            request.folder.string()));
  }
  return loaded && found.ok();
}

}  // namespace

Result<void> check_request(const NewCellRequest& request) {
  const std::string name = request.folder.filename().string();
  if (!is_plain_name(name)) {
    return fail(fmt::format("\"{}\" is not a name for a cell", printable(name)),
                fmt::format("1 to {} letters, digits, _ and -", kMaxNameLength));
  }
  if (request.urdf.empty()) return fail("--urdf is missing: the URDF of the robot");
  if (!request.eds.empty() && request.nodes.empty())
    return fail("--node is missing: the CANopen node ids of the drives of --eds", "e.g. --node 1 2 3");
  if (request.eds.size() > 1 && request.eds.size() != request.nodes.size()) {
    return fail(fmt::format("{} files with --eds for {}", request.eds.size(), number_of(request.nodes.size(), "node")),
                "give one file for all, or one for each");
  }
  if (request.nodes.size() > kMaxJointsPerRobot)
    return fail(fmt::format("{} drives, but a robot has at most {} joints", request.nodes.size(), kMaxJointsPerRobot));
  std::set<std::uint8_t> ids;
  for (const std::uint8_t node : request.nodes) {
    if (node < 1 || node > 127) return fail(fmt::format("{} is not a node id", node), "they are 1 to 127");
    if (!ids.insert(node).second) return fail(fmt::format("the node id {} is given twice", node));
  }
  for (const double value : request.xyz_m) {
    if (!std::isfinite(value) || std::fabs(value) > kFurthestPlace) return fail("--xyz is too far", "it is in metres");
  }
  if (request.topic && !is_ros_topic(dds_topic(*request.topic)))
    return fail(fmt::format("\"{}\" is not a ROS 2 topic", printable(*request.topic)), "e.g. /joint_states");
  return {};
}

std::optional<CellPlan> plan_new_cell(const NewCellRequest& request, Diagnostics& diagnostics) {
  return Planner(request, diagnostics).plan();
}

bool write_new_cell(const NewCellRequest& request, const CellPlan& plan, const LoadProgress& progress,
                    Diagnostics& diagnostics) {
  const auto refuse = [&](const Error& error) {
    diagnostics.error({request.folder.string(), 0, 0}, error.what, error.remedy);
    return false;
  };
  auto folder = NewFolder::make(request.folder);
  if (!folder) return refuse(folder.error());
  for (const PlannedFile& file : plan.files) {
    if (const auto added = (*folder)->add(file); !added) return refuse(added.error());
  }
  if (!check_written(**folder, request, progress, diagnostics)) return false;
  const auto placed = (*folder)->put_in_place();
  return placed ? true : refuse(placed.error());
}

}  // namespace cellmirror::app

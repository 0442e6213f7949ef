#include "tests/unit/kinematics/shared_arms.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>
#include <stdexcept>

#include "config/parse.hpp"
#include "rt_core/cell/robot_chain.hpp"

namespace cellmirror {

namespace fs = std::filesystem;

namespace {

fs::path shared_data() {
  if (const char* folder = std::getenv("CELLMIRROR_SHARED_DATA")) return folder;
  const char* source = std::getenv("CELLMIRROR_SOURCE_DIR");
  return fs::path(source == nullptr ? "." : source) / "../shared/data";
}

std::string text_of(const fs::path& file) {
  std::ifstream in(file);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

std::string three(double x, double y, double z) { return fmt::format("{} {} {}", x, y, z); }

}  // namespace

std::vector<SharedArm> shared_arms() {
  std::vector<SharedArm> arms;
  const fs::path folder = shared_data() / "robots";
  std::ifstream list(folder / "robots.json");
  if (!list) return arms;
  for (const auto& arm : nlohmann::json::parse(list)) {
    arms.push_back({arm.at("id"), arm.at("base"), arm.at("tip"), text_of(folder / arm.at("urdf").get<std::string>())});
  }
  return arms;
}

Component component_of_urdf(const std::string& text) {
  Diagnostics diagnostics;
  auto component = parse_urdf(text, "test.urdf", "test.urdf", AnyFile(), diagnostics);
  if (!component || !diagnostics.ok()) throw std::runtime_error(diagnostics.text());
  return std::move(*component);
}

kinematics::Chain chain_of_urdf(const std::string& text, const std::string& base, const std::string& tip) {
  auto chain = chain_between(component_of_urdf(text), base, tip);
  if (!chain) throw std::runtime_error(chain.error().text());
  return std::move(*chain);
}

JointValues random_posture(const kinematics::Chain& chain, std::mt19937_64& random) {
  JointValues q{};
  for (std::size_t i = 0; i < chain.variable_count(); ++i) {
    const bool free = !std::isfinite(chain.lower()[i]);
    const double lower = free ? -std::numbers::pi : chain.lower()[i];
    const double upper = free ? std::numbers::pi : chain.upper()[i];
    q[i] = std::uniform_real_distribution<double>(lower, upper)(random);
  }
  return q;
}

std::string random_urdf(std::size_t links, bool along_axes, std::mt19937_64& random) {
  std::uniform_real_distribution<double> length(-1.0, 1.0);
  const auto pick = [&](std::size_t count) { return std::uniform_int_distribution<std::size_t>(0, count - 1)(random); };
  constexpr const char* kKinds[] = {"fixed", "revolute", "continuous", "prismatic"};
  constexpr const char* kAxes[] = {"1 0 0", "-1 0 0", "0 1 0", "0 -1 0", "0 0 1", "0 0 -1"};
  const auto angle = [&] {
    return along_axes ? (static_cast<double>(pick(4)) - 1.0) * std::numbers::pi / 2 : 3 * length(random);
  };
  std::string text = "<robot name=\"R\">\n<link name=\"L0\"/>\n";
  std::size_t moving = 0;
  for (std::size_t i = 1; i < links; ++i) {
    std::string kind = kKinds[pick(4)];
    if (moving == kMaxJointsPerRobot) kind = "fixed";
    moving += kind == "fixed" ? 0 : 1;
    // Mostly long chains, with branches.
    const std::size_t parent = pick(3) == 0 ? pick(i) : i - 1;
    text += fmt::format(
        "<link name=\"L{}\"/>\n<joint name=\"J{}\" type=\"{}\"><parent link=\"L{}\"/><child link=\"L{}\"/>\n", i, i,
        kind, parent, i);
    const double roll = angle();
    const double pitch = angle();
    const double yaw = angle();
    text += fmt::format("<origin xyz=\"{}\" rpy=\"{}\"/>\n", three(length(random), length(random), length(random)),
                        three(roll, pitch, yaw));
    const Eigen::Vector3d axis = Eigen::Vector3d(length(random), length(random), length(random)).normalized();
    text += fmt::format("<axis xyz=\"{}\"/>\n", along_axes ? kAxes[pick(6)] : three(axis.x(), axis.y(), axis.z()));
    text += "<limit lower=\"-2\" upper=\"1.5\" velocity=\"1\" effort=\"1\"/></joint>\n";
  }
  return text + "</robot>\n";
}

}  // namespace cellmirror

#include "app/owner/io_service.hpp"

#include <fmt/format.h>

#include <span>
#include <utility>
#include <variant>

#include "app/io/node_channels.hpp"
#include "rt_core/base/log.hpp"

namespace cellmirror::app {

namespace {

constexpr Nanoseconds kTryAgainAfter{1'000'000'000};

std::string name_of(const IoNodeConfig& node, const DigitalOutputConfig& output) {
  return fmt::format("I/O node {}, output {}", node.node_id, output.bit);
}

}  // namespace

IoService::IoService(Parts parts, std::vector<IoNodeConfig> nodes, const std::function<void()>& wake) : parts_(parts) {
  for (IoNodeConfig& config : nodes) {
    Node& node = nodes_.emplace_back();
    node.config = std::make_shared<const IoNodeConfig>(std::move(config));
    node.faults = std::make_shared<const FaultTarget>(
        FaultTarget{.channel = node.config->channel.endpoint, .robot = {}, .nodes = {node.config->node_id}});
    node.stream = can::make_cia401_node(*node.config, {node.inputs, node.outputs, wake, node.faults->inlet},
                                        parts_.clock, parts_.channels.find(node.config->channel));
  }
}

IoService::~IoService() {
  for (const Node& node : nodes_) node.stream->close();
}

void IoService::prepare() {
  for (Node& node : nodes_) open(node);
}

void IoService::open(Node& node) {
  node.tried = parts_.clock.now();
  if (auto opened = node.stream->open(can::no_samples()); !opened) {
    if (node.trouble.empty())
      log_warning("io-node", "I/O node {} does not answer yet: {}", node.config->node_id, opened.error().text());
    node.trouble = opened.error().text();
    return;
  }
  node.trouble.clear();
  node.open = true;
}

bool IoService::follow() {
  bool any = false;
  for (Node& node : nodes_) {
    if (!node.open && parts_.clock.now() - node.tried > kTryAgainAfter) open(node);
    const std::uint32_t outputs = node.outputs->read().value.digital;
    const std::uint32_t changed = std::exchange(node.done, outputs) ^ outputs;
    if (changed == 0) continue;
    any = true;
    for (const DigitalOutputConfig& output : node.config->outputs) {
      if ((changed >> output.bit & 1U) == 0) continue;
      ++node.changes;
      carry_out(node, output, (outputs >> output.bit & 1U) != 0);
    }
  }
  return any;
}

void IoService::carry_out(Node& node, const DigitalOutputConfig& output, bool on) {
  const std::string source = name_of(*node.config, output);
  if (const auto* joint = std::get_if<JointOutput>(&output.target)) {
    if (const auto moved = move(*joint, on); !moved) note(*node.refusals, source, moved.error());
    return;
  }
  const auto& commands = std::get<CommandOutput>(output.target);
  const std::string& text = on ? commands.on : commands.off;
  if (text.empty()) return;
  auto answer = [refusals = node.refusals, source](const Result<std::string>& result) {
    if (!result) note(*refusals, source, result.error());
  };
  parts_.runner.execute({text, {.kind = script::CommandSource::Kind::program, .place = source}, std::move(answer)});
}

// The joints before it are commanded to where they are going anyway: MotionTarget names the first joints.
Result<void> IoService::move(const JointOutput& output, bool on) {
  const RobotModel* robot = parts_.cell.robot(output.robot);
  if (robot == nullptr) return std::unexpected(parts_.cell.explain_robot(output.robot));
  JointValues values = parts_.targets.target(output.robot).value_or(parts_.fleet.positions()[robot->slot()]);
  values.at(output.joint) = on ? output.on : output.off;
  MotionTarget target;
  target.mode = TargetMode::joint_abs;
  target.joints = std::span<const double>(values).first(output.joint + 1);
  auto begun = parts_.motion.position(output.robot, target);
  if (!begun) return std::unexpected(begun.error());
  return {};
}

void IoService::note(Refusals& refusals, const std::string& source, const Error& why) {
  ++refusals.count;
  refusals.last = fmt::format("{}: {}", source, why.text());
  log_warning("io-output", "{}", refusals.last);
}

std::vector<IoNodeSnapshot> IoService::snapshots() const {
  std::vector<IoNodeSnapshot> out;
  for (const Node& node : nodes_)
    out.push_back({node.config, node.stream, node.inputs, node.done, node.changes, node.refusals->count,
                   node.refusals->last, node.trouble, node.faults});
  return out;
}

}  // namespace cellmirror::app

#include "app/owner/tissue/tissue_service.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <span>
#include <utility>

#include "app/owner/tissue/effector_geometry.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror::app {

namespace {

constexpr std::string_view kNoObjects = "the cell has no deformable object, so this has no effect";
constexpr std::string_view kNoPool = "no deformable object has a pool, so this has no visible effect";

bool concerns_tool(TissueEffect effect) {
  return effect == TissueEffect::suction || effect == TissueEffect::irrigation;
}

// The settings of the robot, made where there are none yet.
TissueInstrumentSettings& instrument_of(TissueSettings& settings, const RobotModel& robot) {
  auto place = std::ranges::lower_bound(settings.instruments, robot.slot(), {}, &TissueInstrumentSettings::slot);
  if (place == settings.instruments.end() || place->slot != robot.slot())
    place = settings.instruments.insert(place, {.robot = robot.id(), .slot = robot.slot()});
  return *place;
}

const TissueInstrumentSettings* find_instrument(const TissueSettings& settings, const RobotModel& robot) {
  const auto found = std::ranges::find(settings.instruments, robot.slot(), &TissueInstrumentSettings::slot);
  return found == settings.instruments.end() ? nullptr : &*found;
}

// Whether a joint that stays within low..high can make the test true.
bool can_be_true(const InstrumentTrigger& trigger, double low, double high) {
  switch (trigger.test) {
    case InstrumentTest::off:
      return true;
    case InstrumentTest::at_least:
      return high >= trigger.value_1;
    case InstrumentTest::below:
      return low < trigger.value_1;
    case InstrumentTest::within:
      return std::max(low, trigger.value_1) <= std::min(high, trigger.value_2);
    case InstrumentTest::outside:
      return low < trigger.value_1 || high > trigger.value_2;
  }
  return true;
}

}  // namespace

TissueService::TissueService(const Cell& cell, const NameDirectory& names, TissueParts parts)
    : cell_(cell),
      names_(names),
      objects_(std::move(parts.objects)),
      readers_(std::move(parts.readers)),
      port_(parts.port) {
  auto settings = std::make_shared<TissueSettings>();
  for (const TissueObject& object : objects_.all()) settings->objects.push_back({object.name, object.attributes});
  settings->hyper_file = std::move(parts.hyper_file);
  settings->connections = parts.connections;
  settings_ = std::move(settings);
}

Result<const RobotModel*> TissueService::instrument() const {
  const RobotModel* robot = names_.active_robot().empty() ? nullptr : cell_.robot(names_.active_robot());
  if (robot == nullptr) return fail("no robot is active", "activate one with ROBACT <Robot_id>");
  const bool room = settings_->instruments.size() < tissue::kMostInstruments;
  if (!room && find_instrument(*settings_, *robot) == nullptr) {
    return fail(fmt::format("{} robots are instruments already, more cannot act on tissue", tissue::kMostInstruments),
                "use one of those that commands have named");
  }
  return robot;
}

Result<std::string> TissueService::apply(std::vector<tissue::Command> commands,
                                         const std::function<void(TissueSettings&)>& change, std::string remark) {
  if (port_ != nullptr && !objects_.empty() && !commands.empty()) {
    if (auto taken = port_->request(std::move(commands)); !taken) return std::unexpected(std::move(taken.error()));
  }
  if (change) {
    auto changed = std::make_shared<TissueSettings>(*settings_);
    change(*changed);
    settings_ = std::move(changed);
  }
  return objects_.empty() ? std::string(kNoObjects) : std::move(remark);
}

Result<std::string> TissueService::set_attributes(std::string_view object, std::uint16_t mask, std::uint16_t values) {
  const bool all = objects_.means_all(object);
  const auto found = all ? Result<std::size_t>(0) : objects_.find(object);
  if (!found) return std::unexpected(found.error());
  const int index = all ? -1 : static_cast<int>(*found);
  return apply({tissue::SetAttributes{.object = index, .mask = mask, .values = values}}, [&](TissueSettings& settings) {
    const auto concerned = all ? std::span(settings.objects) : std::span(settings.objects).subspan(*found, 1);
    for (TissueObjectSettings& known : concerned)
      known.attributes = static_cast<std::uint16_t>((known.attributes & ~mask) | (values & mask));
  });
}

Result<std::string> TissueService::set_cylinders(std::string_view geometry, const EffectorCylinders& cylinders) {
  const auto robot = instrument();
  if (!robot) return std::unexpected(robot.error());
  const auto compiled = cell_.compile();
  if (auto known = check_effector_geometry(*compiled, *compiled->robot((*robot)->slot()), geometry); !known)
    return std::unexpected(std::move(known.error()));
  InstrumentCylinders asked{.geometry = std::string(geometry),
                            .flags = cylinders.flags,
                            .effector_length_m = cylinders.effector_length_m,
                            .fourth = cylinders.fourth};
  asked.shape.shaft_radius_m = cylinders.shaft_diameter_m / 2;
  asked.shape.effector_radius_m = cylinders.effector_radius_m;
  if (cylinders.effector_length_m > 0) asked.shape.effector_length_m = cylinders.effector_length_m;
  return apply({tissue::SetInstrumentShape{.instrument = static_cast<int>((*robot)->slot()), .shape = asked.shape}},
               [&](TissueSettings& settings) { instrument_of(settings, **robot).cylinders = std::move(asked); });
}

Result<std::string> TissueService::set_connections(std::string_view hyper_file) {
  if (objects_.empty())
    return fail("the cell has no deformable object that could be connected",
                "deformable objects (.mpo files) are placed in the cell file");
  if (!readers_.hyper) return fail(fmt::format("the file {} cannot be read here", printable(hyper_file)));
  auto hyper = readers_.hyper(hyper_file);
  if (!hyper) return std::unexpected(std::move(hyper.error()));
  const std::size_t count = hyper->connections.size();
  return apply({tissue::SetConnections{std::move(hyper->connections)}}, [&](TissueSettings& settings) {
    settings.hyper_file = std::filesystem::path(hyper->file).filename().string();
    settings.connections = count;
  });
}

Result<std::string> TissueService::set_network_shown(bool on) {
  return apply({}, [on](TissueSettings& settings) { settings.network_shown = on; });
}

// The attributes follow, since the simulation may have frozen objects.
Result<std::string> TissueService::reset_model() {
  std::vector<tissue::Command> commands{tissue::ResetModel{}};
  for (std::size_t i = 0; i < settings_->objects.size(); ++i) {
    commands.emplace_back(tissue::SetAttributes{
        .object = static_cast<int>(i), .mask = kAllTissueAttributes, .values = settings_->objects[i].attributes});
  }
  return apply(std::move(commands), {});
}

Result<std::string> TissueService::set_limit(TissueLimit limit, std::uint8_t actions, double value) {
  const bool off = !(value > 0);
  return apply(
      {tissue::SetLimit{.limit = limit, .actions = actions, .value = value}},
      [&](TissueSettings& settings) {
        settings.limits.at(std::to_underlying(limit)) = {off ? std::uint8_t{0} : actions, value};
      },
      off && actions != 0 ? "a limit of 0 is off, whatever the flags are" : "");
}

Result<std::string> TissueService::set_effect(TissueEffect effect, bool on) {
  const TissueEffectSettings& now = settings_->effects.at(std::to_underlying(effect));
  TissueEffectSettings asked{.on = on};
  const RobotModel* robot = nullptr;
  int tool = -1;
  if (concerns_tool(effect)) {
    tool = now.slot;  // what is switched off is the tool that it was switched on with
    if (on) {
      const auto active = instrument();
      if (!active) return std::unexpected(active.error());
      robot = *active;
      asked.slot = tool = static_cast<int>(robot->slot());
      asked.robot = robot->id();
    }
  }
  return apply(
      {tissue::SetEffect{.effect = effect, .on = on, .instrument = tool}},
      [&](TissueSettings& settings) {
        if (robot != nullptr) instrument_of(settings, *robot);  // the simulation has to know where it is
        settings.effects.at(std::to_underlying(effect)) = std::move(asked);
      },
      on ? effect_remark(effect) : std::string());
}

std::string TissueService::effect_remark(TissueEffect effect) const {
  switch (effect) {
    case TissueEffect::pulse:
      return objects_.any(&TissueObject::artery) ? "" : "no deformable object has an artery, so nothing pulses";
    case TissueEffect::bleeding:
      return objects_.any(&TissueObject::blood_vessel) ? "" : "no deformable object has a blood vessel to bleed from";
    case TissueEffect::suction:
      return objects_.any(&TissueObject::pool) ? "" : "no deformable object has a pool, so only smoke is cleared";
    case TissueEffect::pool_ripples:
    case TissueEffect::irrigation:
      return objects_.any(&TissueObject::pool) ? "" : std::string(kNoPool);
  }
  return {};
}

Result<std::string> TissueService::reset_pool() {
  return apply({tissue::ResetPool{}}, {}, objects_.any(&TissueObject::pool) ? "" : std::string(kNoPool));
}

Result<std::string> TissueService::clean_lens() { return apply({tissue::CleanLens{}}, {}); }

Result<std::string> TissueService::set_calculating(bool on) {
  return apply({tissue::SetCalculation{on}}, [on](TissueSettings& settings) { settings.calculating = on; });
}

Result<std::string> TissueService::set_trigger(const InstrumentTrigger& trigger) {
  const auto robot = instrument();
  if (!robot) return std::unexpected(robot.error());
  if (trigger.joint >= (*robot)->joint_count()) {
    return fail(fmt::format("{} has {} joints, none with the number {}", (*robot)->id(), (*robot)->joint_count(),
                            trigger.joint + 1),
                "joints count from 1 in the order of the component file");
  }
  const tissue::InstrumentAction action{.kind = trigger.kind,
                                        .test = trigger.test,
                                        .joint = static_cast<std::uint8_t>(trigger.joint),
                                        .value_1 = trigger.value_1,
                                        .value_2 = trigger.value_2};
  return apply(
      {tissue::SetInstrumentAction{.instrument = static_cast<int>((*robot)->slot()), .action = action}},
      [&](TissueSettings& settings) { instrument_of(settings, **robot).action = action; },
      trigger_remark(trigger, **robot));
}

std::string TissueService::trigger_remark(const InstrumentTrigger& trigger, const RobotModel& robot) const {
  if (trigger.test == InstrumentTest::off) return {};
  const RobotJoint& joint = robot.joints()[trigger.joint];
  const RobotParameters& parameters = robot.parameters();
  const double low = parameters.min_range.at(trigger.joint);
  const double high = parameters.max_range.at(trigger.joint);
  if (trigger.test == InstrumentTest::within && trigger.value_1 > trigger.value_2)
    return "the test is never true: testval1 is more than testval2";
  if (joint.kind != JointKind::continuous && !can_be_true(trigger, low, high)) {
    return fmt::format("the test is never true: {} stays within {} and {}", joint.name, position_text(joint.kind, low),
                       position_text(joint.kind, high));
  }
  const TissueInstrumentSettings* known = find_instrument(*settings_, robot);
  if (trigger.kind == InstrumentKind::clip_applicator && (known == nullptr || !known->clip))
    return fmt::format("no clip is defined for {} yet: ela_clip_def does it", robot.id());
  return {};
}

Result<std::string> TissueService::set_clip(std::string_view file, const Pose& X_TC) {
  const auto robot = instrument();
  if (!robot) return std::unexpected(robot.error());
  if (!readers_.clip) return fail(fmt::format("the file {} cannot be read here", printable(file)));
  auto clip = readers_.clip(file);
  if (!clip) return std::unexpected(std::move(clip.error()));
  clip->X_TC = X_TC;
  return apply({tissue::SetClip{.instrument = static_cast<int>((*robot)->slot()), .clip = *std::move(clip)}},
               [&](TissueSettings& settings) { instrument_of(settings, **robot).clip = {std::string(file), X_TC}; });
}

}  // namespace cellmirror::app

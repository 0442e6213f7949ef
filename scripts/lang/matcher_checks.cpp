// The checks of Matcher beyond one word: names, the robot concerned, values that depend on others.
#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "rt_core/base/text.hpp"
#include "rt_core/base/utf8.hpp"
#include "scripts/lang/command_table.hpp"
#include "scripts/lang/matcher.hpp"
#include "scripts/lang/slots.hpp"
#include "scripts/lang/values.hpp"

namespace cellmirror::script {

namespace {

constexpr Range kSpeedFraction{0, 1};
constexpr Range kFlyAngle{0, 180};

// Slots of the commands whose values depend on each other.
constexpr std::size_t kFlyTypeSlot = slots::fly::kType;
constexpr std::size_t kPlausibilityTokenSlot = slots::tissue_limit::kToken;
constexpr std::size_t kEffectorJointSlot = slots::instrument::kJoint;
constexpr std::size_t kTrackingSwitchSlot = slots::camera_switch::kOn;
constexpr std::size_t kTrackingFrameParameter = 2;
constexpr std::size_t kTestSwitchSlot = slots::tcp_test::kOn;
constexpr std::size_t kFirstTestValue = 1;  // parameters of SET_EXT_TCP_TEST
constexpr std::size_t kLastTestValue = 4;
constexpr std::size_t kFirstViewParameter = 1;  // parameters of STVW: VP to BCP
constexpr std::size_t kLastViewParameter = 6;

bool has_empty_part(std::string_view path) {
  return path.empty() || path.starts_with('.') || path.ends_with('.') || path.find("..") != std::string_view::npos;
}

// Synopses have names in brackets: <name>, (name), [name].
std::string_view without_brackets(std::string_view text) {
  constexpr std::string_view kOpening = "([<";
  constexpr std::string_view kClosing = ")]>";
  if (text.size() < 3) return text;
  const std::size_t kind = kOpening.find(text.front());
  if (kind == std::string_view::npos || text.back() != kClosing[kind]) return text;
  return text.substr(1, text.size() - 2);
}

bool has_control_byte(std::string_view text) {
  return std::any_of(text.begin(), text.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte < 0x20 || byte == 0x7f;
  });
}

}  // namespace

void Matcher::check_commas() {
  for (std::size_t i = 0; i < words_.size(); ++i) {
    const Token& word = words_[i];
    if (word.commas_before == 0) continue;
    if (!form_.commas || i == 0) {
      findings_.error(word.begin, fmt::format("a comma before {} is not allowed here", printable(word.text)),
                      "values are separated by blanks, numbers have a decimal point");
    } else if (word.commas_before > 1) {
      findings_.error(word.begin, fmt::format("there is no value between the commas before {}", printable(word.text)));
    }
  }
}

void Matcher::check_active_robot() {
  if (form_.needs_active_robot) require_active_robot();
}

void Matcher::require_active_robot() {
  if (names_ == nullptr || !names_->active_robot().empty()) return;
  if (check_ != NameCheck::for_execution) {
    findings_.warning(out_.begin(), "no robot is active unless a caller activates one",
                      "activate one first with ROBACT <Robot_id>");
  } else {
    findings_.error(out_.begin(), "no robot is active", "activate one with ROBACT <Robot_id>");
  }
}

void Matcher::check_name(const Parameter& parameter, const Token& word) {
  const bool path = parameter.name_kind == NameKind::frame_node || parameter.name_kind == NameKind::branch;
  // Cameras, sensors and workframes may be given by dotted path too.
  const std::size_t longest = parameter.name_kind == NameKind::robot ? kMaxNameLength : kMaxFramePath;
  if (!word.plain || word.text.size() > longest) {
    if (!check_text(word, parameter.meaning, longest)) return;
  }
  if (path && (names_ == nullptr || parameter.checked_by_host) && has_empty_part(word.text)) {
    findings_.error(word.begin, fmt::format("the path {} has an empty part", printable(word.text)),
                    "names of a path are separated by single dots");
    return;
  }
  if (names_ == nullptr || parameter.checked_by_host || names_->knows(parameter.name_kind, word.text)) return;
  const std::string_view bare = without_brackets(word.text);
  Error why = names_->explain(parameter.name_kind, bare);
  if (bare.size() < word.text.size() && names_->knows(parameter.name_kind, bare)) {
    why = {fmt::format("{} is in brackets, which are only notation of the synopsis", printable(word.text)),
           fmt::format("write {}", printable(bare))};
  }
  const bool may_be_loaded = path || parameter.name_kind == NameKind::volume;
  if (check_ == NameCheck::ahead_after_loading && may_be_loaded) {
    findings_.warning(word.begin, why.what, why.remedy);
  } else {
    findings_.error(word.begin, why.what, why.remedy);
  }
}

bool Matcher::check_text(const Token& word, std::string_view meaning, std::size_t longest) {
  const auto shown = [&] { return printable(word.text); };
  if (word.text.size() > longest) {
    findings_.error(word.begin,
                    fmt::format("the {} {} has {} bytes, more than {}", meaning, shown(), word.text.size(), longest));
  } else if (!word.plain && has_control_byte(word.text)) {
    findings_.error(word.begin, fmt::format("the {} {} contains a control byte", meaning, shown()));
  } else if (!word.plain && !is_utf8(word.text)) {
    findings_.error(word.begin, fmt::format("the {} {} is not UTF-8", meaning, shown()), "save the file as UTF-8");
  } else {
    return true;
  }
  return false;
}

Unit Matcher::unit_of(const Parameter& parameter) const {
  switch (parameter.unit) {
    case Unit::by_fly_type: {
      const std::size_t type = out_.choice(kFlyTypeSlot);
      return type == 0 ? Unit::none : type == 1 ? Unit::mm : Unit::degree;
    }
    case Unit::by_plausibility:
      return plausibility_tokens()[out_.choice(kPlausibilityTokenSlot)].unit;
    case Unit::by_effector_joint:
      return out_.converted() ? parameter.unit : Unit::none;
    default:
      return parameter.unit;
  }
}

Range Matcher::range_of(const Parameter& parameter) const {
  if (parameter.unit != Unit::by_fly_type) return parameter.range;
  const std::size_t type = out_.choice(kFlyTypeSlot);
  return type == 0 ? kSpeedFraction : type == 1 ? parameter.range : kFlyAngle;
}

std::string_view Matcher::robot_concerned() const {
  std::size_t slot = 0;
  for (const Parameter& parameter : form_.parameters) {
    if (parameter.kind == ParameterKind::name && parameter.name_kind == NameKind::robot) return out_.text(slot);
    if (parameter.kind == ParameterKind::joint_list) break;
    slot += parameter.width;
  }
  return names_ == nullptr ? std::string_view{} : names_->active_robot();
}

std::span<const JointKind> Matcher::joint_kinds() const {
  if (names_ == nullptr) return {};
  return names_->joints(robot_concerned());
}

JointKind Matcher::effector_joint_kind() {
  const std::span<const JointKind> kinds = joint_kinds();
  const auto joint = static_cast<std::size_t>(out_.integer(kEffectorJointSlot));
  if (joint == 0 || joint > kinds.size()) {
    out_.set_unconverted();
    return JointKind::revolute;
  }
  return kinds[joint - 1];
}

void Matcher::check_dependencies() {
  if (form_.id == FormId::cam_tracking) {
    const bool on = out_.choice(kTrackingSwitchSlot) == 0;
    const bool given = out_.given(kTrackingFrameParameter);
    if (on && !given) findings_.error(end_, "the target frame <frame_id> is missing", expected());
    if (!on && given) findings_.error(words_.back().begin, "a target frame is given only with on", "omit it");
  }
  if (form_.id == FormId::stvw) {
    bool any = false;
    for (std::size_t i = kFirstViewParameter; i <= kLastViewParameter; ++i) any = any || out_.given(i);
    if (!any) findings_.error(end_, "it gives no value to change", "give VP, LP, TW, VA, FCP or BCP");
  }
  if (form_.id == FormId::set_ext_tcp_test) {
    const bool off_alone = out_.choice(kTestSwitchSlot) != 0 && !out_.given(kFirstTestValue);
    std::size_t value = kFirstTestValue;
    while (value <= kLastTestValue && out_.given(value)) ++value;
    if (value <= kLastTestValue && !off_alone) missing(form_.parameters[value]);
  }
  const bool tool = form_.id == FormId::effects_suction || form_.id == FormId::effects_irrigation;
  if (tool && out_.choice(kOnlySlot) == 0) require_active_robot();
  if (form_.id == FormId::rob_ela_interact && names_ != nullptr) {
    const std::size_t joints = joint_kinds().size();
    if (joints != 0 && out_.integer(kEffectorJointSlot) > static_cast<std::int64_t>(joints)) {
      findings_.error(words_.front().begin, fmt::format("effector joint {} does not exist: {} has {} joints",
                                                        words_.front().text, names_->active_robot(), joints));
    }
  }
}

}  // namespace cellmirror::script

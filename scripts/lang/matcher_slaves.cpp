// MASTER_SLAVE: a list of slaves, each with a list of pairs of joints.
#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "rt_core/base/text.hpp"
#include "scripts/lang/matcher.hpp"
#include "scripts/lang/values.hpp"

namespace cellmirror::script {

namespace {

constexpr std::size_t kMasterSlot = 1;
constexpr std::size_t kCountSlot = 2;

constexpr Parameter kSlave{
    .name = "slave_robot", .meaning = "slave", .kind = ParameterKind::name, .name_kind = NameKind::robot};
constexpr Parameter kDofs{.name = "n_dof",
                          .meaning = "number of joints",
                          .kind = ParameterKind::integer,
                          .range = {1, static_cast<double>(kMaxJointsPerRobot)}};
constexpr Parameter kMasterJoint{.name = "master_joint", .meaning = "joint of the master"};
constexpr Parameter kSlaveJoint{.name = "slave_joint", .meaning = "joint of the slave"};

}  // namespace

void Matcher::match_slaves() {
  const std::string_view master = out_.text(kMasterSlot);
  const auto count = static_cast<std::size_t>(out_.integer(kCountSlot));
  if (count == 0) next_ = words_.size();  // the count was wrong: the rest is ambiguous
  for (std::size_t i = 0; i < count; ++i) {
    if (!match_slave(i, master)) {
      next_ = words_.size();
      return;
    }
  }
}

bool Matcher::match_slave(std::size_t number, std::string_view master) {
  if (next_ == words_.size()) {
    missing(kSlave);
    return false;
  }
  const Token& slave = words_[next_++];
  match_single(kSlave, slave);
  if (slave.text == master) {
    findings_.error(slave.begin, fmt::format("{} cannot be its own slave", printable(slave.text)));
  }
  if (next_ == words_.size()) {
    missing(kDofs);
    return false;
  }
  const bool fine_so_far = findings_.ok();
  match_single(kDofs, words_[next_++]);
  if (fine_so_far && !findings_.ok()) return false;  // without the count the rest is ambiguous
  const auto dofs = static_cast<std::size_t>(out_.integer(out_.size() - 1));
  const std::size_t first_pair = next_;
  for (std::size_t k = 0; k < dofs; ++k) {
    if (words_.size() - next_ < 2) {
      findings_.error(end_, fmt::format("slave {} has {} of {} pairs of joints", number + 1, k, dofs), expected());
      return false;
    }
    for (std::size_t earlier = first_pair + 1; earlier < next_; earlier += 2) {
      if (words_[earlier].text == words_[next_ + 1].text)
        findings_.error(words_[next_ + 1].begin,
                        fmt::format("the joint {} follows more than one joint", printable(words_[earlier].text)));
    }
    match_joint_pair(master, slave.text);
  }
  return true;
}

void Matcher::match_joint_pair(std::string_view master, std::string_view slave) {
  for (const auto& [parameter, robot] : {std::pair(&kMasterJoint, master), std::pair(&kSlaveJoint, slave)}) {
    const Token& word = words_[next_++];
    check_text(word, parameter->meaning, kMaxNameLength);
    check_joint_name(robot, word);
    out_.push(word.text, 0);
  }
}

void Matcher::check_joint_name(std::string_view robot, const Token& word) {
  if (names_ == nullptr || !names_->knows(NameKind::robot, robot)) return;
  const std::vector<std::string> joints = names_->joint_names(robot);
  if (std::find(joints.begin(), joints.end(), word.text) != joints.end()) return;
  std::string remedy = did_you_mean(word.text, joints);
  if (remedy.empty()) {
    for (const std::string& joint : joints) remedy += (remedy.empty() ? "its joints: " : ", ") + joint;
  }
  findings_.error(word.begin, fmt::format("{} has no joint {}", printable(robot), printable(word.text)),
                  std::move(remedy));
}

}  // namespace cellmirror::script

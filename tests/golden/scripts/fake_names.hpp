// The names of the manual's examples, as a directory for tests: every kind with a hash table, as a gateway has them.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "rt_core/base/text.hpp"
#include "scripts/lang/names.hpp"

namespace cellmirror::testing {

struct TextHash {
  using is_transparent = void;
  std::size_t operator()(std::string_view text) const { return std::hash<std::string_view>{}(text); }
};

class FakeNames final : public NameDirectory {
 public:
  FakeNames() {
    using enum JointKind;
    const std::vector<JointKind> arm(6, revolute);
    for (const char* name : {"MANTEC_RM3", "MANTEC_R3", "mantec_R3", "mantec_R3a", "PUMA_762"}) robots[name] = arm;
    robots["TRAEGERSYSTEM"] = {prismatic, prismatic, prismatic};
    robots["ZELLENKRAN"] = {prismatic, revolute, continuous};
    names_[0] = {"Testlab_1",
                 "Testlab_1.FL_Klein",
                 "Testlab_1.FL_Klein.Flansch_Typ1",
                 "Testlab_1.FL_Klein_02",
                 "Testlab_1.FL_Klein_02.Flansch_Typ1",
                 "HTL_UMGEBUNG",
                 "HTL_UMGEBUNG.FL_Klein01",
                 "HTL_UMGEBUNG.FL_Klein02",
                 "Mantec_1.HAND",
                 "Toolbox.Tool1",
                 "Gantry.J_2.Hand"};
    names_[2] = {"UMG_Kamera_1", "CAMERA_5"};
    names_[3] = {"USS_1B", "USS_5"};
    names_[4] = {"Tool1_WFRM"};
    names_[5] = {"Table.Head_CT", "Part_CT"};
  }

  [[nodiscard]] bool knows(NameKind kind, std::string_view name) const override {
    if (kind == NameKind::robot) return robots.contains(name);
    return names_[place(kind)].contains(name);
  }
  [[nodiscard]] Error explain(NameKind kind, std::string_view name) const override {
    constexpr std::array<std::string_view, 6> kKinds = {"frame",  "robot",     "camera",
                                                        "sensor", "workframe", "voxel volume"};
    return {"there is no " + std::string(kKinds[place(kind)]) + " " + printable(name), did_you_mean(name, all(kind))};
  }
  [[nodiscard]] std::span<const JointKind> joints(std::string_view robot) const override {
    const auto found = robots.find(robot);
    return found == robots.end() ? std::span<const JointKind>{} : std::span<const JointKind>(found->second);
  }
  [[nodiscard]] std::vector<std::string> joint_names(std::string_view robot) const override {
    std::vector<std::string> all_names;
    for (std::size_t i = 1; i <= joints(robot).size(); ++i) all_names.push_back("J_" + std::to_string(i));
    return all_names;
  }
  [[nodiscard]] std::string_view active_robot() const override { return active; }
  [[nodiscard]] std::vector<std::string> all(NameKind kind) const override {
    std::vector<std::string> sorted;
    if (kind == NameKind::robot) {
      for (const auto& [name, kinds] : robots) sorted.push_back(name);
    } else {
      const auto& set = names_[place(kind)];
      sorted.assign(set.begin(), set.end());
    }
    std::sort(sorted.begin(), sorted.end());
    return sorted;
  }

  void add(NameKind kind, std::string name) { names_[place(kind)].insert(std::move(name)); }

  std::unordered_map<std::string, std::vector<JointKind>, TextHash, std::equal_to<>> robots;
  std::string active;

 private:
  // Of the cell itself nothing is known here: a branch is that of a frame.
  static std::size_t place(NameKind kind) {
    if (kind == NameKind::volume) return 5;
    return static_cast<std::size_t>(kind == NameKind::branch ? NameKind::frame_node : kind);
  }

  std::array<std::unordered_set<std::string, TextHash, std::equal_to<>>, 6> names_;
};

}  // namespace cellmirror::testing

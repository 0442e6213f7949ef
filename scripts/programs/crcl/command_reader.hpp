// Makes a program of the commands of CRCL, one by one.
#pragma once

#include <string>
#include <vector>

#include "scripts/programs/crcl/fields.hpp"
#include "scripts/programs/crcl/speeds.hpp"
#include "scripts/programs/crcl/xml_tree.hpp"
#include "scripts/programs/program/program_builder.hpp"

namespace cellmirror::crcl {

class CommandReader {
 public:
  CommandReader(program::ProgramBuilder& builder, const std::string& file, Diagnostics& diagnostics)
      : builder_(builder), file_(file), diagnostics_(diagnostics) {}

  // A child of <CRCLProgram>: Name, InitCanon, MiddleCommand, EndCanon.
  void read(const XmlTree& tree);
  // What is missing at the end of the program, which begins at `root`.
  void finish(const Place& root);

 private:
  using Handler = void (CommandReader::*)(const Fields&, const XmlNode&);
  static Handler handler_of(std::string_view type);
  void middle_command(const Fields& fields, const XmlNode& node);
  void place(const Fields& fields, const XmlNode& node);

  void actuate_joints(const Fields& fields, const XmlNode& node);
  void dwell(const Fields& fields, const XmlNode& node);
  void message(const Fields& fields, const XmlNode& node);
  void move_to(const Fields& fields, const XmlNode& node);
  void move_through_to(const Fields& fields, const XmlNode& node);
  void move_screw(const Fields& fields, const XmlNode& node);
  void no_effect(const Fields& fields, const XmlNode& node);
  void parameters(const Fields& fields, const XmlNode& node);
  void run_program(const Fields& fields, const XmlNode& node);
  void set_angle_units(const Fields& fields, const XmlNode& node);
  void set_coordination(const Fields& fields, const XmlNode& node);
  void set_end_effector(const Fields& fields, const XmlNode& node);
  void set_end_tolerance(const Fields& fields, const XmlNode& node);
  void set_force_units(const Fields& fields, const XmlNode& node);
  void set_intermediate_tolerance(const Fields& fields, const XmlNode& node);
  void set_length_units(const Fields& fields, const XmlNode& node);
  void set_limit(const Fields& fields, const XmlNode& node);
  void stop_motion(const Fields& fields, const XmlNode& node);
  void tool_changer(const Fields& fields, const XmlNode& node);

  void add(const Fields& fields, const XmlNode& node, const program::Statement& statement);
  // What a move needs that is not in force yet.
  void put_limits(const Fields& fields, const XmlNode& node, const Limits& wanted);
  void put_fly(const Fields& fields, const XmlNode& node, std::optional<double> distance_m);
  // PoseType or PoseAndSetType; `through`: the next move continues from there.
  void move_to_pose(const Fields& fields, const XmlNode& node, bool straight, bool through);
  Limits read_overrides(const Fields& fields, const XmlNode& node, std::optional<double>& tolerance_m) const;
  void add_screw(const Fields& fields, const XmlNode& node, double distance_m, double turn_rad);
  [[nodiscard]] program::JointUnits joint_units() const;
  using Joints = std::vector<std::optional<double>>;
  [[nodiscard]] Joints read_joints(const Fields& fields, const XmlNode& node);
  [[nodiscard]] Result<program::ExpressionId> joint_target(const Joints& joints);

  program::ProgramBuilder& builder_;
  const std::string& file_;
  Diagnostics& diagnostics_;
  enum class Part : std::uint8_t { before, commands, behind } part_ = Part::before;
  Units units_;
  Limits limits_;                              // as the commands have set them
  Limits limits_in_force_;                     // as the statements so far have
  std::optional<double> through_tolerance_m_;  // of way points; none: the robot's own
  std::optional<double> fly_in_force_m_;
  bool told_joint_speeds_ = false;
  bool told_tool_changer_ = false;
};

}  // namespace cellmirror::crcl

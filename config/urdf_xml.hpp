// Reads attributes of URDF elements and finds what is wrong with them. Private to this folder.
#pragma once

#include <tinyxml2.h>

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rt_core/base/diagnostics.hpp"
#include "rt_core/base/pose.hpp"

namespace cellmirror {

class UrdfXml {
 public:
  UrdfXml(std::string file, Diagnostics& diagnostics) : file_(std::move(file)), diagnostics_(&diagnostics) {}

  void error(const tinyxml2::XMLElement& element, std::string message, std::string remedy = {}) const;
  void warning(const tinyxml2::XMLElement& element, std::string message, std::string remedy = {}) const;

  // The attribute as text; empty where it is missing, which is an error where `required`.
  [[nodiscard]] std::string text(const tinyxml2::XMLElement& element, const char* attribute, bool required) const;
  // The same as a name of ours: without blanks and dots, at most kMaxNameLength.
  [[nodiscard]] std::optional<std::string> name(const tinyxml2::XMLElement& element, const char* attribute) const;
  // The name of <robot>, or a similar one that may stand in a path, with a warning.
  [[nodiscard]] std::string robot_name(const tinyxml2::XMLElement& robot) const;
  [[nodiscard]] std::optional<double> number(const tinyxml2::XMLElement& element, const char* attribute,
                                             bool required) const;
  // `count` numbers separated by blanks.
  [[nodiscard]] std::optional<std::vector<double>> numbers(const tinyxml2::XMLElement& element, const char* attribute,
                                                           std::size_t count, bool required) const;
  [[nodiscard]] Eigen::Vector3d vector3(const tinyxml2::XMLElement& element, const char* attribute,
                                        const Eigen::Vector3d& fallback) const;
  // Of the child element <origin>.
  [[nodiscard]] Pose origin(const tinyxml2::XMLElement& parent) const;

  [[nodiscard]] const std::string& file() const { return file_; }
  [[nodiscard]] Diagnostics& diagnostics() const { return *diagnostics_; }

 private:
  [[nodiscard]] Pose turned_pose(const tinyxml2::XMLElement& origin, const Eigen::Vector3d& xyz) const;

  std::string file_;
  Diagnostics* diagnostics_;
};

}  // namespace cellmirror

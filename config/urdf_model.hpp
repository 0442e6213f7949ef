// The links and joints of a URDF as its file lists them, before they become a tree. Private to this folder.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "config/file_finder.hpp"
#include "config/urdf_xml.hpp"
#include "rt_core/cell/component.hpp"

namespace cellmirror {

struct UrdfLink {
  std::string name;
  std::vector<Geometry> geometry;
  BodyInertia inertia;
  int line = 0;
};

struct UrdfJoint {
  std::string name;
  std::string parent;
  std::string child;
  Pose X_PJ = Pose::Identity();
  std::optional<JointDefinition> joint;  // nothing: fixed
  int line = 0;
};

struct UrdfModel {
  std::string name;
  std::vector<UrdfLink> links;
  std::vector<UrdfJoint> joints;
};

// Reads all <link> and <joint> elements; invalid ones are left out, with diagnostics.
[[nodiscard]] UrdfModel read_urdf_elements(const tinyxml2::XMLElement& robot, const UrdfXml& xml,
                                           const std::filesystem::path& path, const FileFinder& files);
[[nodiscard]] std::optional<UrdfJoint> read_urdf_joint(const tinyxml2::XMLElement& element, const UrdfXml& xml);
using UrdfMaterials = std::map<std::string, std::array<float, 4>, std::less<>>;
[[nodiscard]] std::optional<UrdfLink> read_urdf_link(const tinyxml2::XMLElement& element, const UrdfXml& xml,
                                                     const UrdfMaterials& materials, const std::filesystem::path& path,
                                                     const FileFinder& files);
[[nodiscard]] std::optional<std::array<float, 4>> read_urdf_color(const tinyxml2::XMLElement& material,
                                                                  const UrdfXml& xml);

// Takes out of the document what the kinematics between two links does not need: bodies, and links and joints off the
// way from the root to both (and to the joints that are mimicked there). Where a link is unknown or the joints are no
// tree, all links and joints stay, so that reading finds out what is wrong.
void keep_kinematics_between(tinyxml2::XMLElement& robot, std::string_view base, std::string_view tip);

}  // namespace cellmirror

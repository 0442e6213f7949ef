#include "app/snapshot/robot_description.hpp"

#include <fmt/format.h>

#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string_view>

#include "rt_core/base/pose.hpp"

namespace cellmirror::app {

namespace {

// For an attribute in double quotes.
std::string xml_text(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
  }
  return out;
}

// RFC 8089 and RFC 3986: what is not unreserved is percent-encoded.
std::string file_uri(std::string_view path) {
  std::string out = "file://";
  for (const char c : path) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '/' ||
                       c == '-' || c == '_' || c == '.' || c == '~';
    out += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return out;
}

std::string origin_text(const Pose& X) {
  const Eigen::Vector3d p = X.translation();
  const Eigen::Vector3d rpy = rpy_from_rotation(X.linear());
  return fmt::format("<origin xyz=\"{:.9g} {:.9g} {:.9g}\" rpy=\"{:.9g} {:.9g} {:.9g}\"/>", p.x(), p.y(), p.z(),
                     rpy.x(), rpy.y(), rpy.z());
}

class Description {
 public:
  using MeshUri = std::function<std::string(std::string_view)>;

  Description(const CompiledCell& cell, const std::vector<bool>& wanted, const MeshUri& mesh_uri)
      : cell_(cell), wanted_(wanted), mesh_uri_(mesh_uri) {
    compute_poses(cell, zero_positions(), poses_);
  }

  std::string write() {
    links_.push_back({"world", {}});
    link_of_node_[0] = 0;
    for (std::size_t i = 0; i < cell_.robots.size(); ++i) {
      if (!wanted_[i]) continue;
      for (const std::string& joint : cell_.robots[i].joint_names) ++uses_of_name_[joint];
    }
    for (std::size_t i = 0; i < cell_.robots.size(); ++i) {
      if (wanted_[i]) {
        add_links(cell_.robots[i]);
      } else {
        left_out_.insert(cell_.robots[i].component);
      }
    }
    for (std::size_t i = 0; i < cell_.robots.size(); ++i) {
      if (wanted_[i]) add_joints(cell_.robots[i]);
    }
    for (const CompiledGeometry& shape : cell_.geometry) add_shape(shape);
    std::string out = fmt::format("<?xml version=\"1.0\"?>\n<robot name=\"{}\">\n", xml_text(cell_.name));
    for (const Link& link : links_) {
      out += link.visuals.empty() ? fmt::format("<link name=\"{}\"/>\n", xml_text(link.name))
                                  : fmt::format("<link name=\"{}\">\n{}</link>\n", xml_text(link.name), link.visuals);
    }
    return out + joints_ + "</robot>\n";
  }

 private:
  struct Link {
    std::string name;
    std::string visuals;
  };
  struct Carrier {
    std::size_t link = 0;
    std::int32_t node = 0;  // its frame
  };

  [[nodiscard]] static std::span<const JointValues> zero_positions() {
    static const std::vector<JointValues> zero(kMaxRobots);
    return zero;
  }
  [[nodiscard]] const Pose& X_WN(std::int32_t node) const { return poses_.X_WN[static_cast<std::size_t>(node)]; }

  void add_link(const std::string& name, std::int32_t node) {
    link_of_node_.emplace(node, links_.size());
    links_.push_back({name, {}});
  }

  void add_links(const CompiledRobot& robot) {
    base_of_node_[robot.base] = links_.size();
    links_.push_back({robot.id + "/base", {}});
    for (std::size_t j = 0; j < robot.joint_nodes.size(); ++j)
      add_link(robot.id + "/" + robot.joint_names[j], robot.joint_nodes[j]);
  }

  // The link that the node moves with; nothing where a joint without a link lies between, and within a robot that is
  // not wanted.
  [[nodiscard]] std::optional<Carrier> carrier_of(std::int32_t node) const {
    for (std::int32_t at = node;; at = cell_.parent[static_cast<std::size_t>(at)]) {
      if (const auto joint = link_of_node_.find(at); joint != link_of_node_.end()) return Carrier{joint->second, at};
      if (const auto base = base_of_node_.find(at); base != base_of_node_.end()) return Carrier{base->second, at};
      if (at <= 0 || left_out_.contains(at) || cell_.joint_of[static_cast<std::size_t>(at)] >= 0) return std::nullopt;
    }
  }

  void add_fixed(const std::string& parent, const std::string& child, const Pose& X_PC) {
    joints_ +=
        fmt::format("<joint name=\"{0}_fixed\" type=\"fixed\"><parent link=\"{1}\"/><child link=\"{0}\"/>{2}</joint>\n",
                    xml_text(child), xml_text(parent), origin_text(X_PC));
  }

  // What carries the base; a robot on a robot that is not wanted hangs at the world, where /tf places it anyway.
  [[nodiscard]] Carrier carrier_of_base(const CompiledRobot& robot) const {
    if (robot.base == 0) return {};
    if (const auto joint = link_of_node_.find(robot.base); joint != link_of_node_.end())
      return {joint->second, robot.base};
    return carrier_of(cell_.parent[static_cast<std::size_t>(robot.base)]).value_or(Carrier{});
  }

  void add_joints(const CompiledRobot& robot) {
    const std::string base = robot.id + "/base";
    const Carrier below = carrier_of_base(robot);
    add_fixed(links_[below.link].name, base, X_WN(below.node).inverse(Eigen::Isometry) * X_WN(robot.base));
    for (std::size_t j = 0; j < robot.joint_nodes.size(); ++j) add_joint(robot, j);
    const auto flange = carrier_of(robot.flange);
    const std::string parent = flange ? links_[flange->link].name : base;
    const Pose X_WP = X_WN(flange ? flange->node : robot.base);
    const std::string name = robot.id + "/flange";
    links_.push_back({name, {}});
    add_fixed(parent, name, X_WP.inverse(Eigen::Isometry) * X_WN(robot.flange));
    links_.push_back({robot.id + "/tcp", {}});
    add_fixed(name, robot.id + "/tcp", robot.X_FT);
  }

  void add_joint(const CompiledRobot& robot, std::size_t j) {
    const std::int32_t node = robot.joint_nodes[j];
    const auto index = static_cast<std::size_t>(node);
    const auto above = carrier_of(cell_.parent[index]);
    const Carrier carrier = above.value_or(Carrier{base_of_node_.at(robot.base), robot.base});
    const CompiledJoint& joint = cell_.joints[static_cast<std::size_t>(cell_.joint_of[index])];
    const bool shared = uses_of_name_.at(robot.joint_names[j]) > 1;
    const std::string child = robot.id + "/" + robot.joint_names[j];
    const char* type = joint.kind == JointKind::prismatic    ? "prismatic"
                       : joint.kind == JointKind::continuous ? "continuous"
                                                             : "revolute";
    joints_ += fmt::format(
        "<joint name=\"{}\" type=\"{}\"><parent link=\"{}\"/><child link=\"{}\"/>{}<axis xyz=\"{:.9g} {:.9g} "
        "{:.9g}\"/>",
        xml_text(shared ? child : robot.joint_names[j]), type, xml_text(links_[carrier.link].name), xml_text(child),
        origin_text(X_WN(carrier.node).inverse(Eigen::Isometry) * X_WN(node)), joint.axis.x(), joint.axis.y(),
        joint.axis.z());
    if (joint.kind != JointKind::continuous) {
      // Speed and effort are required attributes; what moves here is mirrored, so nobody limits it by them.
      joints_ += fmt::format("<limit lower=\"{:.9g}\" upper=\"{:.9g}\" velocity=\"0\" effort=\"0\"/>",
                             robot.min_range[j], robot.max_range[j]);
    }
    joints_ += "</joint>\n";
  }

  void add_visual(Link& link, const Pose& X_LG, const std::string& shape, const Geometry& geometry) {
    std::string material;
    if (geometry.look == nullptr) {
      const auto& c = geometry.rgba;
      material = fmt::format("<material name=\"m{}\"><color rgba=\"{:.4g} {:.4g} {:.4g} {:.4g}\"/></material>",
                             materials_++, c[0], c[1], c[2], c[3]);
    }
    fmt::format_to(std::back_inserter(link.visuals), "<visual>{}<geometry>{}</geometry>{}</visual>\n",
                   origin_text(X_LG), shape, material);
  }

  void add_shape(const CompiledGeometry& compiled) {
    const Geometry& geometry = *compiled.geometry;
    const auto carrier = carrier_of(compiled.node);
    if (!geometry.drawn || !carrier || cell_.visible[static_cast<std::size_t>(compiled.node)] == 0) return;
    Link& link = links_[carrier->link];
    const Pose X_LG = X_WN(carrier->node).inverse(Eigen::Isometry) * X_WN(compiled.node) * geometry.X_NG;
    const Eigen::Vector3d& size = geometry.size;
    const auto cylinder = [&] {
      return fmt::format("<cylinder radius=\"{:.9g}\" length=\"{:.9g}\"/>", size.x(), size.y());
    };
    const auto sphere = [&] { return fmt::format("<sphere radius=\"{:.9g}\"/>", size.x()); };
    switch (geometry.shape) {
      case Shape::box:
        return add_visual(link, X_LG, fmt::format("<box size=\"{:.9g} {:.9g} {:.9g}\"/>", size.x(), size.y(), size.z()),
                          geometry);
      case Shape::cylinder:
        return add_visual(link, X_LG, cylinder(), geometry);
      case Shape::sphere:
        return add_visual(link, X_LG, sphere(), geometry);
      case Shape::capsule:
        add_visual(link, X_LG, cylinder(), geometry);
        for (const double end : {-0.5, 0.5}) {
          const Pose X_GE(Eigen::Translation3d(0.0, 0.0, end * size.y()));
          add_visual(link, X_LG * X_GE, sphere(), geometry);
        }
        return;
      case Shape::mesh:
        return add_visual(link, X_LG,
                          fmt::format("<mesh filename=\"{}\" scale=\"{:.9g} {:.9g} {:.9g}\"/>",
                                      xml_text(uri_of(geometry.mesh_file)), size.x(), size.y(), size.z()),
                          geometry);
    }
  }

  [[nodiscard]] std::string uri_of(std::string_view file) const {
    std::string named = mesh_uri_ ? mesh_uri_(file) : std::string();
    return named.empty() ? file_uri(file) : named;
  }

  const CompiledCell& cell_;
  const std::vector<bool>& wanted_;
  const MeshUri& mesh_uri_;
  CellPoses poses_;  // of all joints at zero
  std::vector<Link> links_;
  std::map<std::int32_t, std::size_t> link_of_node_;  // the world and joints
  std::map<std::int32_t, std::size_t> base_of_node_;
  std::set<std::int32_t> left_out_;  // components of robots that are not wanted
  std::map<std::string, int> uses_of_name_;
  std::string joints_;
  int materials_ = 0;
};

}  // namespace

std::string robot_description(const CompiledCell& cell, const std::vector<bool>& wanted,
                              const std::function<std::string(std::string_view)>& mesh_uri) {
  return Description(cell, wanted, mesh_uri).write();
}

}  // namespace cellmirror::app

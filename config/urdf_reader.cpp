// From the links and joints of a URDF to a component: a node for each link, and one for each joint that moves. A fixed
// joint is only the place of its child link.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <unordered_map>

#include "config/parse.hpp"
#include "config/robot_builder.hpp"
#include "config/urdf_model.hpp"
#include "rt_core/base/capacity.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror {

using tinyxml2::XMLElement;

UrdfModel read_urdf_elements(const XMLElement& robot, const UrdfXml& xml, const std::filesystem::path& path,
                             const FileFinder& files) {
  UrdfModel model;
  model.name = xml.robot_name(robot);
  UrdfMaterials materials;
  constexpr std::size_t kMostMaterials = 10'000;
  for (const XMLElement* material = robot.FirstChildElement("material");
       material != nullptr && materials.size() < kMostMaterials; material = material->NextSiblingElement("material")) {
    if (const auto color = read_urdf_color(*material, xml)) materials[xml.text(*material, "name", false)] = *color;
  }
  // A link and a joint may become a node each.
  constexpr std::size_t kMost = kMaxNodes / 2;
  for (const XMLElement* link = robot.FirstChildElement("link"); link != nullptr;
       link = link->NextSiblingElement("link")) {
    if (model.links.size() >= kMost) {
      xml.error(*link, fmt::format("there are more than {} links", kMost));
      break;
    }
    if (auto read = read_urdf_link(*link, xml, materials, path, files)) model.links.push_back(std::move(*read));
  }
  for (const XMLElement* joint = robot.FirstChildElement("joint"); joint != nullptr;
       joint = joint->NextSiblingElement("joint")) {
    if (model.joints.size() >= kMost) {
      xml.error(*joint, fmt::format("there are more than {} joints", kMost));
      break;
    }
    if (auto read = read_urdf_joint(*joint, xml)) model.joints.push_back(std::move(*read));
  }
  return model;
}

namespace {

class UrdfTree {
 public:
  UrdfTree(const UrdfModel& model, const std::string& file, Diagnostics& diagnostics)
      : model_(model), diagnostics_(diagnostics) {
    component_.file = file;
  }

  Component build() {
    index_links();
    index_joints();
    const auto root = find_root();
    if (root) {
      add_branch(*root);
      check_all_reached();
    }
    add_robot();
    return std::move(component_);
  }

 private:
  struct Link {
    std::vector<std::size_t> joints_below;
    std::size_t joints_above = 0;
    bool reached = false;
  };

  void error(int line, std::string message, std::string remedy = {}) {
    diagnostics_.error({component_.file, line, 0}, std::move(message), std::move(remedy));
  }

  void index_links() {
    for (std::size_t i = 0; i < model_.links.size(); ++i) {
      const auto& link = model_.links[i];
      if (!link_of_.emplace(link.name, i).second) error(link.line, fmt::format("there are two links {}", link.name));
    }
    links_.resize(model_.links.size());
    if (model_.links.empty()) diagnostics_.error({component_.file, 0, 0}, "there is no link");
  }

  std::optional<std::size_t> link_named(const UrdfJoint& joint, const std::string& name, const char* end) {
    const auto at = link_of_.find(name);
    if (at != link_of_.end()) return at->second;
    std::vector<std::string> names;
    for (const auto& [known, index] : link_of_) names.push_back(known);
    std::ranges::sort(names);
    error(joint.line, fmt::format("joint {}: its {} {} is not a link", joint.name, end, printable(name)),
          did_you_mean(name, names));
    return std::nullopt;
  }

  void index_joints() {
    std::unordered_map<std::string_view, int> lines;
    for (std::size_t i = 0; i < model_.joints.size(); ++i) {
      const UrdfJoint& joint = model_.joints[i];
      if (!lines.emplace(joint.name, joint.line).second)
        error(joint.line, fmt::format("there are two joints {}", joint.name));
      const auto parent = link_named(joint, joint.parent, "parent");
      const auto child = link_named(joint, joint.child, "child");
      if (!parent || !child) continue;
      if (++links_[*child].joints_above > 1) {
        error(joint.line, fmt::format("link {} has two parents", joint.child), "a URDF is a tree");
        continue;
      }
      if (*parent == *child) {
        error(joint.line, fmt::format("joint {} connects {} to itself", joint.name, joint.child));
        continue;
      }
      links_[*parent].joints_below.push_back(i);
    }
  }

  std::optional<std::size_t> find_root() {
    std::vector<std::size_t> roots;
    for (std::size_t i = 0; i < links_.size(); ++i) {
      // Of two links of one name only the first counts.
      if (links_[i].joints_above == 0 && link_of_.find(model_.links[i].name)->second == i) roots.push_back(i);
    }
    if (roots.empty() && !links_.empty())
      diagnostics_.error({component_.file, 0, 0}, "there is no root link: the joints form a loop");
    for (std::size_t i = 1; i < roots.size(); ++i) {
      error(
          model_.links[roots[i]].line,
          fmt::format("{} is a root link, but {} is one too", model_.links[roots[i]].name, model_.links[roots[0]].name),
          "connect it by a joint of type fixed");
      links_[roots[i]].reached = true;
    }
    if (roots.empty()) return std::nullopt;
    several_roots_ = roots.size() > 1;
    return roots.front();
  }

  int add_node(ComponentNode node) {
    for (const ComponentNode& other : component_.nodes) {
      if (other.parent == node.parent && other.name == node.name && node.parent >= 0)
        error(node.line, fmt::format("a joint and a link below {} are both named {}",
                                     component_.nodes[static_cast<std::size_t>(node.parent)].name, node.name));
    }
    component_.nodes.push_back(std::move(node));
    return static_cast<int>(component_.nodes.size()) - 1;
  }

  int add_link(const UrdfLink& link, int parent, const Pose& X_PL) {
    ComponentNode node;
    node.name = link.name;
    node.parent = parent;
    node.X_PF = X_PL;
    node.geometry = link.geometry;
    node.inertia = link.inertia;
    node.line = link.line;
    return add_node(std::move(node));
  }

  // Depth first, so that the joints are numbered along the chains; a stack of our own, because depth is the file's.
  void add_branch(std::size_t root) {
    struct Open {
      std::size_t link;
      int node;
      std::size_t moving;  // joints between the root and here
      std::size_t next = 0;
    };
    links_[root].reached = true;
    std::vector<Open> open{{root, add_link(model_.links[root], -1, Pose::Identity()), 0}};
    while (!open.empty()) {
      Open& top = open.back();
      const Link& link = links_[top.link];
      if (top.next == link.joints_below.size()) {
        if (link.joints_below.empty()) note_leaf(top.node, top.moving);
        open.pop_back();
        continue;
      }
      const UrdfJoint& joint = model_.joints[link.joints_below[top.next++]];
      const std::size_t child = link_of_.find(joint.child)->second;
      if (links_[child].reached) continue;
      links_[child].reached = true;
      int parent = top.node;
      Pose X_PL = joint.X_PJ;
      if (joint.joint) {
        ComponentNode node;
        node.name = joint.name;
        node.kind = NodeKind::joint;
        node.parent = top.node;
        node.X_PF = joint.X_PJ;
        node.joint = joint.joint;
        node.line = joint.line;
        parent = add_node(std::move(node));
        X_PL = Pose::Identity();
      }
      const std::size_t moving = top.moving + (joint.joint ? 1 : 0);
      const int node = add_link(model_.links[child], parent, X_PL);
      open.push_back({child, node, moving});
    }
  }

  // The flange: a link tool0, else the end of the longest chain.
  void note_leaf(int node, std::size_t moving) {
    if (flange_ >= 0 && moving <= flange_moving_) return;
    flange_ = node;
    flange_moving_ = moving;
  }

  void check_all_reached() {
    if (several_roots_) return;  // links below the other roots were not visited
    for (std::size_t i = 0; i < links_.size(); ++i) {
      if (links_[i].reached || link_of_.find(model_.links[i].name)->second != i) continue;
      error(model_.links[i].line,
            fmt::format("link {} is not connected to the root: its joints form a loop", model_.links[i].name));
    }
  }

  void add_robot() {
    const bool moves =
        std::ranges::any_of(component_.nodes, [](const ComponentNode& n) { return n.joint.has_value(); });
    if (!moves) return;
    RobotDefinition robot;
    robot.id = model_.name;
    robot.base = 0;
    robot.zero_point = 0;
    robot.flange = flange_;
    for (std::size_t i = 0; i < component_.nodes.size(); ++i) {
      const ComponentNode& node = component_.nodes[i];
      if (!node.joint && node.name == "tool0") robot.flange = static_cast<int>(i);
    }
    component_.robot = robot;
    complete_robot(component_, {component_.file, 1, 0}, diagnostics_);
  }

  const UrdfModel& model_;
  Diagnostics& diagnostics_;
  Component component_;
  std::unordered_map<std::string, std::size_t> link_of_;
  std::vector<Link> links_;
  bool several_roots_ = false;
  int flange_ = -1;
  std::size_t flange_moving_ = 0;
};

// A document type could define entities; URDF needs none.
bool refuse_document_type(const tinyxml2::XMLDocument& document, const std::string& file, Diagnostics& diagnostics) {
  for (const tinyxml2::XMLNode* node = document.FirstChild(); node != nullptr; node = node->NextSibling()) {
    if (node->ToUnknown() == nullptr) continue;
    diagnostics.error({file, node->GetLineNum(), 0}, "the document has a <!...> declaration", "remove it");
    return true;
  }
  return false;
}

// Accepts values that xacro replaces: ${...}, and $(...) with one of its commands. Other $(...) may be in a file's
// name.
bool is_expression(std::string_view value) {
  constexpr std::array<std::string_view, 8> kBegins{"${",      "$(arg ",    "$(find ", "$(env ",
                                                    "$(eval ", "$(optenv ", "$(anon ", "$(dirname)"};
  return std::ranges::any_of(kBegins,
                             [&](std::string_view begin) { return value.find(begin) != std::string_view::npos; });
}

// The first place where a xacro file was not expanded.
class XacroFinder : public tinyxml2::XMLVisitor {
 public:
  bool VisitEnter(const XMLElement& element, const tinyxml2::XMLAttribute* attribute) override {
    if (std::string_view(element.Name()).starts_with("xacro:")) note(element, element.Name());
    for (; attribute != nullptr; attribute = attribute->Next()) {
      if (is_expression(attribute->Value())) note(element, attribute->Value());
    }
    return found_.empty();
  }
  [[nodiscard]] const std::string& found() const { return found_; }
  [[nodiscard]] int line() const { return line_; }

 private:
  void note(const XMLElement& element, std::string_view what) {
    if (!found_.empty()) return;
    found_ = what;
    line_ = element.GetLineNum();
  }

  std::string found_;
  int line_ = 0;
};

bool refuse_xacro(const XMLElement& robot, const std::string& file, Diagnostics& diagnostics) {
  XacroFinder finder;
  robot.Accept(&finder);
  if (finder.found().empty()) return false;
  diagnostics.error({file, finder.line(), 0},
                    fmt::format("this is a xacro file that was not expanded: {}", printable(finder.found())),
                    "expand it first: xacro FILE > FILE.urdf");
  return true;
}

// The root element, or nothing and what is wrong with the document.
XMLElement* read_document(std::string_view text, const std::string& file, tinyxml2::XMLDocument& document,
                          Diagnostics& diagnostics) {
  if (text.find('\0') != std::string_view::npos) {
    diagnostics.error({file, 0, 0}, "the file contains NUL bytes and is not XML");
    return nullptr;
  }
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
    diagnostics.error({file, document.ErrorLineNum(), 0},
                      fmt::format("the XML is faulty: {}", printable(document.ErrorName())), "the file was not read");
    return nullptr;
  }
  if (refuse_document_type(document, file, diagnostics)) return nullptr;
  XMLElement* robot = document.RootElement();
  if (robot == nullptr || std::string_view(robot->Name()) != "robot") {
    diagnostics.error({file, robot == nullptr ? 0 : robot->GetLineNum(), 0}, "the root element is not <robot>",
                      "a xacro file has to be expanded first: xacro FILE > FILE.urdf");
    return nullptr;
  }
  if (refuse_xacro(*robot, file, diagnostics)) return nullptr;
  return robot;
}

Component component_of(const XMLElement& robot, const std::string& file, const std::filesystem::path& path,
                       const FileFinder& files, Diagnostics& diagnostics) {
  Diagnostics findings;
  const UrdfXml xml(file, findings);
  if (robot.NextSiblingElement() != nullptr) xml.error(*robot.NextSiblingElement(), "there is a second root element");
  const UrdfModel model = read_urdf_elements(robot, xml, path, files);
  Component component = UrdfTree(model, file, findings).build();
  component.description = fmt::format("robot {} of a URDF", model.name);
  take_sorted(diagnostics, findings);
  return component;
}

// Nothing would ever be reported of such a robot, as if it touched nothing.
void warn_where_nothing_collides(const Component& component, const XMLElement& robot, Diagnostics& diagnostics) {
  if (!component.robot || !diagnostics.ok()) return;
  const bool collides = std::ranges::any_of(component.nodes, [](const ComponentNode& node) {
    return std::ranges::any_of(node.geometry, &Geometry::collides);
  });
  if (collides) return;
  diagnostics.add({Severity::warning,
                   {component.file, robot.GetLineNum(), 0},
                   fmt::format("no link of {} has a shape that collides: COLLISIONS OF THIS ROBOT ARE NOT FOUND",
                               component.robot->id),
                   "give its links <collision> elements"});
}

}  // namespace

std::optional<Component> parse_urdf(std::string_view text, const std::string& file, const std::filesystem::path& path,
                                    const FileFinder& files, Diagnostics& diagnostics) {
  tinyxml2::XMLDocument document;
  const XMLElement* robot = read_document(text, file, document, diagnostics);
  if (robot == nullptr) return std::nullopt;
  Component component = component_of(*robot, file, path, files, diagnostics);
  warn_where_nothing_collides(component, *robot, diagnostics);
  return component;
}

std::optional<Component> parse_urdf_between(std::string_view text, const std::string& file, std::string_view base,
                                            std::string_view tip, Diagnostics& diagnostics) {
  tinyxml2::XMLDocument document;
  XMLElement* robot = read_document(text, file, document, diagnostics);
  if (robot == nullptr) return std::nullopt;
  keep_kinematics_between(*robot, base, tip);
  return component_of(*robot, file, file, AnyFile(), diagnostics);
}

}  // namespace cellmirror

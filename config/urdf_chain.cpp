// The part of a URDF that the kinematics between two links needs.
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "config/urdf_model.hpp"

namespace cellmirror {

using tinyxml2::XMLElement;

namespace {

// The attribute of a child element; empty where either is missing.
std::string_view attribute_of(const XMLElement& element, const char* child, const char* attribute) {
  const XMLElement* found = element.FirstChildElement(child);
  const char* text = found == nullptr ? nullptr : found->Attribute(attribute);
  return text == nullptr ? std::string_view() : std::string_view(text);
}

std::string_view name_of(const XMLElement& element) {
  const char* text = element.Attribute("name");
  return text == nullptr ? std::string_view() : std::string_view(text);
}

class Pruning {
 public:
  explicit Pruning(XMLElement& robot) : robot_(robot) {}

  void keep_between(std::string_view base, std::string_view tip) {
    if (!index() || !keep_way_up_from(base) || !keep_way_up_from(tip)) return keep_all_without_bodies();
    for (XMLElement* child = robot_.FirstChildElement(); child != nullptr;) {
      XMLElement* next = child->NextSiblingElement();
      const std::string_view kind = child->Name();
      const bool kept = kind == "link"    ? kept_links_.contains(name_of(*child))
                        : kind == "joint" ? kept_joints_.contains(child)
                                          : false;
      if (!kept) robot_.DeleteChild(child);
      child = next;
    }
    keep_all_without_bodies();
  }

 private:
  // False where the links and joints are no tree.
  bool index() {
    std::unordered_set<std::string_view> links;
    for (const XMLElement* link = robot_.FirstChildElement("link"); link != nullptr;
         link = link->NextSiblingElement("link")) {
      if (name_of(*link).empty() || !links.insert(name_of(*link)).second) return false;
    }
    for (const XMLElement* joint = robot_.FirstChildElement("joint"); joint != nullptr;
         joint = joint->NextSiblingElement("joint")) {
      const std::string_view parent = attribute_of(*joint, "parent", "link");
      const std::string_view child = attribute_of(*joint, "child", "link");
      if (!links.contains(parent) || !links.contains(child)) return false;
      if (!above_.emplace(child, joint).second) return false;
      if (name_of(*joint).empty() || !joints_.emplace(name_of(*joint), joint).second) return false;
    }
    links_ = std::move(links);
    return true;
  }

  // False for an unknown link, a joint that mimics an unknown one, and a circle of joints.
  bool keep_way_up_from(std::string_view link) {
    std::vector<std::string_view> open{link};
    while (!open.empty()) {
      std::string_view at = open.back();
      open.pop_back();
      if (!links_.contains(at)) return false;
      std::unordered_set<std::string_view> here;
      for (;;) {
        if (!here.insert(at).second) return false;
        if (!kept_links_.insert(at).second) break;
        const auto above = above_.find(at);
        if (above == above_.end()) break;
        const XMLElement& joint = *above->second;
        kept_joints_.insert(&joint);
        if (const std::string_view mimicked = attribute_of(joint, "mimic", "joint"); !mimicked.empty()) {
          const auto found = joints_.find(mimicked);
          if (found == joints_.end()) return false;
          open.push_back(attribute_of(*found->second, "child", "link"));
        }
        at = attribute_of(joint, "parent", "link");
      }
    }
    return true;
  }

  void keep_all_without_bodies() {
    for (XMLElement* link = robot_.FirstChildElement("link"); link != nullptr; link = link->NextSiblingElement("link"))
      link->DeleteChildren();
    for (XMLElement* joint = robot_.FirstChildElement("joint"); joint != nullptr;
         joint = joint->NextSiblingElement("joint")) {
      XMLElement* limit = joint->FirstChildElement("limit");
      if (limit != nullptr && limit->Attribute("velocity") == nullptr) limit->SetAttribute("velocity", 1.0);
    }
  }

  XMLElement& robot_;
  std::unordered_set<std::string_view> links_;
  std::unordered_map<std::string_view, const XMLElement*> above_;  // by link: the joint whose child it is
  std::unordered_map<std::string_view, const XMLElement*> joints_;
  std::unordered_set<std::string_view> kept_links_;
  std::unordered_set<const XMLElement*> kept_joints_;
};

}  // namespace

void keep_kinematics_between(XMLElement& robot, std::string_view base, std::string_view tip) {
  Pruning(robot).keep_between(base, tip);
}

}  // namespace cellmirror

// The values in an element, each with what is wrong with it.
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>

#include "rt_core/base/diagnostics.hpp"
#include "rt_core/base/pose.hpp"
#include "scripts/programs/crcl/xml_tree.hpp"

namespace cellmirror::crcl {

enum class AngleUnit : std::uint8_t { radian, degree };
enum class LengthUnit : std::uint8_t { metre, millimetre, inch };

// In force at a command's place in the text.
struct Units {
  AngleUnit angle = AngleUnit::radian;
  LengthUnit length = LengthUnit::metre;
  [[nodiscard]] double rad() const;  // of one unit
  [[nodiscard]] double metres() const;
};

class Fields {
 public:
  Fields(const XmlTree& tree, const std::string& file, Diagnostics& diagnostics)
      : tree_(tree), file_(file), diagnostics_(diagnostics) {}

  void error(const XmlNode& at, std::string message, std::string remedy = {}) const;
  void warning(const XmlNode& at, std::string message, std::string remedy = {}) const;

  // Reports elements in `node` that are not listed (Name may be anywhere), and those given twice unless their name is
  // `repeated`.
  void only(const XmlNode& node, std::initializer_list<std::string_view> names, std::string_view repeated = {}) const;
  // Reports where it is missing.
  [[nodiscard]] const XmlNode* required(const XmlNode& node, std::string_view name) const;
  [[nodiscard]] const XmlNode* optional(const XmlNode& node, std::string_view name) const {
    return tree_.child(node, name);
  }
  [[nodiscard]] const XmlTree& tree() const { return tree_; }

  // Of an element itself: none, and reported, where its text is not that.
  [[nodiscard]] std::optional<double> number(const XmlNode& node) const;  // finite
  [[nodiscard]] std::optional<long long> positive_integer(const XmlNode& node) const;
  [[nodiscard]] std::optional<bool> boolean(const XmlNode& node) const;
  [[nodiscard]] std::optional<double> fraction(const XmlNode& node) const;  // 0 .. 1
  // Of a required child.
  [[nodiscard]] std::optional<double> number(const XmlNode& node, std::string_view name) const;
  [[nodiscard]] std::optional<long long> positive_integer(const XmlNode& node, std::string_view name) const;
  [[nodiscard]] std::optional<bool> boolean(const XmlNode& node, std::string_view name) const;

  // PoseType: Point, XAxis, ZAxis. In metres.
  [[nodiscard]] std::optional<Pose> pose(const XmlNode& node, const Units& units) const;

 private:
  [[nodiscard]] std::optional<Eigen::Vector3d> vector(const XmlNode& node, std::string_view name,
                                                      std::initializer_list<std::string_view> components) const;

  const XmlTree& tree_;
  const std::string& file_;
  Diagnostics& diagnostics_;
};

}  // namespace cellmirror::crcl

// Reads an XML document element by element below the root, with expat.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "rt_core/base/diagnostics.hpp"
#include "scripts/programs/crcl/xml_tree.hpp"

namespace cellmirror::crcl {

struct XmlVisitor {
  // The root has opened: its name and place. False: nothing more is read.
  std::function<bool(const XmlNode& root)> root;
  // A child of the root is complete.
  std::function<void(const XmlTree& element)> element;
};

// Hostile text: no document type declarations (so no entities of its own), at most kMostDepth elements within each
// other, kMostNodes in one child of the root, kLongestText bytes in one element; what is beyond is an error. Reports
// where the text is no XML; then nothing after that place has been visited.
void read_xml(std::string_view text, const std::string& file, const XmlVisitor& visitor, Diagnostics& diagnostics);

inline constexpr int kMostDepth = 16;
inline constexpr std::size_t kMostNodes = 500'000;
inline constexpr std::size_t kLongestText = 8192;

}  // namespace cellmirror::crcl

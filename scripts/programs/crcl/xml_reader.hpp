// Reads an XML document element by element below the root. What most documents consist of is read in place; where
// anything else comes, and where something is wrong, expat reads the document and decides.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

#include "rt_core/base/diagnostics.hpp"
#include "scripts/programs/crcl/xml_tree.hpp"

namespace cellmirror::crcl {

struct XmlVisitor {
  // The root has opened: its name and place. False: nothing more is read.
  std::function<bool(const XmlNode& root)> root;
  // A child of the root is complete. The tree is valid until the next one.
  std::function<void(const XmlTree& element)> element;
};

inline constexpr std::size_t kMostDepth = 16;
inline constexpr std::size_t kMostNodes = 500'000;
inline constexpr std::size_t kLongestText = 8192;

// Hostile text: no document type declarations (so no entities of its own), at most kMostDepth elements within each
// other, kMostNodes in one child of the root, kLongestText bytes in one element; what is beyond is an error. Reports
// where the text is no XML; then nothing after that place has been visited.
void read_xml(std::string_view text, const std::string& file, const XmlVisitor& visitor, Diagnostics& diagnostics);

// What has been visited of a document.
struct XmlProgress {
  bool root = false;
  std::size_t elements = 0;  // children of the root, from the first
};

// The same by expat alone, and from where another reader has come to.
void read_xml_by_expat(std::string_view text, const std::string& file, const XmlVisitor& visitor,
                       Diagnostics& diagnostics, XmlProgress visited = {});

}  // namespace cellmirror::crcl

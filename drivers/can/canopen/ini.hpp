// The INI dialect of EDS and DCF files (CiA 306): sections, keys, values, with their places. For the EDS reader.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "rt_core/base/diagnostics.hpp"

namespace cellmirror::can {

struct IniValue {
  std::string text;  // trimmed
  int line = 0;
  int column = 0;
};

struct IniSection {
  std::string name;  // as written
  int line = 0;
  std::map<std::string, IniValue, std::less<>> values;  // keys in lower case

  [[nodiscard]] const IniValue* find(std::string_view key_in_lower_case) const;
};

// Sections by their names in lower case. Comments begin with ; (CiA 306), # or //. Any other line that is neither
// section nor key is a warning. So is a section or key that appears twice; the first one counts.
using IniFile = std::map<std::string, IniSection, std::less<>>;
[[nodiscard]] IniFile parse_ini(std::string_view text, const std::string& file, Diagnostics& diagnostics);

}  // namespace cellmirror::can

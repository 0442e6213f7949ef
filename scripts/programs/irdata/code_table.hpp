// Numeric operation codes. The numbers of the standards are not public, so they are data: a table of the project's own
// numbers is built in, and an owner of the standards can replace it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rt_core/base/diagnostics.hpp"
#include "scripts/programs/irdata/operations.hpp"

namespace cellmirror::program::irdata {

inline constexpr std::uint32_t kGreatestCode = 99'999'999;

class CodeTable {
 public:
  // Lines of columns divided by tabs: code, symbolic name, then anything for people; '#' begins a comment. An operation
  // may have several codes or none, a code has one operation. All diagnostics name `file`; linear in the text but for a
  // sort.
  static CodeTable read(std::string_view text, const std::string& file, Diagnostics& diagnostics);

  [[nodiscard]] std::optional<Operation> find(std::uint32_t code) const;
  struct Row {
    std::uint32_t code = 0;
    Operation operation = Operation::comment;
    std::uint32_t line = 0;
  };
  [[nodiscard]] const std::vector<Row>& rows() const { return rows_; }  // by code

 private:
  std::vector<Row> rows_;
};

// The text of config/languages/irdata_codes.tsv as it was when the program was built.
[[nodiscard]] std::string_view built_in_codes();

}  // namespace cellmirror::program::irdata

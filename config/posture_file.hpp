// Postures of a cell's robots from a CSV: a header of robot.joint columns, then a row a posture. rad or m. Read a row
// at a time, so that files of any length need no memory. One thread; not for the tick.
#pragma once

#include <cstddef>
#include <cstdint>
#include <istream>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "rt_core/base/diagnostics.hpp"
#include "rt_core/cell/cell.hpp"
#include "rt_core/ports/robot_state.hpp"

namespace cellmirror {

inline constexpr std::uint64_t kMaxPostures = 10'000'000;
inline constexpr std::size_t kLongestPostureLine = std::size_t{1} << 20U;  // bytes
inline constexpr std::size_t kMaxPostureColumns = 1024;
inline constexpr double kGreatestJointValue = 1e6;  // rad or m, of either sign

// Accepted: columns in any order; columns for some of the joints only; LF and CRLF; a UTF-8 byte order mark; fields in
// double quotes; blanks around fields; lines that begin with #; blank lines at the end. Values beyond a joint's range
// are accepted, since a real robot may be there; finish() gives one warning per column. Any bytes are allowed as text.
class PostureReader {
 public:
  // `in`, `diagnostics` and `cell` are used until the last call.
  PostureReader(std::istream& in, std::string file, const Cell& cell, Diagnostics& diagnostics);

  // False, and all its errors, if the header is wrong: nothing can be read then.
  bool read_header();
  // Writes the columns of the next row into q[slot][joint] and leaves the others as they are. False: there is no
  // further row. An invalid row gives its errors, leaves `q` unchanged, and counts.
  bool read_row(std::span<JointValues> q);
  // Reports errors of the whole file: no rows, values beyond ranges.
  void finish();

  [[nodiscard]] std::uint64_t rows() const { return rows_; }
  [[nodiscard]] std::size_t columns() const { return columns_.size(); }

 private:
  struct Field {
    std::string text;  // without quotes and the blanks around it
    int column = 1;
  };
  struct Column {
    std::string name;  // robot.joint
    std::size_t slot = 0;
    std::size_t joint = 0;
    JointKind kind = JointKind::revolute;
    double lower = 0;
    double upper = 0;
    int header_column = 1;
    std::uint64_t beyond = 0;  // rows whose value is outside of lower..upper
    int first_line = 0;        // the first of them
    int first_column = 0;
    double first_value = 0;
  };

  bool next_line();
  bool next_content_line();
  bool split();
  void read_column(const Field& field);
  [[nodiscard]] bool find_joint(const std::string& name, Column& column) const;
  [[nodiscard]] Error explain_joint(const std::string& name) const;
  bool read_value(std::size_t i, double& value);
  void error(int column, std::string message, std::string remedy = {});

  std::istream& in_;
  std::string file_;
  const Cell& cell_;
  Diagnostics& diagnostics_;
  std::string line_;
  std::vector<Field> fields_;  // of the line; kept for their memory
  std::size_t field_count_ = 0;
  std::vector<Column> columns_;
  std::vector<double> values_;
  std::uint64_t rows_ = 0;
  int line_number_ = 0;
  int blank_line_ = 0;  // the first of the blank lines just before this one; 0: none
  bool ended_ = false;
};

}  // namespace cellmirror

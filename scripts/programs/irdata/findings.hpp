// What is wrong with a program, with the line that is being read.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "rt_core/base/diagnostics.hpp"

namespace cellmirror::program::irdata {

class Findings {
 public:
  Findings(Diagnostics& diagnostics, std::string file) : diagnostics_(diagnostics), file_(std::move(file)) {}

  void at_line(std::uint32_t line) { line_ = line; }
  [[nodiscard]] std::uint32_t line() const { return line_; }
  [[nodiscard]] const std::string& file() const { return file_; }
  void error(std::uint32_t column, std::string message, std::string remedy = {}) {
    error_at(line_, column, std::move(message), std::move(remedy));
  }
  void error_at(std::uint32_t line, std::uint32_t column, std::string message, std::string remedy = {}) {
    ++errors_;
    diagnostics_.error({file_, static_cast<int>(line), static_cast<int>(column)}, std::move(message),
                       std::move(remedy));
  }
  [[nodiscard]] std::size_t errors() const { return errors_; }
  // Names similar to a wrong one are searched a limited number of times, since each time costs a pass over all names.
  [[nodiscard]] bool may_suggest() { return suggestions_++ < 100; }

 private:
  Diagnostics& diagnostics_;
  std::string file_;
  std::uint32_t line_ = 0;
  std::size_t errors_ = 0;
  std::size_t suggestions_ = 0;
};

}  // namespace cellmirror::program::irdata

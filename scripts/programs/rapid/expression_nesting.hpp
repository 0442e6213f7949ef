// How deep the reader of expressions is in itself; private to expressions.cpp, relations.cpp and aggregates.cpp.
#pragma once

#include <fmt/format.h>

#include "scripts/programs/rapid/expressions.hpp"

namespace cellmirror::program::rapid {

class ExpressionReader::Nesting {
 public:
  explicit Nesting(ExpressionReader& reader) : reader_(reader) { ++reader_.nesting_; }
  ~Nesting() { --reader_.nesting_; }
  Nesting(const Nesting&) = delete;
  Nesting& operator=(const Nesting&) = delete;
  // False, and reported, if it is too deep.
  [[nodiscard]] bool fits() const {
    constexpr int kMostNesting = 64;  // reading is recursive
    if (reader_.nesting_ <= kMostNesting) return true;
    reader_.error(reader_.lexer_.token(), fmt::format("the expression is nested more than {} deep", kMostNesting),
                  "compute a part of it into a num first");
    return false;
  }

 private:
  ExpressionReader& reader_;
};

}  // namespace cellmirror::program::rapid

// Labels, numbers of records and subprograms: what jumps and calls lead to. A jump may lead out of blocks (IF, WHILE,
// ...) but not into one, and stays within its subprogram.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "scripts/programs/irdata/findings.hpp"
#include "scripts/programs/program/program_builder.hpp"

namespace cellmirror::program::irdata {

// The place of a jump or its target.
struct Spot {
  std::uint32_t line = 0;
  std::uint32_t column = 0;
  std::uint32_t block = 0;  // 0: none
  std::uint32_t scope = 0;  // 0: main section, else the subprogram's number
};

class Jumps {
 public:
  Jumps(ProgramBuilder& builder, Findings& findings) : builder_(builder), findings_(findings) {}

  // Number of records that follow.
  void reserve(std::size_t records) { records_.reserve(records); }
  // A block begins within another one (0: none); its number.
  std::uint32_t new_block(std::uint32_t within);
  // A record with a number greater than all before.
  void begin_record(std::uint32_t number, const Spot& spot);
  // LABEL. Names must outlive this.
  void define_label(std::string_view name, const Spot& spot);
  void define_subprogram(std::string_view name, const Spot& spot);
  ProgramBuilder::Label to_label(std::string_view name, const Spot& from);
  ProgramBuilder::Label to_record(std::uint32_t number, const Spot& from);
  ProgramBuilder::Label to_subprogram(std::string_view name, const Spot& from);
  // At the end of the text: reports what leads nowhere, or where it may not.
  void finish();

 private:
  enum class Kind : std::uint8_t { label, record, subprogram };
  struct Target {
    ProgramBuilder::Label label;
    Kind kind = Kind::label;
    std::string_view name;
    std::uint32_t number = 0;
    Spot spot;  // line 0: used, not defined yet
  };
  struct Use {
    std::uint32_t target = 0;
    Spot from;
  };
  struct Record {
    std::uint32_t number = 0;
    ProgramBuilder::Label label;
    Spot spot;
  };
  std::uint32_t target_index(std::unordered_map<std::string_view, std::uint32_t>& names, std::string_view name,
                             Kind kind);
  ProgramBuilder::Label use(std::uint32_t target, const Spot& from);
  void define(Target& target, const Spot& spot, std::string_view what);
  void check(const Use& use);
  [[nodiscard]] bool encloses(std::uint32_t outer, std::uint32_t block) const;
  [[nodiscard]] std::string name_of_target(const Target& target) const;
  [[nodiscard]] std::string remedy_for(const Target& target);

  ProgramBuilder& builder_;
  Findings& findings_;
  std::vector<std::uint32_t> outer_blocks_ = {0};  // by block
  std::vector<Target> targets_;
  std::vector<Use> uses_;
  std::vector<Record> records_;  // by number
  std::unordered_map<std::string_view, std::uint32_t> labels_;
  std::unordered_map<std::string_view, std::uint32_t> subprograms_;
  std::unordered_map<std::uint32_t, std::uint32_t> record_targets_;  // number to target
};

}  // namespace cellmirror::program::irdata

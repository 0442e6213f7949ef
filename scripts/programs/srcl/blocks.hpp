// The blocks, labels, jumps and subprograms of a program: what closes what, and where jumps lead.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "scripts/programs/program/program.hpp"
#include "scripts/programs/srcl/emitter.hpp"
#include "scripts/programs/srcl/faults.hpp"
#include "scripts/programs/srcl/keywords.hpp"
#include "scripts/programs/srcl/lexer.hpp"

namespace cellmirror::program::srcl {

struct Block {
  Keyword begin = Keyword::none;   // if_begin, while_begin, count_begin, repeat_begin, loop_begin
  Token at;                        // where it begins
  std::uint32_t id = 0;            // the block of labels and jumps; each branch of a WENN has its own
  StatementId top = 0;             // loops: where each round begins
  StatementId skip = kNone;        // the branch that leads behind the block, or to the next branch of a WENN
  std::vector<StatementId> exits;  // jumps to behind the block
  std::vector<StatementId> next_rounds;
  VariableId counter = kNone;  // count_begin
  std::int64_t step = 1;
  bool has_otherwise = false;

  [[nodiscard]] bool loops() const { return begin != Keyword::if_begin; }
};

// The word that closes such a block.
[[nodiscard]] Keyword closing(Keyword begin);

class Blocks {
 public:
  static constexpr std::size_t kMostNested = 64;

  Blocks(Emitter& emitter, Faults& faults) : emitter_(emitter), faults_(faults) {}

  // Blocks nested too deeply are reported once and kept, so that their ends match.
  Block& open(Keyword begin, const Token& at);
  [[nodiscard]] Block* innermost() { return open_.empty() ? nullptr : &open_.back(); }
  [[nodiscard]] Block* innermost_loop();
  // The innermost block of this kind; inner ones that are still open are reported and closed. Null, and reported, if
  // there is none.
  Block* find_to_close(Keyword begin, const Token& at);
  // The innermost one: what leads behind it leads here from now on.
  void close();
  void close_all();
  // What follows is another branch of the innermost block: no jump leads into it.
  void begin_branch();

  void label(const Token& name);
  void jump(const Token& name, const Token& at);
  void jump_to(StatementId target, const Token& at) { emitter_.add(JumpStatement{target}, at); }

  void begin_subprogram(const Token& name, const Token& at);
  void end_subprogram(const Token& at);
  [[nodiscard]] bool in_subprogram() const { return subprogram_.has_value(); }
  [[nodiscard]] bool has_subprograms() const { return !subprograms_.empty() || in_subprogram(); }
  void call(const Token& name, const Token& at);

  // At the end of the text.
  void finish();

 private:
  struct Label {
    StatementId statement = 0;
    std::uint32_t block = 0;
    std::uint32_t line = 0;
  };
  struct Jump {
    StatementId statement = 0;
    std::uint32_t block = 0;
    Token name;
  };

  void close_routine();  // labels are known within the main program or one subprogram
  void resolve_jumps();
  void resolve_calls();
  [[nodiscard]] std::uint32_t block_here() const { return open_.empty() ? 0 : open_.back().id; }
  [[nodiscard]] bool encloses(std::uint32_t outer, std::uint32_t inner) const;
  [[nodiscard]] std::uint32_t new_id(std::uint32_t parent);

  Emitter& emitter_;
  Faults& faults_;
  std::vector<Block> open_;
  std::vector<std::uint32_t> parents_ = {0};  // of block ids; 0: outside blocks
  std::unordered_map<std::string_view, Label> labels_;
  std::vector<Jump> jumps_;
  std::optional<Token> subprogram_;
  std::unordered_map<std::string_view, Label> subprograms_;
  std::vector<Jump> calls_;
  bool told_depth_ = false;
};

}  // namespace cellmirror::program::srcl

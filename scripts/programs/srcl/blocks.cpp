#include "scripts/programs/srcl/blocks.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace cellmirror::program::srcl {

namespace {

template <class Map>
std::vector<std::string> names_in(const Map& map) {
  std::vector<std::string> names;
  names.reserve(map.size());
  for (const auto& [name, value] : map) names.emplace_back(name);
  std::ranges::sort(names);
  return names;
}

}  // namespace

Keyword closing(Keyword begin) {
  switch (begin) {
    case Keyword::if_begin:
      return Keyword::if_end;
    case Keyword::while_begin:
      return Keyword::while_end;
    case Keyword::count_begin:
      return Keyword::count_end;
    case Keyword::repeat_begin:
      return Keyword::until;
    default:
      return Keyword::loop_end;
  }
}

std::uint32_t Blocks::new_id(std::uint32_t parent) {
  parents_.push_back(parent);
  return static_cast<std::uint32_t>(parents_.size() - 1);
}

Block& Blocks::open(Keyword begin, const Token& at) {
  if (open_.size() >= kMostNested && !told_depth_) {
    told_depth_ = true;
    faults_.add(at, fmt::format("more than {} nested blocks", kMostNested), "move some into a subprogram");
  }
  const std::uint32_t parent = block_here();
  Block& block = open_.emplace_back();
  block.begin = begin;
  block.at = at;
  block.id = new_id(parent);
  block.top = emitter_.here();
  return block;
}

Block* Blocks::innermost_loop() {
  for (std::size_t i = open_.size(); i > 0; --i) {
    if (open_[i - 1].loops()) return &open_[i - 1];
  }
  return nullptr;
}

Block* Blocks::find_to_close(Keyword begin, const Token& at) {
  std::size_t found = open_.size();
  // Bounded: only permitted nesting levels are searched.
  for (std::size_t looked = 0; found > 0 && looked <= kMostNested; --found, ++looked) {
    if (open_[found - 1].begin == begin) break;
  }
  if (found == 0 || open_[found - 1].begin != begin) {
    faults_.add(at, fmt::format("{} has no {} before it", shown(at), spelling(begin)),
                fmt::format("write {} before it, or delete it", spelling(begin)));
    return nullptr;
  }
  while (open_.size() > found) {
    const Block& inner = open_.back();
    faults_.add(inner.at,
                fmt::format("{} is not closed before {} in line {}", spelling(inner.begin), shown(at), at.line),
                fmt::format("write {} before that line", spelling(closing(inner.begin))));
    close();
  }
  return &open_.back();
}

void Blocks::close() {
  const Block& block = open_.back();
  const StatementId here = emitter_.here();
  if (block.skip != kNone) emitter_.set_target(block.skip, here);
  for (const StatementId jump : block.exits) emitter_.set_target(jump, here);
  for (const StatementId jump : block.next_rounds) emitter_.set_target(jump, block.top);
  open_.pop_back();
}

void Blocks::close_all() {
  while (!open_.empty()) {
    const Block& block = open_.back();
    faults_.add(block.at, fmt::format("{} is not closed", spelling(block.begin)),
                fmt::format("write {} after its statements", spelling(closing(block.begin))));
    close();
  }
}

void Blocks::begin_branch() {
  Block& block = open_.back();
  block.id = new_id(parents_[block.id]);
}

void Blocks::label(const Token& name) {
  const Label label{emitter_.here(), block_here(), name.line};
  const auto [at, fresh] = labels_.emplace(name.text, label);
  if (!fresh) {
    faults_.add(name, fmt::format("the label {} exists already, in line {}", shown(name), at->second.line),
                "give one of the two another name");
  }
  emitter_.name_next(std::string(name.text));
}

void Blocks::jump(const Token& name, const Token& at) {
  jumps_.push_back({emitter_.add(JumpStatement{}, at), block_here(), name});
}

bool Blocks::encloses(std::uint32_t outer, std::uint32_t inner) const {
  // Deeper ones have been reported; the way out is bounded, too.
  for (std::size_t step = 0; step <= kMostNested && inner > outer; ++step) inner = parents_[inner];
  return inner == outer;
}

void Blocks::resolve_jumps() {
  std::vector<std::string> names;
  for (const Jump& jump : jumps_) {
    const auto label = labels_.find(jump.name.text);
    if (label == labels_.end()) {
      if (names.empty() && faults_.may_propose(labels_.size())) names = names_in(labels_);
      const std::string_view where = in_subprogram() ? "this subprogram" : "the main program";
      faults_.add(
          jump.name, fmt::format("there is no label {} in {}", shown(jump.name), where),
          faults_.proposal(jump.name.text, names, fmt::format("write '{}:' before a statement", jump.name.text)));
    } else if (!encloses(label->second.block, jump.block)) {
      faults_.add(jump.name,
                  fmt::format("the label {} in line {} is in a block, which no jump may enter", shown(jump.name),
                              label->second.line),
                  "put the label before the block");
    } else {
      emitter_.set_target(jump.statement, label->second.statement);
    }
  }
}

void Blocks::close_routine() {
  close_all();
  resolve_jumps();
  labels_.clear();
  jumps_.clear();
}

void Blocks::begin_subprogram(const Token& name, const Token& at) {
  if (in_subprogram()) {
    faults_.add(at, fmt::format("the subprogram {} of line {} is not closed", shown(*subprogram_), subprogram_->line),
                "write ENDE_UPRO before this line");
    end_subprogram(at);
  } else {
    close_routine();
    // The end of the main program must not continue in the first subprogram.
    if (subprograms_.empty()) emitter_.add(EndStatement{}, at);
  }
  const auto [earlier, fresh] = subprograms_.emplace(name.text, Label{emitter_.here(), 0, name.line});
  if (!fresh) {
    faults_.add(name, fmt::format("the subprogram {} exists already, in line {}", shown(name), earlier->second.line),
                "give one of the two another name");
  }
  subprogram_ = name;
}

void Blocks::end_subprogram(const Token& at) {
  if (!in_subprogram()) {
    faults_.add(at, "ENDE_UPRO has no UPRO before it", "delete it, or write UPRO and a name before the subprogram");
    return;
  }
  close_routine();
  emitter_.add(ReturnStatement{}, at);
  subprogram_.reset();
}

void Blocks::call(const Token& name, const Token& at) {
  calls_.push_back({emitter_.add(CallStatement{}, at), 0, name});
}

void Blocks::resolve_calls() {
  std::vector<std::string> names;
  for (const Jump& call : calls_) {
    const auto subprogram = subprograms_.find(call.name.text);
    if (subprogram != subprograms_.end()) {
      emitter_.set_target(call.statement, subprogram->second.statement);
      continue;
    }
    if (names.empty() && faults_.may_propose(subprograms_.size())) names = names_in(subprograms_);
    faults_.add(
        call.name, fmt::format("there is no subprogram {}", shown(call.name)),
        faults_.proposal(call.name.text, names,
                         fmt::format("write 'UPRO {}' ... 'ENDE_UPRO' after the main program", call.name.text)));
  }
}

void Blocks::finish() {
  if (in_subprogram()) {
    faults_.add(*subprogram_, fmt::format("the subprogram {} is not closed", shown(*subprogram_)),
                "write ENDE_UPRO at its end");
  }
  close_routine();
  resolve_calls();
}

}  // namespace cellmirror::program::srcl

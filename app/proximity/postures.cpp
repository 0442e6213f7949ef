#include "app/proximity/postures.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>

#include "rt_core/base/text.hpp"

namespace cellmirror::app {

Postures::Postures(std::string file, const Cell& cell)
    : file_(std::move(file)), cell_(cell), q_(cell.start_positions()) {}

std::unique_ptr<Postures> Postures::open(const std::string& file, const Cell& cell, Diagnostics& diagnostics,
                                         const ReadProgress& progress) {
  std::unique_ptr<Postures> out(new Postures(file, cell));
  if (file.empty()) return out;
  std::error_code failure;
  if (!std::filesystem::is_regular_file(file, failure)) {
    const bool exists = std::filesystem::exists(file, failure);
    diagnostics.error({printable(file, 200)}, exists ? "this is no regular file" : "there is no such file",
                      exists ? "postures are read twice: write them to a file" : "");
    return nullptr;
  }
  if (!out->check(diagnostics, progress) || !out->rewind()) {
    if (diagnostics.ok()) diagnostics.error({file}, "the file cannot be read");
    return nullptr;
  }
  return out;
}

bool Postures::check(Diagnostics& diagnostics, const ReadProgress& progress) {
  std::error_code failure;
  const std::uint64_t size = std::filesystem::file_size(file_, failure);
  in_.open(file_, std::ios::binary);
  if (!in_) return false;
  Diagnostics found;
  PostureReader reader(in_, file_, cell_, found);
  if (reader.read_header()) {
    constexpr std::uint64_t kEvery = 4096;  // rows
    const std::shared_ptr<const CompiledCell> compiled = cell_.compile();
    while (reader.read_row(q_)) {
      (void)ranges_.note(*compiled, q_);
      if (progress && reader.rows() % kEvery == 0) progress(static_cast<std::uint64_t>(in_.tellg()), size);
    }
    reader.finish();
  }
  count_ = reader.rows();
  diagnostics.take(found);
  return found.ok();
}

bool Postures::rewind() {
  q_ = cell_.start_positions();
  in_.close();
  in_.clear();
  in_.open(file_, std::ios::binary);
  if (!in_) return false;
  reader_.emplace(in_, file_, cell_, again_);
  return reader_->read_header();
}

Result<bool> Postures::next() {
  if (given_ == count_) return false;
  ++given_;
  if (!reader_) return true;
  if (reader_->read_row(q_) && again_.ok()) return true;
  return fail(fmt::format("{} has changed while it was read", printable(file_, 200)), "run it again");
}

}  // namespace cellmirror::app

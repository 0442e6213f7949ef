// Bytes in memory as a stream that can be read and positioned, without a copy.
#pragma once

#include <istream>
#include <streambuf>
#include <string_view>

namespace cellmirror {

class MemoryBuffer final : public std::streambuf {
 public:
  explicit MemoryBuffer(std::string_view bytes);
  // Whether more than the bytes was wanted.
  [[nodiscard]] bool overran() const { return overran_; }
  // Whether the bytes ended within what was wanted.
  [[nodiscard]] bool cut() const { return cut_; }

 protected:
  int_type underflow() override;
  std::streamsize xsgetn(char* to, std::streamsize count) override;
  pos_type seekoff(off_type offset, std::ios_base::seekdir from, std::ios_base::openmode which) override;
  pos_type seekpos(pos_type at, std::ios_base::openmode which) override;

 private:
  bool overran_ = false;
  bool cut_ = false;
};

}  // namespace cellmirror

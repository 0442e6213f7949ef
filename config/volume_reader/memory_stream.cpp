#include "config/volume_reader/memory_stream.hpp"

#include <algorithm>
#include <cstring>

namespace cellmirror {

MemoryBuffer::MemoryBuffer(std::string_view bytes) {
  char* first = const_cast<char*>(bytes.data());  // never written: there is no overflow()
  setg(first, first, first + bytes.size());
}

MemoryBuffer::int_type MemoryBuffer::underflow() {
  if (gptr() < egptr()) return traits_type::to_int_type(*gptr());
  overran_ = true;
  return traits_type::eof();
}

std::streamsize MemoryBuffer::xsgetn(char* to, std::streamsize count) {
  const std::streamsize there = std::min<std::streamsize>(count, egptr() - gptr());
  if (there < count) overran_ = true;
  if (there < count && there > 0) cut_ = true;
  if (there <= 0) return 0;
  std::memcpy(to, gptr(), static_cast<std::size_t>(there));
  setg(eback(), gptr() + there, egptr());
  return there;
}

MemoryBuffer::pos_type MemoryBuffer::seekoff(off_type offset, std::ios_base::seekdir from, std::ios_base::openmode) {
  const off_type size = egptr() - eback();
  off_type base = 0;
  if (from == std::ios_base::cur) base = gptr() - eback();
  if (from == std::ios_base::end) base = size;
  if (offset > size - base) overran_ = true;
  if (offset > size - base || offset < -base) return {off_type(-1)};
  setg(eback(), eback() + base + offset, egptr());
  return {base + offset};
}

MemoryBuffer::pos_type MemoryBuffer::seekpos(pos_type at, std::ios_base::openmode which) {
  return seekoff(off_type(at), std::ios_base::beg, which);
}

}  // namespace cellmirror

// One client of the control socket, as seen by the server: collects a request line, then sends the answer.
#pragma once

#include <cstddef>
#include <string>

#include "rt_core/base/descriptor.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror {

class ControlConnection {
 public:
  enum class Progress { waiting, request_complete, too_long, finished, failed };

  // `socket` does not block. `deadline`: until when the request must be there; answering has as long again.
  ControlConnection(Descriptor socket, Timestamp deadline) : socket_(std::move(socket)), deadline_(deadline) {}

  // Takes what has come.
  Progress read_some();
  // The request line without its line break; after request_complete.
  [[nodiscard]] std::string_view request() const;
  // The answer and its line break are sent from now on.
  void answer(std::string text, Timestamp deadline);
  // Sends what fits.
  Progress write_some();

  [[nodiscard]] bool answering() const { return answering_; }
  [[nodiscard]] int fd() const { return socket_.get(); }
  [[nodiscard]] Timestamp deadline() const { return deadline_; }

 private:
  Descriptor socket_;
  Timestamp deadline_;
  bool answering_ = false;
  std::string buffer_;        // request, then answer
  std::size_t position_ = 0;  // end of the request line; bytes of the answer that are sent
};

}  // namespace cellmirror

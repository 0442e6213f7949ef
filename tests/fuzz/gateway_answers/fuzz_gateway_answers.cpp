// Any bytes as the answer of a gateway on its control socket, through a socket as a client reads them, and then as a
// picture, as an error and as what it says about its queues. A document or a reason, never an end of the program.
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

#include "app/pictures/snapshot_request.hpp"
#include "ipc/control/control_client.hpp"
#include "ipc/control/control_request.hpp"
#include "ipc/control/queue_answer.hpp"
#include "ipc/control/unix_address.hpp"
#include "rt_core/base/contract.hpp"
#include "rt_core/base/descriptor.hpp"

namespace {

using namespace cellmirror;

// A gateway that answers every request with the same bytes and closes.
class Gateway {
 public:
  Gateway() {
    std::string pattern = (std::filesystem::temp_directory_path() / "cellmirror-fuzz-XXXXXX").string();
    CELLMIRROR_EXPECTS(mkdtemp(pattern.data()) != nullptr);
    folder_ = pattern;
    const auto address = unix_address(socket());
    CELLMIRROR_EXPECTS(address.has_value());
    listening_ = Descriptor(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
    CELLMIRROR_EXPECTS(::bind(listening_.get(), reinterpret_cast<const sockaddr*>(&*address), sizeof *address) == 0);
    CELLMIRROR_EXPECTS(::listen(listening_.get(), 4) == 0);
    std::thread([this] { serve(); }).detach();  // until the end of the process, as this object
  }
  ~Gateway() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  Gateway(const Gateway&) = delete;
  Gateway& operator=(const Gateway&) = delete;

  [[nodiscard]] std::filesystem::path socket() const { return folder_ / "control.sock"; }
  void answer_with(std::string_view bytes) {
    const std::lock_guard lock(mutex_);
    answer_ = bytes;
  }

 private:
  void serve() {
    while (true) {
      const Descriptor client(::accept(listening_.get(), nullptr, nullptr));
      if (!client.valid()) return;
      char byte = 0;
      while (::recv(client.get(), &byte, 1, 0) == 1 && byte != '\n') continue;
      const std::lock_guard lock(mutex_);
      std::string_view left = answer_;
      while (!left.empty()) {
        const ssize_t sent = ::send(client.get(), left.data(), left.size(), MSG_NOSIGNAL);
        if (sent <= 0) break;
        left.remove_prefix(static_cast<std::size_t>(sent));
      }
    }
  }

  std::filesystem::path folder_;
  Descriptor listening_;
  std::mutex mutex_;
  std::string answer_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static Gateway gateway;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  gateway.answer_with(bytes);
  const auto answer = control_request_at(gateway.socket(), "fuzz", R"({"request":"status"})", std::chrono::seconds(4));
  const std::string_view document = bytes.substr(0, bytes.empty() ? 0 : bytes.size() - 1);
  if (answer) {
    CELLMIRROR_EXPECTS(bytes.ends_with('\n') && *answer == document && !control_error_in(document));
  } else {
    CELLMIRROR_EXPECTS(!answer.error().what.empty());
    CELLMIRROR_EXPECTS(!bytes.ends_with('\n') || control_error_in(document));
  }
  if (const auto picture = app::snapshot_answer(bytes); !picture) CELLMIRROR_EXPECTS(!picture.error().what.empty());
  if (const auto queues = parse_queue_answer(bytes)) {
    CELLMIRROR_EXPECTS(queues->script_queue >= 0 && queues->reply_queue >= 0);
  } else {
    CELLMIRROR_EXPECTS(!queues.error().what.empty());
  }
  return 0;
}

#include "drivers/dds/process/library_log.hpp"

#include <fastdds/dds/log/Log.hpp>
#include <memory>
#include <string>

namespace cellmirror::dds {

namespace {

using eprosima::fastdds::dds::Log;

constexpr std::size_t kMostText = 400;

class ToCellmirror final : public eprosima::fastdds::dds::LogConsumer {
 public:
  explicit ToCellmirror(EventSender& sender) : sender_(sender) {}
  // The library's log thread calls this.
  void Consume(const Log::Entry& entry) override {
    const std::string category = entry.context.category != nullptr ? entry.context.category : "";
    sender_.send(LibraryLog{entry.kind == Log::Kind::Error, category, entry.message.substr(0, kMostText)});
  }

 private:
  EventSender& sender_;
};

}  // namespace

void send_library_log(EventSender& sender) {
  Log::ClearConsumers();
  Log::RegisterConsumer(std::make_unique<ToCellmirror>(sender));
  Log::SetVerbosity(Log::Kind::Warning);
}

}  // namespace cellmirror::dds

#if defined(__SANITIZE_ADDRESS__) || defined(CELLMIRROR_SANITIZED)
// Fast DDS 2.9 deletes its writers' statistics through a base class of another size; AddressSanitizer would end
// the process when it removes a writer. Read by the sanitizer's run time when the program starts.
extern "C" const char* __asan_default_options();  // NOLINT(bugprone-reserved-identifier)
extern "C" const char* __asan_default_options() { return "new_delete_type_mismatch=0"; }
#endif

#include "drivers/dds/internal/library_log.hpp"

#include <fastdds/dds/log/Log.hpp>
#include <memory>
#include <string>

#include "rt_core/base/log.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror::dds {

namespace {

using eprosima::fastdds::dds::Log;

class ToOurLog final : public eprosima::fastdds::dds::LogConsumer {
 public:
  // On the library's log thread.
  void Consume(const Log::Entry& entry) override {
    const LogLevel level = entry.kind == Log::Kind::Error ? LogLevel::warning : LogLevel::info;
    const std::string category = entry.context.category != nullptr ? entry.context.category : "";
    log_text(level, "dds.library " + category, printable(entry.message, 400));
  }
};

// The library's log thread outlives our log at the end of the process unless it is stopped before.
struct Redirection {
  Redirection() {
    log_text(LogLevel::debug, "dds.library", "redirected");  // our log exists first, so that it goes last
    Log::ClearConsumers();
    Log::RegisterConsumer(std::make_unique<ToOurLog>());
    Log::SetVerbosity(Log::Kind::Warning);
  }
  ~Redirection() {
    Log::ClearConsumers();
    Log::KillThread();
  }
  Redirection(const Redirection&) = delete;
  Redirection& operator=(const Redirection&) = delete;
};

}  // namespace

void redirect_library_log() { static const Redirection redirection; }

}  // namespace cellmirror::dds

#if defined(__SANITIZE_ADDRESS__) || defined(CELLMIRROR_SANITIZED)
// Fast DDS 2.9 deletes its writers' statistics through a base class of another size; AddressSanitizer would stop every
// program that removes a writer. Read by the sanitizer's run time when the program starts.
extern "C" const char* __asan_default_options();  // NOLINT(bugprone-reserved-identifier)
extern "C" const char* __asan_default_options() { return "new_delete_type_mismatch=0"; }
#endif

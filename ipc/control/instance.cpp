#include "ipc/control/instance.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <system_error>
#include <utility>

#include "ipc/runtime/ipc_owner.hpp"
#include "ipc/runtime/runtime_folder.hpp"
#include "ipc/runtime/system_error.hpp"
#include "rt_core/base/descriptor.hpp"

namespace cellmirror {
namespace {

using nlohmann::json;

constexpr std::size_t kLongestName = 32;
constexpr std::size_t kLargestDescription = 65'536;
constexpr std::size_t kMostFolders = 4096;  // in the runtime folder; more are ignored

std::filesystem::path lock_path(const std::filesystem::path& runtime, std::string_view name) {
  return runtime / ".locks" / fmt::format("instance-{}", name);
}

// Another user's gateway is not found in this user's runtime folder, but its SCRIPT queue is in sight of all. Root's
// queue may also be meant for others, but not root's control socket.
std::optional<Error> running_elsewhere(std::string_view name) {
  const std::int32_t key = default_queues(name).script_key;
  const auto queue = ipc_owner(IpcKind::queue, key);
  if (!queue || queue->creator == ::geteuid()) return std::nullopt;
  const pid_t process = gateway_process_of(queue->creator);
  if (process == 0) return std::nullopt;  // killed, or another program's queue
  return Error{fmt::format("a gateway runs as {} (process {}), and only that user and root may ask it",
                           user_text(queue->creator), process),
               "run this as that user; as root, set CELLMIRROR_RUNTIME_DIR to that user's runtime folder"};
}

std::string description(const InstanceInfo& info) {
  const json document{{"name", info.name},
                      {"pid", info.pid},
                      {"cell", info.cell},
                      {"script_key", info.queues.script_key},
                      {"sensor_key", info.queues.sensor_key},
                      {"reply_key", info.queues.reply_key},
                      {"mode", info.queues.mode},
                      {"sensor_rate_hz", info.queues.sensor_rate_hz}};
  return document.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
}

// Readers never see half a file: it is written beside and moved.
Result<void> write_description(const std::filesystem::path& folder, const std::string& text) {
  const auto beside = folder / "instance.json.new";
  const auto failed = [&](int reason) {
    return fail(fmt::format("cannot write {}: {}", beside.native(), system_error_text(reason)));
  };
  ::unlink(beside.c_str());
  const Descriptor file(::open(beside.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0600));
  if (!file.valid()) return failed(errno);
  if (::write(file.get(), text.data(), text.size()) != static_cast<ssize_t>(text.size())) return failed(errno);
  if (::rename(beside.c_str(), (folder / "instance.json").c_str()) != 0) return failed(errno);
  return {};
}

// A number that does not fit is refused: a conversion of its own would be undefined.
template <class Integer>
Integer integer_at(const json& document, const char* name) {
  const json& value = document.at(name);
  const bool fits = value.is_number_unsigned()  ? std::in_range<Integer>(value.get<std::uint64_t>())
                    : value.is_number_integer() ? std::in_range<Integer>(value.get<std::int64_t>())
                                                : false;
  if (!fits) throw json::out_of_range::create(406, fmt::format("{} is no number of its type", name), &document);
  return value.get<Integer>();
}

Result<InstanceInfo> read_description(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string text(kLargestDescription, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  try {
    const json document = json::parse(text);
    InstanceInfo info;
    info.name = document.at("name").get<std::string>();
    info.pid = integer_at<pid_t>(document, "pid");
    info.cell = document.at("cell").get<std::string>();
    info.queues.script_key = integer_at<std::int32_t>(document, "script_key");
    info.queues.sensor_key = integer_at<std::int32_t>(document, "sensor_key");
    info.queues.reply_key = integer_at<std::int32_t>(document, "reply_key");
    info.queues.mode = integer_at<std::uint32_t>(document, "mode");
    info.queues.sensor_rate_hz = document.at("sensor_rate_hz").get<double>();
    return info;
  } catch (const json::exception& error) {
    return fail(fmt::format("{} cannot be read: {}", file.native(), error.what()),
                "restart that gateway with this version");
  }
}

void remove_files(const std::filesystem::path& folder) {
  for (const char* name : {"instance.json", "instance.json.new", "control.sock", "page.json"})
    ::unlink((folder / name).c_str());
  ::rmdir(folder.c_str());
}

// Nothing but what a gateway puts there is removed, and only with the instance's lock held.
void clean_up(const std::filesystem::path& runtime, const std::string& name) {
  const auto lock = LockFile::take(lock_path(runtime, name), "");
  if (lock) remove_files(runtime / name);
}

}  // namespace

std::unexpected<Error> not_running(std::string_view name) {
  if (auto elsewhere = running_elsewhere(name)) return std::unexpected(*std::move(elsewhere));
  return fail(fmt::format("no gateway of the instance {} is running", name),
              name == kDefaultInstance ? "start one with cellmirror run CELL.toml"
                                       : fmt::format("start one with cellmirror run CELL.toml --instance {}", name));
}

Result<void> check_instance_name(std::string_view name) {
  const auto allowed = [](char c) {
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  if (name.empty() || name.size() > kLongestName || !std::all_of(name.begin(), name.end(), allowed)) {
    return fail("the instance's name is not 1 to 32 letters, digits, _ and -", "choose another --instance NAME");
  }
  return {};
}

QueueConfig default_queues(std::string_view instance) {
  QueueConfig queues;
  if (instance == kDefaultInstance) return queues;
  // FNV-1a, 32 bits: offset basis and prime of the published algorithm.
  std::uint32_t hash = 2'166'136'261u;
  for (const char c : instance) hash = (hash ^ static_cast<unsigned char>(c)) * 16'777'619u;
  constexpr std::int32_t kFirstKey = 0x434D'0000;  // "CM"
  constexpr std::uint32_t kTriples = 21'845;       // as many as have room below 0x434E0000
  const auto base = kFirstKey + 3 * static_cast<std::int32_t>(hash % kTriples);
  queues.script_key = base;
  queues.sensor_key = base + 1;
  queues.reply_key = base + 2;
  constexpr std::int32_t kFirstForceKey = 0x434E'0000;
  queues.tcp_force_key = kFirstForceKey + static_cast<std::int32_t>(hash % 0x1'0000u);
  return queues;
}

QueueConfig queues_of_instance(std::string_view instance, QueueConfig from_cell) {
  const QueueConfig manual;
  const QueueConfig own = default_queues(instance);
  if (from_cell.script_key == manual.script_key) from_cell.script_key = own.script_key;
  if (from_cell.sensor_key == manual.sensor_key) from_cell.sensor_key = own.sensor_key;
  if (from_cell.reply_key == manual.reply_key) from_cell.reply_key = own.reply_key;
  if (from_cell.tcp_force_key == manual.tcp_force_key) from_cell.tcp_force_key = own.tcp_force_key;
  return from_cell;
}

Result<Instance> Instance::claim(const InstanceInfo& info) {
  if (const auto name = check_instance_name(info.name); !name) return std::unexpected(name.error());
  const auto runtime = runtime_folder();
  if (!runtime) return std::unexpected(runtime.error());
  const auto path = lock_path(*runtime, info.name);
  if (const auto made = make_private_folder(path.parent_path()); !made) return std::unexpected(made.error());
  auto lock = LockFile::take(path, info.name);
  if (!lock) {
    if (lock.error().why == LockFile::Refusal::failed) return std::unexpected(lock.error().error);
    return fail(
        fmt::format("a gateway of the instance {} is already running: process {}", info.name, lock.error().holder.pid),
        "end it, or choose another --instance NAME");
  }
  const auto folder = *runtime / info.name;
  remove_files(folder);  // what a killed gateway left behind
  if (const auto made = make_private_folder(folder); !made) return std::unexpected(made.error());
  InstanceInfo with_pid = info;
  with_pid.pid = ::getpid();
  if (const auto written = write_description(folder, description(with_pid)); !written) {
    return std::unexpected(written.error());
  }
  return Instance(std::move(*lock), std::move(with_pid), folder);
}

Instance::Instance(LockFile lock, InstanceInfo info, std::filesystem::path folder)
    : lock_(std::move(lock)), info_(std::move(info)), folder_(std::move(folder)) {}

Instance::~Instance() {
  if (lock_.held()) remove_files(folder_);
}

Result<InstanceInfo> find_instance(std::string_view name) {
  if (const auto good = check_instance_name(name); !good) return std::unexpected(good.error());
  const auto runtime = runtime_folder_for_client();
  if (!runtime) return std::unexpected(runtime.error());
  if (!lock_holder(lock_path(*runtime, name))) return not_running(name);
  const auto file = *runtime / name / "instance.json";
  std::error_code ignored;
  // Between taking the lock and writing the description a gateway is about to run.
  if (!std::filesystem::exists(file, ignored)) return not_running(name);
  return read_description(file);
}

Result<std::vector<InstanceInfo>> running_instances() {
  const auto runtime = runtime_folder_for_client();
  if (!runtime) return std::unexpected(runtime.error());
  std::vector<std::string> names;
  std::error_code error;
  for (std::filesystem::directory_iterator at(*runtime, error), end; !error && at != end && names.size() < kMostFolders;
       at.increment(error)) {
    std::string name = at->path().filename().native();
    if (check_instance_name(name)) names.push_back(std::move(name));
  }
  std::sort(names.begin(), names.end());
  std::vector<InstanceInfo> running;
  for (const std::string& name : names) {
    if (!lock_holder(lock_path(*runtime, name))) {
      clean_up(*runtime, name);
    } else if (auto info = find_instance(name)) {
      running.push_back(std::move(*info));
    }
  }
  return running;
}

Result<std::filesystem::path> control_socket_of(std::string_view instance) {
  if (const auto good = check_instance_name(instance); !good) return std::unexpected(good.error());
  const auto runtime = runtime_folder_for_client();
  if (!runtime) return std::unexpected(runtime.error());
  return *runtime / instance / "control.sock";
}

}  // namespace cellmirror

// cellmirror-dds: the DDS library for one participant of cellmirror, confined. Started by cellmirror, with a channel
// (ipc/sandbox/channel.hpp) at its descriptors; ends with it.
#include <malloc.h>
#include <unistd.h>

#include <exception>
#include <optional>
#include <string>
#include <vector>

#include "drivers/dds/message/dds_message.hpp"
#include "drivers/dds/process/event_sender.hpp"
#include "drivers/dds/process/library_log.hpp"
#include "drivers/dds/process/participant_host.hpp"
#include "ipc/sandbox/beating.hpp"
#include "ipc/sandbox/channel.hpp"
#include "ipc/sandbox/confinement.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror::dds {
namespace {

constexpr Nanoseconds kBeat{50'000'000};
constexpr int kMostRequests = 1024;                   // between two beats
constexpr int kArenas = 2;                            // of malloc: each takes 64 MB of addresses
constexpr std::uint64_t kAddresses = 1536ULL << 20U;  // with the stacks of the library's threads

// Returns false if the participant is to be closed.
bool carry_out(ParticipantHost& host, const ReceivedMessage<DdsRequest>& request) {
  if (const auto* add = std::get_if<AddEndpoint>(&request.message)) host.add(*add);
  if (const auto* gone = std::get_if<RemoveEndpoint>(&request.message)) host.remove(gone->id);
  if (const auto* sample = std::get_if<WriteSample>(&request.message)) host.write(*sample, request.rest);
  return !std::holds_alternative<CloseParticipant>(request.message);
}

// Waits for the first message of cellmirror.
std::optional<OpenParticipant> wanted_participant(Channel& channel, std::vector<std::byte>& message) {
  while (!channel.ended()) {
    if (channel.receive(message) == RingResult::done) {
      const auto request = decode_request(message);
      if (!request || !std::holds_alternative<OpenParticipant>(request->message)) return std::nullopt;
      return std::get<OpenParticipant>(request->message);
    }
    channel.wait(kBeat);
    channel.beat();
  }
  return std::nullopt;
}

void serve(Channel& channel, EventSender& sender, ParticipantHost& host, std::vector<std::byte>& message) {
  while (!channel.ended()) {
    for (int i = 0; i < kMostRequests && channel.receive(message) == RingResult::done; ++i) {
      const auto request = decode_request(message);
      if (!request || !carry_out(host, *request)) return;
    }
    sender.flush();
    channel.beat();
    channel.wait(kBeat);
  }
}

int run() {
  mallopt(M_ARENA_MAX, kArenas);
  auto channel = Channel::attach();
  if (!channel) return 2;
  std::vector<std::byte> message;
  const auto wanted = wanted_participant(*channel, message);
  if (!wanted) return 1;
  const DdsSecurityConfig& files = wanted->security;
  const std::vector<std::string> readable{files.identity_ca,    files.certificate, files.private_key,
                                          files.permissions_ca, files.governance,  files.permissions};
  channel->set_confinement(confine_to_network({.address_space_bytes = kAddresses, .readable = readable}));
  EventSender sender(*channel);
  send_library_log(sender);
  ParticipantHost host(sender);
  {
    const Beating beating(*channel);
    if (!host.open(*wanted)) return 1;
  }
  forbid_opening_files();
  serve(*channel, sender, host, message);
  return 0;
}

}  // namespace
}  // namespace cellmirror::dds

int main() {
  int status = 1;
  try {
    status = cellmirror::dds::run();
  } catch (const std::exception&) {
    status = 1;
  }
  // The library's objects with static lifetime have nothing to do.
  _exit(status);
}

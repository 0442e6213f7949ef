// The process data objects of a CANopen device (CiA 301, 7.2.2): four received and four sent ones, whose parameters and
// mappings a master sets in the object dictionary. No I/O, no clock.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "drivers/can/canopen/frame_output.hpp"
#include "drivers/can/canopen/object_dictionary.hpp"
#include "drivers/can/canopen/sdo.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/stream_config.hpp"

namespace cellmirror::can {

inline constexpr std::uint16_t kSlavePdos = 4;  // of each direction

// Objects 0x1400.., 0x1600.., 0x1800.., 0x1A00.. of all PDOs; those that `rpdos` and `tpdos` do not have are invalid
// and wait for a master. Breaks its contract for numbers beyond 1..4 and mappings that are not valid.
void add_pdo_objects(ObjectDictionary& objects, std::uint8_t node, std::span<const TpdoConfig> rpdos,
                     std::span<const TpdoConfig> tpdos);

// What of a change of a mapped object is an event.
class PdoEvents {
 public:
  virtual ~PdoEvents() = default;
  // `sent`: the value that the TPDO had last, bit by bit; it differs from `now`.
  [[nodiscard]] virtual bool is_event(ObjectAddress /*address*/, std::uint64_t /*sent*/, std::uint64_t /*now*/) const {
    return true;
  }
};

class SlavePdos {
 public:
  enum class Received : std::uint8_t { none, taken, too_short };

  // `event`: the object whose change is an event also where a TPDO has an event timer. The others outlive this.
  SlavePdos(ObjectDictionary& objects, ObjectAddress event, const PdoEvents& events, FrameOutput& output);

  [[nodiscard]] static bool is_parameter(ObjectAddress address) {
    return address.index >= 0x1400 && address.index <= 0x1BFF;
  }
  // Why a write of a PDO parameter, which fits its type, is refused (CiA 301, 7.5.2.35 to 7.5.2.38).
  [[nodiscard]] std::optional<SdoAbort> check(ObjectAddress address, std::uint64_t value) const;
  // Takes the parameters of all PDOs from the dictionary; their timers begin again.
  void load(Timestamp now);
  // The same for the PDO that has this parameter; the others go on.
  void load_pdo_of(ObjectAddress parameter, Timestamp now);
  // NMT operational begins: event-driven TPDOs are sent once.
  void start(Timestamp now);
  void stop();  // NMT operational ends: RPDOs are no longer watched

  // Appends the identifiers of the valid RPDOs, and of the TPDOs that allow RTR, to `identifiers`. They change with
  // load() and load_pdo_of() only.
  void list_identifiers(std::vector<std::uint32_t>& identifiers) const;
  // An RPDO's values go into the dictionary now, or with the next SYNC; `written` gets the objects.
  [[nodiscard]] Received receive(const CanFrame& frame, std::vector<ObjectAddress>& written, Timestamp now);
  // Answers a remote frame with this identifier: sends the TPDO if its COB-ID allows RTR.
  void request(std::uint32_t id, Timestamp now);
  // Returns true, once per timeout, if an RPDO has not arrived within its event timer. The timer starts with the first
  // RPDO.
  [[nodiscard]] bool watch(Timestamp now);
  [[nodiscard]] bool is_late() const;  // an RPDO that watch() has reported is still missing
  // Sends the TPDOs of this SYNC; `counter` where the SYNC has one.
  void send_on_sync(std::optional<std::uint8_t> counter, Timestamp now);
  // Then the RPDOs that waited for it.
  void apply_on_sync(std::vector<ObjectAddress>& written);
  // Values have changed: sends event-driven TPDOs, as their inhibit times allow.
  void changed(Timestamp now);
  void advance(Timestamp now);  // event timers, ends of inhibit times
  [[nodiscard]] Timestamp next_due() const;

 private:
  struct Tpdo {
    std::uint32_t cob_id = 0;
    bool valid = false;
    bool on_request = false;  // RTR is allowed
    std::uint8_t transmission_type = 255;
    std::uint8_t sync_start = 0;  // counter of the SYNC that the count of SYNCs begins with; 0: any
    bool counting = true;
    Nanoseconds inhibit{0};
    Nanoseconds event_timer{0};
    std::vector<PdoEntryConfig> entries;
    unsigned syncs = 0;    // since it was sent
    Timestamp sent;        // last time
    Timestamp event_due;   // event timer
    bool pending = false;  // a change waits for the end of the inhibit time
    std::vector<std::uint64_t> last;
  };
  struct Rpdo {
    std::uint32_t cob_id = 0;
    bool valid = false;
    bool on_sync = false;
    std::vector<PdoEntryConfig> entries;
    std::optional<CanFrame> waiting;  // for the next SYNC
    Nanoseconds event_timer{0};
    Timestamp due;  // the RPDO is late from this time on
    bool late = false;
  };

  [[nodiscard]] std::uint32_t number(std::uint16_t index, std::uint8_t subindex) const;
  [[nodiscard]] std::vector<PdoEntryConfig> mapping_of(std::uint16_t index) const;
  [[nodiscard]] std::optional<SdoAbort> check_parameter(ObjectAddress address, std::uint64_t value) const;
  [[nodiscard]] std::optional<SdoAbort> check_mapping(ObjectAddress address, std::uint64_t value) const;
  [[nodiscard]] std::optional<SdoAbort> check_mapping_count(ObjectAddress address, std::uint64_t value) const;
  [[nodiscard]] std::optional<SdoAbort> check_mapped_object(bool received, std::uint32_t word) const;
  void load_tpdo(std::uint16_t i, Timestamp now);
  void load_rpdo(std::uint16_t i);
  void apply(const Rpdo& rpdo, const CanFrame& frame, std::vector<ObjectAddress>& written);
  [[nodiscard]] bool has_event(const Tpdo& tpdo, std::span<const std::uint64_t> values) const;
  [[nodiscard]] bool event_differs(const Tpdo& tpdo, std::span<const std::uint64_t> values) const;
  [[nodiscard]] bool counts(Tpdo& tpdo, std::optional<std::uint8_t> counter) const;
  void read_values(const Tpdo& tpdo, std::vector<std::uint64_t>& values) const;
  void send(Tpdo& tpdo, Timestamp now);

  ObjectDictionary* objects_;
  ObjectAddress event_;
  const PdoEvents* events_;
  FrameOutput* output_;
  std::vector<Tpdo> tpdos_;
  std::vector<Rpdo> rpdos_;
  std::vector<std::uint64_t> values_;  // of the TPDO under way
};

}  // namespace cellmirror::can

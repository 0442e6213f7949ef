// What a cell file says about the end-to-end protection of CAN frames. Plain data.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "rt_core/base/diagnostics.hpp"

namespace cellmirror {

struct CrcParameters {
  std::uint8_t width = 8;  // bits: 8 or 16
  std::uint16_t polynomial = 0;
  std::uint16_t initial = 0;
  std::uint16_t final_xor = 0;
};

enum class E2eProfile : std::uint8_t { p01, p02, p05, described };

// Profile 1: which bytes of the data id go into the CRC.
enum class E2eDataIdMode : std::uint8_t { both, alternating, low, nibble };

struct E2eConfig {
  std::string message = {};  // name in the DBC
  E2eProfile profile = E2eProfile::p01;
  // Profiles 1 and 5: one of 16 bits. Profile 2: sixteen of 8 bits, by the counter. Described: up to sixteen bytes.
  std::vector<std::uint16_t> data_id = {};
  E2eDataIdMode data_id_mode = E2eDataIdMode::both;
  std::uint8_t max_delta = 1;
  // Described; elsewhere the profile has them.
  std::string counter_signal = {};
  std::string crc_signal = {};
  CrcParameters crc = {};
  std::uint16_t last_counter = 0;  // 0: all bits set
  bool data_id_first = false;
  Place place = {};  // of the table
};

}  // namespace cellmirror

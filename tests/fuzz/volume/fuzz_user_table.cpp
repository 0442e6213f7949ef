// Any bytes as a user's look-up table: bounded, in range, rising, and usable as a table.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "rt_core/base/contract.hpp"
#include "rt_core/volume/transfer.hpp"
#include "rt_core/volume/user_table.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cellmirror;
  Diagnostics diagnostics;
  const auto table = volume::parse_user_table({reinterpret_cast<const char*>(data), size}, "fuzz.lut", diagnostics);
  CELLMIRROR_EXPECTS(table.has_value() == diagnostics.ok());
  if (!table) return 0;
  CELLMIRROR_EXPECTS(table->rows.size() >= 2 && table->rows.size() <= volume::kMostUserRows);
  for (std::size_t i = 0; i < table->rows.size(); ++i) {
    const VolumeUserRow& row = table->rows[i];
    CELLMIRROR_EXPECTS(i == 0 || row.value > table->rows[i - 1].value);
    CELLMIRROR_EXPECTS(row.opacity >= 0 && row.opacity <= 1);
    for (const float part : row.rgb) CELLMIRROR_EXPECTS(part >= 0 && part <= 1);
  }
  volume::TransferRequest request;
  request.settings.table = VolumeTable::user1;
  request.user[0] = std::make_shared<const VolumeUserTable>(*table);
  for (const volume::Appearance& look : volume::make_transfer(request, 64).entries)
    CELLMIRROR_EXPECTS(std::isfinite(look.extinction) && look.extinction >= 0);
  return 0;
}

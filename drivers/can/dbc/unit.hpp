// What one unit of a DBC's signal is in SI.
#pragma once

#include <optional>
#include <string_view>

namespace cellmirror::can {

// rad, m, rad/s, m/s, Nm or N in one `unit` as DBC files write it ("deg", "mm", "rpm"), by any quantity. Nothing for
// those that are SI and for words that are not known, are ambiguous ("grad" is German for degree) or have no meaning
// for a joint.
[[nodiscard]] std::optional<double> si_scale_of(std::string_view unit);

}  // namespace cellmirror::can

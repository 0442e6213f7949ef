// What was understood of a volume, as text, JSON and a figure.
#pragma once

#include <string>

#include "app/plot/figure.hpp"
#include "app/volume_info/volume_summary.hpp"
#include "config/volume/volume_data.hpp"
#include "rt_core/base/diagnostics.hpp"

namespace cellmirror::app {

[[nodiscard]] std::string volume_text(const VolumeData& volume, const VolumeSummary& summary);

// `file`: as the user named it. The document is described in docs/cell-files.md.
[[nodiscard]] std::string volume_json(const std::string& file, const VolumeData& volume, const VolumeSummary& summary,
                                      const Diagnostics& diagnostics);

// Three slices through the middle and the histogram.
[[nodiscard]] plot::Figure volume_figure(const std::string& file, const VolumeData& volume,
                                         const VolumeSummary& summary, const GreyWindow& window);

}  // namespace cellmirror::app

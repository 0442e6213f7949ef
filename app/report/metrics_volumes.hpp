// Figures of voxel volumes in the metrics.
#pragma once

#include "app/report/metrics.hpp"

namespace cellmirror::app {

// Nothing where the cell has no voxel volume.
void add_volume_metrics(MetricsText& out, const LiveSources& sources);

}  // namespace cellmirror::app

// Figures of deformable objects in the metrics.
#pragma once

#include "app/report/metrics.hpp"

namespace cellmirror::app {

// Nothing where there is no report.
void add_tissue_metrics(MetricsText& out, const LiveSources& sources);

}  // namespace cellmirror::app

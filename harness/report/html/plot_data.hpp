// The plots of a Document as JSON, for its scripts.
#pragma once

#include <string>

#include "harness/report/document.hpp"

namespace attest {

// {"groups": [{"title": "", "x_label": "time [s]", "plots": [
//     {"title": "Body rates", "unit": "rad/s", "note": "", "shape": "line",
//      "logarithmic_x": false, "logarithmic_y": false, "marks": [{"x": 0.4, "text": "..."}],
//      "grids": ["..."],
//      "series": [{"name": "...", "grid": 0, "y": "...", "pattern": "solid", "colour": 0}],
//      "band": {"name": "tolerance", "grid": 0, "low": "...", "high": "..."}}]}],
//  "replay": [{"name": "", "time": "...", "attitude": ["...", 4 times], "setpoint": [...]}]}
//
// The texts "..." in grids, y, low, high and the replay are base64 of float32. `grid` is an index
// into the grids, the x values at which something is drawn. `<` is escaped.
std::string plot_data_json(const Document& page);

}  // namespace attest

// The plots of a document as JSON, for the scripts of its page; numbers and JSON in a page.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "harness/report/document.hpp"

namespace attest {

// {"groups": [{"title": "", "x_label": "time [s]", "plots": [
//     {"title": "Body rates", "unit": "rad/s", "note": "", "shape": "line",
//      "logarithmic_x": false, "logarithmic_y": false,
//
//      "marks": [{"x": 0.4, "text": "...", "quiet": false}],
//      "bounds": [{"first": 0, "last": 2, "level": 5, "text": "...", "upper": true,
//                  "missed": false}],
//
//      "grids": ["..."],
//
//      "series": [{"name": "...", "grid": 0, "y": "...", "pattern": "solid", "colour": 0}],
//
//      "band": {"name": "tolerance", "grid": 0, "low": "...", "high": "..."}}]}],
//  "replay": [{"name": "", "time": "...", "attitude": ["...", 4 times], "setpoint": [...]}]}
//
// The texts "..." in grids, y, low, high and the replay are base64 of float32. `grid` is an index
// into the grids, the x values at which something is drawn. `<` is escaped.
std::string plot_data_json(const Document& page);

// Base64 (RFC 4648, with padding); of numbers, of their bytes, least significant byte first.
std::string base64(std::string_view bytes);
std::string base64(std::span<const float> numbers);

// JSON on one line, as the content of a <script> element. "</script" and "<!--" would end or change
// the element, so `<` is written as \u003c.
std::string script_json(const nlohmann::json& value);

// The ticks at which to draw series of equal length: all of them, or, of a series longer than
// `most`, approximately `most` or fewer. The series are divided into parts of equal length. The
// ticks of the smallest and the largest value of each part are kept, and that of its first NaN, so
// that no spike is lost. The first and the last tick of the series are kept, too. REQUIRES: at
// least one series.
std::vector<std::size_t> extreme_ticks(std::span<const std::vector<float>> series,
                                       std::size_t most);

// Adds `marked`, the tick before it and the tick after it to the ascending `kept`. Ticks at or
// above `size` are not added.
void keep_neighbours(std::size_t marked, std::size_t size, std::vector<std::size_t>& kept);

}  // namespace attest

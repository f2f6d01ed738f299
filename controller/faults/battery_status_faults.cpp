// Wrong battery estimates.
#include <algorithm>
#include <cmath>
#include <utility>

#include "controller/faults/groups.hpp"

namespace attest::faults {
namespace {

using Law = BatteryStages::Law;
using Options = BatteryStages::Options;
using Sample = BatteryStages::Sample;

template <typename Drop>
void change_drop(FaultyLaw& law, Drop drop) {
  change_stage(law.battery.load_drop_V,
               [drop](const auto& then, const Sample& sample, const Options& options) {
                 return drop(then(sample, options), sample, options);
               });
}

const Fault battery_status_list[] = {
    {"battery-status-pack", "battery_status", Stage::battery_status,
     "uses the voltage of the pack as that of a cell", "always", "a missing factor",
     [](FaultyLaw& law) {
       change_stage(law.battery.measured,
                    [](const auto& then, const Sample& sample, float drop, const Options& options) {
                      Options one_cell = options;
                      one_cell.cell_count = 1;
                      return then(sample, drop, one_cell);
                    });
     }},
    {"battery-status-three-cells", "battery_status", Stage::battery_status,
     "always assumes three cells", "another number of cells", "a wrong parameter",
     [](FaultyLaw& law) {
       change_stage(law.battery.measured,
                    [](const auto& then, const Sample& sample, float drop, const Options& options) {
                      Options three_cells = options;
                      three_cells.cell_count = 3;
                      return then(sample, drop, three_cells);
                    });
     }},
    {"battery-status-default-voltages", "battery_status", Stage::battery_status,
     "keeps the default voltages of a cell", "other voltages", "a wrong parameter",
     [](FaultyLaw& law) {
       change_stage(law.battery.measured,
                    [](const auto& then, const Sample& sample, float drop, const Options& options) {
                      return then(sample, drop, Options{.cell_count = options.cell_count});
                    });
       change_stage(law.battery.scale, [](const auto& then, float remaining, const Options&) {
         return then(remaining, Options{});
       });
     }},
    {"battery-status-no-load", "battery_status", Stage::battery_status,
     "does not correct for the load", "throttle while armed", "a missing term",
     [](FaultyLaw& law) {
       change_drop(law, [](float, const Sample&, const Options&) { return 0.0f; });
     }},
    {"battery-status-load-subtracted", "battery_status", Stage::battery_status,
     "subtracts the drop under load", "throttle while armed", "a sign",
     [](FaultyLaw& law) {
       change_drop(law, [](float drop, const Sample&, const Options&) { return -drop; });
     }},
    {"battery-status-load-disarmed", "battery_status", Stage::battery_status,
     "corrects for a load while disarmed", "throttle while disarmed", "a condition dropped",
     [](FaultyLaw& law) {
       change_stage(law.battery.load_drop_V,
                    [](const auto& then, Sample sample, const Options& options) {
                      sample.armed = true;
                      return then(sample, options);
                    });
     }},
    {"battery-status-throttle-clamped", "battery_status", Stage::battery_status,
     "clamps the throttle to 1", "throttle beyond 1", "a helpful clamp",
     [](FaultyLaw& law) {
       change_stage(law.battery.load_drop_V,
                    [](const auto& then, Sample sample, const Options& options) {
                      sample.throttle = std::clamp(sample.throttle, -1.0f, 1.0f);
                      return then(sample, options);
                    });
     }},
    {"battery-status-no-charging", "battery_status", Stage::battery_status,
     "treats a charging current as 0", "a current below 0", "a helpful clamp",
     [](FaultyLaw& law) {
       change_stage(law.battery.load_drop_V,
                    [](const auto& then, Sample sample, const Options& options) {
                      sample.current_A = std::max(sample.current_A, 0.0f);
                      return then(sample, options);
                    });
     }},
    {"battery-status-no-idle-share", "battery_status", Stage::battery_status,
     "computes a drop of 0 at zero throttle", "throttle below full while armed", "a missing term",
     [](FaultyLaw& law) {
       change_drop(law, [](float drop, const Sample& sample, const Options& options) {
         const bool modelled = sample.armed && !options.internal_resistance_ohm;
         return modelled ? options.load_drop_V * std::abs(sample.throttle) : drop;
       });
     }},
    {"battery-status-not-normalised", "battery_status", Stage::battery_status,
     "exceeds BAT_V_LOAD_DROP at full throttle", "throttle while armed", "a missing factor",
     [](FaultyLaw& law) {
       change_drop(law, [](float drop, const Sample&, const Options& options) {
         return options.internal_resistance_ohm ? drop : drop * (1 + Law::idle_share);
       });
     }},
    {"battery-status-signed-throttle", "battery_status", Stage::battery_status,
     "uses the signed throttle", "negative throttle", "a sign",
     [](FaultyLaw& law) {
       change_drop(law, [](float drop, const Sample& sample, const Options& options) {
         const bool modelled = sample.armed && !options.internal_resistance_ohm;
         if (!modelled || !(sample.throttle < 0)) return drop;
         return options.load_drop_V * (sample.throttle + Law::idle_share) / (1 + Law::idle_share);
       });
     }},
    {"battery-status-no-resistance", "battery_status", Stage::battery_status,
     "ignores a known resistance", "a known resistance", "a missing branch",
     [](FaultyLaw& law) {
       change_stage(law.battery.load_drop_V,
                    [](const auto& then, const Sample& sample, Options options) {
                      options.internal_resistance_ohm.reset();
                      return then(sample, options);
                    });
     }},
    {"battery-status-both-drops", "battery_status", Stage::battery_status,
     "adds the modelled drop to that of the resistance", "a known resistance",
     "a condition dropped",
     [](FaultyLaw& law) {
       change_drop(law, [](float drop, const Sample& sample, Options options) {
         if (!options.internal_resistance_ohm) return drop;
         options.internal_resistance_ohm.reset();
         return drop + Law::load_drop_V(sample, options);
       });
     }},
    {"battery-status-resistance-armed-only", "battery_status", Stage::battery_status,
     "uses a known resistance only while armed", "a known resistance while disarmed",
     "a helpful extra",
     [](FaultyLaw& law) {
       change_drop(law, [](float drop, const Sample& sample, const Options&) {
         return sample.armed ? drop : 0.0f;
       });
     }},
    {"battery-status-no-filter", "battery_status", Stage::battery_status, "does not filter",
     "a voltage that changes", "a missing step",
     [](FaultyLaw& law) {
       law.battery.remaining = [](float, float measured) {
         return std::clamp(measured, 0.0f, 1.0f);
       };
     }},
    {"battery-status-filter-exchanged", "battery_status", Stage::battery_status,
     "exchanges the weights of the filter", "a voltage that changes", "wrong order",
     [](FaultyLaw& law) {
       change_stage(law.battery.remaining, [](const auto& then, float before, float measured) {
         return then(measured, before);
       });
     }},
    {"battery-status-first-sample-starts", "battery_status", Stage::battery_status,
     "starts the filter at the first sample instead of at a full battery", "the first seconds",
     "a wrong initial value",
     [](FaultyLaw& law) {
       change_stage(law.battery.remaining,
                    [is_first = true](const auto& then, float before, float measured) mutable {
                      const bool starts = std::exchange(is_first, false) && std::isfinite(measured);
                      return starts ? std::clamp(measured, 0.0f, 1.0f) : then(before, measured);
                    });
     }},
    {"battery-status-filter-from-0", "battery_status", Stage::battery_status,
     "starts the filter at 0", "the first seconds", "a wrong initial value",
     [](FaultyLaw& law) {
       change_stage(law.battery.remaining,
                    [is_first = true](const auto& then, float before, float measured) mutable {
                      return then(std::exchange(is_first, false) ? 0.0f : before, measured);
                    });
     }},
    {"battery-status-filter-faster", "battery_status", Stage::battery_status,
     "filters with 0.98 and 0.02", "a voltage that changes", "a wrong constant",
     [](FaultyLaw& law) {
       law.battery.remaining = [](float before, float measured) {
         const float next = before * 0.98f + measured * 0.02f;
         return std::clamp(std::isfinite(next) ? next : before, 0.0f, 1.0f);
       };
     }},
    {"battery-status-unclamped", "battery_status", Stage::battery_status,
     "lets the filter leave 0..1", "a voltage beyond full, then a lower one", "missing clamp",
     [](FaultyLaw& law) { law.battery.remaining = Law::low_passed; }},
    {"battery-status-clamps-sample", "battery_status", Stage::battery_status,
     "clamps the sample instead of the filter",
     "a voltage beyond full while the filter is below full", "a misplaced clamp",
     [](FaultyLaw& law) {
       change_stage(law.battery.remaining, [](const auto& then, float before, float measured) {
         return then(before, std::clamp(measured, 0.0f, 1.0f));
       });
     }},
    {"battery-status-nan-stays", "battery_status", Stage::battery_status,
     "does not reject a sample that is not finite", "a voltage that is NaN or infinite",
     "a missing guard",
     [](FaultyLaw& law) {
       law.battery.remaining = [](float before, float measured) {
         return std::clamp(before * Law::filter_keep + measured * Law::filter_take, 0.0f, 1.0f);
       };
     }},
    {"battery-status-voltage-nan-stays", "battery_status", Stage::battery_status,
     "does not keep voltages that are not finite out of the filtered voltage",
     "a single NaN voltage, and a battery that is not full after it", "a missing guard",
     [](FaultyLaw& law) {
       law.battery.low_passed = [](float kept, float sample) {
         return kept * Law::filter_keep + sample * Law::filter_take;
       };
     }},
    {"battery-status-always-plugged-in", "battery_status", Stage::battery_status,
     "scales for a pack that has almost no voltage", "a pack below 2.1 V", "a missing gate",
     [](FaultyLaw& law) { law.battery.is_plugged_in = [](float) { return true; }; }},
    {"battery-status-plugged-in-by-sample", "battery_status", Stage::battery_status,
     "compares the latest voltage with 2.1 V instead of the filtered one",
     "a voltage that drops out for a moment", "the wrong signal",
     [](FaultyLaw& law) { law.battery.low_passed = [](float, float sample) { return sample; }; }},
    {"battery-status-plugged-in-by-cell", "battery_status", Stage::battery_status,
     "compares the voltage of a cell with 2.1 V instead of that of the pack",
     "a pack of 3 cells below 6.3 V", "the wrong signal",
     [](FaultyLaw& law) {
       change_stage(law.battery.is_plugged_in,
                    [](const auto& then, float filtered_V) { return then(filtered_V / 3); });
     }},
    {"battery-status-infinite-is-1", "battery_status", Stage::battery_status,
     "returns 1 instead of 1.3 for an infinite scale", "cells that are empty at 0 V", "wrong order",
     [](FaultyLaw& law) {
       change_stage(
           law.battery.scale, [](const auto& then, float remaining, const Options& options) {
             const float factor =
                 options.full_cell_V / (options.empty_cell_V + Law::range_V(options) * remaining);
             return std::isfinite(factor) ? then(remaining, options) : 1.0f;
           });
     }},
    {"battery-status-never", "battery_status", Stage::battery_status, "always returns 1",
     "a battery that is not full", "a missing step",
     [](FaultyLaw& law) { law.battery.scale = [](float, const Options&) { return 1.0f; }; }},
    {"battery-status-inverse", "battery_status", Stage::battery_status,
     "returns the inverse of the scale", "a battery that is not full", "a wrong factor",
     [](FaultyLaw& law) {
       change_stage(law.battery.scale,
                    [](const auto& then, float remaining, const Options& options) {
                      return 1 / then(remaining, options);
                    });
     }},
    {"battery-status-by-charge", "battery_status", Stage::battery_status,
     "divides by the remaining charge", "a battery that is not full", "another law",
     [](FaultyLaw& law) {
       law.battery.scale = [](float remaining, const Options&) {
         return std::clamp(1 / remaining, 1.0f, Law::scale_max);
       };
     }},
    {"battery-status-uncapped", "battery_status", Stage::battery_status,
     "lets the scale exceed 1.3", "cells whose empty voltage is low", "missing clamp",
     [](FaultyLaw& law) {
       law.battery.scale = [](float remaining, const Options& options) {
         const float factor =
             options.full_cell_V / (options.empty_cell_V + Law::range_V(options) * remaining);
         return std::isfinite(factor) && factor >= 1 ? factor : 1.0f;
       };
     }},
    {"battery-status-below-1", "battery_status", Stage::battery_status,
     "lets the scale fall below 1", "voltages of empty and full cells exchanged", "missing clamp",
     [](FaultyLaw& law) {
       law.battery.scale = [](float remaining, const Options& options) {
         const float factor =
             options.full_cell_V / (options.empty_cell_V + Law::range_V(options) * remaining);
         return std::isfinite(factor) ? std::min(factor, Law::scale_max) : 1.0f;
       };
     }},
};

}  // namespace

std::span<const Fault> battery_status_faults() { return battery_status_list; }

}  // namespace attest::faults

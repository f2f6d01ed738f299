// The battery estimate: battery_status.scale, a factor on the controls that compensates for the
// discharge.
//
// The estimate of PX4 v1.5.5 systemlib Battery. The cell voltage, corrected for the drop under
// load, gives a measured charge. Low-pass filtered, it is the remaining charge, which gives the
// voltage of the cell at rest. The order of the operations is part of the estimate: the results
// have the same bits as golden/recorded/battery-v1.5.5.
//
// Voltages [V], currents [A], throttle [0..1]. No clock: one update is one sample at 100 Hz. No
// allocation; one thread at a time.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string_view>

namespace attest::actuation {

// The defaults are those of PX4 v1.5.5. With its default of 0 cells the measured charge is not
// finite and the scale stays 1.
struct BatteryOptions {
  int cell_count = 0;
  float empty_cell_V = 3.4f;
  float full_cell_V = 4.05f;
  float load_drop_V = 0.3f;  // of one cell at full throttle
  // Of one cell. If it is known, it is used instead of load_drop_V.
  std::optional<float> internal_resistance_ohm = std::nullopt;
};

struct BatteryParameter {
  std::string_view name;
  float default_value;
  std::string_view unit;  // "1" when dimensionless
  std::string_view description;
};

// The PX4 parameters that set the options.
std::span<const BatteryParameter> battery_parameters();

// Returns false and keeps the options if no parameter has that name, or if the value is not
// allowed: BAT_N_CELLS must be a whole number from 0 to 100.
bool set_battery_parameter(BatteryOptions& options, std::string_view name, float value);

struct BatterySample {
  float voltage_V;  // of the pack
  float current_A;
  float throttle;  // as commanded, 0..1
  bool armed;
};

// The stages of the estimate. Pure; any thread.
template <typename Scalar>
struct BatteryStages {
  static constexpr Scalar filter_keep = Scalar(0.99f);
  static constexpr Scalar filter_take = Scalar(0.01f);
  static constexpr Scalar scale_max = Scalar(1.3f);

  // Up to this voltage a pack counts as unplugged, and the scale is 1.
  static constexpr Scalar plugged_in_V = Scalar(2.1f);

  // Added to the throttle, so that the drop under load is not zero at idle.
  static constexpr Scalar idle_share = Scalar(0.1f);

  static Scalar range_V(const BatteryOptions& options) {
    return Scalar(options.full_cell_V) - Scalar(options.empty_cell_V);
  }

  // A sample that would make the filter NaN or infinite is ignored.
  static Scalar low_passed(Scalar kept, Scalar sample) {
    const Scalar next = kept * filter_keep + sample * filter_take;
    using std::isfinite;
    return isfinite(next) ? next : kept;
  }

  // Returns the drop of one cell.
  static Scalar load_drop_V(const BatterySample& sample, const BatteryOptions& options) {
    if (options.internal_resistance_ohm) {
      return Scalar(sample.current_A) * Scalar(*options.internal_resistance_ohm);
    }
    using std::abs;
    const Scalar load = (abs(Scalar(sample.throttle)) + idle_share) / (1 + idle_share);
    return Scalar(options.load_drop_V) * (sample.armed ? load : Scalar(0));
  }

  // The remaining charge according to this sample alone. With 0 cells it is not finite.
  static Scalar measured(const BatterySample& sample, Scalar load_drop_V,
                         const BatteryOptions& options) {
    const Scalar cells = static_cast<Scalar>(options.cell_count);
    const Scalar empty_V = Scalar(options.empty_cell_V) - load_drop_V;
    return (Scalar(sample.voltage_V) - cells * empty_V) / (cells * range_V(options));
  }

  static Scalar remaining(Scalar before, Scalar measured) {
    return std::clamp(low_passed(before, measured), Scalar(0), Scalar(1));
  }

  // The rest voltage of a full cell divided by that of this cell, limited to 1 .. 1.3.
  static Scalar scale(Scalar remaining, const BatteryOptions& options) {
    const Scalar factor =
        Scalar(options.full_cell_V) / (Scalar(options.empty_cell_V) + range_V(options) * remaining);
    if (factor > scale_max) return scale_max;  // infinity too
    using std::isfinite;
    return isfinite(factor) && !(factor < 1) ? factor : 1;
  }

  static bool is_plugged_in(Scalar filtered_V) { return filtered_V > plugged_in_V; }
};

// Stages is a policy: the stages above, or wrong ones (controller/faults).
template <typename Scalar, typename Stages = BatteryStages<Scalar>>
class BasicBatteryStatus {
 public:
  explicit BasicBatteryStatus(const BatteryOptions& options, const Stages& stages = {})
      : options_(options), stages_(stages) {}

  // Takes one 100 Hz sample and returns the new scale, 1 .. 1.3.
  Scalar update(const BatterySample& sample) {
    // A value below 0 means that the filter has no value yet: the first sample initialises it.
    if (filtered_V_ < 0) filtered_V_ = Scalar(sample.voltage_V);
    filtered_V_ = stages_.low_passed(filtered_V_, Scalar(sample.voltage_V));
    const Scalar drop_V = stages_.load_drop_V(sample, options_);
    remaining_ = stages_.remaining(remaining_, stages_.measured(sample, drop_V, options_));
    const Scalar scale = stages_.scale(remaining_, options_);
    return stages_.is_plugged_in(filtered_V_) ? scale : Scalar(1);
  }

  // The filtered remaining charge, 0..1. A new estimate starts from a full battery.
  Scalar remaining() const { return remaining_; }

 private:
  BatteryOptions options_;
  [[no_unique_address]] Stages stages_;
  Scalar filtered_V_ = -1;  // of the pack
  Scalar remaining_ = 1;
};

using BatteryStatus = BasicBatteryStatus<float>;

}  // namespace attest::actuation

// The factor by which controls are raised as a battery empties: battery_status.scale.
//
// The estimate of PX4 v1.5.5 systemlib Battery: the cell voltage, corrected for the drop under load
// and low-passed, gives the remaining charge, which gives the voltage the cell would have at rest.
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

// Voltages are the defaults of PX4 v1.5.5; the number of cells is the vehicle's.
struct BatteryOptions {
  int cell_count = 3;
  float empty_cell_V = 3.4f;
  float full_cell_V = 4.05f;
  float load_drop_V = 0.3f;  // of one cell at full throttle
  // Of one cell; where it is known it is used instead of load_drop_V.
  std::optional<float> internal_resistance_ohm = std::nullopt;
};

struct BatteryParameter {
  std::string_view name;
  float default_value;
  std::string_view unit;  // "1" when dimensionless
  std::string_view description;
};

// The parameters of PX4 that the options are made of.
std::span<const BatteryParameter> battery_parameters();

// False, and nothing changes: no parameter has that name, or it cannot have that value (a number of
// cells that is none).
bool set_battery_parameter(BatteryOptions& options, std::string_view name, float value);

struct BatterySample {
  float voltage_V;  // of the pack
  float current_A;
  float throttle;  // as commanded, 0..1
  bool armed;
};

// In the order they run. Pure; any thread.
template <typename Scalar>
struct BatteryStages {
  static constexpr Scalar filter_keep = Scalar(0.99f);
  static constexpr Scalar filter_take = Scalar(0.01f);
  static constexpr Scalar scale_max = Scalar(1.3f);

  // The drop under load is fitted to throttle plus this share, so that it is not zero at idle.
  static constexpr Scalar idle_share = Scalar(0.1f);

  static Scalar range_V(const BatteryOptions& options) {
    return Scalar(options.full_cell_V) - Scalar(options.empty_cell_V);
  }

  static Scalar load_drop_V(const BatterySample& sample, const BatteryOptions& options) {
    if (options.internal_resistance_ohm) {
      return Scalar(sample.current_A) * Scalar(*options.internal_resistance_ohm);
    }
    if (!sample.armed) return 0;
    using std::abs;
    return Scalar(options.load_drop_V) * (abs(Scalar(sample.throttle)) + idle_share) /
           (1 + idle_share);
  }

  // What one sample by itself says is left.
  static Scalar measured(const BatterySample& sample, Scalar load_drop_V,
                         const BatteryOptions& options) {
    const Scalar cell_V = Scalar(sample.voltage_V) / static_cast<Scalar>(options.cell_count);
    return (cell_V - (Scalar(options.empty_cell_V) - load_drop_V)) / range_V(options);
  }

  static Scalar filtered(Scalar remaining, Scalar measured, bool is_first) {
    const Scalar next = is_first ? measured : remaining * filter_keep + measured * filter_take;
    return std::clamp(next, Scalar(0), Scalar(1));
  }

  // The rest voltage of a full cell over that of this one.
  static Scalar scale(Scalar remaining, const BatteryOptions& options) {
    const Scalar factor =
        Scalar(options.full_cell_V) / (Scalar(options.empty_cell_V) + range_V(options) * remaining);
    using std::isfinite;
    if (!isfinite(factor) || factor < 1) return 1;
    return std::min(factor, scale_max);
  }
};

// Stages replace those of above: controller/faults has wrong ones.
template <typename Scalar, typename Stages = BatteryStages<Scalar>>
class BasicBatteryStatus {
 public:
  explicit BasicBatteryStatus(const BatteryOptions& options, const Stages& stages = {})
      : options_(options), stages_(stages) {}

  // Takes one 100 Hz sample and returns the new scale, 1 .. 1.3. A NaN voltage leaves it at 1 for
  // ever, because the filter remembers.
  Scalar update(const BatterySample& sample) {
    const Scalar drop_V = stages_.load_drop_V(sample, options_);
    const Scalar measured = stages_.measured(sample, drop_V, options_);
    remaining_ = stages_.filtered(remaining_, measured, is_first_);
    is_first_ = false;
    return stages_.scale(remaining_, options_);
  }

  // What the filtered voltage says is left, 0..1. The first sample starts the filter.
  Scalar remaining() const { return remaining_; }

 private:
  BatteryOptions options_;
  [[no_unique_address]] Stages stages_;
  Scalar remaining_ = 0;
  bool is_first_ = true;
};

using BatteryStatus = BasicBatteryStatus<float>;

}  // namespace attest::actuation

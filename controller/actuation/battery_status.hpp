// The factor by which controls are raised as a battery empties: battery_status.scale.
//
// The estimate of PX4 v1.5.5 systemlib Battery: the cell voltage, corrected for the drop under load
// and low-passed, gives the remaining charge, which gives the voltage the cell would have at rest.
//
// Voltages [V], currents [A], throttle [0..1]. No clock: one update is one sample at 100 Hz. No
// allocation; one thread at a time.
#pragma once

#include <optional>

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

struct BatterySample {
  float voltage_V;  // of the pack
  float current_A;
  float throttle;  // as commanded, 0..1
  bool armed;
};

class BatteryStatus {
 public:
  explicit BatteryStatus(const BatteryOptions& options) : options_(options) {}

  // Takes one 100 Hz sample and returns the new scale, 1 .. 1.3. A NaN voltage leaves it at 1 for
  // ever, because the filter remembers.
  float update(const BatterySample& sample);

  // What the filtered voltage says is left, 0..1. The first sample starts the filter.
  float remaining() const { return remaining_; }

 private:
  float load_drop_V(const BatterySample& sample) const;
  void filter_remaining(float measured);
  float scale() const;

  BatteryOptions options_;
  float remaining_ = 0.0f;
  bool started_ = false;
};

}  // namespace attest::actuation

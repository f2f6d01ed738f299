#include "harness/plant/battery.hpp"

#include <algorithm>
#include <cmath>

namespace attest {
namespace {

constexpr double s_per_h = 3600;
constexpr double s_per_ns = 1e-9;

}  // namespace

Battery::Battery(const BatteryPack& pack, double charge)
    : pack_(pack), initial_charge_(charge), charge_(charge), current_A_(pack.hover_current_A) {}

void Battery::update(Nanoseconds now, double hover_seconds_used, double power_ratio) {
  const double used = pack_.hover_current_A * hover_seconds_used / (pack_.capacity_Ah * s_per_h);
  charge_ = std::clamp(initial_charge_ - used, 0.0, 1.0);
  const double dt_s = static_cast<double>((now - updated_).count()) * s_per_ns;
  updated_ = now;
  // The low-pass is exact for a current that was constant since the last update.
  const double current = pack_.hover_current_A * power_ratio;
  const double kept =
      pack_.current_filter_s > 0 ? std::exp(-dt_s / pack_.current_filter_s) : (dt_s > 0 ? 0 : 1);
  current_A_ = current + (current_A_ - current) * kept;
}

double Battery::voltage_V() const {
  return std::max(0.0,
                  pack_.full_V - pack_.fall_V * (1 - charge_) - pack_.resistance_ohm * current_A_);
}

double Battery::supply_ratio() const {
  return voltage_V() / (pack_.full_V - pack_.resistance_ohm * pack_.hover_current_A);
}

}  // namespace attest

#include "tests/harness/loop/loop_truth.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "harness/core/random.hpp"
#include "harness/loop/land_detector.hpp"
#include "tests/harness/loop/allocations.hpp"
#include "tests/harness/loop/gyro_response.hpp"
#include "tests/harness/plant/test_vehicle.hpp"

namespace attest::test {
namespace {

// ---- control allocator -------------------------------------------------------------------------

// How far the speeds and flags of many saturated setpoints are from those of the second program.
class Distance {
 public:
  void add(const Eigen::ArrayXd& speeds, const Eigen::ArrayXd& exact, bool other_flags) {
    const Eigen::ArrayXd difference = (speeds - exact).abs();
    sum_ += difference.mean();
    max_ = std::max(max_, difference.maxCoeff());
    other_flags_ += other_flags ? 1 : 0;
    ++count_;
  }
  double mean() const { return sum_ / count_; }
  double max() const { return max_; }
  double other_flags() const { return other_flags_ / count_; }

 private:
  double sum_ = 0, max_ = 0, other_flags_ = 0, count_ = 0;
};

Eigen::ArrayXd speeds_of(const Allocation& allocation, Eigen::Index rotors) {
  return (Eigen::Map<const Eigen::ArrayXf>(allocation.commands.data(), rotors).cast<double>() + 1) /
         2;
}

std::array<int, 3> flags_of(const Allocation& allocation) {
  std::array<int, 3> result{};
  if (allocation.torque_setpoint_achieved) return result;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float lack = allocation.unallocated_torque[axis];
    result[axis] = (lack > 0 ? 1 : 0) - (lack < 0 ? 1 : 0);
  }
  return result;
}

// The torque is uniform within +-1 about each axis, the thrust within 0..1. Setpoints that do not
// saturate are left out: all programs give the same for them.
void allocator(std::vector<LoopTruth>& table, const std::string& name, int setpoints) {
  const auto model = vehicle_model(name);
  const Vehicle& vehicle = model->vehicle();
  const ControlAllocator allocator(vehicle);
  const AllocationModel exact(vehicle);
  Random random(7);
  Distance simple, measured, in_airmode;
  for (int count = 0; count < setpoints;) {
    const auto uniform = [&](double low, double high) {
      return static_cast<float>(random.uniform(low, high));
    };
    const std::array<float, 3> torque{uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
    const float thrust = uniform(0, 1);
    const AllocationModel::Torque wanted(torque[0], torque[1], torque[2]);
    const auto up = static_cast<double>(thrust);
    if (!exact.saturates(wanted, up)) continue;
    ++count;
    const auto flags = [&](const Eigen::ArrayXd& speeds) { return exact.flags(wanted, speeds); };
    const auto add = [&](Distance& distance, Airmode airmode) {
      const Allocation allocation = allocator.allocate(torque, {0, 0, -thrust}, airmode);
      const Eigen::ArrayXd speeds = exact.sequential(wanted, up, airmode);
      distance.add(speeds_of(allocation, speeds.size()), speeds,
                   flags_of(allocation) != flags(speeds));
    };
    add(measured, Airmode::off);
    add(in_airmode, Airmode::roll_pitch);
    add(in_airmode, Airmode::roll_pitch_yaw);
    const Eigen::ArrayXd speeds = exact.sequential(wanted, up, Airmode::off);
    const Eigen::ArrayXd scaled = exact.scaled(wanted, up);
    simple.add(scaled, speeds, flags(scaled) != flags(speeds));
  }
  // Commands are floats.
  constexpr double bound = 2e-7;
  const std::string of = "allocator, " + name;
  const auto add = [&](const std::string& what, std::optional<double> other, double value) {
    table.push_back({what, of, "", other, value, 0, value, bound});
  };
  add("mean difference of a rotor's speed", simple.mean(), measured.mean());
  add("largest difference of a rotor's speed", simple.max(), measured.max());
  add("share of setpoints with other saturation flags", simple.other_flags(),
      measured.other_flags());
  add("largest difference, MC_AIRMODE 1 and 2", std::nullopt, in_airmode.max());
  add("share with other flags, MC_AIRMODE 1 and 2", std::nullopt, in_airmode.other_flags());
}

// ---- gyro --------------------------------------------------------------------------------------

// The simpler model does not filter the rates, and its filter of the derivative is of second order.
void gyro(std::vector<LoopTruth>& table, std::int64_t sampling_hz) {
  const auto sampling = static_cast<double>(sampling_hz);
  // The filter's tangent is rounded to float.
  constexpr double bound = 2e-6;
  const auto add = [&](std::string_view what, double frequency_hz, const Response& simple,
                       const Response& measured, const Response& exact) {
    table.push_back({fmt::format("gain of the {} at {:g} Hz", what, frequency_hz),
                     fmt::format("gyro, {} Hz", sampling_hz), "", std::abs(simple),
                     std::abs(measured), std::abs(exact), std::abs(measured - exact), bound});
  };
  const Rate rate = Rate::hz(sampling_hz);
  const double rate_cutoff_hz = GyroFilter::default_rate_cutoff_hz;
  const double acceleration_cutoff_hz = GyroFilter::default_acceleration_cutoff_hz;
  for (const double f : {10.0, rate_cutoff_hz, 100.0}) {
    add("rates", f, 1, measured_response(rate, GyroFilter(rate), f).rate,
        butterworth(f, rate_cutoff_hz, sampling));
  }
  for (const double f : {10.0, acceleration_cutoff_hz, 100.0}) {
    const Response derivative = difference(f, sampling);
    add("derivative", f, derivative * butterworth(f, acceleration_cutoff_hz, sampling),
        measured_response(rate, GyroFilter(rate), f).acceleration,
        derivative * butterworth(f, rate_cutoff_hz, sampling) *
            first_order(f, acceleration_cutoff_hz, sampling));
  }
}

// ---- land detector -----------------------------------------------------------------------------

constexpr double sample_s = 0.02;

Nanoseconds sample_time(int sample) { return Nanoseconds(sample * std::int64_t{20'000'000}); }

struct LandedAfter {
  double maybe_landed_s = 0, landed_s = 0;
};

// The times from when the vehicle stands still. Before that it turns on its feet for some samples:
// that is ground contact, and not maybe_landed.
LandedAfter landed_after(int samples_turning) {
  Case flight;
  flight.duration = {20, Span::In::seconds};
  flight.flight.emplace();
  LandDetector detector(flight, Rate::hz(1000));
  PlantState turning;
  turning.rate_rad_s = {1, 0, 0};
  for (int i = 0; i < samples_turning; ++i) detector.sample(sample_time(i), turning, 0, true);
  LandedAfter result;
  for (int i = 0; i < 500; ++i) {
    const auto [maybe_landed, landed] =
        detector.sample(sample_time(samples_turning + i), PlantState{}, 0, true);
    if (!maybe_landed) result.maybe_landed_s = sample_s * (i + 1);
    if (!landed) result.landed_s = sample_s * (i + 1);
  }
  return result;
}

// The simpler model has two stages, reached after 0.25 and 0.55 s.
void land_detector(std::vector<LoopTruth>& table) {
  const LandedAfter at_rest = landed_after(0), after_contact = landed_after(100);
  const auto first_sample_after = [](double seconds) {
    return sample_s * std::ceil(seconds / sample_s);
  };
  const auto add = [&](std::string_view stage, std::optional<double> simple, double measured,
                       int stages) {
    const double exact = stages * first_sample_after(1.0 / 3);
    table.push_back({fmt::format("time until {}", stage), "land detector, 50 Hz", "s", simple,
                     measured, exact, std::abs(measured - exact), 1e-9});
  };
  // Ground contact is not an output: it is the part of maybe_landed that a vehicle that had ground
  // contact before saves.
  add("ground contact", std::nullopt, at_rest.maybe_landed_s - after_contact.maybe_landed_s, 1);
  add("maybe_landed", first_sample_after(0.25), at_rest.maybe_landed_s, 2);
  add("landed", first_sample_after(0.55), at_rest.landed_s, 3);
}

}  // namespace

std::vector<LoopTruth> loop_truths(int setpoints) {
  std::vector<LoopTruth> table;
  for (const char* vehicle : {"iris", "hexa", "heavy_quad"}) allocator(table, vehicle, setpoints);
  gyro(table, 1000);
  land_detector(table);
  return table;
}

}  // namespace attest::test

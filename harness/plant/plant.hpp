// The plant that the unit under test controls: a rigid body with rotors. It has two implementations
// that are checked against each other and against exact solutions (models/README.md).
//
// Rotor speed w of each rotor follows its command u with a first-order lag, dw/dt = (u - w) / tau.
// tau has one value for u > w and another for u < w. Each rotor has a thrust kf w^2 along -z body
// at its hub, and a drag torque km w^2 about z against its rotation. The drag force is linear in
// the velocity relative to the air. Gravity acts along +z world.
// The spin of the rotors is not part of the body's angular momentum.
//
// Frames NED and FRD, SI units, time since reset() in integer nanoseconds. No clock, no allocation
// after reset(), one thread at a time. The same calls give the same bits.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "harness/core/frames.hpp"
#include "harness/core/rate.hpp"
#include "harness/core/result.hpp"
#include "harness/core/time.hpp"
#include "harness/plant/vehicle.hpp"

namespace attest {

struct PlantState {
  Vector3 position_m{};    // of the centre of mass, NED
  Vector3 velocity_m_s{};  // of the centre of mass, NED
  Quaternion attitude;     // body FRD to world NED, norm 1
  Vector3 rate_rad_s{};    // of the body, FRD
  std::array<double, rotors_max> rotor_rad_s{};
  // Time integral of mean((w / w_hover)^3) over the rotors: the charge used, in seconds of hover.
  double hover_seconds_used = 0;
};

// The early end of a flight: the state or a motor command is not finite, the body rate is beyond
// the vehicle's bound, or the simulator reported an error or a warning.
struct Divergence {
  Nanoseconds at{0};
  std::string what;  // "the body rate is 103 rad/s, beyond 100"
};

// The divergence of a flight with this velocity [m/s] and body rate [rad/s] at time `at`; empty if
// the flight goes on.
std::optional<Divergence> divergence_of(std::span<const double, 3> velocity,
                                        std::span<const double, 3> rate, const Vehicle& vehicle,
                                        Nanoseconds at);

class Plant {
 public:
  virtual ~Plant() = default;

  // Restarts at time 0 in the state `start`: commands equal to the rotor speeds, no wind, the
  // centre of mass at its nominal place. REQUIRES: a unit quaternion.
  virtual void reset(const PlantState& start) = 0;

  // Commanded rotor speeds [rad/s], one per rotor, not negative; held until the next call.
  virtual void command(std::span<const double> rotor_rad_s) = 0;

  // Velocity of the air, NED; held until the next call.
  virtual void set_wind(const Vector3& velocity_m_s) = 0;

  // Offset of the centre of mass from its nominal place, FRD; held until the next call. The
  // position and velocity of the centre of mass do not jump. The hubs' places relative to it jump,
  // as when a load is dropped.
  virtual void set_centre_of_mass(const Vector3& offset_m) = 0;

  // Integrates to exactly the time `to`. REQUIRES: `to` is not before the time reached. After a
  // divergence the state does not change until reset().
  virtual std::optional<Divergence> advance(Nanoseconds to) = 0;

  // The state at the time reached.
  virtual const PlantState& state() const = 0;
};

enum class PlantKind { mujoco, ode };
inline constexpr std::array<PlantKind, 2> plant_kinds{PlantKind::mujoco, PlantKind::ode};
std::string_view name_of(PlantKind kind);  // "mujoco"
bool has_floor(PlantKind kind);            // ground contact
Result<PlantKind> parse_plant_kind(std::string_view name);

struct PlantOptions {
  // How often MuJoCo steps. Its steps begin at multiples of 1 / physics, and at the times that
  // advance() was given. The ode plant chooses its own steps.
  Rate physics = Rate::hz(1000);
  bool floor = false;  // MuJoCo only: ground contact at z = 0
};

// A vehicle ready to fly: its numbers, and its compiled MuJoCo model. Compiling takes milliseconds
// and is done once. Immutable; may be shared, also across fork().
class VehicleModel {
 public:
  // Reads models/<name>.toml and models/<name>.xml. A vehicle with the key `mjcf_of` has the MuJoCo
  // model of that other vehicle, with its own numbers. Errors, with file and, if known, line: no
  // such vehicle (with the known ones), an unsuitable `mjcf_of`, the errors of read_vehicle() and
  // of MujocoModel::parse().
  static Result<std::shared_ptr<const VehicleModel>> load(const std::filesystem::path& models,
                                                          const std::string& name);
  virtual ~VehicleModel() = default;

  virtual const Vehicle& vehicle() const = 0;

  // The same MuJoCo model with the numbers of another vehicle, without compiling it again. Errors:
  // another number of rotors; those of MuJoCo.
  virtual Result<std::shared_ptr<const VehicleModel>> with_numbers_of(Vehicle vehicle) const = 0;

  // Errors: options.floor for a plant without a floor; those of MuJoCo. The vehicle model must
  // outlive the plant.
  virtual Result<std::unique_ptr<Plant>> make_plant(PlantKind kind,
                                                    const PlantOptions& options) const = 0;
};

}  // namespace attest

#include "harness/plant/ode_plant.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include <arkode/arkode_erkstep.h>
#include <fmt/format.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>

namespace attest {
namespace {

// The index at which each variable of the state begins.
enum Variable : int { position = 0, velocity = 3, attitude = 6, rate = 10, used = 13, rotors = 14 };

Vector3 cross(const Vector3& a, const Vector3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

struct Inputs {
  std::array<double, rotors_max> command{};  // rad/s
  Vector3 wind_m_s{};
  Vector3 centre_of_mass_m{};
};

// dy/dt with the held inputs. Written in plain scalars, because it takes most of a step's time.
class Dynamics {
 public:
  explicit Dynamics(const Vehicle& vehicle) : vehicle_(vehicle), count_(vehicle.rotors.size()) {}

  Inputs inputs;

  void derivative(const double* y, double* dy) const {
    Vector3 force_B{}, torque_B{};
    add_rotors(y, dy, force_B, torque_B);
    const double w = y[attitude], x = y[attitude + 1], yy = y[attitude + 2], z = y[attitude + 3];
    // Rows of the rotation from body to world; q may differ from norm 1 by the integrator's error.
    const double R_NB[3][3] = {
        {w * w + x * x - yy * yy - z * z, 2 * (x * yy - w * z), 2 * (x * z + w * yy)},
        {2 * (x * yy + w * z), w * w - x * x + yy * yy - z * z, 2 * (yy * z - w * x)},
        {2 * (x * z - w * yy), 2 * (yy * z + w * x), w * w - x * x - yy * yy + z * z}};
    add_drag(y, R_NB, force_B);
    for (int i = 0; i < 3; ++i) {
      const double force_N =
          R_NB[i][0] * force_B[0] + R_NB[i][1] * force_B[1] + R_NB[i][2] * force_B[2];
      dy[position + i] = y[velocity + i];
      dy[velocity + i] = force_N / vehicle_.mass_kg;
    }
    dy[velocity + 2] += gravity_m_s2;
    add_rotation(y, torque_B, dy);
  }

 private:
  void add_rotors(const double* y, double* dy, Vector3& force_B, Vector3& torque_B) const {
    for (std::size_t i = 0; i < count_; ++i) {
      const double speed = y[static_cast<std::size_t>(rotors) + i];
      const double missing = inputs.command[i] - speed;
      dy[static_cast<std::size_t>(rotors) + i] =
          missing / (missing > 0 ? vehicle_.time_constant_up_s : vehicle_.time_constant_down_s);
      const VehicleRotor& rotor = vehicle_.rotors[i];
      const double thrust = vehicle_.thrust_coefficient * speed * speed;
      force_B[2] -= thrust;
      torque_B[0] -= (rotor.position_m[1] - inputs.centre_of_mass_m[1]) * thrust;
      torque_B[1] += (rotor.position_m[0] - inputs.centre_of_mass_m[0]) * thrust;
      torque_B[2] += rotor.turns * vehicle_.torque_over_thrust_m * thrust;
    }
    dy[used] = vehicle_.power_ratio({y + rotors, count_});
  }

  // Drag acts at the centre of mass, so it does not turn the body.
  void add_drag(const double* y, const double (&R_NB)[3][3], Vector3& force_B) const {
    const Vector3& k = vehicle_.drag_kg_s;
    if (k[0] == 0 && k[1] == 0 && k[2] == 0) return;
    const Vector3 air_N = {y[velocity] - inputs.wind_m_s[0], y[velocity + 1] - inputs.wind_m_s[1],
                           y[velocity + 2] - inputs.wind_m_s[2]};
    for (std::size_t i = 0; i < 3; ++i) {
      force_B[i] -= k[i] * (R_NB[0][i] * air_N[0] + R_NB[1][i] * air_N[1] + R_NB[2][i] * air_N[2]);
    }
  }

  // Euler's equations about principal axes, and dq/dt = q (0, w) / 2.
  void add_rotation(const double* y, const Vector3& torque_B, double* dy) const {
    const Vector3 w_BN_B = {y[rate], y[rate + 1], y[rate + 2]};
    const Vector3& I = vehicle_.inertia_kg_m2;
    const Vector3 gyro_B = cross(w_BN_B, {I[0] * w_BN_B[0], I[1] * w_BN_B[1], I[2] * w_BN_B[2]});
    for (std::size_t i = 0; i < 3; ++i) {
      dy[static_cast<std::size_t>(rate) + i] = (torque_B[i] - gyro_B[i]) / I[i];
    }
    const double* q = y + attitude;
    double* dq = dy + attitude;
    dq[0] = 0.5 * (-q[1] * w_BN_B[0] - q[2] * w_BN_B[1] - q[3] * w_BN_B[2]);
    dq[1] = 0.5 * (q[0] * w_BN_B[0] + q[2] * w_BN_B[2] - q[3] * w_BN_B[1]);
    dq[2] = 0.5 * (q[0] * w_BN_B[1] + q[3] * w_BN_B[0] - q[1] * w_BN_B[2]);
    dq[3] = 0.5 * (q[0] * w_BN_B[2] + q[1] * w_BN_B[1] - q[2] * w_BN_B[0]);
  }

  const Vehicle& vehicle_;
  std::size_t count_;
};

int right_hand_side(sunrealtype, N_Vector y, N_Vector dy, void* dynamics) {
  static_cast<const Dynamics*>(dynamics)->derivative(N_VGetArrayPointer(y), N_VGetArrayPointer(dy));
  return 0;
}

// The names of SUNDIALS 7 for what SUNDIALS 6 has under other names. silence() keeps both from
// printing their errors, because check() reports them by the returned flag.
#if SUNDIALS_VERSION_MAJOR < 7
constexpr void* SUN_COMM_NULL = nullptr;
constexpr auto& ARKodeEvolve = ERKStepEvolve;
constexpr auto& ARKodeFree = ERKStepFree;
constexpr auto& ARKodeReset = ERKStepReset;
constexpr auto& ARKodeSetFixedStep = ERKStepSetFixedStep;
constexpr auto& ARKodeSetInterpolantType = ERKStepSetInterpolantType;
constexpr auto& ARKodeSetMaxNumSteps = ERKStepSetMaxNumSteps;
constexpr auto& ARKodeSetOrder = ERKStepSetOrder;
constexpr auto& ARKodeSetStopTime = ERKStepSetStopTime;
constexpr auto& ARKodeSetUserData = ERKStepSetUserData;
constexpr auto& ARKodeSStolerances = ERKStepSStolerances;
void silence(SUNContext, void* integrator) { ERKStepSetErrFile(integrator, nullptr); }
#else
void silence(SUNContext context, void*) { SUNContext_ClearErrHandlers(context); }
#endif

// The calls that are checked by made() fail only if memory is missing.
template <typename T>
T* made(T* pointer) {
  if (!pointer) throw std::bad_alloc();
  return pointer;
}

class ErkPlant final : public OdePlant {
 public:
  ErkPlant(const Vehicle& vehicle, const OdeOptions& options)
      : vehicle_(vehicle), dynamics_(vehicle), count_(vehicle.rotors.size()) {
    SUNContext_Create(SUN_COMM_NULL, &context_);
    y_ = made(N_VNew_Serial(rotors + static_cast<sunindextype>(count_), context_));
    // One pass over the vectors instead of several; this saves 15-22% of the time.
    N_VEnableFusedOps_Serial(y_, SUNTRUE);
    N_VConst(0, y_);
    integrator_ = made(ERKStepCreate(right_hand_side, 0, y_, context_));
    silence(context_, integrator_);
    ARKodeSetUserData(integrator_, &dynamics_);
    ARKodeSetOrder(integrator_, options.order);
    ARKodeSetInterpolantType(integrator_, ARK_INTERP_LAGRANGE);
    ARKodeSStolerances(integrator_, options.relative_tolerance, options.absolute_tolerance);
    ARKodeSetMaxNumSteps(integrator_, 100'000);
    if (options.fixed_step_s > 0) ARKodeSetFixedStep(integrator_, options.fixed_step_s);
  }
  ~ErkPlant() override {
    ARKodeFree(&integrator_);
    N_VDestroy(y_);
    SUNContext_Free(&context_);
  }
  ErkPlant(const ErkPlant&) = delete;
  ErkPlant& operator=(const ErkPlant&) = delete;

  void reset(const PlantState& start) override {
    now_ = Nanoseconds(0);
    lost_.reset();
    state_ = start;
    dynamics_.inputs = {};
    dynamics_.inputs.command = start.rotor_rad_s;
    double* y = N_VGetArrayPointer(y_);
    std::copy_n(start.position_m.begin(), 3, y + position);
    std::copy_n(start.velocity_m_s.begin(), 3, y + velocity);
    const Quaternion& q = start.attitude;
    y[attitude] = q.w, y[attitude + 1] = q.x, y[attitude + 2] = q.y, y[attitude + 3] = q.z;
    std::copy_n(start.rate_rad_s.begin(), 3, y + rate);
    y[used] = start.hover_seconds_used;
    std::copy_n(start.rotor_rad_s.begin(), count_, y + rotors);
    // Discards the last step size of the previous flight.
    ERKStepReInit(integrator_, right_hand_side, 0, y_);
    stale_ = false;
  }

  void command(std::span<const double> rotor_rad_s) override {
    std::copy(rotor_rad_s.begin(), rotor_rad_s.end(), dynamics_.inputs.command.begin());
    stale_ = true;
  }
  void set_wind(const Vector3& velocity_m_s) override {
    dynamics_.inputs.wind_m_s = velocity_m_s;
    stale_ = true;
  }
  void set_centre_of_mass(const Vector3& offset_m) override {
    dynamics_.inputs.centre_of_mass_m = offset_m;
    stale_ = true;
  }

  std::optional<Divergence> advance(Nanoseconds to) override {
    if (lost_ || to <= now_) return lost_;
    const double end = in_seconds(to);
    // Without a reset the integrator would reuse a stage of its last step, which had other inputs.
    if (stale_) ARKodeReset(integrator_, in_seconds(now_), y_);
    stale_ = false;
    ARKodeSetStopTime(integrator_, end);
    double reached = 0;
    const int flag = ARKodeEvolve(integrator_, end, y_, &reached, ARK_NORMAL);
    now_ = to;
    read();
    check(flag);
    return lost_;
  }

  const PlantState& state() const override { return state_; }

  double quaternion_norm() const override {
    const double* q = N_VGetArrayPointer(y_) + attitude;
    return std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  }

 private:
  void read() {
    const double* y = N_VGetArrayPointer(y_);
    std::copy_n(y + position, 3, state_.position_m.begin());
    std::copy_n(y + velocity, 3, state_.velocity_m_s.begin());
    // Only the copy is scaled: to scale the integrator's state would change its results.
    const double* q = y + attitude;
    const double scale = 1 / quaternion_norm();
    state_.attitude = {scale * q[0], scale * q[1], scale * q[2], scale * q[3]};
    std::copy_n(y + rate, 3, state_.rate_rad_s.begin());
    state_.hover_seconds_used = y[used];
    std::copy_n(y + rotors, count_, state_.rotor_rad_s.begin());
  }

  void check(int flag) {
    const auto& [x, y, z] = state_.rate_rad_s;
    const double size = std::sqrt(x * x + y * y + z * z);
    const auto& v = state_.velocity_m_s;
    if (!std::isfinite(size + v[0] + v[1] + v[2])) {
      lost_ = Divergence{now_, "the state is not finite"};
    } else if (size > vehicle_.rate_bound_rad_s) {
      lost_ = Divergence{now_, fmt::format("the body rate is {:.0f} rad/s, beyond {:g}", size,
                                           vehicle_.rate_bound_rad_s)};
    } else if (flag < 0) {
      lost_ = Divergence{now_, fmt::format("ARKODE gave up with flag {}", flag)};
    }
  }

  const Vehicle& vehicle_;
  Dynamics dynamics_;
  std::size_t count_;
  SUNContext context_ = nullptr;
  N_Vector y_ = nullptr;
  void* integrator_ = nullptr;

  Nanoseconds now_{0};
  bool stale_ = false;  // an input changed since the last step
  PlantState state_;
  std::optional<Divergence> lost_;
};

}  // namespace

std::unique_ptr<OdePlant> make_ode_plant(const Vehicle& vehicle, const OdeOptions& options) {
  return std::make_unique<ErkPlant>(vehicle, options);
}

}  // namespace attest

#include "harness/plant/ode_plant.hpp"

#include <algorithm>
#include <cmath>
#include <new>

#include <arkode/arkode_erkstep.h>
#include <fmt/format.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>

#include "harness/plant/vehicle_dynamics.hpp"

namespace attest {
namespace {

using enum VehicleDynamics::Variable;

int right_hand_side(sunrealtype, N_Vector y, N_Vector dy, void* dynamics) {
  static_cast<const VehicleDynamics*>(dynamics)->derivative(N_VGetArrayPointer(y),
                                                            N_VGetArrayPointer(dy));
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
    lost_ = divergence_of(state_.velocity_m_s, state_.rate_rad_s, vehicle_, now_);
    if (!lost_ && flag < 0) {
      lost_ = Divergence{now_, fmt::format("ARKODE gave up with flag {}", flag)};
    }
  }

  const Vehicle& vehicle_;
  VehicleDynamics dynamics_;
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

// The ode plant against a bare ERKStep loop: the same equations and options, without abstractions.
#include <array>
#include <cmath>
#include <vector>

#include <arkode/arkode_erkstep.h>
#include <benchmark/benchmark.h>
#include <nvector/nvector_serial.h>

#include "harness/core/random.hpp"
#include "harness/plant/ode_plant.hpp"

namespace attest::bench {
namespace {

constexpr int ticks = 1000;  // of 1 ms, each with new commands

const Vehicle& iris() {
  static const Vehicle vehicle = *read_vehicle(ATTEST_SOURCE_DIR "/models/iris.toml");
  return vehicle;
}

using Commands = std::array<double, 4>;

const std::vector<Commands>& commands() {
  static const std::vector<Commands> all = [] {
    std::vector<Commands> list(ticks);
    Random random(7);
    for (Commands& held : list) {
      for (double& speed : held) speed = iris().hover_rotor_rad_s() * random.uniform(0.97, 1.03);
    }
    return list;
  }();
  return all;
}

void plant(benchmark::State& state) {
  const auto flown = make_ode_plant(iris(), {});
  PlantState start;
  start.rotor_rad_s.fill(iris().hover_rotor_rad_s());
  for (auto _ : state) {
    flown->reset(start);
    for (int tick = 0; tick < ticks; ++tick) {
      flown->command(commands()[static_cast<std::size_t>(tick)]);
      flown->advance(Nanoseconds((tick + 1) * 1'000'000LL));
    }
    benchmark::DoNotOptimize(flown->state());
  }
}

// The state y: position, velocity, quaternion, body rate, hover seconds, four rotor speeds.
int derivative(realtype, N_Vector y_vector, N_Vector dy_vector, void* user) {
  const double* y = N_VGetArrayPointer(y_vector);
  double* dy = N_VGetArrayPointer(dy_vector);
  const Commands& command = *static_cast<const Commands*>(user);
  const Vehicle& v = iris();
  double thrust = 0, torque[3] = {0, 0, 0}, power = 0;
  for (int i = 0; i < 4; ++i) {
    const double speed = y[14 + i], missing = command[static_cast<std::size_t>(i)] - speed;
    dy[14 + i] = missing / (missing > 0 ? v.time_constant_up_s : v.time_constant_down_s);
    const VehicleRotor& rotor = v.rotors[static_cast<std::size_t>(i)];
    const double of_one = v.thrust_coefficient * speed * speed;
    thrust += of_one;
    torque[0] -= rotor.position_m[1] * of_one;
    torque[1] += rotor.position_m[0] * of_one;
    torque[2] += rotor.turns * v.torque_over_thrust_m * of_one;
    const double ratio = speed / 793.5;
    power += ratio * ratio * ratio;
  }
  dy[13] = power / 4;
  const double w = y[6], x = y[7], q = y[8], z = y[9];
  const double R[3][3] = {
      {w * w + x * x - q * q - z * z, 2 * (x * q - w * z), 2 * (x * z + w * q)},
      {2 * (x * q + w * z), w * w - x * x + q * q - z * z, 2 * (q * z - w * x)},
      {2 * (x * z - w * q), 2 * (q * z + w * x), w * w - x * x - q * q + z * z}};
  double force[3] = {0, 0, -thrust};
  for (int i = 0; i < 3; ++i) {
    const double air = R[0][i] * y[3] + R[1][i] * y[4] + R[2][i] * y[5];
    force[i] -= v.drag_kg_s[static_cast<std::size_t>(i)] * air;
  }
  for (int i = 0; i < 3; ++i) {
    dy[i] = y[3 + i];
    dy[3 + i] = (R[i][0] * force[0] + R[i][1] * force[1] + R[i][2] * force[2]) / v.mass_kg;
  }
  dy[5] += gravity_m_s2;
  const double a = y[10], b = y[11], c = y[12];
  dy[6] = 0.5 * (-x * a - q * b - z * c);
  dy[7] = 0.5 * (w * a + q * c - z * b);
  dy[8] = 0.5 * (w * b + z * a - x * c);
  dy[9] = 0.5 * (w * c + x * b - q * a);
  const auto& I = v.inertia_kg_m2;
  dy[10] = (torque[0] - (I[2] - I[1]) * b * c) / I[0];
  dy[11] = (torque[1] - (I[0] - I[2]) * c * a) / I[1];
  dy[12] = (torque[2] - (I[1] - I[0]) * a * b) / I[2];
  return 0;
}

void bare(benchmark::State& state) {
  SUNContext context = nullptr;
  SUNContext_Create(nullptr, &context);
  N_Vector y = N_VNew_Serial(18, context);
  N_VEnableFusedOps_Serial(y, SUNTRUE);
  N_VConst(0, y);
  void* integrator = ERKStepCreate(derivative, 0, y, context);
  const OdeOptions options;
  ERKStepSetOrder(integrator, options.order);
  ERKStepSetInterpolantType(integrator, ARK_INTERP_LAGRANGE);
  ERKStepSStolerances(integrator, options.relative_tolerance, options.absolute_tolerance);
  for (auto _ : state) {
    N_VConst(0, y);
    double* values = N_VGetArrayPointer(y);
    values[6] = 1;
    for (int i = 0; i < 4; ++i) values[14 + i] = iris().hover_rotor_rad_s();
    ERKStepReInit(integrator, derivative, 0, y);
    double t = 0;
    for (const Commands& held : commands()) {
      ERKStepSetUserData(integrator, const_cast<Commands*>(&held));
      ERKStepReset(integrator, t, y);
      ERKStepSetStopTime(integrator, t + 1e-3);
      ERKStepEvolve(integrator, t + 1e-3, y, &t, ARK_NORMAL);
    }
    benchmark::DoNotOptimize(values[0]);
  }
  ERKStepFree(&integrator);
  N_VDestroy(y);
  SUNContext_Free(&context);
}

BENCHMARK(plant)->Name("ode/plant");
BENCHMARK(bare)->Name("ode/erkstep");

}  // namespace
}  // namespace attest::bench

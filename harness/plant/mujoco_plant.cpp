#include "harness/plant/mujoco_plant.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include "harness/plant/model_numbers.hpp"
#include "harness/plant/mujoco_model_copy.hpp"
#include "harness/plant/mujoco_numbers.hpp"
#include "harness/plant/simulator_message.hpp"

namespace attest {
namespace {

using namespace mujoco_layout;  // NOLINT(google-build-using-namespace)

Vector3 vector_at(const mjtNum* numbers) { return {numbers[0], numbers[1], numbers[2]}; }

// ---- MuJoCo's errors and warnings ---------------------------------------------------------------

// MuJoCo's error handler must not return, so it throws. Warnings come from deep inside a step, so
// they are stored.
struct MujocoError {
  std::string what;
};

thread_local std::string warning;  // the first since it was cleared

[[noreturn]] void on_error(const char* text) { throw MujocoError{text}; }

void on_warning(const char* text) {
  if (warning.empty()) warning = text;
}

// ---- callbacks of the model ---------------------------------------------------------------------

// Rotor speed is the activation: first-order lag, dynprm = {tau up, tau down}.
mjtNum rotor_lag(const mjModel* model, const mjData* data, int id) {
  const double difference = data->ctrl[id] - data->act[id];
  const mjtNum* tau = model->actuator_dynprm + id * mjNDYN;
  return difference / (difference > 0 ? tau[0] : tau[1]);
}

// Thrust = gain * speed and gain = kf * speed, so that thrust is kf * speed^2. gainprm = {kf}.
mjtNum rotor_gain(const mjModel* model, const mjData* data, int id) {
  return model->actuator_gainprm[id * mjNGAIN] * data->act[id];
}

// Linear drag at the centre of mass. Called at each stage of the Runge-Kutta step.
void drag(const mjModel* model, mjData* data) {
  const mjtNum* k = data->userdata + drag_at;
  if (model->nuserdata < userdata_size || (k[0] == 0 && k[1] == 0 && k[2] == 0)) return;
  const mjtNum* R = data->xmat + 9 * body;
  const mjtNum* offset = model->body_ipos + 3 * body;
  mjtNum turning[3], velocity[3], force[3], force_world[3], torque[3];
  mju_cross(turning, data->qvel + 3, offset);  // body frame
  mju_rotVecMat(velocity, turning, R);
  for (int i = 0; i < 3; ++i) velocity[i] += data->qvel[i] - data->userdata[wind_at + i];
  mju_rotVecMatT(force, velocity, R);
  for (int i = 0; i < 3; ++i) force[i] *= -k[i];
  mju_rotVecMat(force_world, force, R);
  mju_cross(torque, offset, force);
  for (int i = 0; i < 3; ++i) {
    data->qfrc_passive[i] += force_world[i];
    data->qfrc_passive[3 + i] += torque[i];
  }
}

void install_callbacks() {
  mju_user_error = on_error;
  mju_user_warning = on_warning;
  mjcb_act_dyn = rotor_lag;
  mjcb_act_gain = rotor_gain;
  mjcb_passive = drag;
}

struct Delete {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
  void operator()(mjData* data) const { mj_deleteData(data); }
  void operator()(mjVFS* files) const {
    mj_deleteVFS(files);
    delete files;
  }
};
using Model = std::unique_ptr<mjModel, Delete>;
using Data = std::unique_ptr<mjData, Delete>;
using Files = std::unique_ptr<mjVFS, Delete>;

// ---- loading ------------------------------------------------------------------------------------

// MuJoCo's file system in memory (2 MB), with one file. MuJoCo reads other files from disk.
Files in_memory(std::string_view text, const std::filesystem::path& path) {
  Files files(new mjVFS);
  mj_defaultVFS(files.get());
  mj_makeEmptyFileVFS(files.get(), path.filename().c_str(), static_cast<int>(text.size()));
  std::copy(text.begin(), text.end(), static_cast<char*>(files->filedata[0]));
  return files;
}

Result<Model> compile(std::string_view mjcf, const std::filesystem::path& xml) {
  constexpr int error_size = 1000;
  char text[error_size] = "";
  warning.clear();
  Model model;
  try {
    const Files files = in_memory(mjcf, xml);
    model.reset(mj_loadXML(xml.c_str(), files.get(), text, error_size));
  } catch (const MujocoError& error) {
    return fail_at(xml.string(), "MuJoCo: " + on_one_line(error.what), line_in(error.what));
  }
  const std::string simulator_message = on_one_line(text[0] ? std::string(text) : warning);
  if (!model || !simulator_message.empty()) {
    return fail_at(xml.string(), "MuJoCo: " + simulator_message, line_in(simulator_message));
  }
  return model;
}

// ---- models for a flight ------------------------------------------------------------------------

// Enables contacts, and reserves memory for at least 64 contact points with four constraint rows
// each.
void enable_floor(mjModel& model) {
  constexpr int contacts = 64, rows_of_one = 4, stack_numbers = 200'000;
  model.nconmax = std::max(model.nconmax, contacts);
  model.njmax = std::max(model.njmax, rows_of_one * contacts);
  model.nstack = std::max(model.nstack, stack_numbers);
  model.opt.disableflags &= ~(mjDSBL_CONSTRAINT | mjDSBL_CONTACT);
}

// Leaves out cameras, lights and sensors, which no flight reads, and geoms that have no effect.
// MuJoCo would compute their places at each stage of a step, a quarter of the time of a flight.
void leave_out_unused(mjModel& model) {
  model.ncam = model.nlight = model.nsensor = 0;
  const bool geoms_act = (model.opt.disableflags & mjDSBL_CONTACT) == 0 || model.ntendon > 0 ||
                         model.opt.density != 0 || model.opt.viscosity != 0;
  if (!geoms_act) model.ngeom = 0;
}

// ---- the plant ----------------------------------------------------------------------------------

void copy(const Vector3& vector, mjtNum* numbers) {
  std::copy(vector.begin(), vector.end(), numbers);
}

class MujocoPlant final : public Plant {
 public:
  MujocoPlant(const mjModel& model, const Vehicle& vehicle, const Rate& physics)
      : copy_(model),
        data_(mj_makeData(&model_)),
        vehicle_(vehicle),
        physics_(physics),
        rotors_(vehicle.rotors.size()) {}

  void reset(const PlantState& start) override {
    mj_resetData(&model_, data_.get());
    copy(vehicle_.drag_kg_s, data_->userdata + drag_at);  // the same in FRD and FLU
    place_centre_of_mass({0, 0, 0});
    now_ = Nanoseconds(0);
    steps_ = 0;
    lost_.reset();
    state_ = start;
    std::copy_n(start.rotor_rad_s.begin(), rotors_, data_->act);
    std::copy_n(start.rotor_rad_s.begin(), rotors_, data_->ctrl);
    write_body();
  }

  void command(std::span<const double> rotor_rad_s) override {
    std::copy(rotor_rad_s.begin(), rotor_rad_s.end(), data_->ctrl);
  }

  void set_wind(const Vector3& velocity_m_s) override {
    copy(enu_from_ned(velocity_m_s), data_->userdata + wind_at);
  }

  void set_centre_of_mass(const Vector3& offset_m) override {
    place_centre_of_mass(flu_from_frd(offset_m));
    write_body();
  }

  std::optional<Divergence> advance(Nanoseconds to) override {
    if (lost_ || to <= now_) return lost_;
    warning.clear();
    while (now_ < to && !lost_) step(to);
    read_body();
    return lost_;
  }

  const PlantState& state() const override { return state_; }

 private:
  // Steps to the next multiple of the physics period, or to `to` if that comes first.
  void step(Nanoseconds to) {
    Nanoseconds next = physics_.tick(steps_ + 1);
    if (next <= to) ++steps_;
    next = std::min(next, to);
    const double h = in_seconds(next - now_);
    model_.opt.timestep = h;
    const double power_before = power_ratio();
    try {
      mj_step(&model_, data_.get());
    } catch (const MujocoError& error) {
      lost_ = Divergence{next, "MuJoCo: " + error.what};
    }
    // The power is the cube of a speed that follows an exponential, so the error of the trapezium
    // rule is of the order of (h / tau)^2. A battery's numbers are much less accurate than that.
    state_.hover_seconds_used += h * (power_before + power_ratio()) / 2;
    now_ = next;
    check();
  }

  void check() {
    if (lost_) return;
    const mjtNum* v = data_->qvel;
    lost_ = divergence_of(std::span<const double, 3>(v, 3), std::span<const double, 3>(v + 3, 3),
                          vehicle_, now_);
    if (!lost_ && !warning.empty()) lost_ = Divergence{now_, "MuJoCo: " + on_one_line(warning)};
  }

  double power_ratio() const { return vehicle_.power_ratio({data_->act, rotors_}); }

  // MuJoCo has faster code for a centre of mass at the body's origin. These fields select it.
  void place_centre_of_mass(const Vector3& offset_flu) {
    copy(offset_flu, model_.body_ipos + 3 * body);
    const bool at_origin = offset_flu == Vector3{0, 0, 0};
    model_.body_sameframe[body] = at_origin;
    model_.body_simple[body] = at_origin;
    for (int i = 0; i < model_.nv; ++i) model_.dof_simplenum[i] = at_origin ? model_.nv - i : 0;
  }

  // MuJoCo's free joint is at the body's origin. PlantState has the place of the centre of mass.
  void write_body() {
    const Quaternion q = flu_to_enu(state_.attitude);
    mjtNum *const qpos = data_->qpos, *const qvel = data_->qvel;
    qpos[3] = q.w, qpos[4] = q.x, qpos[5] = q.y, qpos[6] = q.z;
    copy(flu_from_frd(state_.rate_rad_s), qvel + 3);
    mjtNum arm_W[3], velocity_W[3];
    offset_in_world(arm_W, velocity_W);
    const Vector3 position = enu_from_ned(state_.position_m);
    const Vector3 speed = enu_from_ned(state_.velocity_m_s);
    for (int i = 0; i < 3; ++i) {
      qpos[i] = position[static_cast<std::size_t>(i)] - arm_W[i];
      qvel[i] = speed[static_cast<std::size_t>(i)] - velocity_W[i];
    }
  }

  void read_body() {
    const mjtNum *const qpos = data_->qpos, *const qvel = data_->qvel;
    state_.attitude = frd_to_ned({qpos[3], qpos[4], qpos[5], qpos[6]});
    state_.rate_rad_s = frd_from_flu(vector_at(qvel + 3));
    mjtNum arm_W[3], velocity_W[3];
    offset_in_world(arm_W, velocity_W);
    state_.position_m = ned_from_enu({qpos[0] + arm_W[0], qpos[1] + arm_W[1], qpos[2] + arm_W[2]});
    state_.velocity_m_s =
        ned_from_enu({qvel[0] + velocity_W[0], qvel[1] + velocity_W[1], qvel[2] + velocity_W[2]});
    std::copy_n(data_->act, rotors_, state_.rotor_rad_s.begin());
  }

  // The place and velocity of the centre of mass relative to the body's origin, in world axes.
  void offset_in_world(mjtNum* arm_W, mjtNum* velocity_W) const {
    const mjtNum* arm_B = model_.body_ipos + 3 * body;
    mjtNum velocity_B[3];
    mju_cross(velocity_B, data_->qvel + 3, arm_B);
    mju_rotVecQuat(arm_W, arm_B, data_->qpos + 3);
    mju_rotVecQuat(velocity_W, velocity_B, data_->qpos + 3);
  }

  MujocoModelCopy copy_;
  mjModel& model_ = copy_.model();
  Data data_;
  const Vehicle& vehicle_;
  Rate physics_;
  std::size_t rotors_;
  Nanoseconds now_{0};
  std::int64_t steps_ = 0;  // whole physics periods
  PlantState state_;
  std::optional<Divergence> lost_;
};

class CompiledModel final : public MujocoModel {
 public:
  CompiledModel(std::filesystem::path file, const mjModel& model)
      : file_(std::move(file)), copy_(model) {}

  Result<std::shared_ptr<const MujocoModel>> with_numbers_of(
      const Vehicle& vehicle) const override {
    const auto rotors = static_cast<std::size_t>(copy_.model().nu);
    if (rotors != vehicle.rotors.size()) {
      return fail_at(vehicle.file.string(),
                     fmt::format("has {} rotors, but {} has {}; they must have the same number",
                                 vehicle.rotors.size(), file_.filename().string(), rotors));
    }
    try {
      auto other = std::make_shared<CompiledModel>(file_, copy_.model());
      mjModel& model = other->copy_.model();
      set_numbers(vehicle, model);
      const Data data(mj_makeData(&model));
      mj_setConst(&model, data.get());
      return other;
    } catch (const MujocoError& error) {
      return fail_at(file_.string(), "MuJoCo: " + on_one_line(error.what));
    }
  }

  Result<std::unique_ptr<Plant>> make_plant(const Vehicle& vehicle,
                                            const PlantOptions& options) const override {
    try {
      mjModel model = copy_.model();  // shares all arrays
      if (options.floor) enable_floor(model);
      leave_out_unused(model);
      return std::make_unique<MujocoPlant>(model, vehicle, options.physics);
    } catch (const MujocoError& error) {
      return fail_at(file_.string(), "MuJoCo: " + on_one_line(error.what));
    }
  }

 private:
  std::filesystem::path file_;
  MujocoModelCopy copy_;
};

}  // namespace

Result<std::shared_ptr<const MujocoModel>> MujocoModel::parse(std::string_view text,
                                                              const std::filesystem::path& xml,
                                                              const Vehicle& vehicle) {
  install_callbacks();
  auto model = compile(text, xml);
  if (!model) return tl::unexpected(model.error());
  const auto numbers = numbers_of(**model, xml);
  if (!numbers) return tl::unexpected(numbers.error());
  if (const auto differs = first_difference(*numbers, vehicle); !differs.empty()) {
    return fail_at(xml.string(), differs);
  }
  return std::make_shared<const CompiledModel>(xml, **model);
}

}  // namespace attest

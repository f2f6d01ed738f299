#include "harness/plant/plant.hpp"

#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/core/file.hpp"
#include "harness/core/suggestion.hpp"
#include "harness/core/suite_files.hpp"
#include "harness/plant/mujoco_plant.hpp"
#include "harness/plant/ode_plant.hpp"

namespace attest {
namespace {

class LoadedModel final : public VehicleModel {
 public:
  LoadedModel(Vehicle vehicle, std::shared_ptr<const MujocoModel> model)
      : vehicle_(std::move(vehicle)), model_(std::move(model)) {}

  const Vehicle& vehicle() const override { return vehicle_; }

  Result<std::shared_ptr<const VehicleModel>> with_numbers_of(Vehicle vehicle) const override {
    vehicle.mjcf_sha256 = vehicle_.mjcf_sha256;
    auto model = model_->with_numbers_of(vehicle);
    if (!model) return tl::unexpected(model.error());
    return std::make_shared<const LoadedModel>(std::move(vehicle), *std::move(model));
  }

  Result<std::unique_ptr<Plant>> make_plant(PlantKind kind,
                                            const PlantOptions& options) const override {
    if (options.floor && !has_floor(kind)) {
      return fail(fmt::format("the {} plant has no floor; fly this on mujoco", name_of(kind)));
    }
    switch (kind) {
      case PlantKind::mujoco:
        return model_->make_plant(vehicle_, options);
      case PlantKind::ode:
        return make_ode_plant(vehicle_, {});
    }
    return fail("unknown plant");
  }

 private:
  Vehicle vehicle_;
  std::shared_ptr<const MujocoModel> model_;
};

Result<std::shared_ptr<const VehicleModel>> load_with_other_mjcf(
    const std::filesystem::path& models, Vehicle vehicle) {
  const std::string file = vehicle.file.string();
  if (vehicle.mjcf_of == vehicle.name) {
    return fail_at(file, "`mjcf_of` names this vehicle itself; leave it out");
  }
  const auto other = VehicleModel::load(models, vehicle.mjcf_of);
  if (!other) return tl::unexpected(other.error());
  if (!(*other)->vehicle().mjcf_of.empty()) {
    return fail_at(file, fmt::format("`mjcf_of` names {}, which has no MJCF of its own; name {}",
                                     vehicle.mjcf_of, (*other)->vehicle().mjcf_of));
  }
  return (*other)->with_numbers_of(std::move(vehicle));
}

}  // namespace

std::optional<Divergence> divergence_of(std::span<const double, 3> velocity,
                                        std::span<const double, 3> rate, const Vehicle& vehicle,
                                        Nanoseconds at) {
  const double size = std::sqrt(rate[0] * rate[0] + rate[1] * rate[1] + rate[2] * rate[2]);
  if (!std::isfinite(size + velocity[0] + velocity[1] + velocity[2])) {
    return Divergence{at, "the state is not finite"};
  }
  if (size <= vehicle.rate_bound_rad_s) return std::nullopt;
  return Divergence{at, fmt::format("the body rate is {:.0f} rad/s, beyond {:g}", size,
                                    vehicle.rate_bound_rad_s)};
}

std::string_view name_of(PlantKind kind) {
  switch (kind) {
    case PlantKind::mujoco:
      return "mujoco";
    case PlantKind::ode:
      return "ode";
  }
  return "";
}

bool has_floor(PlantKind kind) {
  switch (kind) {
    case PlantKind::mujoco:
      return true;
    case PlantKind::ode:
      return false;
  }
  return false;
}

Result<PlantKind> parse_plant_kind(std::string_view name) {
  std::vector<std::string> names;
  for (const PlantKind kind : plant_kinds) {
    if (name == name_of(kind)) return kind;
    names.emplace_back(name_of(kind));
  }
  return fail(fmt::format("unknown plant `{}`{}; there are {}", name, suggestion(name, names),
                          fmt::join(names, " and ")));
}

Result<std::shared_ptr<const VehicleModel>> VehicleModel::load(const std::filesystem::path& models,
                                                               const std::string& name) {
  const auto toml = models / (name + ".toml");
  if (!is_suite_file(toml)) {
    const auto known = vehicle_names(models);
    return fail_at(models.string(), fmt::format("unknown vehicle `{}`{}; there are {}", name,
                                                suggestion(name, known), fmt::join(known, ", ")));
  }
  auto vehicle = read_vehicle(toml);
  if (!vehicle) return tl::unexpected(vehicle.error());
  if (!vehicle->mjcf_of.empty()) return load_with_other_mjcf(models, *std::move(vehicle));
  const auto file = models / (name + ".xml");
  const auto mjcf = read_suite_file(file);
  if (!mjcf) return tl::unexpected(mjcf.error());
  vehicle->mjcf_sha256 = sha256(*mjcf);
  auto model = MujocoModel::parse(*mjcf, file, *vehicle);
  if (!model) return tl::unexpected(model.error());
  return std::make_shared<const LoadedModel>(std::move(*vehicle), std::move(*model));
}

}  // namespace attest

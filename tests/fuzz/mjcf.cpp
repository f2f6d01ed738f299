// MuJoCo models of vehicles, which users write. A model that is read flies for some steps; all
// others are an error with the name of the file.
#include <filesystem>
#include <string>

#include "harness/plant/plant.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace attest::fuzz {
namespace {

const std::string vehicle = "iris";

void copy_vehicle() {
  const std::filesystem::path models = ATTEST_SOURCE_DIR "/models";
  std::filesystem::copy_file(models / (vehicle + ".toml"), folder() / (vehicle + ".toml"));
}

void require_flies(const VehicleModel& model, bool floor, const std::filesystem::path& file) {
  const auto plant = model.make_plant(PlantKind::mujoco, {.floor = floor});
  if (!plant) return require_readable(plant.error(), file);
  (*plant)->reset({});
  const auto lost = (*plant)->advance(Nanoseconds(10'000'000));
  if (lost) require_readable(lost->what);
}

}  // namespace
}  // namespace attest::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace attest;
  [[maybe_unused]] static const bool is_copied = (fuzz::copy_vehicle(), true);
  const auto file = fuzz::write(fuzz::vehicle + ".xml", fuzz::text_of(data, size));
  const auto model = VehicleModel::load(fuzz::folder(), fuzz::vehicle);
  if (!model) {
    fuzz::require_readable(model.error(), file);
    return 0;
  }
  for (const bool floor : {false, true}) fuzz::require_flies(**model, floor, file);
  return 0;
}

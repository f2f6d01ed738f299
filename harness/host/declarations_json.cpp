#include "harness/host/declarations_json.hpp"

#include <string>

#include <nlohmann/json.hpp>

#include "harness/port/hello.hpp"

namespace attest {

using nlohmann::json;

json to_json(const Declarations& says) {
  json out = {{"name", says.name},
              {"version", says.version},
              {"unsupported_groups", says.unsupported_groups},
              {"modules", says.modules.to_ulong()}};
  if (says.lacks.any()) out["lacks"] = says.lacks.words;
  if (says.fraction_bits) out["fraction_bits"] = *says.fraction_bits;
  if (says.fixed_step) out["fixed_step"] = says.fixed_step->to_string();
  if (!says.files.empty()) out["files"] = says.files;
  if (says.cost) {
    out["cost_unit"] = name_of(says.cost->unit);
    if (says.cost->unit == CostUnit::cycles) out["clock_hz"] = says.cost->clock_hz;
  }
  return out;
}

Declarations declarations_from(JsonReader in, bool of_program) {
  Declarations says;
  says.name = in.text("name");
  says.version = in.text("version");
  says.unsupported_groups = in.texts("unsupported_groups");
  if (in.has("files")) says.files = in.texts("files");
  for (const std::string& wrong :
       {wrong_in_declared(says.name, says.version, says.unsupported_groups),
        wrong_in_files(says.files)}) {
    if (!wrong.empty()) in.wrong(wrong);
  }
  if (in.has("lacks")) {
    const auto lacks = Lacks::parse(in.texts("lacks"));
    if (!lacks) in.wrong("lacks", "is wrong: " + lacks.error().message);
    if (lacks) says.lacks = *lacks;
  }
  if (in.has("fraction_bits")) {
    const auto bits = in.integer("fraction_bits", fewest_fraction_bits, most_fraction_bits);
    says.fraction_bits = static_cast<int>(bits);
  }
  if (in.has("fixed_step")) {
    const auto step = Rate::parse(in.text("fixed_step"));
    if (!step) in.wrong("fixed_step", "is wrong: " + step.error().message);
    if (step) says.fixed_step = *step;
  }
  if (in.has("cost_unit")) {
    std::optional<double> clock_hz;
    if (in.has("clock_hz")) clock_hz = in.real("clock_hz");
    const auto cost = CostCounter::make(in.text("cost_unit"), clock_hz);
    if (!cost) in.wrong("cost_unit", "is wrong: " + cost.error().message);
    if (cost) says.cost = *cost;
    // A library would bypass the check of its clock (clock_check.hpp).
    if (!of_program) in.wrong("cost_unit", "is there, but only a program counts its cost");
  }
  says.modules = ModuleSet(in.count("modules", ModuleSet().set().to_ulong()));
  return says;
}

}  // namespace attest

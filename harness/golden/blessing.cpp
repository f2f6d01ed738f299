#include "harness/golden/blessing.hpp"

#include <algorithm>
#include <memory>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "harness/golden/golden_change.hpp"
#include "harness/golden/make_golden.hpp"
#include "harness/plant/vehicle_models.hpp"

namespace attest {
namespace {

struct Blessing {
  const BlessingOptions& options;
  Reference reference;
  VehicleModels vehicle_models;
};

// Makes and writes the goldens of a case file in all its profiles. The golden of the first profile
// is the base of the others.
Result<void> write_goldens_of_file(const Case& first, Blessing& blessing, PendingGoldens& pending) {
  MadeGolden of_first;
  std::filesystem::path base_folder = golden_folder(blessing.options.golden, first);
  bool base_changes = false;
  for (const std::string& profile : first.profiles) {
    const Case the_case = first.in_profile(profile);
    auto made =
        make_golden(the_case, blessing.reference, blessing.vehicle_models, blessing.options.stop);
    if (!made) return tl::unexpected(made.error());
    if (!made->left_out.empty()) {
      ++pending.left_out[made->left_out];
      continue;
    }
    const bool is_first = the_case.is_of_first_profile();
    if (is_first) of_first = *made;
    std::string line = change_of_golden(the_case, *made, blessing.options.golden);
    if (line.empty() && base_changes && !the_case.flight)
      line = fmt::format("{}: its base changes", the_case.id());
    if (line.empty()) {
      ++pending.unchanged;
      continue;
    }
    blessing.options.on_change(line);
    const GoldenBase base{of_first.traces, base_folder};
    // Keyframes have no base: another profile keeps other ticks.
    const bool rests_on_base = !is_first && !of_first.traces.empty() &&
                               std::all_of(made->traces.begin(), made->traces.end(),
                                           [](const GoldenTrace& trace) { return trace.is_whole; });
    auto golden =
        NewGolden::write(blessing.options.golden, the_case, made->traces, made->vehicle_files,
                         blessing.options.making, rests_on_base ? &base : nullptr);
    if (!golden) return tl::unexpected(golden.error());
    if (is_first) {
      base_folder = golden->written();
      base_changes = true;
    }
    pending.goldens.push_back(std::move(*golden));
  }
  return {};
}

}  // namespace

Result<PendingGoldens> write_new_goldens(const std::vector<SelectedCase>& cases,
                                         const BlessingOptions& options) {
  auto reference =
      options.port ? Reference::of_port(*options.port) : Result<Reference>(Reference::own());
  if (!reference) return tl::unexpected(reference.error());
  Blessing blessing{options, *std::move(reference), VehicleModels(options.models)};
  PendingGoldens pending;
  std::set<std::filesystem::path> done;
  for (const SelectedCase& selected : cases) {
    const Case& the_case = selected.the_case;
    if (!done.insert(the_case.file).second) continue;
    const Case first = the_case.in_profile(the_case.profiles.front());
    if (auto written = write_goldens_of_file(first, blessing, pending); !written) {
      return tl::unexpected(written.error());
    }
  }
  return pending;
}

}  // namespace attest

#include "harness/golden/blessing.hpp"

#include <utility>

#include <fmt/format.h>

#include "harness/golden/golden_change.hpp"
#include "harness/golden/make_golden.hpp"
#include "harness/plant/vehicle_models.hpp"

namespace attest {
namespace {

Result<void> remove_without_case(const std::vector<SelectedCase>& cases, const Goldens& goldens,
                                 const BlessingOptions& options, PendingGoldens& pending) {
  std::set<std::string> profiles;
  for (const SelectedCase& selected : cases) profiles.insert(selected.the_case.profile);
  for (const std::string& profile : profiles) {
    for (const std::string& key : goldens.without_case(profile, options.all_cases.at(profile))) {
      options.on_change(fmt::format("{}: removed, because its case is gone", id_of(profile, key)));
      if (auto removed = pending.goldens.remove(profile, key); !removed) return removed;
    }
  }
  return {};
}

}  // namespace

Result<PendingGoldens> write_new_goldens(const std::vector<SelectedCase>& cases,
                                         const Goldens& goldens, const BlessingOptions& options) {
  auto reference = options.port ? GoldenSource::of_port(*options.port)
                                : Result<GoldenSource>(GoldenSource::own());
  if (!reference) return tl::unexpected(reference.error());
  VehicleModels vehicle_models(options.models);
  PendingGoldens pending{NewGoldens(goldens), 0, {}};
  for (const SelectedCase& selected : cases) {
    const Case& the_case = selected.the_case;
    const auto made = make_golden(the_case, *reference, vehicle_models, options.stop);
    if (!made) return tl::unexpected(made.error());
    if (!made->left_out.empty()) {
      ++pending.left_out[made->left_out];
      continue;
    }
    const auto change = change_of_golden(the_case, *made, goldens);
    if (!change) return tl::unexpected(change.error());
    if (change->empty()) {
      ++pending.unchanged;
      continue;
    }
    options.on_change(*change);
    auto added = pending.goldens.add(the_case, *made, options.making);
    if (!added) return tl::unexpected(added.error());
  }
  if (auto removed = remove_without_case(cases, goldens, options, pending); !removed) {
    return tl::unexpected(removed.error());
  }
  return pending;
}

}  // namespace attest

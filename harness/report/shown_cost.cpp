#include "harness/report/shown_cost.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace attest {

std::string in_unit(std::string_view name, const Shown& shown) {
  return fmt::format("{} [{}]", name, shown.unit());
}

std::vector<Period> periods_of(const TimeRun& run) {
  std::vector<Period> periods;
  const Shown shown(run.counter);
  for (const VectorTimes& vector : run.times.vectors) {
    if (!vector.is_timed() || !shown.in_ns(Cost(0))) continue;
    const Rate& rate = vector.result.rate.motor_unit;
    const double share = *shown.in_ns(vector.slowest()) * 1e-9 / rate.period_s();
    const auto found = std::ranges::find_if(periods, [&](const Period& one) {
      return one.module == vector.module && one.slowest->result.rate.motor_unit == rate;
    });
    if (found == periods.end()) {
      periods.push_back({vector.module, &vector, share});
    } else if (share > found->share) {
      *found = {vector.module, &vector, share};
    }
  }
  std::ranges::stable_sort(periods, [](const Period& a, const Period& b) {
    const auto key = [](const Period& one) {
      return std::pair(one.module, one.slowest->result.rate.hertz());
    };
    return key(a) < key(b);
  });
  return periods;
}

}  // namespace attest

#include "harness/loop/scheduled_timing.hpp"

namespace attest {

LoopTiming scheduled_timing(const std::vector<TaskJob>& unit,
                            const std::vector<TaskJob>* estimator) {
  LoopTiming timing;
  std::size_t estimated = 0;  // finished jobs of the estimator
  for (const TaskJob& job : unit) {
    Nanoseconds sampled = job.start;
    if (estimator != nullptr) {
      const auto& jobs = *estimator;
      while (estimated < jobs.size() && jobs[estimated].finish <= job.start) ++estimated;
      sampled = estimated == 0 ? Nanoseconds(-1) : jobs[estimated - 1].start;
    }
    timing.push_back({sampled, job.start, job.finish});
  }
  return timing;
}

FlightTiming scheduled_cascade(const std::vector<TaskJob>& rate_unit,
                               const std::vector<TaskJob>& attitude_unit,
                               const std::vector<TaskJob>* estimator) {
  FlightTiming timing = scheduled_timing(rate_unit, nullptr);
  timing.attitude_unit = scheduled_timing(attitude_unit, estimator);
  return timing;
}

}  // namespace attest

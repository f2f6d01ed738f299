// A job that runs a port in processes of its own.
#pragma once

#include <utility>

#include "harness/host/port_launcher.hpp"
#include "harness/host/port_process.hpp"
#include "harness/process/job.hpp"

namespace attest {

// The launcher of the ports' processes starts before the worker opens its first job. So the memory
// of these processes does not have the goldens that the worker reads later.
template <typename R>
class PortJob : public Job<R> {
 public:
  Result<void> begin_worker() final { return start_port_launcher(*options_.barrier); }
  bool ends_worker() const final { return !has_port_launcher(); }

 protected:
  explicit PortJob(HostOptions options) : options_(std::move(options)) {}

  const HostOptions options_;  // read by the port's processes, so it must not change
};

}  // namespace attest

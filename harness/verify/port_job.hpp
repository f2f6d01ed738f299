// A job that runs a port in processes of its own.
#pragma once

#include "harness/host/port_launcher.hpp"
#include "harness/workers/job.hpp"

namespace attest {

// The launcher starts before the worker opens its first job. So no process of a port has a golden
// or an output of the reference in its memory, also none of an earlier job.
template <typename R>
class PortJob : public Job<R> {
 public:
  void begin_worker() final { start_port_launcher(); }
};

}  // namespace attest

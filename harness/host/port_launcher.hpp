// Starts the processes of ports. Each is a fork of this process's launcher, or, without a launcher,
// of this process.
#pragma once

#include <memory>

#include "harness/core/result.hpp"
#include "harness/host/port_calls.hpp"
#include "harness/host/port_host.hpp"
#include "harness/process/child.hpp"

namespace attest {

struct HostOptions;

// Starts the launcher of this process, and ends the one that it had. A worker calls this before it
// reads data that ports must not read (Job::begin_worker()). The launcher can then start the
// processes of many ports, one after the other. All of them are behind the same barrier. Errors: a
// process cannot be started.
Result<void> start_port_launcher(const BarrierOptions& barrier);

// False before the first start, and after a launch found the launcher dead. A worker must then end:
// it may have read data that ports must not read, and a new launcher would have them in its memory.
bool has_port_launcher();

// A process that loads a port and serves requests (host_protocol.hpp).
struct PortChild {
  Child child;
  std::shared_ptr<const PortCalls> calls;
};

// Errors: a process cannot be started, or the process is a worker without a launcher.
// REQUIRES, if there is a launcher: `options` and the objects of `course` were made before it was
// started, because only their addresses are sent; the port's process before this one has ended.
Result<PortChild> launch_port(const HostOptions& options, const Course& course);

}  // namespace attest

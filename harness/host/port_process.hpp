// A PortHost (a running port, port_host.hpp) in a process of its own. The process is a fork
// (port_launcher.hpp). Its memory has the cases with their tolerances, but no golden. A crash or
// hang of the port affects that process only.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/host/port_host.hpp"
#include "harness/port/port_files.hpp"
#include "harness/process/barrier.hpp"

namespace attest {

// The limit of CPU time for each answer of a port [s]. An answer usually takes milliseconds.
inline constexpr double default_timeout_s = 10;
// While an answer is awaited, the port's processes may sleep this many times as long as they may
// run. On a machine under load a page of a file may take seconds to arrive.
inline constexpr double longer_asleep = 3;

struct HostOptions;
using StartHost =
    std::function<Result<std::unique_ptr<PortHost>>(const HostOptions&, const Course&)>;

struct HostOptions {
  std::string port = "builtin";  // as for open_port
  // The declarations that the port made before the run. It must not change them. Empty: those that
  // it makes when it is loaded.
  std::optional<Declarations> said = {};
  // The port's files when the run began. It is not loaded if they have other bytes then; null: not
  // compared.
  std::shared_ptr<const PortFiles> files = nullptr;
  double timeout_s = default_timeout_s;
  bool in_process = false;  // for a debugger: no process of its own, no protection
  // Never null. Hides what the port must not see: the suite, recorded outputs.
  std::shared_ptr<const BarrierOptions> barrier = std::make_shared<BarrierOptions>();
  // The text of the fault, if the port hung when it was loaded. Such a port is not started again.
  // The first request ends with this fault, and later requests with `not run`.
  std::string hangs = {};
  // Called while an answer is awaited. True: stop waiting, because the answer is not needed any
  // more.
  std::function<bool()> stop = [] { return false; };
  // Makes the host, if set; start_host() then calls only this. describe_port() ignores it.
  StartHost start = {};
};

// Starts a host. Without `start` and `in_process`, this is a process that loads the port and waits
// for requests, or for `recorded:DIR` a reader of its files. REQUIRES, for a process: those of
// launch_port(); without a launcher it is a copy of the caller's memory, which must have no data
// that the port must not read. Errors: the port cannot be opened, a process cannot be started. A
// port that crashes or hangs when it is loaded is no error: then each request ends with a fault.
Result<std::unique_ptr<PortHost>> start_host(const HostOptions& options, const Course& course = {});

// If `host` is null or spent (PortHost::is_spent(): after a crash or broken protocol, not after a
// timeout), replaces it by a new one without a course. Errors: those of start_host().
Result<void> ensure_host(std::unique_ptr<PortHost>& host, const HostOptions& options);

// The declarations of a port, read in a process of its own.
struct PortDescription : Declarations {
  std::string hangs;       // the fault, if the port did not answer in time when it was loaded
  std::string goes_wrong;  // its first fault when it was asked for a profile; empty: no fault
  // Profile -> what the port last printed when it made no unit of it; empty if it printed nothing.
  std::map<std::string, std::string> refusals;
};

// The result has in Declarations::profiles those of `profiles` that the port supports; of a
// recorded port, all profiles of its vectors. Each profile is requested in a process of its own: so
// a port that makes a single unit per process is not mistaken for one that supports only the first
// profile. After a fault of the port, the remaining profiles are not requested. Errors: the port
// cannot be loaded, or its process ends while the port is being loaded.
Result<PortDescription> describe_port(const HostOptions& options,
                                      const std::vector<std::string>& profiles = {});

// From now on, hosts of these options hold the port to its description.
void hold_to(const PortDescription& port, HostOptions& options);

// Hashes the port's files before its code runs for the first time, describes the port, and calls
// hold_to(). Later hosts of these options load the same bytes. Errors: those of describe_port() and
// PortFiles::read().
Result<PortDescription> prepare_port(HostOptions& options,
                                     const std::vector<std::string>& profiles = {});

// At the end of the work with a port. Errors: its files have other bytes than HostOptions::files.
Result<void> check_port(const HostOptions& options);

}  // namespace attest

// A host in a process of its own, which is started before the golden of its case is read. It is a
// fork, so the case with its tolerances is in its memory. Whatever the port does there ends there.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/host/port_host.hpp"

namespace attest {

// For each answer of a port [s]; they take milliseconds.
inline constexpr double default_timeout_s = 10;

struct HostOptions;
using StartHost =
    std::function<Result<std::unique_ptr<PortHost>>(const HostOptions&, const Course&)>;

struct HostOptions {
  std::string port = "builtin";  // as for open_port
  // What the port said before the run, which it is held to; empty: what it says when it is loaded.
  std::optional<PortSays> said = {};
  double timeout_s = default_timeout_s;
  bool in_process = false;  // for a debugger: no process of its own, no protection
  // Why the port is not to be asked at all, as it hangs when it is loaded: the fault of the first
  // request; later ones are "not run". Empty: it is asked.
  std::string hangs = {};
  // Looked at while an answer is awaited; true: the answer does not matter any more.
  std::function<bool()> stop = [] { return false; };
  // Makes a host of another kind in place of a process; empty: a process, or `in_process`.
  // describe_port() does not look at it.
  StartHost start = {};
};

// Starts a process, which loads the port and waits for requests. REQUIRES: the caller has nothing
// in its memory that the port must not read: the process is a copy of it. Errors: the port cannot
// be opened, a process cannot be started. A port that crashes or hangs when it is loaded is no
// error: each request ends with that fault.
Result<std::unique_ptr<PortHost>> start_host(const HostOptions& options, const Course& course = {});

// Starts one in place of `host` if that is null or its process has ended. Errors as start_host().
Result<void> ensure_host(std::unique_ptr<PortHost>& host, const HostOptions& options);

// What a port says of itself, asked in a process of its own.
struct PortDescription : PortSays {
  std::string hangs;       // why it says nothing: no answer in time when it was loaded
  std::string goes_wrong;  // how, when it was to make a unit; empty: it did not
};

// With those of `profiles` that the port makes a unit of, each asked in a process of its own: a
// port that makes a single unit is told from one that does not support the second profile. One that
// goes wrong there is not asked for the profiles after that one. Errors: the port cannot be loaded,
// or its process ends when it is.
Result<PortDescription> describe_port(const HostOptions& options,
                                      const std::vector<std::string>& profiles = {});

}  // namespace attest

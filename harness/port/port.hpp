// What the harness tests: a port is a kind of controller, a unit one running instance of it.
//
// Ways in share this meaning: `builtin` (the reference), `lib:PATH` (a shared library with the ABI
// of attest_unit.h), `fault:ID` (the reference with a mistake of the catalogue).
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "controller/attest_unit.h"
#include "harness/core/result.hpp"

namespace attest {

// One instance, used by one thread at a time.
class Unit {
 public:
  virtual ~Unit() = default;

  // Both return ATTEST_OK, ATTEST_UNSUPPORTED, ATTEST_INVALID or ATTEST_FAILED; anything else is
  // the port's fault and is reported as such.
  virtual int set_parameter(const std::string& name, float value) = 0;
  virtual int step(const attest_inputs& in, attest_outputs& out) = 0;
};

class Port {
 public:
  virtual ~Port() = default;

  virtual std::string name() const = 0;
  virtual std::string version() const = 0;

  // The groups of cases that the port declares not to do.
  virtual std::vector<std::string> unsupported_groups() const { return {}; }

  // A unit in its power-on state; null when the port does not support the profile.
  // The port must outlive the unit.
  virtual std::unique_ptr<Unit> create(const std::string& profile) = 0;
};

// Opens "builtin", "lib:PATH" or "fault:ID". Loading a library runs its code: a program that must
// survive a bad port does this in a child process. Errors: unknown kind, missing library, missing
// symbol, wrong ABI version, incomplete function table.
Result<std::unique_ptr<Port>> open_port(const std::string& specification);

}  // namespace attest

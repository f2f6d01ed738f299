// A port: the software under test. It implements one or more modules. A Unit is one running
// instance of any module, also of a mixer or a battery estimate.
//
// The kinds of port are the rows of a table in open_port.cpp.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "controller/attest_unit.h"
#include "harness/core/rate.hpp"
#include "harness/core/result.hpp"
#include "harness/port/cost.hpp"
#include "harness/port/lacks.hpp"
#include "harness/trace/module.hpp"

namespace attest {

// A port that is a program has ended, or has broken the rules of PROTOCOL.md. Thrown by
// create_unit(), create(), finish() and the functions of the units. `what()` is one line.
class PortBroke : public std::runtime_error {
 public:
  enum class How { ended, rules };
  PortBroke(How how, const std::string& what) : std::runtime_error(what), how_(how) {}
  How how() const { return how_; }

 private:
  How how_;
};

// How a batch ended. `done` steps returned ATTEST_OK. If `result` is not ATTEST_OK, the next step
// returned it.
struct Batched {
  std::size_t done = 0;
  int result = 0;
};

// One instance of a module, used by one thread at a time.
class Unit {
 public:
  virtual ~Unit() = default;

  // The functions with an int return ATTEST_OK, ATTEST_UNSUPPORTED, ATTEST_INVALID or
  // ATTEST_FAILED. Any other value is reported as an error of the port.
  virtual int set_parameter(const std::string& name, float value) = 0;
  // Same as attest_timestamp_sample: called once before each step. A unit that does not need the
  // time returns ATTEST_OK.
  virtual int set_timestamp_sample(std::uint64_t /*timestamp_sample_us*/) { return ATTEST_OK; }
  // REQUIRES: `in` and `out` are the ABI structs of the unit's module.
  virtual int step_structs(const void* in, void* out) = 0;

  template <typename In, typename Out>
  int step(const In& in, Out& out) {
    return step_structs(&in, &out);
  }

  // The most steps that batch() takes; 0 if the unit has no batch().
  virtual std::size_t max_batch() const { return 0; }
  // Makes one step for each sample, with set_timestamp_sample() before it. REQUIRES: 1 <=
  // samples.size() <= max_batch(), and a time for each; the outputs of the first sample are those
  // of the last step before this batch.
  virtual Batched batch(std::span<Sample> /*samples*/,
                        std::span<const std::uint64_t> /*timestamp_samples_us*/) {
    return {0, ATTEST_UNSUPPORTED};
  }

  // The costs of the steps of the last call that made steps: of each step that returned ATTEST_OK.
  // Empty if the port does not count (Port::cost()). Valid until the next call.
  virtual std::span<const StepCost> costs() const { return {}; }
};

// Passes the calls on to another unit, which outlives it. What it does in addition is in
// step_structs(). It has no batch(), so each step is seen.
class ForwardingUnit : public Unit {
 public:
  explicit ForwardingUnit(Unit& unit) : unit_(unit) {}

  int set_parameter(const std::string& name, float value) override {
    return unit_.set_parameter(name, value);
  }
  int set_timestamp_sample(std::uint64_t timestamp_sample_us) override {
    return unit_.set_timestamp_sample(timestamp_sample_us);
  }

 protected:
  Unit& unit_;
};

// A unit of the module that has these structs.
template <typename In, typename Out>
class UnitOf : public Unit {
 public:
  using Inputs = In;
  using Outputs = Out;

  int step_structs(const void* in, void* out) final {
    return step(*static_cast<const In*>(in), *static_cast<Out*>(out));
  }
  virtual int step(const In& in, Out& out) = 0;
};

class Port {
 public:
  virtual ~Port() = default;

  virtual std::string name() const = 0;
  virtual std::string version() const = 0;

  // The groups of cases that the port declares as unsupported.
  virtual std::vector<std::string> unsupported_groups() const { return {}; }

  virtual const Lacks& lacks() const;  // what it declares that it has not; nothing by default

  // Fraction bits of a port in fixed point; empty for other arithmetic.
  virtual std::optional<int> fraction_bits() const { return std::nullopt; }

  // The rate of a port with a fixed step; empty for other ports.
  virtual std::optional<Rate> fixed_step() const { return std::nullopt; }

  // Whether calls of different threads never overlap, as those of a program: it gets one request
  // after the other.
  virtual bool is_one_at_a_time() const { return false; }

  virtual ModuleSet modules() const { return only(Module::mc_att_control); }

  // The files that a program names in the handshake, as paths from the folder in which it runs.
  virtual std::vector<std::string> files() const { return {}; }

  // How the port counts the cost of its steps; empty if it does not count.
  virtual std::optional<CostCounter> cost() const { return std::nullopt; }

  // A unit in its power-on state; null if the port does not support the profile or the definition,
  // or allows no further instance now. Only the mixer has a `definition`. The port must outlive the
  // unit. REQUIRES: the port has the module.
  virtual std::unique_ptr<Unit> create_unit(Module module, const std::string& profile,
                                            const std::string& definition) = 0;
  // A controller. REQUIRES: same as create_unit().
  std::unique_ptr<Unit> create(const std::string& profile) {
    return create_unit(Module::mc_att_control, profile, "");
  }

  // Call after units were destroyed. Throws PortBroke if a program broke the protocol in destroy(),
  // because the destructor of a unit cannot throw.
  virtual void finish() {}
};

// The fraction bits that a port in fixed point can have. With fewer bits, too many wrong ports
// would pass the tolerance: of the detectable faults of px4-v1.16.0, 9 of 396 pass with 16 bits,
// and none with 20. With more, the tolerance is practically that of floats.
inline constexpr int fewest_fraction_bits = 16, most_fraction_bits = 32;

// The error in a name: "is longer than 200 bytes". Empty if it is printable and short enough.
std::string wrong_in_name(std::string_view name);

// The first error in what a port declares: "`version` is longer than 200 bytes"; empty if there is
// none.
std::string wrong_in_declared(std::string_view name, std::string_view version,
                              std::span<const std::string> unsupported_groups);

// Parses the text of ATTEST_EXTENSION_ARITHMETIC: "fixed:22" -> 22. Errors: other text, bits out of
// range.
Result<int> parse_fraction_bits(std::string_view arithmetic);

// A kind of port. A specification is its prefix and an argument: "lib:" and "./mine.so".
struct PortKind {
  std::string_view prefix;
  std::string_view argument;  // for help: "PATH"; empty for a kind without an argument
  bool is_program;            // its units are in a process of its own, and answer messages
  // The files that the port consists of. Null: it has no files.
  std::vector<std::string> (*files)(const std::string& argument);
  // Null: the port cannot be called. Its outputs are in the folder `argument`; start_host() opens
  // it, and open_port() refuses it.
  Result<std::unique_ptr<Port>> (*open)(const std::string& argument);

  bool is_callable() const { return open != nullptr; }
};

// Of an unknown kind: a row without files whose open() fails.
const PortKind& kind_of(const std::string& specification);
std::string argument_of(const std::string& specification);
std::vector<std::string> files_of(const std::string& specification);

// The port that the file `given` is: "./mine.so" becomes "lib:./mine.so", and an executable file
// "proc:FILE". Returns anything else as it is.
std::string port_of_file(const std::string& given);

// For help and messages: "`builtin`, `lib:PATH`". `only_callable`: those that open_port() opens.
std::string names_of_port_kinds(bool only_callable);

class PortFiles;

// Opens a port. Loading a library runs its code, and a program may not answer: a caller that must
// survive a bad port does this in a child process. Errors: unknown kind; those of the kind's
// open(). `files`, if not null: the port is loaded only if they have the bytes that were hashed;
// otherwise the errors of PortFiles::check().
Result<std::unique_ptr<Port>> open_port(const std::string& specification,
                                        const PortFiles* files = nullptr);

}  // namespace attest

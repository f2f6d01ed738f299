#include "harness/loop/open_loop.hpp"

#include <algorithm>
#include <limits>
#include <memory>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "harness/loop/other_instance.hpp"
#include "harness/loop/two_threads.hpp"
#include "harness/port/profiles.hpp"

namespace attest {
namespace {

class Drive {
 public:
  // `first_tick`: that of `trace`, which may be a part of a longer one.
  Drive(Unit& unit, UnitDriver& driver, Trace& trace, std::size_t first_tick = 0)
      : driver_(driver),
        max_batch_(unit.max_batch()),
        trace_(trace),
        first_tick_(first_tick),
        changes_(trace.parameters) {}

  bool is_over() const { return tick_ == trace_.samples.size(); }

  std::optional<PortFault> step() {
    auto fault =
        driver_.step(first_tick_ + tick_, changes_.take_until(tick_), trace_.samples[tick_]);
    ++tick_;
    return fault;
  }

  // Makes one step, or a batch: at most max_batch steps, up to the next change of a parameter.
  std::optional<PortFault> advance() {
    if (max_batch_ == 0) return step();
    const auto due = changes_.take_until(tick_);
    const std::size_t end =
        std::min({tick_ + max_batch_, changes_.next_tick(), trace_.samples.size()});
    auto fault = driver_.batch(first_tick_ + tick_, due,
                               std::span(trace_.samples).subspan(tick_, end - tick_));
    tick_ = end;
    return fault;
  }

 private:
  UnitDriver& driver_;
  std::size_t max_batch_;
  Trace& trace_;
  std::size_t first_tick_;
  PendingChanges changes_;
  std::size_t tick_ = 0;
};

std::optional<PortFault> to_its_end(Drive drive) {
  while (!drive.is_over()) {
    if (auto fault = drive.advance()) return fault;
  }
  return std::nullopt;
}

// The other instance, with its own inputs. Its outputs are not judged.
class Other {
 public:
  Other(Unit& unit, const ModuleUnderTest& subject, const Trace& judged)
      : unit_(unit),
        defaults_(other_defaults(judged, subject.module, subject.profile)),
        trace_(other_inputs(judged, subject.module, subject.profile)),
        driver_(unit, subject.module),
        drive_(unit, driver_, trace_) {}

  // The first call also sets the parameters of this instance, after the judged instance's first
  // step.
  std::optional<PortFault> step() {
    if (auto fault = set_defaults()) return fault;
    return drive_.step();
  }

  bool is_over() const { return drive_.is_over(); }

  // Makes all steps. A fault gets tick 0, because the judged instance has not made a step yet.
  std::optional<PortFault> run() {
    auto fault = set_defaults();
    while (!fault && !drive_.is_over()) fault = drive_.advance();
    if (fault) fault->tick = 0;
    return fault;
  }

 private:
  std::optional<PortFault> set_defaults() {
    try {
      for (const ParameterChange& change : std::exchange(defaults_, {})) {
        (void)unit_.set_parameter(change.name, change.value);  // the port may refuse it
      }
    } catch (const PortBroke& broke) {
      return fault_of(broke);
    }
    return std::nullopt;
  }

  Unit& unit_;
  std::vector<ParameterChange> defaults_;
  Trace trace_;
  UnitDriver driver_;
  Drive drive_;
};

// Each step of the other instance follows the judged one's. So the other instance also sets its
// first parameters and topics after the judged one has received its own.
std::optional<PortFault> drive_alternately(Drive judged, Other& other) {
  while (!judged.is_over()) {
    if (auto fault = judged.step()) return fault;
    if (auto fault = other.step()) return fault;
  }
  return std::nullopt;
}

// The threads do not follow each other's steps, so the steps overlap in any way.
std::optional<PortFault> drive_on_two_threads(Drive judged, Other& other, std::size_t ticks,
                                              Overlaps& overlaps) {
  std::optional<PortFault> fault, of_other;
  const auto judged_step = [&] {
    fault = judged.step();
    return !fault && !judged.is_over();
  };
  const auto other_step = [&] {
    of_other = other.step();
    return !of_other && !other.is_over();
  };
  if (run_on_two_threads(judged_step, other_step, ticks, overlaps)) return fault ? fault : of_other;
  overlaps.blocked = std::numeric_limits<std::size_t>::max();  // there will be no more
  return drive_alternately(judged, other);
}

PortFault makes_only_one() {
  return {PortFault::Kind::unsupported, 0,
          "the port makes no second instance while it has one: create() returned NULL"};
}

PortFault makes_no_other() {
  return {
      PortFault::Kind::protocol, 0,
      "create() returned NULL after the first instance was destroyed; create() is always legal"};
}

bool are_alive_together(Instances instances) {
  return instances == Instances::together || instances == Instances::two_threads;
}

bool is_on_two_threads(const Port& port, const ModuleUnderTest& subject) {
  return subject.instances == Instances::two_threads && !port.is_one_at_a_time();
}

// Two instances of the subject. `overlaps`: counts those on two threads.
std::optional<PortFault> drive_in_company(Port& port, const ModuleUnderTest& subject, Trace& trace,
                                          Overlaps& overlaps) {
  auto first = make_unit(port, subject);
  if (!first) return first.error();
  Other other(**first, subject, trace);
  if (subject.instances == Instances::again) {
    if (auto fault = other.run()) return fault;
    first->reset();
  }
  const auto judged = port.create_unit(subject.module, subject.profile, subject.mixer);
  if (!judged) {
    return subject.instances == Instances::again ? makes_no_other() : makes_only_one();
  }
  if (subject.instances == Instances::crossed) {
    if (auto fault = other.run()) return fault;
    first->reset();
  }
  if (!are_alive_together(subject.instances)) return drive(*judged, trace, subject.module);
  OverlappedUnit overlapped(*judged);
  UnitDriver driver(overlapped, subject.module);
  const Drive drive_judged(overlapped, driver, trace);
  if (!is_on_two_threads(port, subject)) return drive_alternately(drive_judged, other);
  return drive_on_two_threads(drive_judged, other, trace.samples.size(), overlaps);
}

PortFault no_profile(const ModuleUnderTest& subject) {
  return {PortFault::Kind::profile, 0,
          fmt::format("the port does not support profile {}", subject.profile)};
}

// Then the port supports the subject's profile, but not its module.
bool makes_another(Port& port, const ModuleUnderTest& subject) {
  return find_profile(subject.profile) && makes_any_of(port, subject.profile, subject.module);
}

PortFault lacks_module(Port& port, const ModuleUnderTest& subject) {
  const ModuleInfo& info = info_of(subject.module);
  const bool has_profile =
      find_profile(subject.profile) ? makes_another(port, subject) : info.extension != nullptr;
  if (!has_profile) return no_profile(subject);
  std::string what = fmt::format("the port has no module {}", info.name);
  if (info.extension) what += fmt::format(" (extension {})", info.extension);
  return {PortFault::Kind::module, 0, what};
}

PortFault makes_none(Port& port, const ModuleUnderTest& subject) {
  if (subject.module == Module::mixer) {
    return {
        PortFault::Kind::unsupported, 0,
        fmt::format("the port makes no mixer `{}` of profile {}", subject.mixer, subject.profile)};
  }
  if (!makes_another(port, subject)) return no_profile(subject);
  return {PortFault::Kind::module, 0,
          fmt::format("the port makes no module {} of profile {}", info_of(subject.module).name,
                      subject.profile)};
}

PortFault makes_one_profile(const std::string& profile, const std::string& other) {
  return {PortFault::Kind::unsupported, 0,
          fmt::format("the port makes no unit of {} while it has one of {}", other, profile)};
}

// Many instances, of which each is made, makes the next step, and is destroyed. They have the
// inputs of the other instance (other_instance.hpp), and default parameters.
class Many {
 public:
  // REQUIRES: the port has the module.
  Many(Port& port, const ModuleUnderTest& subject, const Trace& judged)
      : port_(port),
        subject_(subject),
        trace_(other_inputs(judged, subject.module, subject.profile)) {}

  bool is_over() const { return tick_ == trace_.samples.size(); }

  std::optional<PortFault> step(bool judged_exists) {
    const auto unit = make(judged_exists);
    if (!unit) return unit.error();
    UnitDriver driver(**unit, subject_.module);
    const std::size_t tick = tick_++;
    return driver.step(tick, {}, trace_.samples[tick]);
  }

 private:
  // Of the profile whose turn it is, or of the judged one's if the port never makes that one.
  tl::expected<std::unique_ptr<Unit>, PortFault> make(bool judged_exists) {
    if (const auto& others = subject_.other_profiles; !others.empty()) {
      const std::string& profile = others[tick_ % others.size()];
      if (auto unit = port_.create_unit(subject_.module, profile, subject_.mixer)) {
        made_.insert(profile);
        return unit;
      }
      if (made_.contains(profile)) {
        return tl::unexpected(makes_one_profile(subject_.profile, profile));
      }
    }
    auto unit = make_unit(port_, subject_);
    if (!unit && judged_exists) return tl::unexpected(makes_only_one());
    if (!unit && tick_ > 0) return tl::unexpected(makes_no_other());
    return unit;
  }

  Port& port_;
  const ModuleUnderTest& subject_;
  Trace trace_;
  std::size_t tick_ = 0;
  std::set<std::string> made_;  // profiles
};

bool are_many(Instances instances) {
  return instances == Instances::after_many || instances == Instances::among_many ||
         instances == Instances::other_profiles;
}

// How many of the many instances are made before the judged one. One of another profile is the very
// first: a port may take the profile of its first instance for all of them.
std::size_t count_before(const ModuleUnderTest& subject, const Trace& trace) {
  if (subject.instances == Instances::after_many) return trace.samples.size();
  return subject.instances == Instances::other_profiles ? 1 : 0;
}

std::optional<PortFault> drive_with_many(Port& port, const ModuleUnderTest& subject, Trace& trace) {
  if (!contains(port.modules(), subject.module)) return lacks_module(port, subject);
  Many many(port, subject, trace);
  for (std::size_t left = count_before(subject, trace); left > 0; --left) {
    if (auto fault = many.step(false)) {
      fault->tick = 0;  // the judged instance has not made a step yet
      return fault;
    }
  }
  const auto judged = make_unit(port, subject);
  if (!judged) return many.is_over() ? makes_no_other() : judged.error();
  UnitDriver driver(**judged, subject.module);
  Drive drive_judged(**judged, driver, trace);
  while (!drive_judged.is_over()) {
    auto fault = many.is_over() ? drive_judged.advance() : drive_judged.step();
    if (!fault && !many.is_over()) fault = many.step(true);
    if (fault) return fault;
  }
  return std::nullopt;
}

}  // namespace

std::optional<PortFault> drive(Unit& unit, Trace& trace, Module module) {
  UnitDriver driver(unit, module);
  return to_its_end(Drive(unit, driver, trace));
}

std::optional<PortFault> PartDriver::drive(Trace& part, std::size_t first_tick) {
  return to_its_end(Drive(*unit_, driver_, part, first_tick));
}

ModuleUnderTest subject_of(const Case& the_case) {
  ModuleUnderTest subject{the_case.profile, the_case.module, the_case.mixer, the_case.instances};
  if (the_case.instances != Instances::other_profiles || the_case.profiles.empty()) return subject;
  auto& others = subject.other_profiles = the_case.profiles;
  std::erase(others, the_case.profile);
  // The oldest comes first, unless it is the judged one: neighbours may have the same law.
  if (the_case.profile != the_case.profiles.back()) std::swap(others.front(), others.back());
  return subject;
}

tl::expected<std::unique_ptr<Unit>, PortFault> make_unit(Port& port,
                                                         const ModuleUnderTest& subject) {
  const bool has_module = contains(port.modules(), subject.module);
  auto unit =
      has_module ? port.create_unit(subject.module, subject.profile, subject.mixer) : nullptr;
  if (!unit) return tl::unexpected(why_no_unit(port, subject));
  return unit;
}

PortFault why_no_unit(Port& port, const ModuleUnderTest& subject) {
  const bool has_module = contains(port.modules(), subject.module);
  return has_module ? makes_none(port, subject) : lacks_module(port, subject);
}

std::optional<PortFault> drive(Port& port, const ModuleUnderTest& subject, Trace& trace) {
  if (are_many(subject.instances)) return drive_with_many(port, subject, trace);
  if (subject.instances == Instances::one) {
    const auto unit = make_unit(port, subject);
    return unit ? drive(**unit, trace, subject.module) : unit.error();
  }
  const auto run = [&](Trace& driven, Overlaps& overlaps) {
    return drive_in_company(port, subject, driven, overlaps);
  };
  Overlaps none;
  return is_on_two_threads(port, subject) ? run_until_overlapped(trace, run) : run(trace, none);
}

}  // namespace attest

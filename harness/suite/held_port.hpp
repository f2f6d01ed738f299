// Holds a port to what it said of itself before the run. The tolerances and the cases of a port
// follow from that, so a port that says something else later broke the rules of the ABI.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/port/port.hpp"
#include "harness/suite/verdict.hpp"

namespace attest {

// What a port said, in a process of its own.
struct PortSays {
  std::string name, version;
  std::vector<std::string> unsupported_groups;
  std::optional<int> fraction_bits;
  std::optional<Rate> fixed_step;
  bool has_mixer = false, has_battery_status = false;
  std::vector<std::string> profiles;  // that it made a unit of

  // Of a port that is loaded; the profiles stay empty.
  static PortSays asked(const Port& port);
};

// Answers with what was said, whatever the port says by now.
class HeldPort final : public Port {
 public:
  // `said` empty: the port is asked each time, and hold() changes nothing.
  HeldPort(std::unique_ptr<Port> port, std::optional<PortSays> said)
      : port_(std::move(port)), said_(std::move(said)) {}

  // After a task: the verdict becomes protocol if the port says something else by now, or did not
  // make the unit of a profile that it had made one of.
  void hold(CaseResult& result) const;

  std::string name() const override { return says().name; }
  std::string version() const override { return says().version; }
  std::vector<std::string> unsupported_groups() const override { return says().unsupported_groups; }
  std::optional<int> fraction_bits() const override { return says().fraction_bits; }
  std::optional<Rate> fixed_step() const override { return says().fixed_step; }
  bool has_mixer() const override { return says().has_mixer && port_->has_mixer(); }
  bool has_battery_status() const override {
    return says().has_battery_status && port_->has_battery_status();
  }
  std::unique_ptr<Unit> create(const std::string& profile) override;
  std::unique_ptr<MixerUnit> create_mixer(const std::string& profile,
                                          const std::string& definition) override {
    return port_->create_mixer(profile, definition);
  }
  std::unique_ptr<BatteryUnit> create_battery_status(const std::string& profile) override {
    return port_->create_battery_status(profile);
  }

 private:
  PortSays says() const { return said_ ? *said_ : PortSays::asked(*port_); }

  std::unique_ptr<Port> port_;
  std::optional<PortSays> said_;
  std::string refused_;  // the profile of which create() made no unit last
};

}  // namespace attest

// The mixer with stages that record its distances from decisions.
#include <algorithm>
#include <cmath>
#include <limits>

#include "controller/actuation/unit_table.hpp"
#include "harness/golden/margin_meters.hpp"

namespace attest {
namespace {

struct NotingMixer : actuation::MixerStages<double> {
  using Law = actuation::MixerStages<double>;
  MarginNotes* notes;

  explicit NotingMixer(MarginNotes* to) : notes(to) {}

  Fit fit(double min_out, double max_out, double thrust) const {
    for (const double beyond : {-min_out, max_out - 1}) notes->note(Decision::mixer_limit, beyond);
    const bool one_end = (min_out < 0) != (max_out > 1);
    if (one_end) notes->note(Decision::mixer_branch, max_out - min_out - 1);
    return Law::fit(min_out, max_out, thrust);
  }
  // Whether the flag is set depends on the rotor that is furthest out, not on the rotors' order.
  bool yield_yaw(std::span<const actuation::Rotor> rotors, Controls& c, const Fit& fit) const {
    double beyond = -std::numeric_limits<double>::infinity();
    for (const actuation::Rotor& rotor : rotors) {
      const double out =
          without_yaw(rotor, c, fit.roll_pitch_scale) + c.yaw * rotor.yaw + c.thrust + fit.boost;
      beyond = std::max({beyond, -out, out - 1});
    }
    notes->note(Decision::mixer_yaw, beyond);
    return Law::yield_yaw(rotors, c, fit);
  }
};

class MixerMeter final : public MarginMeter {
 public:
  explicit MixerMeter(const actuation::MixerDefinition& definition)
      : mixer_(definition, NotingMixer(&notes_)) {}

 private:
  void measure(std::span<const ParameterChange> /*a mixer has none*/,
               const Sample& sample) override {
    actuation::step_mixer(mixer_, sample.mixer_in, out_);
  }

  actuation::BasicMixer<double, NotingMixer> mixer_;
  attest_mixer_outputs out_{};
};

}  // namespace

std::unique_ptr<MarginMeter> mixer_meter(const std::string& definition) {
  const auto parsed = actuation::parse_mixer(definition);
  return parsed ? std::make_unique<MixerMeter>(*parsed) : nullptr;
}

}  // namespace attest

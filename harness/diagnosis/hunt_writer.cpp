#include "harness/diagnosis/hunt_writer.hpp"

#include <array>
#include <cmath>

#include "harness/casefile/baseline.hpp"
#include "harness/casefile/flight_mode.hpp"

namespace attest {
namespace {

// How often a value changes.
double change_rate(HuntRandom& random) {
  constexpr std::array<double, 6> rates = {0, 0, 0.02, 0.1, 0.4, 1};
  return random.one_of(rates);
}

// When a topic with a bit is new.
class HuntReleases {
 public:
  explicit HuntReleases(HuntRandom& random) : kind_(random.below(16)) {
    period_ = random.skewed(2, 40);
    phase_ = random.chance(0.7) ? 0 : random.below(period_);
    probability_ = random.chance(0.5) ? 0.05 : 0.4;
  }

  bool is_new(std::size_t tick, HuntRandom& random) const {
    if (kind_ == 0) return false;                      // never
    if (kind_ <= 4) return tick == 0;                  // once
    if (kind_ <= 8) return true;                       // at every tick
    if (kind_ <= 12) return tick % period_ == phase_;  // periodically
    return (tick == 0 && kind_ != 15) || random.chance(probability_);
  }

 private:
  std::size_t kind_, period_, phase_;
  double probability_;
};

class HuntWriter {
 public:
  HuntWriter(const HuntTarget& target, const HuntTopic& topic, HuntInputs& inputs,
             HuntRandom& random)
      : target_(target), topic_(topic), inputs_(inputs), random_(random) {}

  // Chooses the ticks at which the topic is new, and then writes its values.
  void release(const HuntWindow& window) {
    if (topic_.bit == 0) return;
    const HuntReleases releases(random_);
    for (std::size_t tick = window.begin; tick < window.end; ++tick) {
      auto& updated = inputs_.ticks[tick].sample.in.updated;
      updated = releases.is_new(tick, random_) ? updated | topic_.bit : updated & ~topic_.bit;
    }
  }

  void write(const HuntWindow& window) {
    const bool is_calm = random_.chance(0.25);
    for (std::size_t i = 0; i < topic_.fields.size(); ++i) {
      const Channel& field = *topic_.fields[i];
      if (field.quantity == Quantity::quaternion) {
        if (field.field().ends_with("[0]")) write_rotation(i, window, is_calm);
      } else {
        write_field(field, window, is_calm || random_.chance(0.4));
      }
    }
    if (topic_.name == "vehicle_control_mode" && !random_.chance(0.15)) write_mode(window);
  }

  void write_field(const Channel& field, const HuntWindow& window, bool is_baseline) {
    const double changes = is_baseline ? 0 : change_rate(random_);
    // A ramp or walk in place of jumps.
    const double slope = !is_baseline && random_.chance(0.25) ? random_.uniform(-0.05, 0.05) : 0;
    double value = is_baseline ? baseline(field) : new_value(field);
    double counter = random_.chance(0.9) ? 0 : 255;
    const bool is_counter = field.field() == "quat_reset_counter";
    for_each_release(window, [&](std::size_t, Sample& sample) {
      if (random_.chance(changes)) value = new_value(field);
      if (is_counter) {
        counter += random_.chance(changes * 0.1) ? 1 : 0;
        value = std::fmod(counter, 256);
      } else if (field.type == ChannelType::f32 && slope != 0) {
        value += slope * (random_.chance(0.5) ? 1 : random_.uniform(-1, 1));
        const double most = std::max(1.0, std::abs(baseline(field)) * 2);
        if (std::abs(value) > most && std::abs(value) < 4 * most) value = -value;
      }
      set(field, sample, value);
    });
  }

 private:
  template <typename Work>
  void for_each_release(const HuntWindow& window, Work work) {
    for (std::size_t tick = window.begin; tick < window.end; ++tick) {
      Sample& sample = inputs_.ticks[tick].sample;
      if (topic_.is_new(sample)) work(tick, sample);
    }
  }

  static void set(const Channel& field, Sample& sample, double value) {
    if (field.type == ChannelType::u64) {
      set_relative_us(field, sample, static_cast<std::int64_t>(value));
    } else {
      set_value(field, sample, value);
    }
  }

  double new_value(const Channel& field) {
    if (field.type == ChannelType::u64) {
      const bool keeps_step = target_.fixed_step && field.field() == "timestamp_sample";
      const double period_s = inputs_.rate.period_s();
      return keeps_step ? 0 : static_cast<double>(hunt_time_us(field, period_s, random_));
    }
    if (field.type == ChannelType::u8) return hunt_byte(field, random_);
    return hunt_value(field, target_.level, random_);
  }

  // The attitude of the vehicle at a tick.
  HuntRotation attitude(const Sample& sample) const {
    const std::string_view topic =
        info_of(target_.subject.module).is_of_cascade() || info_of(target_.subject.module).is_law()
            ? "in/vehicle_attitude.q[0]"
            : "in/control_state.q[0]";
    const auto first = find_channel(target_.subject.module, topic);
    HuntRotation q{};
    for (std::size_t i = 0; first && i < 4; ++i) q[i] = value_of(channels()[*first + i], sample);
    return q;
  }

  void write_rotation(std::size_t first, const HuntWindow& window, bool is_calm) {
    const bool is_setpoint = topic_.fields[first]->field() == "q_d[0]";
    const bool follows = is_setpoint && random_.chance(0.7);  // at an error to the attitude
    const bool turns = !is_calm && random_.chance(0.4);
    const double changes = is_calm ? 0 : change_rate(random_);
    HuntRotation q = is_calm ? HuntRotation{1, 0, 0, 0} : hunt_rotation(random_);
    // The units normalise setpoints and resets; other forms of the old law need a norm of 1, as
    // that of an estimator is.
    const bool is_attitude =
        topic_.fields[first]->field() == "q[0]" || !info_of(target_.subject.module).is_of_cascade();
    const bool is_exact = target_.level == Level::exact;
    const double norm = (is_exact || !is_attitude) && random_.chance(0.08)
                            ? random_.uniform(is_exact ? 0 : 0.5, 2)
                            : 1;
    const HuntRotation turn = rotation({0.48, 0.6, 0.64}, random_.uniform(-0.05, 0.05));
    for_each_release(window, [&](std::size_t, Sample& sample) {
      if (random_.chance(changes)) q = hunt_rotation(random_);
      if (turns) q = normalised(product(q, turn));
      const HuntRotation value = follows && !is_calm ? normalised(product(attitude(sample), q)) : q;
      for (std::size_t i = 0; i < 4; ++i) {
        set_value(*topic_.fields[first + i], sample, value[i] * norm);
      }
    });
  }

  static HuntRotation normalised(HuntRotation q) {
    const double norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (!(norm > 0.1)) return {1, 0, 0, 0};
    for (double& part : q) part /= norm;
    return q;
  }

  void write_mode(const HuntWindow& window) {
    const Module module = target_.subject.module;
    const auto modes = flight_modes(module);
    const double changes = random_.chance(0.5) ? 0 : 0.1;
    std::size_t mode = random_.below(modes.size());
    if (random_.chance(0.5)) mode = random_.below(4);  // those of a pilot
    for_each_release(window, [&](std::size_t, Sample& sample) {
      if (random_.chance(changes)) mode = random_.below(modes.size());
      for (std::size_t i = 0; i < modes[mode].flags.size(); ++i) {
        for (const Channel* field : topic_.fields) {
          if (field->field() != flag_names(module)[i]) continue;
          set_value(*field, sample, modes[mode].flags[i]);
        }
      }
    });
  }

  const HuntTarget& target_;
  const HuntTopic& topic_;
  HuntInputs& inputs_;
  HuntRandom& random_;
};

}  // namespace

void write_topic(const HuntTarget& target, const HuntTopic& topic, const HuntWindow& window,
                 HuntInputs& inputs, HuntRandom& random) {
  HuntWriter writer(target, topic, inputs, random);
  writer.release(window);
  writer.write(window);
}

void write_values(const HuntTarget& target, const HuntTopic& topic, const HuntWindow& window,
                  HuntInputs& inputs, HuntRandom& random) {
  HuntWriter(target, topic, inputs, random).write(window);
}

void write_field(const HuntTarget& target, const HuntTopic& topic, const Channel& field,
                 const HuntWindow& window, HuntInputs& inputs, HuntRandom& random) {
  HuntWriter(target, topic, inputs, random).write_field(field, window, random.chance(0.2));
}

}  // namespace attest

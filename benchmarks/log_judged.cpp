// `attest replay` of the log of a flight, as CPU time of all its processes, per MB of the log. The
// floor is one reading of the log's messages. Two kinds of log are as PX4 writes them: by its
// default logging profile, as nearly all public logs are, and with every step of both units.
#include <filesystem>
#include <initializer_list>
#include <string>

#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <unistd.h>

#include "harness/process/program.hpp"
#include "harness/realtime/usage.hpp"
#include "harness/ulog/reader.hpp"
#include "harness/ulog/writer.hpp"
#include "tests/harness/ulog/crafted.hpp"

namespace attest::bench {
namespace {

using ulog::raw;

constexpr auto definitions = std::to_array<const char*>({
    "vehicle_control_mode:uint64_t timestamp;bool flag_armed;bool flag_control_attitude_enabled;"
    "bool flag_control_rates_enabled;",
    "vehicle_status:uint64_t timestamp;uint8_t arming_state;uint8_t vehicle_type;bool is_vtol;",
    "vehicle_land_detected:uint64_t timestamp;bool maybe_landed;bool landed;",
    "vehicle_attitude:uint64_t timestamp;uint64_t timestamp_sample;float[4] q;"
    "float[4] delta_q_reset;uint8_t quat_reset_counter;",
    "vehicle_attitude_setpoint:uint64_t timestamp;float yaw_sp_move_rate;float[4] q_d;"
    "float[3] thrust_body;",
    "vehicle_rates_setpoint:uint64_t timestamp;float roll;float pitch;float yaw;"
    "float[3] thrust_body;",
    "vehicle_angular_velocity:uint64_t timestamp;uint64_t timestamp_sample;float[3] xyz;"
    "float[3] xyz_derivative;",
    "rate_ctrl_status:uint64_t timestamp;float rollspeed_integ;float pitchspeed_integ;"
    "float yawspeed_integ;",
    "vehicle_thrust_setpoint:uint64_t timestamp;uint64_t timestamp_sample;float[3] xyz;",
    "vehicle_torque_setpoint:uint64_t timestamp;uint64_t timestamp_sample;float[3] xyz;",
    "sensor_other:uint64_t timestamp;float[14] x;",
});
// Of the topics, in the order of the definitions. The last one is not read.
enum Topic : std::uint16_t {
  mode,
  status,
  land,
  attitude,
  setpoint,
  rates,
  gyro,
  integral,
  thrust,
  torque,
  unread
};

// How often a logger writes the topics.
struct Profile {
  int duration_ms;
  int attitude_ms, rates_ms, gyro_ms, integral_ms;
  int unread;  // messages at each gyro sample that the law does not read
};
// In a public log four fifths of the bytes are of topics that the law does not read, and a message
// has about 60 bytes.
constexpr Profile by_default{1'200'000, 50, 20, 20, 200, 12};
constexpr Profile every_step{100'000, 4, 4, 1, 1, 0};

// It is removed when the program ends.
class FlightFile {
 public:
  explicit FlightFile(const Profile& profile) {
    auto writer = *ulog::Writer::open(path_, 0);
    (void)writer.info("sys_name", "PX4");
    (void)writer.parameter("IMU_GYRO_RATEMAX", 1000);
    for (const char* definition : definitions) (void)writer.define(definition);
    for (const std::string_view definition : definitions) {
      (void)writer.subscribe(definition.substr(0, definition.find(':')));
    }
    for (int ms = 0; ms < profile.duration_ms; ++ms) write(profile, ms, writer);
    (void)writer.commit();
  }
  ~FlightFile() { std::filesystem::remove(path_); }
  FlightFile(const FlightFile&) = delete;
  FlightFile& operator=(const FlightFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  double megabytes() const { return 1e-6 * static_cast<double>(std::filesystem::file_size(path_)); }

 private:
  // What is logged in this millisecond of a flight at rest, whose thrust grows.
  static void write(const Profile& profile, int ms, ulog::Writer& writer) {
    constexpr std::uint8_t on = 1, off = 0, armed = 2, rotary_wing = 1;
    const std::uint64_t time = 1'000'000 + 1000 * static_cast<std::uint64_t>(ms);
    const auto up = -0.5F - 1e-7F * static_cast<float>(ms / profile.rates_ms);
    const auto is_due = [&](int period_ms) { return ms % period_ms == 0; };
    if (is_due(500)) {
      (void)writer.data(mode, raw(time - 900, on, on, on));
      (void)writer.data(status, raw(time - 890, armed, rotary_wing, off));
      const std::uint8_t landed = ms == 0 ? on : off;
      (void)writer.data(land, raw(time - 880, landed, landed));
    }
    if (is_due(profile.attitude_ms)) {
      (void)writer.data(setpoint, raw(time - 500, 0.0F, 1.0F, 0.0F, 0.0F, 0.0F, 0.0F, 0.0F, up));
      (void)writer.data(attitude, raw(time - 100, time - 600, 1.0F, 0.0F, 0.0F, 0.0F, 1.0F, 0.0F,
                                      0.0F, 0.0F, off));
    }
    if (is_due(profile.rates_ms)) {
      (void)writer.data(rates, raw(time - 80, 0.0F, 0.0F, 0.0F, 0.0F, 0.0F, up));
    }
    if (!is_due(profile.gyro_ms)) return;
    (void)writer.data(gyro, raw(time, time - 300, 0.0F, 0.0F, 0.0F, 0.0F, 0.0F, 0.0F));
    if (is_due(profile.integral_ms)) (void)writer.data(integral, raw(time + 5, 0.0F, 0.0F, 0.0F));
    (void)writer.data(thrust, raw(time + 8, time - 300, 0.0F, 0.0F, up));
    (void)writer.data(torque, raw(time + 9, time - 300, 0.0F, 0.0F, 0.0F));
    for (int i = 0; i < profile.unread; ++i) {
      (void)writer.data(unread, raw(time + 10 + static_cast<std::uint64_t>(i)) +
                                    std::string(14 * sizeof(float), 'x'));
    }
  }

  static inline int count_ = 0;
  std::filesystem::path path_ =
      std::filesystem::temp_directory_path() / fmt::format("bench.{}.{}.ulg", ::getpid(), count_++);
};

const FlightFile& default_log() {
  static const FlightFile file(by_default);
  return file;
}

const FlightFile& full_log() {
  static const FlightFile file(every_step);
  return file;
}

template <typename Work>
void cpu_time_per_megabyte(benchmark::State& state, const FlightFile& log, Work work) {
  for (auto _ : state) {
    const Nanoseconds begin = cpu_time_of_all();
    work(log.path());
    state.SetIterationTime(in_seconds(cpu_time_of_all() - begin) / log.megabytes());
  }
}

void read(benchmark::State& state, const FlightFile& log) {
  cpu_time_per_megabyte(state, log, [](const std::filesystem::path& path) {
    auto reader = *ulog::Reader::open(path);
    ulog::Message message;
    while (*reader.next(message)) benchmark::DoNotOptimize(message);
  });
}

void replayed(benchmark::State& state, const FlightFile& log) {
  cpu_time_per_megabyte(state, log, [&](const std::filesystem::path& path) {
    const auto text = output_of({ATTEST_BENCHMARK_ATTEST, "replay", path.string(), "--profile",
                                 "px4-v1.16.0", "--jobs", "1"},
                                {60});
    if (!text || text->find("PASS 2 of 2") == text->npos) {
      state.SkipWithError("the reference does not agree with the log");
    }
  });
}

void default_replayed(benchmark::State& state) { replayed(state, default_log()); }
void default_read(benchmark::State& state) { read(state, default_log()); }
void full_replayed(benchmark::State& state) { replayed(state, full_log()); }
void full_read(benchmark::State& state) { read(state, full_log()); }

BENCHMARK(default_replayed)->Name("log/default")->UseManualTime()->Iterations(1);
BENCHMARK(default_read)->Name("log/default_read")->UseManualTime()->Iterations(1);
BENCHMARK(full_replayed)->Name("log/every_step")->UseManualTime()->Iterations(1);
BENCHMARK(full_read)->Name("log/every_step_read")->UseManualTime()->Iterations(1);

}  // namespace
}  // namespace attest::bench

// The judgement of a log of a flight as PX4 writes it by default. The floor is one reading of its
// messages. Times are per MB of the log.
#include <chrono>
#include <filesystem>
#include <string>

#include <benchmark/benchmark.h>
#include <unistd.h>

#include "harness/host/in_process_host.hpp"
#include "harness/port/builtin.hpp"
#include "harness/ulog/flight_log.hpp"
#include "harness/ulog/reader.hpp"
#include "harness/ulog/writer.hpp"
#include "harness/verify/evaluate_log.hpp"
#include "tests/harness/ulog/crafted.hpp"

namespace attest::bench {
namespace {

using ulog::raw;

constexpr auto definitions = std::to_array<const char*>({
    "vehicle_control_mode:uint64_t timestamp;bool flag_armed;bool flag_control_attitude_enabled;"
    "bool flag_control_rates_enabled;",
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
    "sensor_other:uint64_t timestamp;float[245] x;",
});
// Of the topics, in the order of the definitions. The last one is not read.
enum Topic : std::uint16_t {
  mode,
  attitude,
  setpoint,
  rates,
  gyro,
  status,
  thrust,
  torque,
  unread
};

// 20 minutes in the air, with the periods of PX4's default logging profile. Four fifths of the
// bytes are a topic that the law does not read, as in public logs. It is removed when the program
// ends.
class FlightFile {
 public:
  FlightFile() {
    auto writer = *ulog::Writer::open(path_, 0);
    (void)writer.info("sys_name", "PX4");
    (void)writer.parameter("IMU_GYRO_RATEMAX", 800);
    for (const char* definition : definitions) (void)writer.define(definition);
    for (const std::string_view definition : definitions) {
      (void)writer.subscribe(definition.substr(0, definition.find(':')));
    }
    constexpr std::uint8_t on = 1;
    for (std::uint64_t i = 0; i < 60'000; ++i) {
      const std::uint64_t time = 1'000'000 + 20'000 * i;
      const auto up = -0.5F - 1e-6F * static_cast<float>(i);
      if (i % 25 == 0) (void)writer.data(mode, raw(time - 9'000, on, on, on));
      if (i % 2 == 0) {
        (void)writer.data(setpoint,
                          raw(time - 5'000, 0.0F, 1.0F, 0.0F, 0.0F, 0.0F, 0.0F, 0.0F, up));
        (void)writer.data(attitude, raw(time - 100, time - 600, 1.0F, 0.0F, 0.0F, 0.0F, 1.0F, 0.0F,
                                        0.0F, 0.0F, std::uint8_t{0}));
      }
      (void)writer.data(rates, raw(time - 80, 0.0F, 0.0F, 0.0F, 0.0F, 0.0F, up));
      (void)writer.data(gyro, raw(time, time - 300, 0.0F, 0.0F, 0.0F, 0.0F, 0.0F, 0.0F));
      if (i % 10 == 0) (void)writer.data(status, raw(time + 5, 0.0F, 0.0F, 0.0F));
      (void)writer.data(thrust, raw(time + 8, time - 300, 0.0F, 0.0F, up));
      (void)writer.data(torque, raw(time + 9, time - 300, 0.0F, 0.0F, 0.0F));
      (void)writer.data(unread, raw(time + 10) + std::string(245 * sizeof(float), 'x'));
    }
    (void)writer.commit();
  }
  ~FlightFile() { std::filesystem::remove(path_); }
  FlightFile(const FlightFile&) = delete;
  FlightFile& operator=(const FlightFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  double megabytes() const { return 1e-6 * static_cast<double>(std::filesystem::file_size(path_)); }

 private:
  std::filesystem::path path_ =
      std::filesystem::temp_directory_path() / ("bench.log." + std::to_string(::getpid()));
};

const FlightFile& flight() {
  static const FlightFile file;
  return file;
}

template <typename Work>
void per_megabyte(benchmark::State& state, Work work) {
  using Steady = std::chrono::steady_clock;
  const double megabytes = flight().megabytes();
  for (auto _ : state) {
    const auto begin = Steady::now();
    work();
    state.SetIterationTime(std::chrono::duration<double>(Steady::now() - begin).count() /
                           megabytes);
  }
}

void log_read(benchmark::State& state) {
  per_megabyte(state, [] {
    auto reader = *ulog::Reader::open(flight().path());
    ulog::Message message;
    while (*reader.next(message)) benchmark::DoNotOptimize(message);
  });
}

void log_judged(benchmark::State& state) {
  per_megabyte(state, [&] {
    const auto log = read_flight_log(flight().path(), {}, false);
    if (!log) return state.SkipWithError(log.error().message.c_str());
    InProcessHost host(open_builtin());
    for (const LoggedUnit& unit : log->units) {
      const auto found = evaluate_log(unit, "px4-v1.16.0", host, {});
      if (!found || found->result.verdict != Verdict::pass) {
        return state.SkipWithError("the reference does not agree with the log");
      }
    }
  });
}

BENCHMARK(log_read)->Name("log/read")->UseManualTime()->Iterations(1);
BENCHMARK(log_judged)->Name("log/judged")->UseManualTime()->Iterations(1);

}  // namespace
}  // namespace attest::bench
